"""Objects that reach into one another before a target: sorted by pixel, or by polygon?

`python -m seethrough.benchmarks.drawing.clusters` prints, for clusters of several kinds, error and
time of a frame where what no plane separates is sorted by pixel (`pixels`: order "planes"), where
the polygons of convex objects are put in order by a BSP tree (`polygons`), and where centres decide
(`centers`).
"""

from __future__ import annotations

import time
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from seethrough.benchmarks.drawing.speed import drawing, times
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.plan.clusters import polygons_of
from seethrough.renderer.polygons import bsp
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.geometry import Mesh
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

SIZE, SMALL = (800, 600), (200, 150)
VIEWS = 4
STEP = 2  # of 255
WAYS = {
    "pixels": DynamicTransparency(doubt=0.0),
    "polygons": DynamicTransparency(doubt=0.0, order="polygons"),
    "centers": DynamicTransparency(order="centers"),
}
KINDS: dict[str, tuple[Mesh, int]] = {
    "3 boxes": (geometry.box(2.0, 2.0, 2.0), 3),
    "6 boxes": (geometry.box(2.0, 2.0, 2.0), 6),
    "12 boxes": (geometry.box(2.0, 2.0, 2.0), 12),
    "6 spheres": (geometry.sphere(1.3, 2), 6),
    "6 tori": (geometry.torus(1.2, 0.4, 24, 12), 6),
}


def cluster(mesh: Mesh, count: int) -> tuple[Scene, list[Camera]]:
    """Objects about one place, each through some of the others, before a wall that is a target."""
    rng = np.random.default_rng(np.random.SeedSequence(3, spawn_key=(12, count)))
    objects = []
    for _ in range(count):
        place = rng.uniform(-1.3, 1.3, 3)
        turned = transforms.placed(place, transforms.random_rotation(rng))
        objects.append(Object(mesh, turned, tuple(rng.uniform(0.2, 1.0, 3))))
    wall = Object(
        geometry.box(9.0, 7.0, 0.5), transforms.translation(0, 0, -6), (1, 0, 0), target=True
    )
    ways = [(x, y, 1.0) for x, y in rng.uniform(-0.25, 0.25, (VIEWS, 2))]
    eyes = [9.0 * np.array(w) for w in ways]
    cameras = [look_at(e, np.zeros(3), fov_y=0.8, near=1, far=40) for e in eyes]
    return Scene((*objects, wall)), cameras


def figures() -> Iterator[str]:
    """One line for each kind of cluster and way."""
    context = standalone()
    small, large = (Renderer(context, s, without=frozenset({"still"})) for s in (SMALL, SIZE))
    for kind, (mesh, count) in KINDS.items():
        scene, cameras = cluster(mesh, count)
        draws = {way: drawing(large, scene, technique) for way, technique in WAYS.items()}
        spent = times(draws, cameras, context)
        truths = [exact(scene, camera, WAYS["pixels"], SMALL) for camera in cameras]
        for way, technique in WAYS.items():
            wrong = []
            for camera, truth in zip(cameras, truths, strict=True):
                small.draw(scene, camera, technique)
                wrong.append(_wrong(small.read(), truth.picture, truth.near_edge))
            line = f"{kind:10s} {way:9s} {100 * np.mean(wrong):7.3f} % wrong"
            yield line + f" {1e3 * spent[way] / VIEWS:7.1f} ms" + _built(scene, way)


def _built(scene: Scene, way: str) -> str:
    """What the tree cost, where there is one."""
    if way != "polygons":
        return ""
    polygons = polygons_of(scene, np.arange(len(scene.objects) - 1))
    start = time.perf_counter()
    stats = bsp.prepare(polygons, halves=False).stats
    spent = 1e3 * (time.perf_counter() - start)
    return f", built in {spent:.0f} ms, {stats.inputs} triangles cut into {stats.outputs} polygons"


def _wrong(
    picture: NDArray[np.uint8], truth: NDArray[np.float64], near_edge: NDArray[np.bool_]
) -> float:
    apart = np.abs(picture.astype(float) - 255 * truth).max(axis=2)
    return float((apart[~near_edge] > STEP).mean())


if __name__ == "__main__":
    for text in figures():
        print(text, flush=True)
