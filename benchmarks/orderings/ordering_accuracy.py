"""Error against time of every ordering and of the usual approximations, on the same scenes.

`seethrough bench ordering_accuracy --json FILE` prints for every scene whether the orders that are
exact give the exact picture, then error and time of every way, then which to pick when, as the
numbers have it; with `--figure FILE.svg` it draws error against time. `python -m
benchmarks.ordering_accuracy --figure FILE.svg --pictures FOLDER` draws that figure alone, and paper
Kang2008's figures 4 to 6.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from seethrough.benchmarks.orderings import ordering_exactness
from seethrough.benchmarks.orderings.painted_scene import PaintedScene as Bench
from seethrough.benchmarks.rows import Row, row
from seethrough.renderer.arrays import Floats
from seethrough.renderer.gpu.levels.approximations import (
    PeelingPainter,
    StochasticPainter,
    WeightedPainter,
)
from seethrough.renderer.gpu.levels.polygon_painter import Corners
from seethrough.renderer.models.translucent.scenes import scene
from seethrough.renderer.polygons import axis_tree, bsp, distance
from seethrough.renderer.polygons.boxes import boxes
from seethrough.renderer.polygons.feudal import feudal
from seethrough.renderer.polygons.prepared import Prepared
from seethrough.renderer.scene.camera import Camera

SCENES = ("panels100", "boxes", "leaves", "cow", "house", "soup1000")
SIZE = (400, 300)
EYES, TURNS = 4, 3
PASSES, DRAWS = (1, 2, 4, 8, 16), (8, 32)
UNSORTED = "unsorted"
ORDERINGS: dict[str, Callable[..., Prepared]] = {
    "distance (003)": distance.prepare,
    "view depth (004)": lambda p: distance.prepare(p, "depth"),
    "axis tree (003)": axis_tree.prepare,
    "boxes, paper's rule (000)": lambda p: boxes.prepare(p, rule="paper"),
    "boxes, by plane": boxes.prepare,
    "bsp (001, ours)": bsp.prepare,
    "feudal static (002)": feudal.prepare,
    "feudal dynamic (002)": lambda p: feudal.prepare(p, "dynamic"),
}
Result = Row


@dataclass(frozen=True, slots=True)
class Way:
    """A way to a picture: `paint` draws it for an eye, after `prepare_ms` of preparation."""

    name: str
    paint: Callable[[Floats], None]
    prepare_ms: float = 0.0


def ways(bench: Bench) -> Iterator[Way]:
    """Every way to a picture of a scene."""
    for name, prepare in ORDERINGS.items():
        prepare(bench.made.polygons).order(eye=bench.made.center + 1e3, view=np.ones(3))
        start = time.perf_counter()
        prepared = prepare(bench.made.polygons)
        spent = 1e3 * (time.perf_counter() - start)
        yield Way(name, partial(bench.paint, prepared), spent)
    yield from _without_order(bench)


def _without_order(bench: Bench) -> Iterator[Way]:
    painter, plain, camera = bench.painter, bench.plain, bench.camera
    weighted, peeling = WeightedPainter(painter), PeelingPainter(painter)
    chance = StochasticPainter(painter)

    def depths(eye: Floats) -> tuple[float, float]:
        away = float(np.linalg.norm(eye - bench.made.center))
        return away - bench.made.radius, away + bench.made.radius

    def _passes(paint: Callable[[Corners, Camera, int], None], n: int, eye: Floats) -> None:
        paint(plain, camera(eye), n)

    yield Way(UNSORTED, lambda eye: painter.paint(plain, None, camera(eye)))
    yield Way("weighted blended", lambda eye: weighted.paint(plain, camera(eye), depths(eye)))
    for n in PASSES:
        yield Way(
            f"depth peeling, {n}",
            partial(_passes, peeling.paint, n),
        )
    for n in DRAWS:
        yield Way(
            f"stochastic, {n}",
            partial(_passes, chance.paint, n),
        )
    yield Way("exact list", lambda eye: bench.exact.paint(plain, camera(eye)))


def measure(name: str, eyes: int = EYES, turns: int = TURNS) -> list[Result]:
    """For each way of one scene: error, and times of preparing and of a frame.

    A frame is ordering and drawing, read-back not included. Ways take turns, and the fastest turn
    at each eye counts, so that other work on the machine falls on none or on all.
    """
    bench = Bench(scene(name), SIZE)
    stream = np.random.SeedSequence(3, spawn_key=(10,))
    places = bench.made.eyes(eyes, np.random.default_rng(stream))
    found = list(ways(bench))
    spent = np.full((len(found), eyes), np.inf)
    squares, over = np.zeros((2, len(found), eyes))
    for e, eye in enumerate(places):
        for i, way in enumerate(found):
            way.paint(eye)
            picture = bench.painter.picture()
            squares[i, e] = ((picture - bench.truth(eye))[..., :3] ** 2).mean()
            over[i, e] = bench.wrong(picture, eye).mean()
        for _ in range(turns):
            for i, way in enumerate(found):
                start = time.perf_counter()
                way.paint(eye)
                bench.painter.context.finish()
                spent[i, e] = min(spent[i, e], time.perf_counter() - start)
    bench.release()
    return [
        {
            "scene": name, "way": way.name, "prepare_ms": way.prepare_ms,
            "frame_ms": 1e3 * float(np.median(spent[i])),
            "rmse": 255 * float(np.sqrt(squares[i].mean())), "over": 100 * float(over[i].mean()),
        }
        for i, way in enumerate(found)
    ]  # fmt: skip


def measure_all(names: tuple[str, ...] = SCENES) -> list[Result]:
    """`measure`, scene by scene."""
    return [result for name in names for result in measure(name)]


def figures() -> Iterator[Row]:
    """The tables as rows of `seethrough bench`."""
    yield from ordering_exactness.figures()
    for name in SCENES:
        yield from rows(measure(name))


def rows(results: list[Result]) -> Iterator[Row]:
    """Four rows for each result."""
    units = {"rmse": "/255", "over": "%", "frame_ms": "ms", "prepare_ms": "ms"}
    for result in results:
        for what, unit in units.items():
            yield row(f"{what}, {result['way']}", result["scene"], result[what], unit)


def results_of(table: list[Row]) -> list[Result]:
    """The results that rows were made of."""
    found: dict[tuple[str, str], Result] = {}
    for line in table:
        what, _, way = line["figure"].partition(", ")
        if what in ("rmse", "over", "frame_ms", "prepare_ms"):
            key = (line["scene"], way)
            found.setdefault(key, {"scene": key[0], "way": way})[what] = line["value"]
    return list(found.values())


def summary(table: list[Row]) -> str:
    """Which way to pick when, from the rows of `figures`."""
    from seethrough.benchmarks.orderings.ordering_advice import advice

    return advice(results_of(table))


def chart(table: list[Row], path: Path) -> None:
    """The figure of error against time, from the rows of `figures`."""
    draw_figure(results_of(table), path)


def draw_figure(results: list[Result], path: Path) -> None:
    """Error against time of a frame, one panel for each scene."""
    from seethrough.benchmarks.orderings.ordering_figures import error_against_time

    error_against_time(results, path)


def main() -> None:
    """Draw what is asked for, and say which way to pick."""
    parser = argparse.ArgumentParser(description="error against time, and paper 000's figures")
    parser.add_argument("--figure", type=Path, metavar="FILE", help="error against time, SVG")
    parser.add_argument("--pictures", type=Path, metavar="FOLDER", help="paper 000's figures 4–6")
    chosen = parser.parse_args()
    if chosen.pictures:
        from seethrough.benchmarks.orderings.paper_figures import draw_pictures

        for line in draw_pictures(chosen.pictures):
            print(line, flush=True)
    if chosen.figure:
        results = measure_all()
        draw_figure(results, chosen.figure)
        print(summary(list(rows(results))))


if __name__ == "__main__":
    main()
