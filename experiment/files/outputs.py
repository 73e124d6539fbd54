"""Where a command is to put a file, asked before the work that the file is to hold."""

from __future__ import annotations

from pathlib import Path

from seethrough.experiment.errors import InputError


def check_output(option: str, path: Path | None, suffix: str = "") -> None:
    """Raises InputError for a name that does not end in `suffix`, and for one that no file can
    have: a folder's, or one in no folder."""
    if path is None:
        return
    if suffix and path.suffix.lower() != suffix:
        raise InputError(f"{option} = {path}: expected a name that ends in {suffix}")
    if path.is_dir():
        raise InputError(f"{option} = {path}: expected a file, there is a folder of that name")
    if not path.parent.is_dir():
        raise InputError(
            f"{option} = {path}: expected an existing folder, there is no {path.parent}"
        )
