"""Meshes of a study's own models: read from the files it names, or as a data folder kept them."""

from __future__ import annotations

import hashlib
import io
from functools import cache
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from renderer.geometry import Mesh
from tasks.parameters import OwnModel

ARRAYS = ("vertices", "normals", "colors", "triangles")


@cache
def mesh_of(model: OwnModel) -> Mesh:
    """The model's mesh, made once, so that scenes share it.

    Raises ValueError, in one line that names the file, for one that cannot be shown or that is
    not the file any more that the study began with.
    """
    if kept_as(model).is_file():
        return _kept(kept_as(model))
    from renderer.models.user import load_model  # trimesh: only for those who have models

    path = Path(model.folder) / model.file
    mesh = load_model(path, model.size, model.up, model.turn)
    if model.sha256 not in ("", digest(model)):
        raise ValueError(f"{path}: is another file now than the study began with")
    return mesh


def digest(model: OwnModel) -> str:
    """SHA-256 of the model's file. Raises OSError."""
    return hashlib.sha256((Path(model.folder) / model.file).read_bytes()).hexdigest()


def kept_as(model: OwnModel) -> Path:
    """Where a data folder has the mesh: named by what it was made of."""
    made = f"{model.sha256} {model.size!r} {model.up} {model.turn!r}"
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
