"""Files of a data folder, read so that "cannot be read" never becomes "is not there".

What is there but no file (a folder, a device, a pipe, a link to nowhere), may not be read, is too
large, or is no text as it was written gets a line of its own. Links are followed inside the data
folder only.
"""

from __future__ import annotations

import hashlib
import json
import os
import stat
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from io import BufferedReader
from pathlib import Path

from seethrough.analysis.errors import DataError

LARGEST = 2**30  # bytes: a session's table is some 20 KB, a chunk of sixteen people's 200 KB
AGAIN = "saved again by another program; put the original back"
# A pipe would be waited for: it is opened without, and closed when it is seen to be none of ours.
AT_ONCE = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
MARKS = {b"\xef\xbb\xbf": "a byte order mark", b"\xff\xfe": "UTF-16", b"\xfe\xff": "UTF-16"}


@dataclass(frozen=True, slots=True)
class Source:
    """A file's name as shown, and its bytes."""

    name: str
    data: bytes


def names_in(folder: Path, shown: Path) -> list[str]:
    """What lies in a folder, sorted, without what file managers hide; [] where there is none.

    Raises DataError for a folder that is none, or cannot be read; `shown` is its name in messages.
    """
    try:
        return sorted(name for name in os.listdir(folder) if not name.startswith("."))
    except FileNotFoundError:
        if folder.is_symlink():
            raise DataError(f"{shown}: a link that leads nowhere: expected a folder") from None
        return []
    except NotADirectoryError:
        raise DataError(f"{shown}: a file: expected a folder") from None
    except OSError as error:
        raise DataError(f"{shown}: cannot be read: {error.strerror}") from None


def is_there(path: Path) -> bool:
    """Whether something has this name, be it readable or not."""
    return os.path.lexists(path)


def is_empty(path: Path) -> bool:
    """Whether it is a file, not a link to one, that holds nothing."""
    try:
        about = os.lstat(path)
    except OSError:
        return False
    return stat.S_ISREG(about.st_mode) and about.st_size == 0


def read_bytes(path: Path, data: Path) -> bytes:
    """A file's bytes; `data` is the data folder, from which it is named. Raises DataError."""
    with _opened(path, data) as file:
        return file.read()


def read_text(path: Path, data: Path) -> str:
    """A file's text, in UTF-8. Raises DataError."""
    try:
        return read_bytes(path, data).decode("utf-8")
    except UnicodeDecodeError as error:
        shown = named(path, data)
        raise DataError(f"{shown}: byte {error.start} is not UTF-8 text") from None


def sha256_of(path: Path, data: Path) -> str:
    """SHA-256 of a file's bytes, in hexadecimal. Raises DataError."""
    with _opened(path, data) as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _opened(path: Path, data: Path) -> BufferedReader:
    """The regular file, open for reading. Raises DataError."""
    shown = named(path, data)
    try:
        if not path.resolve().is_relative_to(data.resolve()):
            raise DataError(f"{shown}: a link out of the data folder: expected the file itself")
        file = os.open(path, os.O_RDONLY | AT_ONCE)
    except FileNotFoundError:
        what = "a link that leads nowhere" if path.is_symlink() else "no such file"
        raise DataError(f"{shown}: {what}: expected a file") from None
    except (OSError, RuntimeError) as error:  # RuntimeError: a link that leads to itself
        reason = error.strerror if isinstance(error, OSError) else "a link to itself"
        raise DataError(f"{shown}: cannot be read: {reason}") from None
    about = os.fstat(file)
    if not stat.S_ISREG(about.st_mode) or about.st_size > LARGEST:
        os.close(file)
        what = "too large" if stat.S_ISREG(about.st_mode) else _kind(about.st_mode)
        raise DataError(f"{shown}: {what}: expected a file of at most {LARGEST} bytes")
    return os.fdopen(file, "rb")


def _kind(mode: int) -> str:
    if stat.S_ISDIR(mode):
        return "a folder"
    return "a pipe" if stat.S_ISFIFO(mode) else "a device or socket"


def named(path: Path, data: Path) -> str:
    """A file's name in messages: from the data folder on."""
    return path.relative_to(data).as_posix() if path.is_relative_to(data) else str(path)


def read_json(path: Path, data: Path) -> dict[str, object]:
    """A JSON object in UTF-8, each key once. Raises DataError."""
    raw, shown = read_bytes(path, data), named(path, data)
    for mark, what in MARKS.items():
        if raw.startswith(mark):
            raise DataError(f"{shown}: {AGAIN} ({what})")
    try:
        value = json.loads(raw.decode("utf-8"), object_pairs_hook=_once)
    except UnicodeDecodeError as error:
        raise DataError(f"{shown}: byte {error.start} is not UTF-8 text") from None
    except (ValueError, RecursionError) as error:
        reason = "nested too deep" if isinstance(error, RecursionError) else error
        raise DataError(f"{shown}: not JSON ({reason})") from None
    if not isinstance(value, dict):
        raise DataError(f"{shown}: expected a JSON object")
    return value


def table_in(entry: Mapping[str, object], name: str) -> Mapping[str, object]:
    """A table within one, of JSON or TOML. Raises KeyError, TypeError where there is none."""
    found = entry[name]
    if not isinstance(found, Mapping):
        raise TypeError(f"{name} = {found!r}: expected a table")
    return found


def list_in(entry: Mapping[str, object], name: str) -> Sequence[object]:
    """An array within a table. Raises KeyError, TypeError where there is none."""
    found = entry[name]
    if not isinstance(found, list):
        raise TypeError(f"{name} = {found!r}: expected an array")
    return found


def _once(pairs: list[tuple[str, object]]) -> dict[str, object]:
    """A JSON object; of a key that is there twice each reader would take another value."""
    made: dict[str, object] = {}
    for key, value in pairs:
        if key in made:
            raise ValueError(f"the key {key[:40]!r} is there twice")
        made[key] = value
    return made


def files_under(folder: Path, data: Path) -> Iterator[Path]:
    """Every file under a folder, in the order of their names; no links, which a copy of the folder
    may follow or not, and names that print. Raises DataError."""
    if folder.is_symlink():
        raise DataError(f"{named(folder, data)}: a link: expected the folder itself")
    for name in names_in(folder, Path(named(folder, data))):
        path = folder / name
        if not name.isprintable() or "\\" in name:
            raise DataError(
                f"{named(path, data)}: expected a name that prints, without backslashes"
            )
        if path.is_symlink():
            raise DataError(f"{named(path, data)}: a link: expected the file or folder itself")
        if path.is_dir():
            yield from files_under(path, data)
        else:
            yield path
