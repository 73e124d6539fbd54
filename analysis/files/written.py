"""What a command writes besides data: files and folders that only their owner can read.

A file appears whole, under a name that was no link: where one was planted, the link is replaced
and what it leads to stays as it is.
"""

from __future__ import annotations

import errno
import os
import secrets
from pathlib import Path

FOLDER, FILE = 0o700, 0o600


def own_folder(path: Path) -> Path:
    """A folder, made if it is missing, and no link to another. Raises OSError."""
    if path.is_symlink():
        raise NotADirectoryError(errno.ENOTDIR, "a link: expected a folder", str(path))
    if not path.is_dir():
        if path.parent != path and not path.parent.is_dir():
            own_folder(path.parent)
        path.mkdir(mode=FOLDER, exist_ok=True)
    return path


def write_over(path: Path, content: str | bytes) -> None:
    """A private file with this content, in the place of one that is there. Raises OSError.

    Its half is named at random: process ids are the same in every container.
    """
    half = half_of(path)
    data = content.encode("utf-8", "replace") if isinstance(content, str) else content
    file = os.open(half, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), FILE)
    try:
        with os.fdopen(file, "wb") as writing:
            writing.write(data)
        os.replace(half, path)
    except BaseException:
        half.unlink(missing_ok=True)
        raise


def half_of(path: Path) -> Path:
    """A name beside a file's own, for what is not whole yet, that nobody else has."""
    return path.with_name(f".{path.name[:100]}.{secrets.token_hex(8)}")
