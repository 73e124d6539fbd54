"""What each key of [look] costs, and what it changes.

`seethrough bench looks --json FILE`. Times are multiples of the same frame without the key, at
800 × 600, frames interleaved. "Changed" are the pixels that differ from that frame by more than
2/255, "by" the mean difference of those. Edges are the pixels in which a picture of 16 samples a
pixel differs from the plain one by more than 4/255: their mean error, that of the whole picture,
and that of what changes from a frame to the next as the view turns by .1° ("crawl") are given as
parts of the plain picture's.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from seethrough.benchmarks.drawing.scenes import SCENES
from seethrough.benchmarks.drawing.speed import drawing, times
from seethrough.benchmarks.rows import Row, row
from seethrough.experiment.gallery.gallery_looks import looks
from seethrough.renderer.arrays import Floats
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.look.dressed import dressed
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.look import PLAIN, Look
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.scene.transforms import rotation_y
from seethrough.renderer.techniques import named
from seethrough.renderer.techniques.base import Parameters

SIZE, VIEWS = (800, 600), 3
EDGE = 4  # of 255
STEP = 0.1  # degrees
VISIBLE = 2  # of 255: what differs by no more is the same to the eye
# What a frame may cost, over the one without: (must, aim).
COSTS = {"fog": (1.2, 1.05), "ground_shadows": (1.2, 1.05), "occlusion": (1.2, 1.05),
         "outlines": (1.3, 1.1)}  # fmt: skip


def figures() -> Iterator[Row]:
    """All rows, as they are measured."""
    renderer = Renderer(standalone(), SIZE, without=frozenset({"still"}))
    fine = Renderer(renderer.context, (4 * SIZE[0], 4 * SIZE[1]), window=SIZE[1])
    for where, make in SCENES.items():
        scene, cameras = make(SIZE[0] / SIZE[1], VIEWS)
        for way in ("standard", "dynamic"):
            yield from _of(renderer, f"{where}, {way}", where, scene, cameras, named(way))
            yield from _edges(renderer, fine, f"{where}, {way}", scene, cameras, named(way))


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
        if name == "antialiasing":
            plain = p.technique.name == "standard" and world != "abstract"
            must, aim = (1.35, 1.2) if plain else (1.5, 1.25)
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


def _edges(
    renderer: Renderer,
    fine: Renderer,
    label: str,
    scene: Scene,
    cameras: list[Camera],
    p: Parameters,
) -> Iterator[Row]:
    """How far off edges are, smoothed, over how far they are plain."""
    off = np.zeros((3, 2))  # edges, all pixels, changes from frame to frame
    for camera in cameras:
        steps = [errors(renderer, fine, scene, c, p) for c in (camera, _turned(camera))]
        for k, way in enumerate(("plain", "smooth")):
            error = steps[0][way] - steps[0]["fine"]
            crawl = steps[1][way] - steps[0][way] - (steps[1]["fine"] - steps[0]["fine"])
            at = np.abs(steps[0]["plain"] - steps[0]["fine"]).max(axis=2) > EDGE
            off[:, k] += np.abs(error[at]).sum(), np.abs(error).sum(), np.abs(crawl[at]).sum()
    must, aim = (0.6, 0.4) if p.technique.name == "standard" else (0.75, 0.5)
    ratio = off[:, 1] / off[:, 0]
    yield row("antialiasing: error of edges / plain", label, float(ratio[0]), "×", must, aim)
    yield row("antialiasing: error of all / plain", label, float(ratio[1]), "×")
    yield row("antialiasing: crawl / plain", label, float(ratio[2]), "×")


def errors(
    renderer: Renderer, fine: Renderer, scene: Scene, camera: Camera, p: Parameters
) -> dict[str, Floats]:
    """The picture plain, smoothed, and from a renderer of four times the size, averaged."""
    found: dict[str, Floats] = {}
    for way, look in (("plain", PLAIN), ("smooth", Look(antialiasing="edges"))):
        renderer.draw(dressed(scene, look), camera, p)
        found[way] = renderer.read().astype(float)
    fine.draw(scene, camera, p)
    height, width = found["plain"].shape[:2]
    blocks = fine.read().reshape(height, 4, width, 4, 3)
    found["fine"] = blocks.mean(axis=(1, 3))
    return found


def _turned(camera: Camera) -> Camera:
    turn = rotation_y(np.radians(STEP))[:3, :3]
    return replace(camera, rotation=turn @ camera.rotation)
