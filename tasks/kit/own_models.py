"""Meshes of a study's own models: read from the files it names, or as a data folder kept them."""

from __future__ import annotations

import hashlib
import io
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING
from zipfile import BadZipFile

import numpy as np

from seethrough.renderer.declared import check, key
from seethrough.renderer.scene.geometry import Mesh

if TYPE_CHECKING:
    from seethrough.renderer.models.user import Facts

READER = 2
"""Changes with what the same file looks like: 1 was trimesh with colours as they came."""
ARRAYS = ("vertices", "normals", "colors", "triangles")


@dataclass(frozen=True)
class OwnModel:
    """A model of the study's own: a glTF, OBJ, STL or PLY file beside the study's.

    Participants read its `name`. `size`, `up`, `turn` and `detail` are those of
    renderer/models/user.py. `sha256` of its files, the `folder` they are in and the number of the
    `reader` that shows them are found out when the study is read; what an older reader showed has
    its number, so that a study under way cannot go on with other pictures.
    """

    name: str = key(..., "what participants read", said="1 to 32 printable characters")
    file: str = key(..., "its file, beside the study's", said="the name of a file beside the study")
    size: float = key(1.5, "its longest side", "world units", low=0.01, high=100)
    up: str = key("y", "the file's upward axis; z in most STL files", choices=("y", "z"))
    turn: float = key(
        0.0, "turn to the left, until its front faces away", "degrees", low=-360, high=360
    )
    detail: int = key(
        30_000, "most triangles to cut it into for what a texture shows", low=0, high=250_000
    )
    sha256: str = key(
        "", "its file's SHA-256, found out when the study is read; where it is set, it has to be "
        "that file's", said="64 hexadecimal digits, or empty",
    )  # fmt: skip
    folder: str = ""
    reader: int = key(
        1, "which of our readers shows it, found out when the study is read", low=1, high=1000
    )

    def __post_init__(self) -> None:
        check(self)
        if not (self.name.isprintable() and self.name.strip() and len(self.name) <= 32):
            raise ValueError(f"name = {self.name[:40]!r}, expected 1 to 32 printable characters")
        if not self.file.isprintable() or len(self.file) > 200 or not self.file:
            raise ValueError(f"file = {self.file[:40]!r}, expected a file beside the study")


@cache
def mesh_of(model: OwnModel) -> Mesh:
    """The model's mesh, made once, so that scenes share it.

    Raises ValueError, in one line that names the file, for one that cannot be shown or that is
    not the file any more that the study began with.
    """
    if kept_as(model).is_file():
        return _kept(kept_as(model))
    return read(model)[0]


def read(model: OwnModel) -> tuple[Mesh, Facts]:
    """The mesh, and what there is to tell about it, from the model's files. Raises ValueError as
    `mesh_of` does, and OSError."""
    path = Path(model.folder) / model.file
    mesh, facts = _read(path, model.size, model.up, model.turn, model.detail)
    if model.sha256 not in ("", facts.digest):
        raise ValueError(f"{path}: is another file now than the study began with")
    return mesh, facts


@cache
def _read(path: Path, size: float, up: str, turn: float, detail: int) -> tuple[Mesh, Facts]:
    from seethrough.renderer.models.user import read_model  # only for those who have models

    return read_model(path, size, up, turn, detail)


def kept_as(model: OwnModel) -> Path:
    """Where a data folder has the mesh: named by what it was made of."""
    made = f"{model.sha256} {model.size!r} {model.up} {model.turn!r}"
    if model.reader > 1:
        made += f" {model.detail} {model.reader}"
    return Path(model.folder) / f"{hashlib.sha256(made.encode()).hexdigest()[:24]}.npz"


def packed(mesh: Mesh) -> bytes:
    """The mesh as a file of NumPy's."""
    file = io.BytesIO()
    np.savez_compressed(file, **{name: getattr(mesh, name) for name in ARRAYS})
    return file.getvalue()


def _kept(path: Path) -> Mesh:
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as arrays:
            return Mesh(*(arrays[name] for name in ARRAYS))
    except (OSError, ValueError, KeyError, EOFError, BadZipFile) as error:
        raise ValueError(f"{path}: not a kept model: {' '.join(str(error).split())}") from None
