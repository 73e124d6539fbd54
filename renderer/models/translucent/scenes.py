"""Every scene of the ordering benchmarks and of the viewer, by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.translucent import garden, house, vise
from seethrough.renderer.models.translucent.solids import Faces, box
from seethrough.renderer.polygons.polygons import (
    Polygons,
    newell,
    polygons_from,
    triangles_from,
)

# Length of a soup's sides, times the mean distance of its triangles: makes the baseline of two to
# three pieces for each triangle at any size.
SOUP_SIZE = 0.25
LIGHT = np.array([3.0, 6.0, 2.0]) / 7.0  # where it comes from


@dataclass(frozen=True, eq=False, slots=True)
class TranslucentScene:
    """Translucent polygons to order, opaque ones drawn before them, and perhaps a texture.

    Attributes are r, g, b, opacity, u, v, textured (0 or 1). `closed`: closed volumes (Chen1996).
    """

    name: str
    polygons: Polygons
    opaque: Polygons | None = None
    texture: Floats | None = None
    closed: bool = False

    @property
    def center(self) -> Floats:
        """(3,) middle of the translucent polygons' bounds."""
        vertices = self.polygons.vertices
        return (vertices.min(axis=0) + vertices.max(axis=0)) / 2

    @property
    def radius(self) -> float:
        """Of a sphere about the centre that holds them."""
        return float(np.linalg.norm(self.polygons.vertices - self.center, axis=1).max())

    def eyes(self, count: int, rng: np.random.Generator) -> Floats:
        """(count, 3) eyes all around, from which the whole scene is seen."""
        ways = rng.normal(size=(count, 3))
        ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        return self.center + 2.3 * self.radius * ways


def _colored(
    name: str, polygons: Polygons, by_object: bool, closed: bool = False
) -> TranslucentScene:
    """Random colours, half transparent: of each polygon, or of each object."""
    rng = np.random.default_rng(np.random.SeedSequence(3, spawn_key=(0,)))
    labels = polygons.objects if by_object else np.arange(len(polygons))
    colors = rng.uniform(0.15, 1.0, (int(labels.max(initial=0)) + 1, 3))[labels]
    corner = np.repeat(np.arange(len(polygons)), polygons.counts)
    columns = np.zeros((len(corner), 7))
    columns[:, :3], columns[:, 3] = (colors * _light(polygons)[:, None])[corner], 0.5
    made = Polygons(polygons.vertices, polygons.starts, columns, polygons.objects)
    return TranslucentScene(name, made, closed=closed)


def _light(polygons: Polygons) -> Floats:
    """(m,) light that each face gets, .7 to 1, so that the sides of a box can be told apart."""
    normals = newell(polygons)
    length = np.maximum(np.linalg.norm(normals, axis=1), np.finfo(float).tiny)
    return 0.85 + 0.15 * (normals @ LIGHT) / length


def _solids(name: str, parts: list[Faces]) -> TranslucentScene:
    faces = [face for part in parts for face in part]
    labels = np.repeat(np.arange(len(parts)), [len(part) for part in parts])
    return _colored(name, polygons_from(faces, objects=labels), by_object=True)


def random_boxes(count: int = 100) -> TranslucentScene:
    """Boxes that don't intersect, turned every way (Kang2008, figure 4)."""
    rng = np.random.default_rng(np.random.SeedSequence(3, spawn_key=(4,)))
    parts = []
    for cell in rng.permutation(5**3)[:count]:
        middle = np.array(np.unravel_index(cell, (5, 5, 5))) * 2.0
        q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        q *= np.sign(np.linalg.det(q))
        half = rng.uniform(0.15, 0.55, 3)
        parts.append([face @ q + middle for face in box(tuple(-half), tuple(half))])
    return _solids("boxes", parts)


def panels(count: int = 100) -> TranslucentScene:
    """Parallel panels, one behind the other, each a little aside (Kang2008, figure 5)."""
    parts = []
    for i in range(count):
        x, y = 1.5 * np.cos(0.7 * i), np.sin(0.9 * i)
        z = -0.25 * i
        parts.append(box((x - 1.2, y - 0.9, z), (x + 1.2, y + 0.9, z + 0.05)))
    return _solids(f"panels{count}", parts)


def soup(count: int = 1000) -> TranslucentScene:
    """Random triangles in a cube."""
    rng = np.random.default_rng(np.random.SeedSequence(3, spawn_key=(5, count)))
    sides = rng.normal(size=(count, 3, 3)) * SOUP_SIZE * count ** (-1 / 3)
    corners = (rng.random((count, 1, 3)) + sides).reshape(-1, 3)
    return _colored(
        f"soup{count}",
        triangles_from(corners, np.arange(3 * count).reshape(-1, 3)),
        by_object=False,
    )


def _garden(name: str) -> TranslucentScene:
    return TranslucentScene(name, *getattr(garden, name)())


SCENES: dict[str, Callable[[], TranslucentScene]] = {
    "boxes": random_boxes,
    "panels100": lambda: panels(100),
    "panels300": lambda: panels(300),
    "cottage": lambda: _garden("cottage"),
    "leaves": lambda: _garden("leaves"),
    "fishbowl": lambda: _garden("fishbowl"),
    "fence": lambda: _garden("fence"),
    "cow": lambda: _garden("cow"),
    "vise": lambda: _colored("vise", polygons_from(vise.faces()), by_object=False, closed=True),
    "house": lambda: _colored("house", polygons_from(house.faces()), by_object=False, closed=True),
    "soup1000": lambda: soup(1000),
    "soup10000": lambda: soup(10_000),
    "soup100000": lambda: soup(100_000),
}


def scene(name: str) -> TranslucentScene:
    """A scene by name. Raises ValueError with the names there are."""
    if name not in SCENES:
        raise ValueError(f"scene = {name!r}, expected one of {', '.join(SCENES)}")
    return SCENES[name]()
