"""A user's own models: glTF, OBJ, STL and PLY files as meshes, and what was made of them.

Every way in which a file can be unusable ends in a ValueError of one line that names the file.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bools, Floats
from seethrough.renderer.models.files.part import (
    GREY,
    LARGEST,
    MOST_TRIANGLES,
    Found,
    Part,
    to_shown,
)
from seethrough.renderer.models.files.refine import Carried, refined
from seethrough.renderer.models.files.source import Nothing, Refused, Source
from seethrough.renderer.models.files.surface import (
    Sides,
    Surface,
    doubled,
    joined,
    shown_from_outside,
)
from seethrough.renderer.models.forms.shapes import Shape, assemble, shade, shape
from seethrough.renderer.scene.geometry import Mesh

READERS = {".glb": "gltf", ".gltf": "gltf", ".obj": "obj", ".ply": "ply", ".stl": "stl"}
KINDS = tuple(READERS)
DETAIL = 30_000
"""Triangles that textures may add: a logo of 64 texels on each side of a box takes as many."""
Read = TypeVar("Read")

__all__ = ["DETAIL", "GREY", "KINDS", "MOST_TRIANGLES", "Facts", "load_model", "read_model"]


@dataclass(frozen=True)
class Facts:
    """What a file held and what became of it.

    `in_file` triangles; `size` (3,) of the model as it stands, x, y, z in world units; `colors`
    says where they come from; `sides` how it was made to show from everywhere; `carried` how its
    textures came through, None without any; `stands` the share of its footprint that touches the
    ground with "y" and with "z" up; `notes` what is not shown as it is in the file; `digest` of
    all its files.
    """

    in_file: int
    size: tuple[float, float, float]
    colors: str
    sides: Sides
    carried: Carried | None
    stands: dict[str, float]
    notes: tuple[str, ...]
    digest: str


def load_model(
    path: Path, size: float = 1.5, up: str = "y", turn: float = 0.0, detail: int = DETAIL
) -> Mesh:
    """The file's meshes as one, standing on y = 0, centred, its longest side `size` units.

    `up` is the file's upward axis, "y" or "z" (usual in STL files); `turn` degrees to the left
    bring its front to −z. glTF says that models face +z, so those are turned by half a turn
    first. Colours are those that a viewer of glTF shows; textures become colours of vertices, for
    which at most `detail` triangles are added. Raises ValueError, with a message of one line that
    names the file, for whatever cannot be shown.
    """
    return read_model(path, size, up, turn, detail)[0]


def read_model(
    path: Path, size: float = 1.5, up: str = "y", turn: float = 0.0, detail: int = DETAIL
) -> tuple[Mesh, Facts]:
    """`load_model`, and what there is to tell about it."""
    try:
        _check(size, up, turn)
        source = Source(path)
        found = found_in(source)
        return _made(found, source, size, up, turn, detail)
    except Refused as error:
        raise ValueError(f"{path}: {error}") from None


def _check(size: float, up: str, turn: float) -> None:
    if up not in ("y", "z"):
        raise Refused(f"up = {up!r}: expected 'y' or 'z'")
    if not (np.isfinite(size) and size > 0):
        raise Refused(f"size = {size}: expected a number > 0")
    if not np.isfinite(turn):
        raise Refused(f"turn = {turn}: expected an angle in degrees")


def found_in(source: Source) -> Found:
    """What the reader for the file's kind makes of it, checked. Raises Refused."""
    suffix = source.path.suffix.lower()
    if suffix not in KINDS:
        raise Refused(f"expected a model file, one of {', '.join(KINDS)}")
    module = import_module(f"seethrough.renderer.models.files.{READERS[suffix]}")
    found: Found = told(source, module.read)
    check_parts(found.parts)
    return found


def told(source: Source, read: Callable[[Source], Read]) -> Read:
    """What a reader makes of a file; whatever else it raises becomes Refused."""
    try:
        return read(source)
    except (Refused, OSError):
        raise
    except Exception as error:  # a broken file may lack or mistake anything that its format has
        said = f"expected a {source.path.suffix[1:].upper()} file, it cannot be read"
        raise Refused(
            f"{said}: something in it is missing, or is not what its format says"
        ) from error


def check_parts(parts: list[Part]) -> None:
    """Raises Refused for coordinates that are no numbers, or too large."""
    for part in parts:
        _check_numbers(part.vertices, "vertex", "coordinates", LARGEST)
        if part.uv is not None:
            _check_numbers(part.uv.reshape(-1, 2), "corner", "texture coordinates", 1e6)


def _check_numbers(values: Floats, what: str, expected: str, most: float) -> None:
    bad = np.flatnonzero(~(np.abs(values) < most).all(axis=1))  # NaN is not less either
    if len(bad):
        shown = ", ".join(f"{v:g}" for v in values[bad[0]])
        finite = "finite" if not np.isfinite(values[bad[0]]).all() else f"smaller than {most:g}"
        raise Refused(f"{what} {bad[0]} = ({shown}): expected {finite} {expected}")


def _made(
    found: Found, source: Source, size: float, up: str, turn: float, detail: int
) -> tuple[Mesh, Facts]:
    def stand(solid: Shape) -> Shape:
        standing = solid.turned("x", -90) if up == "z" else solid
        if source.path.suffix.lower() in (".glb", ".gltf"):
            standing = standing.turned("y", 180)
        return assemble(standing.turned("y", turn), size=size)

    made = meshed(found.parts, found, detail, stand)
    extent = np.ptp(made.mesh.vertices, axis=0)
    solid = made.solid
    facts = Facts(
        sum(len(p.triangles) for p in found.parts),
        (float(extent[0]), float(extent[1]), float(extent[2])), ", ".join(sorted(found.colors)),
        made.sides, made.carried,
        {axis: _standing(solid.vertices, solid.triangles, axis) for axis in ("y", "z")},
        tuple(found.notes), source.digest(),
    )  # fmt: skip
    return made.mesh, facts


@dataclass(frozen=True, eq=False)
class Made:
    """A mesh of a file's parts, what was done to their sides and textures, and the solid as it
    stood in the file."""

    mesh: Mesh
    sides: Sides
    carried: Carried | None
    solid: Shape


def meshed(
    parts: list[Part], found: Found, detail: int, stand: Callable[[Shape], Shape] = lambda s: s
) -> Made:
    """Parts as one mesh that shows from every side, where `stand` puts it. Raises Refused."""
    surface = _without_hidden(joined(parts), found)
    if not len(surface.triangles):
        raise Nothing("0 triangles with an area: expected a mesh")
    surface, is_open, turned = shown_from_outside(surface)
    is_open |= _with_holes(surface)
    solid = shape(surface.vertices, surface.triangles, (1.0, 1.0, 1.0))
    standing = stand(solid)
    plain = shade(standing)
    normals = _true_normals(plain, standing.vertices[standing.triangles])
    surface = replace(surface, vertices=standing.vertices)
    surface, copied = doubled(surface, is_open)
    normals = np.concatenate([normals, -normals[copied][:, ::-1]])
    sides = Sides(int((~is_open).sum()), turned, len(copied))
    if surface.textures:
        surface, normals, carried = refined(surface, normals, detail)
    else:
        surface, carried = replace(surface, colors=to_shown(surface.colors), textures=()), None
    if not len(surface.triangles):
        raise Nothing("0 triangles that can be seen, all are transparent: expected a mesh")
    return Made(_mesh(surface, normals), sides, carried, solid)


def _without_hidden(surface: Surface, found: Found) -> Surface:
    """Without triangles that alpha hides; where a texture says so, that is found out later."""
    alpha = surface.colors[..., 3]
    hidden = (alpha == 0).all(axis=1) & (surface.cutoff >= 0)
    hidden |= (alpha.mean(axis=1) < surface.cutoff) & (surface.texture < 0)
    if hidden.any() and len(surface.triangles):
        if hidden.all():
            raise Nothing("0 triangles that can be seen, all are transparent: expected a mesh")
        found.note(f"{int(hidden.sum())} triangles of alpha 0 are not shown")
    return surface.take(~hidden)


def _with_holes(surface: Surface) -> Bools:
    """(m,) triangles whose texture may hide a part of them, so that their backs show."""
    hiding = np.array([bool((t.levels[0][..., 3] < 1).any()) for t in surface.textures] + [False])
    return hiding[surface.texture] & (surface.cutoff >= 0)


def _true_normals(mesh: Mesh, corners: Floats) -> Floats:
    """(m, 3, 3) normals of corners; the triangle's own where those of its surroundings cancel."""
    normals = mesh.normals[mesh.triangles]
    a, b, c = np.moveaxis(corners, 1, 0)
    own = np.cross(b - a, c - a)
    own = own / np.linalg.norm(own, axis=1, keepdims=True)
    good = np.isfinite(normals).all(axis=2, keepdims=True)
    return np.where(good, normals, own[:, None])


def _mesh(surface: Surface, normals: Floats) -> Mesh:
    """Corners that agree in place, normal and colour become one vertex."""
    flat, rgb = normals.reshape(-1, 3), surface.colors[..., :3].reshape(-1, 3)
    flat = flat / np.linalg.norm(flat, axis=1, keepdims=True)
    # To the millionth: less is rounding, and colours have 255 steps.
    whole = np.round(np.concatenate([flat, rgb], axis=1) * 1e6).astype(np.int64)
    rows = np.ascontiguousarray(np.column_stack([surface.triangles.ravel(), whole]))
    names = rows.view(np.dtype((np.void, rows.dtype.itemsize * rows.shape[1]))).ravel()
    _, first, which = np.unique(names, return_index=True, return_inverse=True)
    return Mesh(
        vertices=surface.vertices[surface.triangles.ravel()[first]],
        normals=flat[first],
        colors=np.clip(rgb[first], 0.0, 1.0),
        triangles=which.reshape(-1, 3).astype(np.int32),
    )


def _standing(vertices: Floats, triangles: NDArray[np.int64], axis: str) -> float:
    """Share of the footprint that touches the ground if `axis` points up: the area of triangles
    that lie within a fiftieth of its height, seen from below, of the rectangle about it all."""
    k = "xyz".index(axis)
    a, b, c = np.moveaxis(vertices[triangles], 1, 0)
    flat = [i for i in range(3) if i != k]
    u, v = (b - a)[:, flat], (c - a)[:, flat]
    area = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
    low, extent = vertices.min(axis=0), np.ptp(vertices, axis=0)
    ground = np.stack([a, b, c], axis=1)[..., k].max(axis=1) <= low[k] + 0.02 * extent[k]
    whole = extent[flat].prod()
    return float(min(area[ground].sum() / whole, 1.0)) if whole > 0 else 0.0
