"""Frames along walks through the building (`seethrough bench paths`).

The walks are those of data/walks, each with the technique that its walker had. Frames are those of
60 a second in which the walker moves, one of EVERY of them; each is drawn in every way in turn, so
that whatever else the machine does meets all ways alike. A frame's processor time is that of all
threads: on an idle machine no frame takes longer than that, on a busy one its time says nothing.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from seethrough.benchmarks.drawing.walks import Walked, walked
from seethrough.benchmarks.rows import Row, row
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.scene.camera import Camera

PARTS = ("standard", "dynamic")
SIZE, RATE, EVERY = (800, 600), 60, 30
MISSED = {"standard": (16.7, 1.0, 0.2), "dynamic": (33.0, 20.0, 1.0)}  # ms; must and aim in %

Draw = Callable[[Walked, Camera], object]


@dataclass
class Spent:
    """Milliseconds of each frame, by the clock and of the processor, and where each was seen."""

    wall: list[float] = field(default_factory=list)
    cpu: list[float] = field(default_factory=list)
    where: list[str] = field(default_factory=list)


def figures(only: list[str] | None = None) -> Iterator[Row]:
    """Every row, a level of the study after the other."""
    context = standalone()
    ways = {
        "": Renderer(context, SIZE, without=frozenset({"still"})),
        ", all rooms": Renderer(context, SIZE, without=frozenset({"still", "rooms"})),
    }
    for level in only or PARTS:
        drawing: dict[str, Draw] = {name: _drawing(renderer) for name, renderer in ways.items()}
        spent = _along(level, drawing, context.finish)
        for name in drawing:
            yield from _rows(level, f"{level}{name}", spent[name])


def _drawing(renderer: Renderer) -> Draw:
    return lambda walk, camera: renderer.draw(walk.scene, camera, walk.technique)


def _along(level: str, ways: Mapping[str, Draw], finish: Callable[[], None]) -> dict[str, Spent]:
    """What each way of drawing takes for the frames of all walks at that level."""
    spent = {name: Spent() for name in ways}
    for walk in walked():
        if walk.level != level:
            continue
        times, cameras = walk.frames(RATE)
        for draw in ways.values():
            draw(walk, cameras[0])  # uploads the scene, and compiles what is not yet
        for at, camera in zip(times[EVERY // 2 :: EVERY], cameras[EVERY // 2 :: EVERY], strict=True):
            for name, draw in ways.items():
                finish()
                began, cpu = time.perf_counter(), time.process_time()
                draw(walk, camera)
                finish()
                spent[name].cpu.append(1000 * (time.process_time() - cpu))
                spent[name].wall.append(1000 * (time.perf_counter() - began))
                spent[name].where.append(f"slot {walk.slot}, trial {walk.trial}, {at:.1f} s")
    return spent


def _rows(level: str, name: str, spent: Spent) -> Iterator[Row]:
    wall, cpu = np.array(spent.wall), np.array(spent.cpu)
    scene = f"{name}, {len(wall)} frames"
    limit, must, aim = MISSED[level]
    for most in (16.7, 33.0):
        judged = (must, aim) if most == limit and name == level else (None, None)
        yield row(f"over {most} ms", scene, 100 * float((wall > most).mean()), "%", *judged)
        share = 100 * float((cpu > most).mean())
        yield row(f"over {most} ms of processor time", scene, share, "%")
    for said, values in (("frame", wall), ("frame, processor time", cpu)):
        yield row(f"{said}, median", scene, float(np.median(values)), "ms")
        yield row(f"{said}, 99 of 100 within", scene, float(np.quantile(values, 0.99)), "ms")
    worst = int(cpu.argmax())
    yield row("worst frame, processor time", spent.where[worst], float(cpu[worst]), "ms")
