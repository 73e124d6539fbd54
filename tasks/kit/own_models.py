"""Meshes of a study's own models: read from the files it names, or as a data folder kept them."""

from __future__ import annotations

import hashlib
import io
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING
from zipfile import BadZipFile

import numpy as np

from seethrough.renderer.scene.geometry import Mesh
from seethrough.tasks.parameters import OwnModel

if TYPE_CHECKING:
    from seethrough.renderer.models.user import Facts

READER = 2
"""Changes with what the same file looks like: 1 was trimesh with colours as they came."""
ARRAYS = ("vertices", "normals", "colors", "triangles")


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
