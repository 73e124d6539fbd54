"""Frames along walks through the building (`seethrough bench paths`).

The walks are those of data/walks, each with the technique that its walker had. Frames are those of
60 a second in which the walker moves, one of EVERY of them; each is drawn in every way in turn, so
that whatever else the machine does meets all ways alike. A frame's processor time is that of all
threads: on an idle machine no frame takes longer than that, on a busy one its time says little.
"Cores free" is what a software rasteriser takes that has all cores to itself and shares its work
evenly: the time of the thread that draws, and that of all others divided by the cores.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from seethrough.benchmarks.drawing.walks import Walked, walked
from seethrough.benchmarks.rows import Row, row
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.look.dressed import dressed
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.look import PLAIN, Look
from seethrough.renderer.scene.scene import Scene

PARTS = ("standard", "dynamic")
SIZE, RATE, EVERY = (800, 600), 60, 30
MISSED = {"standard": (16.7, 1.0, 0.2), "dynamic": (33.0, 20.0, 1.0)}  # ms; must and aim in %

CHANGED = {"standard": (0.5, 0.1), "dynamic": (1.5, 0.5)}  # % of pixels: must and aim
DETAILED = Look(detail_error=0.5)
STEPS = 2  # of 255, by which a pixel may be another without being counted


@dataclass(frozen=True)
class Way:
    """A way of drawing: what does it, and how its scenes look."""

    renderer: Renderer
    look: Look = PLAIN

    def draw(self, scene: Scene, walk: Walked, camera: Camera) -> None:
        """A frame, to its end."""
        self.renderer.draw(dressed(scene, self.look), camera, walk.technique)
        self.renderer.context.finish()


@dataclass
class Spent:
    """Milliseconds of each frame: by the clock, of the processor, with all cores free. Where each
    was seen, and which part of its pixels was another than in the first way."""

    wall: list[float] = field(default_factory=list)
    cpu: list[float] = field(default_factory=list)
    free: list[float] = field(default_factory=list)
    where: list[str] = field(default_factory=list)
    changed: list[float] = field(default_factory=list)


def figures(only: list[str] | None = None) -> Iterator[Row]:
    """Every row, a level of the study after the other."""
    context = standalone()
    whole = Renderer(context, SIZE, without=frozenset({"still"}))
    ways = {
        "": Way(whole),
        ", detail": Way(whole, DETAILED),
        ", all rooms": Way(Renderer(context, SIZE, without=frozenset({"still", "rooms"}))),
    }
    for level in only or PARTS:
        spent = _along(level, ways)
        for name, found in spent.items():
            yield from _rows(level, name, found)


def _along(level: str, ways: Mapping[str, Way]) -> dict[str, Spent]:
    """What each way of drawing takes for the frames of all walks at that level."""
    spent = {name: Spent() for name in ways}
    for walk in walked():
        if walk.level != level:
            continue
        times, cameras = walk.frames(RATE)
        for way in ways.values():
            way.draw(walk.scene, walk, cameras[0])  # uploads the scene, compiles what is not yet
        chosen = slice(EVERY // 2, None, EVERY)
        for at, camera in zip(times[chosen].tolist(), cameras[chosen], strict=True):
            where, first = f"slot {walk.slot}, trial {walk.trial}, {at:.1f} s", None
            for name, way in ways.items():
                _measure(spent[name], partial(way.draw, walk.scene, walk, camera))
                spent[name].where.append(where)
                picture = way.renderer.read().astype(np.int16)
                first = picture if first is None else first
                other = (np.abs(picture - first) > STEPS).any(axis=2)
                spent[name].changed.append(float(other.mean()))
    return spent


def _measure(spent: Spent, draw: Callable[[], None]) -> None:
    wall, cpu, own = time.perf_counter(), time.process_time(), time.thread_time()
    draw()
    own, cpu = time.thread_time() - own, time.process_time() - cpu
    spent.wall.append(1000 * (time.perf_counter() - wall))
    spent.cpu.append(1000 * cpu)
    spent.free.append(1000 * (own + (cpu - own) / (os.cpu_count() or 1)))


def _rows(level: str, name: str, spent: Spent) -> Iterator[Row]:
    scene = f"{level}{name}, {len(spent.wall)} frames"
    limit, must, aim = MISSED[level]
    kinds = (("", spent.wall), (", processor time", spent.cpu), (", cores free", spent.free))
    for said, times in kinds:
        values = np.array(times)
        for most in (16.7, 33.0):
            judged = (must, aim) if most == limit and not said else (None, None)
            share = 100 * float((values > most).mean())
            yield row(f"over {most} ms{said}", scene, share, "%", *judged)
        yield row(f"a frame{said}, median", scene, float(np.median(values)), "ms")
        yield row(f"a frame{said}, 99 of 100", scene, float(np.quantile(values, 0.99)), "ms")
        worst = int(values.argmax())
        yield row(f"worst frame{said}", spent.where[worst], float(values[worst]), "ms")
    if name:
        judged = CHANGED[level] if name == ", detail" else (0.0, 0.0)
        yield row("pixels changed", scene, 100 * float(np.mean(spent.changed)), "%", *judged)
        worst = int(np.argmax(spent.changed))
        yield row("most pixels changed", spent.where[worst], 100 * spent.changed[worst], "%")
