"""What each key of [look] costs, and what it changes.

`seethrough bench looks --json FILE`. Times are processor time, all threads together, as multiples
of the same frame without the key, at 800 × 600: every turn draws each view with each key once; told
are the median over turns, and half the range of their middle half ("±"). Each timed frame follows
one of the same scene. The frame before those is told by itself ("first frame"): the renderer keeps
too few scenes for a turn (SCENES_KEPT), and makes what it has of one, tables, the shadows' texture,
the list of edges, anew there, as at the begin of a trial. "Changed" are the pixels that differ
from the plain frame by more than 2/255, "by" the mean difference of those. Edges are the pixels in
which a picture of 16 samples a pixel differs from the plain one by more than 4/255: their mean
error, that of the whole picture, and that of what changes from a frame to the next along a path
("crawl": .2° of an orbit, or 2 cm of a walk, a frame) are given as parts of the plain picture's.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from seethrough.benchmarks.drawing.scenes import SCENES
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

SIZE, VIEWS, TURNS = (800, 600), 3, 9
EDGE = 4  # of 255
FRAMES = 4  # of a path
ORBIT, WALK = 0.2, 0.04  # degrees, world units a frame: a unit of the building is half a metre
VISIBLE = 2  # of 255: what differs by no more is the same to the eye
OUTLINES = Look(antialiasing="none", outlines=1.5)  # by themselves: the gallery's are smoothed
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
            paths = [_path(camera, where) for camera in cameras]
            yield from _edges(renderer, fine, f"{where}, {way}", scene, paths, named(way))


def _of(
    renderer: Renderer, label: str, world: str, scene: Scene, cameras: list[Camera], p: Parameters
) -> Iterator[Row]:
    every = looks(world) | {"outlines": OUTLINES}
    scenes = {name: dressed(scene, look) for name, look in every.items()}
    ratios = _ratios(renderer, scenes, cameras, p)
    for name in scenes:
        if name == "none":
            continue
        must, aim = COSTS.get(name, (None, None))
        if name == "antialiasing":
            plain = p.technique.name == "standard" and world != "abstract"
            must, aim = (1.35, 1.2) if plain else (1.5, 1.25)
        low, middle, high = np.percentile(ratios[name][1], (25, 50, 75)).tolist()
        line = f"{label}: {name}"
        yield row("frame / without", line, middle, "×", must, aim)
        yield row("±", line, (high - low) / 2, "×")
        yield row("first frame / without", line, float(np.median(ratios[name][0])), "×")
        share, by = _changed(renderer, scenes["none"], scenes[name], cameras, p)
        yield row("changed", line, share, "%")
        yield row("by", line, by, "/255")


def _ratios(
    renderer: Renderer, scenes: dict[str, Scene], cameras: list[Camera], p: Parameters
) -> dict[str, Floats]:
    """Of each scene (2, TURNS) the time of its first frame, and of those that follow, over that of
    "none" in the same turn."""
    spent = {name: np.zeros((2, TURNS + 1)) for name in scenes}
    for turn in range(TURNS + 1):
        for name, scene in scenes.items():
            for some in range(2):
                start = time.process_time()
                for camera in cameras if some else cameras[-1:]:
                    renderer.draw(scene, camera, p)
                    renderer.context.finish()
                spent[name][some, turn] = time.process_time() - start
    # The first turn compiles and uploads.
    return {name: seconds[:, 1:] / spent["none"][:, 1:] for name, seconds in spent.items()}


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
    paths: list[list[Camera]],
    p: Parameters,
) -> Iterator[Row]:
    """How far off edges are, smoothed, over how far they are plain, along paths."""
    off = np.zeros((3, 2))  # edges, all pixels, changes from frame to frame
    for path in paths:
        before: dict[str, Floats] | None = None
        for camera in path:
            found = errors(renderer, fine, scene, camera, p)
            at = np.abs(found["plain"] - found["fine"]).max(axis=2) > EDGE
            for k, way in enumerate(("plain", "smooth")):
                error = np.abs(found[way] - found["fine"])
                off[:2, k] += error[at].sum(), error.sum()
                if before is not None:
                    crawl = found[way] - before[way] - (found["fine"] - before["fine"])
                    off[2, k] += np.abs(crawl[at]).sum()
            before = found
    must, aim = (0.6, 0.4) if p.technique.name == "standard" else (0.75, 0.5)
    ratio = off[:, 1] / off[:, 0]
    line = f"{label}: antialiasing"
    yield row("edges / plain", line, float(ratio[0]), "×", must, aim)
    yield row("all / plain", line, float(ratio[1]), "×")
    yield row("crawl / plain", line, float(ratio[2]), "×")


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


def _path(camera: Camera, world: str) -> list[Camera]:
    """A few frames of a walk straight on, or of an orbit about the origin."""
    if world == "walkthrough":
        step = WALK * camera.forward
        return [replace(camera, eye=camera.eye + k * step) for k in range(FRAMES)]
    turns = [rotation_y(np.radians(k * ORBIT))[:3, :3] for k in range(FRAMES)]
    return [replace(camera, eye=t @ camera.eye, rotation=t @ camera.rotation) for t in turns]
