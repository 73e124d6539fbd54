"""Files and folders that only their owner can read; whole on disk, or not there.

Nothing is ever overwritten. What UTF-8 cannot hold (half a character) becomes a question mark.
"""

from __future__ import annotations

import errno
import os
from pathlib import Path

from seethrough.analysis.files.written import FILE, FOLDER, half_of
from seethrough.experiment.errors import InputError

NO_LINKS = (errno.EPERM, errno.ENOTSUP, errno.EMLINK, errno.ENOSYS)


def make_folder(path: Path) -> None:
    """Make a folder and the ones above it that are missing. Raises OSError.

    `Path.mkdir(parents=True)` would make those above readable for everybody.
    """
    if path.is_dir():
        return
    if path.exists():
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), str(path))
    make_folder(path.parent)
    path.mkdir(mode=FOLDER, exist_ok=True)
    sync_folder(path.parent)


def write_new(path: Path, content: str | bytes) -> None:
    """A new file with all of `content`, on disk when this returns, or none. Raises OSError.

    FileExistsError where there is one, also from another process or a link that leads nowhere. The
    name appears last, so a crash leaves no half file.
    """
    half = half_of(path)
    file = os.open(half, os.O_WRONLY | os.O_CREAT | os.O_EXCL, FILE)
    try:
        try:
            write(file, content.encode("utf-8", "replace") if isinstance(content, str) else content)
            os.fsync(file)
        finally:
            os.close(file)
        _name(half, path)
        sync_folder(path.parent)
    finally:
        half.unlink(missing_ok=True)


def _name(half: Path, path: Path) -> None:
    """Give a whole file its name, unless there is one; some disks know no links."""
    try:
        os.link(half, path)
    except OSError as error:
        if error.errno not in NO_LINKS:
            raise
        if os.path.lexists(path):
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(path)) from None
        os.rename(half, path)


def sync_folder(path: Path) -> None:
    """New names are on disk too. Windows cannot open folders, and needs not."""
    if os.name == "posix":
        folder = os.open(path, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)


def write(file: int, data: bytes) -> None:
    """All of `data`. Raises OSError, also where a disk that fills up takes only the beginning."""
    rest = memoryview(data)
    while rest:
        rest = rest[os.write(file, rest) :]


def refused(error: OSError, path: Path) -> InputError:
    """The line for a file that can't be written."""
    return InputError(
        f"{path}: cannot be written: {error.strerror}; every completed trial is saved"
    )
