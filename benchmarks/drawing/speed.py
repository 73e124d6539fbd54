"""Frame times of the renderer, as ratios within one run.

`seethrough bench speed --json FILE` prints the table and writes a list of
{figure, scene, value, unit, must, aim, met}. Each way of drawing has its turn at every camera, over
and over; a camera's time is the least of its turns, and a scene's the sum over its cameras.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import count
from typing import Protocol

import numpy as np
from moderngl import Context

from seethrough.benchmarks.drawing.paper_way import PaperWay
from seethrough.benchmarks.drawing.scenes import SCENES
from seethrough.benchmarks.memory import used_by
from seethrough.benchmarks.rows import Row as Figure
from seethrough.benchmarks.rows import row
from seethrough.experiment.display.looking import HEIGHT
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.models.simple import simplified
from seethrough.renderer.plan.planner import plan
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.base import Parameters
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard

SIZES = ((800, 600), (1280, 1024))
VIEWS, TURNS = 6, 4
LEAST = 1.5  # s: of a few turns of quick frames the least differs by a tenth from run to run
# What a dynamic frame may cost, over the standard one, on a software rasteriser: (must, aim).
COSTS = {"abstract": (2.0, 1.7), "walkthrough": (2.0, 1.5), "jeep": (2.0, 1.7)}
COSTS_OF_LARGE = {**COSTS, "jeep": (2.3, 1.7)}  # at the larger of SIZES
TECHNIQUE = DynamicTransparency()


def drawing(renderer: Renderer, scene: Scene, technique: Parameters) -> Callable[[Camera], object]:
    """What draws a scene with a technique, from a camera."""
    return lambda camera: renderer.draw(scene, camera, technique)


class Drawn(Protocol):
    """What draws, and says when it has: a context of ours, or another library's."""

    def finish(self) -> None:
        """Wait until everything is drawn."""


def times(
    ways: Mapping[str, Callable[[Camera], object]], cameras: Sequence[Camera], context: Drawn
) -> dict[str, float]:
    """Seconds of each way over all cameras: the least of TURNS turns each, of more where they are
    over within LEAST seconds."""
    best = {name: np.full(len(cameras), np.inf) for name in ways}
    begun = time.perf_counter()
    for turn in count():
        if turn > TURNS and time.perf_counter() - begun > LEAST:
            break
        for k, camera in enumerate(cameras):
            for name, draw in ways.items():
                start = time.perf_counter()
                draw(camera)
                context.finish()
                spent = time.perf_counter() - start
                if turn:  # the first turn compiles and uploads
                    best[name][k] = min(best[name][k], spent)
    return {name: float(values.sum()) for name, values in best.items()}


def figures() -> Iterator[Figure]:
    """All rows, as they are measured."""
    context = standalone()
    software = "llvmpipe" in context.info["GL_RENDERER"]
    for size in SIZES:
        label = f"{size[0]}×{size[1]}"
        # Ratios are over whole models, also where doorways would show less of them.
        renderer = Renderer(context, size, without=frozenset({"still", "rooms"}))
        paper = PaperWay(context, size)
        for name, make in SCENES.items():
            scene, cameras = make(size[0] / size[1], VIEWS)
            yield from _of_scene(renderer, paper, name, label, scene, cameras, software)
    yield from _of_masks(context)
    yield from _of_many_targets(context)
    yield _of_plan()
    yield _of_nothing(context)
    yield from _of_looks(context)
    yield from _of_memory()


def _of_scene(
    renderer: Renderer,
    paper: PaperWay,
    name: str,
    label: str,
    scene: Scene,
    cameras: Sequence[Camera],
    software: bool,
) -> Iterator[Figure]:
    sorted_ = replace(TECHNIQUE, exact=True)
    spent = times(
        {
            "standard": lambda c: renderer.draw(scene, c, Standard()),
            "dynamic": lambda c: renderer.draw(scene, c, TECHNIQUE),
            "exact": lambda c: renderer.draw(scene, c, sorted_),
            "paper": lambda c: paper.draw(scene, c, TECHNIQUE),
        },
        cameras,
        renderer.context,
    )
    where = f"{name} {label}"
    costs = COSTS if renderer.size == SIZES[0] else COSTS_OF_LARGE
    must, aim = costs[name] if software else (1.5, 1.2)
    base = spent["standard"]
    yield row("standard frame", where, 1e3 * base / len(cameras), "ms", None, None)
    yield row("dynamic / standard", where, spent["dynamic"] / base, "×", must, aim)
    yield row("dynamic / paper's way", where, spent["dynamic"] / spent["paper"], "×", 0.25, 0.1)
    most = 10 if software else 2
    yield row("exact / standard", where, spent["exact"] / base, "×", most, 2)


def _masks_alone(scene: Scene) -> Scene:
    """The targets of a scene, and one pane before everything that gives each a mask."""
    return replace(scene, objects=tuple(o for o in scene.objects if o.target))


def _of_masks(context: Context) -> Iterator[Figure]:
    """40 targets of the abstract scene: all that masks add, against the paper's ping-pong."""
    size = SIZES[0]
    scene, cameras = SCENES["abstract"](size[0] / size[1], VIEWS)
    targets = _masks_alone(scene)
    renderer = Renderer(context, size, without=frozenset({"still", "masks"}))
    paper = PaperWay(context, size)
    spent = times(
        {
            "all": lambda c: renderer.draw(targets, c, TECHNIQUE),
            "none": lambda c: renderer.draw(targets, c, Standard()),
            "paper": lambda c: paper.draw(targets, c, TECHNIQUE, masks_only=True),
        },
        cameras,
        context,
    )
    ours = max(spent["all"] - spent["none"], 0.0)
    where = f"{len(targets.objects)} targets 800×600"
    yield row("masks", where, 1e3 * ours / len(cameras), "ms", None, None)
    yield row("masks / paper's ping-pong", where, ours / spent["paper"], "×", 0.1, 0.03)


def _of_many_targets(context: Context) -> Iterator[Figure]:
    size = SIZES[0]
    scene, cameras = SCENES["abstract"](size[0] / size[1], VIEWS)
    with_targets = {
        n: replace(
            scene,
            objects=tuple(replace(o, target=i < n) for i, o in enumerate(scene.objects)),
        )
        for n in (20, 200)
    }
    renderer = Renderer(context, size, without=frozenset({"still"}))
    spent = times(
        {str(n): drawing(renderer, s, TECHNIQUE) for n, s in with_targets.items()},
        cameras,
        context,
    )
    yield row("200 targets / 20", "abstract 800×600", spent["200"] / spent["20"], "×", 2.5, 1.5)


def _of_plan() -> Figure:
    scene, cameras = SCENES["abstract"](4 / 3, VIEWS)
    best = np.full(len(cameras), np.inf)
    for turn in range(2 * TURNS):
        for k, camera in enumerate(cameras):
            start = time.perf_counter()
            plan(scene, camera, TECHNIQUE, SIZES[0])
            if turn:
                best[k] = min(best[k], time.perf_counter() - start)
    count = int(scene.targets.sum())
    return row("plan()", f"200 objects, {count} targets", 1e3 * best.mean(), "ms", 2, 0.4)


def _of_nothing(context: Context) -> Figure:
    """A building without occluded targets: what planning costs."""
    scene, cameras = SCENES["abstract"](4 / 3, VIEWS)
    free = replace(scene, objects=tuple(replace(o, target=False) for o in scene.objects))
    renderer = Renderer(context, SIZES[0], without=frozenset({"still"}))
    spent = times(
        {
            "standard": drawing(renderer, free, Standard()),
            "dynamic": drawing(renderer, free, TECHNIQUE),
        },
        cameras,
        context,
    )
    value = spent["dynamic"] / spent["standard"]
    return row("no target occluded: dynamic / standard", "abstract 800×600", value, "×", 1.1, 1.02)


def _looking(
    renderer: Renderer, scene: Scene, technique: Parameters, size: tuple[int, int]
) -> Callable[[Camera], object]:
    return lambda camera: renderer.look(scene, camera, technique, size)


def _of_looks(context: Context) -> Iterator[Figure]:
    """What a look of a simulated participant takes: small pictures of simple models, measured."""
    size = (200, HEIGHT)
    renderer = Renderer(context, SIZES[0])
    for name in ("abstract", "walkthrough"):
        scene, cameras = SCENES[name](size[0] / size[1], VIEWS)
        simple = simplified(scene)
        spent = times(
            {
                "standard": _looking(renderer, simple, Standard(), size),
                "dynamic": _looking(renderer, simple, TECHNIQUE, size),
            },
            cameras,
            context,
        )
        for way, seconds in spent.items():
            value = 1e3 * seconds / len(cameras)
            yield row(f"a look, {way}", f"{name} 200×{HEIGHT}", value, "ms", 15, None)


_MEMORY = """
from seethrough.benchmarks.drawing.scenes import walkthrough
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.techniques.base import Parameters
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
scene, cameras = walkthrough(4 / 3, 4)
renderer = Renderer(standalone(), (800, 600))
for camera in cameras:
    renderer.draw(scene, camera, DynamicTransparency())
    renderer.read()
"""


def _of_memory() -> Iterator[Figure]:
    """Most memory of a process of its own that draws the walkthrough, where the system tells."""
    held = used_by(_MEMORY).peak
    if held is not None:
        yield row("resident memory", "walkthrough 800×600", held, "MiB", 450, None)
