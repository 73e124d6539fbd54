"""A PostgreSQL of a test's own on loopback, from the system's packages; nothing stays behind."""

from __future__ import annotations

import os
import pwd
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from pathlib import Path

START = 20.0  # s for a server on a busy machine: not a bound on speed


class Postgres:
    """A server in a folder of its own, while the context is open; `url` is where it listens."""

    def __enter__(self) -> Postgres:
        # Not below pytest's folders: those are closed to the user that the server must run as.
        self._folder = Path(tempfile.mkdtemp(prefix="ledger-"))
        self._as = _user(self._folder)
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.url = f"postgresql://tester@127.0.0.1:{self.port}/postgres"
        data = self._folder / "data"
        make = [_program("initdb"), "-D", data, "-U", "tester", "-A", "trust", "-E", "UTF8"]
        subprocess.run(
            [*make, "--no-sync", "--locale=C"], check=True, capture_output=True, cwd=self._folder,
            **self._as,
        )  # fmt: skip
        serve = [_program("postgres"), "-D", data, "-p", str(self.port), "-k", self._folder]
        with open(self._folder / "log", "wb") as log:
            self.process = subprocess.Popen(
                [*serve, "-h", "127.0.0.1", "-c", "fsync=off"], cwd=self._folder,
                stdout=log, stderr=log, **self._as,
            )  # fmt: skip
        try:
            self._wait()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self.process.send_signal(signal.SIGQUIT)  # the server ends its children at once
        self.process.wait(START)
        shutil.rmtree(self._folder)

    def _wait(self) -> None:
        end = time.monotonic() + START
        ready = [_program("pg_isready"), "-h", "127.0.0.1", "-p", str(self.port), "-q"]
        while subprocess.run(ready, check=False).returncode:
            said = (self._folder / "log").read_text("utf-8")
            assert self.process.poll() is None and time.monotonic() < end, said
            time.sleep(0.05)


def _user(folder: Path) -> dict[str, object]:
    """Whom to run as: the server refuses root, so root lends the folder to PostgreSQL's user."""
    if os.geteuid() != 0:
        return {}
    user = pwd.getpwnam("postgres")
    os.chown(folder, user.pw_uid, user.pw_gid)
    return {"user": user.pw_uid, "group": user.pw_gid, "extra_groups": []}


def _program(name: str) -> str:
    """Debian keeps the server's programs off the path, by version."""
    found = shutil.which(name) or next(
        (str(p) for p in sorted(Path("/usr/lib/postgresql").glob(f"*/bin/{name}"))), None
    )
    assert found, f"{name} is missing: expected the system's postgresql package"
    return found
