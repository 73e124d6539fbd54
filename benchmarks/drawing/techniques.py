"""Every technique: what a frame costs, how far it is from exact, and what it shows.

`seethrough bench techniques --json FILE --figure FILE.svg`, at 800 × 600. "Time" is a multiple of
the standard frame, frames interleaved. "Error" is the RMSE of a channel against the technique's own
exact picture, over the pixels that this changes. Of targets that the standard picture hides in
part, "uncovered" is the share of the hidden area that shows, weighted by its opacity: the mean, and
the least; "contrast" is how well they are set off, 0 where they do not show. "Context" is what is
left of everything else's area, "changed" are the pixels that differ from the standard picture.
"Pops" are pixels that jump between two frames half a degree apart while the standard picture stands
still there: of a path of such steps the worst. Hands reach for the target nearest to the middle of
the view, and stay there along a path.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from seethrough import registry
from seethrough.benchmarks.drawing import vtk_peeling
from seethrough.benchmarks.drawing.scenes import SCENES
from seethrough.benchmarks.drawing.speed import times
from seethrough.benchmarks.drawing.technique_ways import COSTS, Way, ways_of
from seethrough.benchmarks.rows import Row, row
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.scene.transforms import rotation_y
from seethrough.renderer.techniques import named
from seethrough.renderer.techniques.base import Shot

PARTS = tuple(SCENES)
SIZE, LOOKED, VIEWS = (800, 600), (400, 300), 3
STANDARD = named("standard")
HIDDEN = 0.05  # share of a target that has to be hidden for it to count
STEPS, STEP = 16, np.radians(0.5)  # of a path
JUMP, STILL = 40, 8  # of 255: what is seen to jump, and what stands still
TIME, ERROR = "time", "error"

Picture = NDArray[np.int16]


def figures(parts: list[str] | None = None) -> Iterator[Row]:
    """All rows, as they are measured."""
    # What is measured against draws whole models, also where doorways would show less of them.
    renderer = Renderer(standalone(), SIZE, without=frozenset({"still", "rooms"}))
    for where in parts or PARTS:
        scene, cameras = SCENES[where](SIZE[0] / SIZE[1], VIEWS)
        paths = _path(where, scene, cameras[0])
        still = [_frame(renderer, scene, c, Way(STANDARD, STANDARD)) for c in paths]
        hidden = [_hidden(renderer, scene, camera) for camera in cameras]
        for name in registry.known("technique"):
            for label, way in ways_of(name, Shot(scene, cameras[0], SIZE)).items():
                at = f"{where}: {label}"
                yield _cost(renderer, at, label, scene, cameras, way)
                yield from _off(renderer, at, scene, cameras, way)
                yield from _shown(renderer, at, scene, cameras, way, hidden)
                yield _pops(renderer, at, scene, paths, way, still)
        yield from _border(renderer, where, scene, cameras)
        free = Scene(tuple(replace(o, impenetrable=True, target=False) for o in scene.objects))
        idle = Way(named("constant"), named("constant"))
        yield _cost(renderer, f"{where}: idle", "idle", free, cameras, idle)
        yield from _beside_vtk(renderer, where, scene, cameras)


def chart(rows: list[Row], path: Path) -> None:
    """Draw the table."""
    from seethrough.benchmarks.drawing.technique_figure import draw

    draw(rows, path)


def _frame(
    renderer: Renderer, scene: Scene, camera: Camera, way: Way, hand: Camera | None = None
) -> Picture:
    """What is drawn, with hands as at `hand`."""
    state = way.state(Shot(scene, hand or camera, SIZE))
    renderer.draw(scene, camera, way.p, state=state)
    return renderer.read().astype(np.int16)


def _cost(
    renderer: Renderer, at: str, label: str, scene: Scene, cameras: list[Camera], way: Way
) -> Row:
    states = {id(c): way.state(Shot(scene, c, SIZE)) for c in cameras}
    spent = times(
        {
            "standard": lambda c: renderer.draw(scene, c, STANDARD),
            "own": lambda c: renderer.draw(scene, c, way.p, state=states[id(c)]),
        },
        cameras,
        renderer.context,
    )
    must, aim = COSTS.get(label, (None, None))
    return row(TIME, at, spent["own"] / spent["standard"], "×", must, aim)


def _beside_vtk(
    renderer: Renderer, where: str, scene: Scene, cameras: list[Camera]
) -> Iterator[Row]:
    """Constant opacity, all surfaces in so many peels as VTK, each over its own opaque frame."""
    label = f"constant, all surfaces, {vtk_peeling.FEW} peels"
    way = ways_of("constant", Shot(scene, cameras[0], SIZE))[label]
    for theirs in vtk_peeling.theirs(SIZE, [where], constant=True).values():
        own = _cost(renderer, f"{where}: {label}", label, scene, cameras, way)["value"]
        yield row("of VTK's time", f"{where}: {label}", own / theirs, "×", 1.0, 1 / 3)


def _off(
    renderer: Renderer, at: str, scene: Scene, cameras: list[Camera], way: Way
) -> Iterator[Row]:
    """How far the picture is from the exact one, and how many pixels differ from the standard."""
    exact = replace(way, p=way.exact)
    squares, count, changed = 0.0, 0, []
    for camera in cameras:
        plain = _frame(renderer, scene, camera, Way(STANDARD, STANDARD))
        own = _frame(renderer, scene, camera, way)
        truth = own if way.p == way.exact else _frame(renderer, scene, camera, exact)
        touched = (truth != plain).any(axis=2)
        squares += float(((own - truth)[touched].astype(float) ** 2).sum())
        count += 3 * int(touched.sum())
        changed.append((own != plain).any(axis=2).mean())
    yield row(ERROR, at, (squares / max(count, 1)) ** 0.5, "of 255")
    yield row("changed pixels", at, 100 * float(np.mean(changed)), "%")


Hidden = tuple[NDArray[np.float64], dict[int, float]]


def _hidden(renderer: Renderer, scene: Scene, camera: Camera) -> Hidden:
    """Areas in the standard picture (n,), and of targets that it hides in part the whole area."""
    plain = renderer.look(scene, camera, STANDARD, LOOKED).area
    found = {}
    for k in np.nonzero(scene.targets)[0]:
        alone = Scene((scene.objects[k],), scene.background)
        whole = float(renderer.look(alone, camera, STANDARD, LOOKED).area[0])
        if whole > 1e-4 and whole - plain[k] > HIDDEN * whole:
            found[int(k)] = whole
    return plain, found


def _shown(
    renderer: Renderer,
    at: str,
    scene: Scene,
    cameras: list[Camera],
    way: Way,
    hidden: list[Hidden],
) -> Iterator[Row]:
    uncovered, contrast, context = [], [], []
    for camera, (plain, wholes) in zip(cameras, hidden, strict=True):
        state = way.state(Shot(scene, camera, SIZE))
        own = renderer.look(scene, camera, way.p, LOOKED, state)
        for k, whole in wholes.items():
            uncovered.append(np.clip((own.area[k] - plain[k]) / (whole - plain[k]), 0, 1))
            contrast.append(own.contrast[k])
        others = ~scene.targets
        context.append(own.area[others].sum() / max(plain[others].sum(), 1e-9))
    if uncovered:
        yield row("uncovered, mean", at, 100 * float(np.mean(uncovered)), "%")
        yield row("uncovered, least", at, 100 * float(np.min(uncovered)), "%")
        yield row("contrast", at, 100 * float(np.mean(contrast)), "%")
    yield row("context left", at, 100 * float(np.mean(context)), "%")


def _path(where: str, scene: Scene, start: Camera) -> list[Camera]:
    """A turn about the middle of the scene, or in the building about oneself, step by step."""
    middle = start.eye if where == "walkthrough" else scene.centers.mean(axis=0)
    found = []
    for k in range(STEPS + 1):
        turn = rotation_y(k * STEP)[:3, :3]
        eye = turn @ (start.eye - middle) + middle
        found.append(replace(start, eye=eye, rotation=turn @ start.rotation))
    return found


def _pops(
    renderer: Renderer, at: str, scene: Scene, path: list[Camera], way: Way, still: list[Picture]
) -> Row:
    drawn = [_frame(renderer, scene, camera, way, path[0]) for camera in path]
    worst = 0.0
    for k in range(STEPS):
        jumps = np.abs(drawn[k + 1] - drawn[k]).max(axis=2) > JUMP
        stands = np.abs(still[k + 1] - still[k]).max(axis=2) <= STILL
        worst = max(worst, float((jumps & stands).mean()))
    return row("pops", at, 100 * worst, "%")


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
