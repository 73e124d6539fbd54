"""Is a picture painted in an order the exact one? Every scene, many eyes, the worst of them.

A pixel may differ where its centre lies within rounding of an edge: corners are snapped to 1/256
of a pixel before they are filled, so an edge that was cut in two is not quite where it was. The
second figure says how far from an edge the farthest such pixel is.
"""

from __future__ import annotations

import os
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from seethrough.benchmarks.orderings.painted_scene import PaintedScene
from seethrough.benchmarks.rows import Row, row
from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.translucent.scenes import SCENES, scene
from seethrough.renderer.polygons.methods import prepare
from seethrough.renderer.polygons.polygons import Polygons
from seethrough.renderer.scene.camera import Camera

METHODS = ("bsp", "feudal", "feudal_dynamic")
# Feudal priority compares all pairs: two thousand polygons are what it serves.
LARGE = {"soup10000": ("bsp",), "soup100000": ("bsp",)}
SIZE = (320, 240)
# Triangles of a soup this large are pixels at the other size.
SIZES = {"soup100000": (800, 600)}
EYES = int(os.environ.get("SEETHROUGH_BENCH_EYES", "100"))
STEP, ALONG_CUTS = 1 / 255, 0.1  # of a channel; per cent of the pixels
SNAP = 1 / 256  # of a pixel: the grid that OpenGL's implementations fill polygons on
MOST_EDGES = 20_000  # each pixel is compared with each edge


def figures(names: tuple[str, ...] = tuple(SCENES), count: int = EYES) -> Iterator[Row]:
    """Two rows for each scene and method."""
    for name in names:
        painted = PaintedScene(scene(name), SIZES.get(name, SIZE))
        stream = np.random.SeedSequence(3, spawn_key=(9,))
        eyes = painted.made.eyes(count, np.random.default_rng(stream))
        for method in LARGE.get(name, METHODS):
            share, distance = worst(painted, method, eyes)
            label = f"pixels over 1/255, {method}, worst of {count} eyes"
            yield row(label, name, 100 * share, "%", ALONG_CUTS, 0.0)
            if distance is not None:
                label = f"farthest of them from an edge, {method}"
                yield row(label, name, distance, "pixels", SNAP, None)
        painted.release()


def worst(painted: PaintedScene, method: str, eyes: Floats) -> tuple[float, float | None]:
    """Share of wrong pixels from the worst of (n, 3) eyes, and how far from an edge the farthest
    of all lies, in pixels; None where edges are too many to compare."""
    prepared = prepare(method, painted.made.polygons)
    pieces = prepared.drawable.polygons
    share, distance = 0.0, 0.0
    for eye in eyes:
        wrong = painted.wrong(painted.ordered(prepared, eye), eye, STEP)
        share = max(share, float(wrong.mean()))
        if wrong.any() and len(pieces.vertices) <= MOST_EDGES:
            found = edge_distance(wrong, pieces, painted.camera(eye))
            distance = max(distance, float(found.max()))
    return share, distance if len(pieces.vertices) <= MOST_EDGES else None


def edge_distance(pixels: NDArray[np.bool_], polygons: Polygons, camera: Camera) -> Floats:
    """(k,) distance of each of the (h, w) `pixels`' centres from the nearest edge, in pixels.

    All edges must lie in front of the eye.
    """
    size = np.array(pixels.shape[::-1])
    matrix = camera.projection(size[0] / size[1]) @ camera.view()
    clip = np.column_stack([polygons.vertices, np.ones(len(polygons.vertices))]) @ matrix.T
    screen = (clip[:, :2] / clip[:, 3:] * [1, -1] + 1) / 2 * size
    ahead = np.arange(1, len(screen) + 1)
    ahead[polygons.starts[1:] - 1] = polygons.starts[:-1]
    along = screen[ahead] - screen
    centers = np.argwhere(pixels)[:, None, ::-1] + 0.5
    length = np.maximum((along**2).sum(axis=1), 1e-30)
    part = np.clip(((centers - screen) * along).sum(axis=2) / length, 0, 1)
    nearest = screen + part[..., None] * along
    return np.linalg.norm(centers - nearest, axis=2).min(axis=1)
