"""Every technique: what a frame costs, and what it shows of hidden targets.

`seethrough bench techniques --json FILE`. Times are multiples of the standard frame, at 800 × 600,
frames interleaved. Of targets that the standard picture hides in part, "uncovered" is the share of
the hidden area that shows, weighted by its opacity: the mean, and the least. "Context" is what is
left of everything else's area; "changed" are the pixels that differ from the standard picture.
Techniques that follow the pointer have it beside the middle of the view, and uncover what is there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, replace

import numpy as np

from seethrough import registry
from seethrough.benchmarks.rows import Row, row
from seethrough.benchmarks.scenes import SCENES
from seethrough.benchmarks.speed import times
from seethrough.experiment.gallery.gallery_techniques import placed
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques import changed, named
from seethrough.renderer.techniques.base import Parameters, Shot

SIZE, LOOKED, VIEWS = (800, 600), (400, 300), 3
STANDARD = named("standard")
HIDDEN = 0.05  # share of a target that has to be hidden for it to count
# What a frame may cost, over the standard one: (must, aim).
COSTS = {
    "cutaway": (2.0, 1.5), "cutaway, cap none": (1.5, 1.25),
    "breakaway": (2.0, 1.5), "breakaway, cap none": (1.5, 1.25),
    "lens": (2.0, 1.5), "lens, cap none": (1.5, 1.25),
    "dig": (2.0, 1.5), "dig, cap none": (1.5, 1.25),
    "adaptive_cutaway": (3.0, 2.0),
    "constant": (4.5, 2.5), "constant, all surfaces, 4 peels": (10.0, 6.0),
    "see_through": (3.0, 2.0), "importance": (3.0, 2.0), "fade": (3.0, 2.0),
    "view_dependent": (5.0, 3.0),
    "blueprint": (6.5, 5.0), "blueprint, all surfaces": (9.0, 5.0),
    "balloon": (2.0, 1.3),
    "idle": (1.1, 1.02),
}  # fmt: skip

Ways = dict[str, tuple[Parameters, object]]


def figures() -> Iterator[Row]:
    """All rows, as they are measured."""
    renderer = Renderer(standalone(), SIZE, without=frozenset({"still"}))
    for where, make in SCENES.items():
        scene, cameras = make(SIZE[0] / SIZE[1], VIEWS)
        ways = {
            way: found for name in registry.known("technique")
            for way, found in _ways(name, Shot(scene, cameras[0], SIZE)).items()
        }  # fmt: skip
        for way, drawn in ways.items():
            yield _cost(renderer, where, scene, cameras, way, drawn)
            yield from _shown(renderer, where, scene, cameras, way, drawn)
        yield from _border(renderer, where, scene, cameras)
        free = Scene(tuple(replace(o, impenetrable=True, target=False) for o in scene.objects))
        yield _cost(renderer, where, free, cameras, "idle", (named("constant"), None))


def _ways(name: str, shot: Shot) -> Ways:
    """A technique as it is, and as the table asks for it besides."""
    eye = float(np.linalg.norm(shot.camera.eye - shot.scene.centers.mean(axis=0)))
    p, state = placed(name, shot, max(eye, 1.0))
    found = {name: (p, state)}
    known = {field.name for field in fields(p)}
    if "cap" in known and name != "adaptive_cutaway":
        found[f"{name}, cap none"] = changed(p, cap="none"), state
    if name == "constant":
        found["constant, all surfaces, 4 peels"] = changed(p, surfaces="all", layers=4), state
    if name == "blueprint":
        found["blueprint, all surfaces"] = changed(p, surfaces="all"), state
    return found


def _cost(
    renderer: Renderer,
    where: str,
    scene: Scene,
    cameras: list[Camera],
    way: str,
    drawn: tuple[Parameters, object],
) -> Row:
    p, state = drawn
    spent = times(
        {
            "standard": lambda c: renderer.draw(scene, c, STANDARD),
            "own": lambda c: renderer.draw(scene, c, p, state=state),
        },
        cameras,
        renderer.context,
    )
    must, aim = COSTS.get(way, (None, None))
    return row(f"{way} / standard", where, spent["own"] / spent["standard"], "×", must, aim)


def _border(renderer: Renderer, where: str, scene: Scene, cameras: list[Camera]) -> Iterator[Row]:
    """By how many pixels the border of the adaptive hole lies elsewhere than exactly: the
    difference of the depths at which lines of sight leave it, over how that changes by pixel."""
    p = named("adaptive_cutaway")
    off = []
    for camera in cameras:
        shot = Shot(scene, camera, SIZE)
        renderer.draw(scene, camera, p)
        needed = renderer.needed(scene, camera, p)
        found = [
            p.technique.pictures(way, None, shot, needed)["clip"].astype(float)
            for way in (p, p.technique.exactly(p))
        ]
        down, across = np.gradient(found[1])
        slope = np.hypot(down, across)
        known = (found[1] > 0) & (needed["target_depth"] == 0) & (slope > 0)
        off.append((np.abs(found[0] - found[1])[known] / slope[known]).ravel())
    pixels = np.concatenate(off)
    figure = "adaptive_cutaway: border off"
    yield row(f"{figure} by more than 4 px", where, 100 * float((pixels > 4).mean()), "%", 1.0)
    yield row(f"{figure}, largest", where, float(pixels.max(initial=0.0)), "px")


def _shown(
    renderer: Renderer,
    where: str,
    scene: Scene,
    cameras: list[Camera],
    way: str,
    drawn: tuple[Parameters, object],
) -> Iterator[Row]:
    p, state = drawn
    targets = scene.targets
    uncovered, context, changed = [], [], []
    for camera in cameras:
        plain = renderer.look(scene, camera, STANDARD, LOOKED).area
        own = renderer.look(scene, camera, p, LOOKED, state).area
        for k in np.nonzero(targets)[0]:
            alone = Scene((scene.objects[k],), scene.background)
            whole = renderer.look(alone, camera, STANDARD, LOOKED).area[0]
            if whole > 1e-4 and whole - plain[k] > HIDDEN * whole:
                uncovered.append(np.clip((own[k] - plain[k]) / (whole - plain[k]), 0, 1))
        context.append(own[~targets].sum() / max(plain[~targets].sum(), 1e-9))
        renderer.draw(scene, camera, STANDARD)
        before = renderer.read()
        renderer.draw(scene, camera, p, state=state)
        changed.append((renderer.read() != before).any(axis=2).mean())
    if uncovered:
        yield row(f"{way}: uncovered, mean", where, 100 * float(np.mean(uncovered)), "%")
        yield row(f"{way}: uncovered, least", where, 100 * float(np.min(uncovered)), "%")
    yield row(f"{way}: context left", where, 100 * float(np.mean(context)), "%")
    yield row(f"{way}: changed pixels", where, 100 * float(np.mean(changed)), "%")
