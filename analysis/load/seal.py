"""One hash over everything that was recorded, to put into a preregistration or a paper.

For each file a line `SHA-256, two spaces, name`, the lines in the order of the names' bytes, and
the SHA-256 of all lines: what `find … | LC_ALL=C sort | xargs sha256sum | sha256sum` gives
(CONVENTIONS.md). Neither times nor the disk's order matter.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import Path

from seethrough.analysis.errors import DataError
from seethrough.analysis.load.files import files_under, is_there, sha256_of

SINGLE = ("dataset_description.json", "certificate.csv")


def seal(data: Path, source: str) -> tuple[str, int]:
    """The hash over one source's data, and of how many files. Raises DataError."""
    lines = sorted(
        f"{path.relative_to(data).as_posix()}\n".encode() for path in _sealed(data, source)
    )
    whole = hashlib.sha256()
    for line in lines:
        digest = sha256_of(data / line.decode().rstrip("\n"), data)
        whole.update(digest.encode() + b"  " + line)
    return whole.hexdigest(), len(lines)


def _sealed(data: Path, source: str) -> Iterator[Path]:
    for name in SINGLE:
        if (data / name).is_symlink():
            raise DataError(f"{name}: a link: expected the file itself")
        if is_there(data / name):
            yield data / name
    yield from files_under(data / "models", data)
    yield from files_under(data / "plugins", data)
    yield from files_under(data / "data" / source, data)
