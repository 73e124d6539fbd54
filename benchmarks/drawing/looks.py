"""What each key of [look] costs, and what it changes.

`seethrough bench looks --json FILE`. Times are multiples of the same frame without the key, at
800 × 600, frames interleaved. "Changed" are the pixels that differ from that frame by more than
2/255, "by" the mean difference of those.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from seethrough.benchmarks.drawing.scenes import SCENES
from seethrough.benchmarks.drawing.speed import drawing, times
from seethrough.benchmarks.rows import Row, row
from seethrough.experiment.gallery.gallery_looks import looks
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.look.dressed import dressed
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques import named
from seethrough.renderer.techniques.base import Parameters

SIZE, VIEWS = (800, 600), 3
VISIBLE = 2  # of 255: what differs by no more is the same to the eye
# What a frame may cost, over the one without: (must, aim).
COSTS = {"fog": (1.2, 1.05), "ground_shadows": (1.2, 1.05), "occlusion": (1.2, 1.05),
         "outlines": (1.3, 1.1)}  # fmt: skip


def figures() -> Iterator[Row]:
    """All rows, as they are measured."""
    renderer = Renderer(standalone(), SIZE, without=frozenset({"still"}))
    for where, make in SCENES.items():
        scene, cameras = make(SIZE[0] / SIZE[1], VIEWS)
        for way in ("standard", "dynamic"):
            yield from _of(renderer, f"{where}, {way}", where, scene, cameras, named(way))


def _of(
    renderer: Renderer, label: str, world: str, scene: Scene, cameras: list[Camera], p: Parameters
) -> Iterator[Row]:
    scenes = {name: dressed(scene, look) for name, look in looks(world).items()}
    ways = {name: drawing(renderer, own, p) for name, own in scenes.items()}
    spent = times(ways, cameras, renderer.context)
    for name in scenes:
        if name == "none":
            continue
        must, aim = COSTS.get(name, (None, None))
        yield row(f"{name} / none", label, spent[name] / spent["none"], "×", must, aim)
        share, by = _changed(renderer, scenes["none"], scenes[name], cameras, p)
        yield row(f"{name}: changed", label, share, "%")
        yield row(f"{name}: by", label, by, "/255")


def _changed(
    renderer: Renderer, plain: Scene, own: Scene, cameras: list[Camera], p: Parameters
) -> tuple[float, float]:
    """Per cent of the pixels that differ, and by how much those do."""
    off = []
    for camera in cameras:
        renderer.draw(plain, camera, p)
        before = renderer.read().astype(int)
        renderer.draw(own, camera, p)
        off.append(np.abs(renderer.read() - before).max(axis=2).ravel())
    found = np.concatenate(off)
    changed = found > VISIBLE
    return 100 * float(changed.mean()), float(found[changed].mean()) if changed.any() else 0.0
