"""Files and folders that only their owner can read, made exclusively, on disk when done."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TextIO

FOLDER, FILE = 0o700, 0o600


def make_folder(path: Path) -> None:
    """Make a folder and the ones above it that are missing. Raises OSError.

    `Path.mkdir(parents=True)` would make those above readable for everybody.
    """
    if path.is_dir():
        return
    make_folder(path.parent)
    path.mkdir(mode=FOLDER, exist_ok=True)


def open_new(path: Path) -> TextIO:
    """A new text file for writing. Raises FileExistsError: nothing is ever overwritten.

    What UTF-8 cannot hold (half a character from a keyboard) becomes a question mark.
    """
    return open(path, "x", encoding="utf-8", errors="replace", newline="", opener=_private)


def write_new(path: Path, text: str) -> None:
    """A new file with all of `text`, on disk when this returns; none if it cannot be whole."""
    file = open_new(path)
    try:
        with file:
            file.write(text)
            sync(file)
    except OSError:
        path.unlink()
        raise


def sync(file: TextIO) -> None:
    """Everything written to the file is on disk when this returns."""
    file.flush()
    os.fsync(file.fileno())


def _private(path: str, flags: int) -> int:
    return os.open(path, flags, FILE)
