"""The bytes of a model's files: the one that is named, and those that it names."""

from __future__ import annotations

import hashlib
from pathlib import Path, PurePosixPath

MOST_BYTES = 256 * 2**20


class Refused(ValueError):
    """Why a model cannot be shown, in one line without the file's name."""


class Nothing(Refused):
    """There is nothing to be seen of a model."""


class Source:
    """Reads a model's files, and remembers what was read: `hashes` of each by its name."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.hashes: dict[str, str] = {}

    def main(self) -> bytes:
        """The model's own file. Raises Refused, OSError."""
        if not self.path.is_file():
            raise Refused("expected a model file, there is none")
        data = _bytes(self.path, "")
        if not data:
            raise Refused("0 bytes: expected a model, the file is empty")
        self.hashes[self.path.name] = hashlib.sha256(data).hexdigest()
        return data

    def beside(self, name: str, what: str) -> bytes:
        """A file that the model names, in its folder or below. Raises Refused, OSError.

        Programs on Windows write backslashes, whole paths of the machine that it was made on, and
        names in another case: what is meant is the file of that name beside the model.
        """
        path = self._found(name)
        if path is None or not path.is_file():
            raise Refused(f"{what} {name[:80]!r}: expected a file beside the model, there is none")
        data = _bytes(path, f"{what} {name[:80]!r}: ")
        self.hashes[path.relative_to(self.path.parent).as_posix()] = hashlib.sha256(
            data
        ).hexdigest()
        return data

    def digest(self) -> str:
        """SHA-256 of the model's file; of the names and hashes of all, where there are others."""
        if len(self.hashes) == 1:
            return next(iter(self.hashes.values()))
        lines = "".join(f"{value}  {name}\n" for name, value in sorted(self.hashes.items()))
        return hashlib.sha256(lines.encode("utf-8", "replace")).hexdigest()

    def _found(self, name: str) -> Path | None:
        if not name.strip() or not name.isprintable() or len(name) > 1000:
            return None
        way = PurePosixPath(name.strip().replace("\\", "/"))
        parts = [part for part in way.parts if part != "."]
        if not parts:
            return None
        if way.is_absolute() or ":" in parts[0] or ".." in parts:
            parts = parts[-1:]
        folder = self.path.parent
        for part in parts:
            found = _entry(folder, part)
            if found is None:
                return None
            folder = found
        inside = folder.resolve().is_relative_to(self.path.parent.resolve())
        return folder if inside else None


def _entry(folder: Path, name: str) -> Path | None:
    """What the folder has by that name, or by the only one that differs in its case."""
    if (folder / name).exists():
        return folder / name
    if not folder.is_dir():
        return None
    alike = [entry for entry in folder.iterdir() if entry.name.lower() == name.lower()]
    return alike[0] if len(alike) == 1 else None


def _bytes(path: Path, what: str) -> bytes:
    length = path.stat().st_size
    if length > MOST_BYTES:
        raise Refused(f"{what}{length} bytes: expected at most {MOST_BYTES}")
    return path.read_bytes()
