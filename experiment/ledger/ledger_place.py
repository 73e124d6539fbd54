"""Where a data folder's ledger lies: in its SQLite file, or at the address in `ledger.url`.

The address is written down when the ledger moves to a database, so that a station that forgets
`--ledger` does not begin a second one.
"""

from __future__ import annotations

import os
from pathlib import Path

from sqlalchemy.engine import URL, Engine
from sqlalchemy.exc import DBAPIError

from seethrough.experiment.errors import InputError
from seethrough.experiment.files.private import make_folder, write_new
from seethrough.experiment.ledger import ledger_store as store

FILE = "ledger.sqlite"
LOCKS = "locks.sqlite"  # of sessions without a ledger: pilots
POINTER = "ledger.url"
MOVED = "ledger-moved.sqlite"
STUDY = "study.path"


def find(data: Path, wanted: str = "") -> URL:
    """The ledger's address: the one wanted, else the one noted, else the folder's file.

    Raises InputError for an address that is no PostgreSQL's, or other than the noted one.
    """
    noted = _noted(data)
    if not wanted:
        return noted or store.sqlite_url(data / FILE)
    url = store.parse_url(wanted)
    if noted and store.shown(noted) != store.shown(url):
        raise InputError(
            f"--ledger = {store.shown(url)}: expected {store.shown(noted)}, "
            f"where this study's ledger is ({data / POINTER})"
        )
    return url


def exists(data: Path, wanted: str = "") -> bool:
    """Whether the folder has a ledger."""
    return bool(wanted) or (data / POINTER).exists() or (data / FILE).exists()


def note_study(data: Path, study: Path, name: str = "") -> None:
    """Note which file the study is in, for `status`: its path, or the `name` of a shipped one."""
    text = f"{name or study.resolve()}\n"
    path = data / STUDY
    try:
        if not path.exists() or path.read_text("utf-8") != text:
            path.unlink(missing_ok=True)
            write_new(path, text)
    except FileExistsError:
        pass  # another station noted its own just now
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None


def noted_study(data: Path) -> str:
    """What was noted; empty where nothing was, or where the file is not there any more."""
    try:
        noted = (data / STUDY).read_text("utf-8").strip()
    except (OSError, UnicodeDecodeError):
        return ""
    return noted if ("/" not in noted and "\\" not in noted) or Path(noted).is_file() else ""


def exists_elsewhere(data: Path, wanted: str = "") -> bool:
    """Whether the ledger is, or will be, in a database and not in the folder."""
    return bool(wanted) or (data / POINTER).exists()


def settle(data: Path, url: URL, engine: Engine) -> None:
    """Note a database's address in the folder; what its SQLite file holds moves there.

    Raises InputError where another station notes another address at the same moment.
    """
    if url.get_backend_name() == "sqlite":
        return
    old = data / FILE
    if old.exists():
        _move(old, engine)
        os.replace(old, data / MOVED)
    if not (data / POINTER).exists():
        make_folder(data)
        try:
            write_new(data / POINTER, store.shown(url) + "\n")
        except FileExistsError:  # another station noted one at the same moment
            find(data, store.shown(url))


def _noted(data: Path) -> URL | None:
    path = data / POINTER
    if not path.exists():
        return None
    return store.parse_url(path.read_text(encoding="utf-8", errors="replace").strip())


def _move(old: Path, engine: Engine) -> None:
    """Copy every study and entry; all or nothing. Raises InputError where the study is there."""
    source = store.connect(store.sqlite_url(old))
    try:
        with store.exclusive(source) as read, store.exclusive(engine) as write:
            for table in (store.STUDIES, store.ENTRIES, store.SUMS):
                rows = [dict(row) for row in read.execute(table.select()).mappings()]
                for row in rows:
                    row.pop("id", None)
                if rows:
                    write.execute(table.insert(), rows)
    except InputError as error:
        if isinstance(error.__cause__, DBAPIError):
            raise InputError(f"{old}: cannot move to {store.shown(engine.url)}: {error}") from None
        raise
    finally:
        source.dispose()
