"""Files of a study, and the study's own: regular ones of a sensible size, beside it.

A study comes from a colleague or out of a download: it may name any file, and must not make the
program read it. Devices and pipes are never read.
"""

from __future__ import annotations

import os
import stat
from pathlib import Path, PureWindowsPath

LARGEST_STUDY = 2**18  # bytes; the longest shipped study has 3,000
LARGEST_TEXT = 2**18
LARGEST_MODEL = 2**28
AT_ONCE = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)


def read_beside(study: Path, name: str, most: int) -> bytes:
    """A file that a study names, which lies beside it or in a folder there.

    Raises ValueError for any other place or kind, OSError where it cannot be read.
    """
    return read_regular(place_beside(study, name), most)


def place_beside(study: Path, name: str) -> Path:
    """Where the file that a study names lies. Raises ValueError unless beside the study."""
    folder = study.parent
    if not name or "\0" in name or ".." in Path(name).parts or _is_absolute(name):
        raise ValueError("not a file beside the study")
    path = folder / name
    try:
        inside = path.resolve().is_relative_to(folder.resolve())
    except (RuntimeError, OSError):  # the former is Python 3.11's word for it
        raise ValueError("a link that leads to itself") from None
    if not inside:
        raise ValueError("a link out of the study's folder")
    return path


def _is_absolute(name: str) -> bool:
    return Path(name).is_absolute() or bool(PureWindowsPath(name).anchor)


def read_regular(path: Path, most: int) -> bytes:
    """A regular file's bytes. Raises OSError; its reason says what it is instead."""
    file = os.open(path, os.O_RDONLY | AT_ONCE)
    with os.fdopen(file, "rb") as reading:
        about = os.fstat(file)
        if not stat.S_ISREG(about.st_mode):
            raise OSError(0, "not a regular file", str(path))
        data = reading.read(most + 1)
    if len(data) > most:
        raise OSError(0, f"more than {most} bytes", str(path))
    return data
