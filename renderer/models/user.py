"""A user's own models: glTF, OBJ, STL and PLY files, read by trimesh.

Every way in which a file can be unusable ends in a ValueError of one line that names the file.
"""

from __future__ import annotations

import logging
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from renderer.geometry import Mesh
from renderer.models.shapes import Array, Shape, assemble, join, shade, shape

if TYPE_CHECKING:
    import trimesh

KINDS = (".glb", ".gltf", ".obj", ".ply", ".stl")
MOST_TRIANGLES = 250_000
"""Half of the whole walkthrough: more in one object is a mistake more often than a wish."""
MOST_BYTES = 256 * 2**20
GREY = (0.7, 0.7, 0.7)


def load_model(path: Path, size: float = 1.5, up: str = "y", turn: float = 0.0) -> Mesh:
    """The file's meshes as one, standing on y = 0, centred, its longest side `size` units.

    `up` is the file's upward axis, "y" or "z" (usual in STL files); `turn` degrees to the left
    bring its front to −z. glTF says that models face +z, so those are turned by half a turn
    first. Vertex colours, material colours and textures become vertex colours. A closed surface
    that is inside out is turned. Raises ValueError, with a message of one line that names the
    file, for whatever cannot be shown.
    """
    if up not in ("y", "z"):
        raise ValueError(f"{path}: up = {up!r}: expected 'y' or 'z'")
    if not (np.isfinite(size) and size > 0):
        raise ValueError(f"{path}: size = {size}: expected a number > 0")
    if not np.isfinite(turn):
        raise ValueError(f"{path}: turn = {turn}: expected an angle in degrees")
    _check_file(path)
    whole = join(*(_cleaned(part) for part in _parts(path)))
    if not len(whole.triangles):
        raise ValueError(f"{path}: 0 triangles with an area: expected a mesh")
    if up == "z":
        whole = whole.turned("x", -90)
    if path.suffix.lower() in (".glb", ".gltf"):
        whole = whole.turned("y", 180)
    return shade(assemble(whole.turned("y", turn), size=size))


def _check_file(path: Path) -> None:
    if path.suffix.lower() not in KINDS:
        raise ValueError(f"{path}: expected a model file, one of {', '.join(KINDS)}")
    if not path.is_file():
        raise ValueError(f"{path}: expected a model file, there is none")
    length = path.stat().st_size
    if length == 0:
        raise ValueError(f"{path}: 0 bytes: expected a model, the file is empty")
    if length > MOST_BYTES:
        raise ValueError(f"{path}: {length} bytes: expected at most {MOST_BYTES}")


def _parts(path: Path) -> list[trimesh.Trimesh]:
    """The meshes in the file, each where the file's scene puts it, checked."""
    import trimesh

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of a broken file's numbers: checked below
            logging.getLogger("trimesh").setLevel(logging.CRITICAL)
            found = trimesh.load_scene(path, process=False).dump()
    except Exception as error:  # a parser may stumble over a broken file in any way
        reason = " ".join(str(error).split())[:120] or type(error).__name__
        raise ValueError(
            f"{path}: expected a {path.suffix[1:].upper()} file, it cannot be read: {reason}"
        ) from error
    meshes = [g for g in found if isinstance(g, trimesh.Trimesh) and len(g.faces)]
    if not meshes:
        raise ValueError(f"{path}: 0 triangles: expected a mesh")
    total = sum(len(m.faces) for m in meshes)
    if total > MOST_TRIANGLES:
        raise ValueError(f"{path}: {total} triangles: expected at most {MOST_TRIANGLES}")
    for mesh in meshes:
        _check_arrays(path, np.asarray(mesh.vertices), np.asarray(mesh.faces))
    return meshes


def _check_arrays(path: Path, vertices: Array, faces: NDArray[np.int64]) -> None:
    bad = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if len(bad):
        values = ", ".join(f"{v:g}" for v in vertices[bad[0]])
        raise ValueError(f"{path}: vertex {bad[0]} = ({values}): expected finite coordinates")
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise ValueError(
            f"{path}: a triangle names vertex {faces.max()} of {len(vertices)}: "
            "expected vertices the file has"
        )


def _cleaned(mesh: trimesh.Trimesh) -> Shape:
    """Without triangles of no area, vertices at one place made one, the outside out."""
    vertices, which = np.unique(np.asarray(mesh.vertices, float), axis=0, return_inverse=True)
    triangles = which.reshape(-1)[np.asarray(mesh.faces, np.int64)].reshape(-1, 3)
    a, b, c = np.moveaxis(vertices[triangles], 1, 0)
    normal = np.cross(b - a, c - a)
    area = np.linalg.norm(normal, axis=1)
    # Relative to the extent, so that a model in millimetres is judged like one in kilometres.
    kept = area > 1e-14 * np.ptp(vertices, axis=0).max() ** 2
    colors = _colors(mesh)[np.asarray(mesh.faces)]
    if _closed(triangles[kept]) and np.einsum("ij,ij->", a - vertices[0], normal) < 0:
        triangles, colors = triangles[:, ::-1], colors[:, ::-1]
    return shape(vertices, triangles[kept], colors[kept])


def _closed(triangles: NDArray[np.int64]) -> bool:
    """Whether each edge is run as often one way as the other."""
    start, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    n = triangles.max(initial=0) + 1
    return bool((np.sort(start * n + end) == np.sort(end * n + start)).all())


def _colors(mesh: trimesh.Trimesh) -> Array:
    """(n, 3) of the vertices, grey where the file has none."""
    visual: Any = mesh.visual
    if visual is None or not visual.defined:
        return np.tile(GREY, (len(mesh.vertices), 1))
    if visual.kind == "texture":
        visual = visual.to_color()
    colors = np.asarray(visual.vertex_colors, float).reshape(-1, 4)[:, :3] / 255
    return np.broadcast_to(colors, (len(mesh.vertices), 3))  # a plain material gives one row
