"""The most memory that processes held, from /proc (Linux).

Not getrusage's ru_maxrss: that stands across `exec`, so a new process starts with its parent's, and
a benchmark would report its own. VmHWM belongs to what the process runs now.
"""

from __future__ import annotations

import os
import subprocess
import sys
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from threading import Event, Thread

PROC = Path("/proc")
_TELL = """
import os
from seethrough.benchmarks.memory import peak
print()
print(peak(), sum(os.times()[:4]))
"""


@dataclass(frozen=True, slots=True)
class Used:
    """What a process used: `peak` in MiB, None where the system does not tell; `cpu` in seconds."""

    peak: float | None
    cpu: float


def peak(process: int | str = "self") -> float | None:
    """The most memory (MiB) a running process has held; None where the system does not tell."""
    return _peak(_status(str(process)))


def used_by(code: str, *words: str) -> Used:
    """What a fresh Python used that ran `code` with `words` as its arguments.

    Raises CalledProcessError if it failed.
    """
    done = subprocess.run(
        [sys.executable, "-c", code + _TELL, *words], check=True, capture_output=True, text=True
    )
    told, cpu = done.stdout.splitlines()[-1].split()
    return Used(None if told == "None" else float(told), float(cpu))


class Watch:
    """While it is entered: the most (`peak`, MiB) that this process or one it started has held.

    Without `own` only those it started, where its own peak may be of what it did before. `total` is
    the largest sum of their peaks, in which what they share counts several times. A peak only
    grows, so reading it now and then misses no more than a process's last moments.
    """

    def __init__(self, every: float = 0.2, own: bool = True) -> None:
        self.peak: float | None = None
        self.total = 0.0
        self._every, self._first = every, 0 if own else 1
        self._over = Event()
        self._thread = Thread(target=self._look, daemon=True)

    def __enter__(self) -> Watch:
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        self._over.set()
        self._thread.join()

    def _look(self) -> None:
        while True:
            over = self._over.wait(self._every)
            known = [p for p in map(peak, _family()[self._first :]) if p is not None]
            self.peak = max([*known, self.peak or 0.0]) if known else self.peak
            self.total = max(self.total, sum(known))
            if over:
                return


def _family() -> list[int]:
    """This process and all that it, or one of them, started."""
    parents = {}
    for folder in PROC.glob("[0-9]*"):
        status = _status(folder.name)
        if "PPid" in status:
            parents[int(folder.name)] = int(status["PPid"])
    found = [os.getpid()]
    for known in found:  # grows on the way
        found += [child for child, parent in parents.items() if parent == known]
    return found


def _status(process: str) -> dict[str, str]:
    """What the system says of a process; nothing if it has ended."""
    with suppress(OSError):
        lines = (PROC / process / "status").read_text("utf-8", "replace").splitlines()
        return {key: value.strip() for key, _, value in (line.partition(":") for line in lines)}
    return {}


def _peak(status: dict[str, str]) -> float | None:
    """From "123 kB"; a process that has ended, but was not waited for, has none."""
    return int(status["VmHWM"].split()[0]) / 1024 if "VmHWM" in status else None
