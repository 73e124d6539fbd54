"""Depth orderings side by side: what each costs, and whether its picture is exact.

`seethrough bench ordering --json FILE`, or `python -m seethrough.benchmarks.orderings.ordering
--json FILE --figure FILE.svg` for the figure of error against time as well. Chen1996's objects are
lost: ratios and the order of methods on stand-ins are compared with its own, no number of it is
reproduced. Times are processor time, the fastest of several: all orderings run on one thread, and
other work on the machine does not count.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from seethrough.benchmarks.memory import used_by
from seethrough.benchmarks.orderings.postprocessing import VIEWS, microseconds
from seethrough.benchmarks.rows import Row, row
from seethrough.renderer.models.translucent.scenes import TranslucentScene, scene
from seethrough.renderer.polygons import bsp
from seethrough.renderer.polygons.boxes import boxes
from seethrough.renderer.polygons.feudal import feudal
from seethrough.renderer.polygons.polygons import Polygons, polygons_from
from seethrough.renderer.polygons.prepared import Prepared

HELP = "depth orderings: splits, relations, times, memory and image error"
SEEDS = 100  # of the BSP baseline: the mean of 20, as in Chen1996, still moves by 3 %
ORDERS = 20  # random input orders of the dynamic version
LOOKAHEAD = 4  # candidates of each rule that are tried out, see `feudal_lookahead`
LISTS = 40  # view vectors whose priority lists are compared
TIMED = 5  # trees of each kind whose postprocessing is timed
EYES = int(os.environ.get("SEETHROUGH_BENCH_EYES", "100"))
IMAGE_SCENES = (
    "boxes", "panels100", "cottage", "leaves", "fishbowl", "fence", "cow", "vise", "house",
    "soup1000",
)  # fmt: skip
PICTURE = (320, 240)

MEMORY = """
from seethrough.renderer.models.translucent.scenes import scene
from seethrough.renderer.polygons import bsp
import numpy as np
from seethrough.benchmarks.orderings.ordering import bare
polygons = scene("soup100000").polygons
prepared = bsp.prepare({polygons})
prepared.order(eye=np.array([3.0, 2.0, 1.0]))
"""
COLD = """
import time
import numpy as np
from seethrough.renderer.models.translucent.scenes import scene
from seethrough.renderer.polygons.boxes import boxes
from seethrough.renderer.polygons import bsp
from seethrough.renderer.polygons.feudal import feudal
polygons = scene("fence").polygons
start = time.process_time()
for method in (bsp, feudal, boxes):
    method.prepare(polygons).order(eye=np.array([3.0, 2.0, 1.0]))
print(time.process_time() - start)
"""


def fastest(call: Callable[[], object], times: int) -> float:
    """Seconds of the fastest of several calls."""
    best = np.inf
    for _ in range(times):
        start = time.process_time()
        call()
        best = min(best, time.process_time() - start)
    return best


def summary(rows: list[Row]) -> str:
    """What the rows of the closed volumes can be compared with."""
    return (
        "vise and house stand in for paper 002's lost objects: compare ratios between methods and "
        "their order with the paper's; its absolute numbers are not reproduced"
    )


def figures() -> Iterator[Row]:
    """Every row of the table, as it is measured."""
    for name in ("vise", "house"):
        yield from closed_volume(scene(name))
    yield panels_per_second()
    yield from large_soup()
    for what, polygons in (("", "polygons"), (", geometry alone", "bare(polygons)")):
        peak = used_by(MEMORY.format(polygons=polygons)).peak
        if peak is not None:
            yield row(f"peak memory{what}", "soup100000", peak, "MiB", 500)
    with tempfile.TemporaryDirectory() as folder:
        cold = float(_child(COLD, NUMBA_CACHE_DIR=folder))
    yield row("first call, compilation not cached", "all methods", cold, "s")
    yield from dense()
    yield from image_errors()


def bare(polygons: Polygons) -> Polygons:
    """Without attributes: geometry alone, as the reference figures have it."""
    nothing = np.empty((len(polygons.vertices), 0))
    return Polygons(polygons.vertices, polygons.starts, nothing, polygons.objects)


def closed_volume(made: TranslucentScene) -> Iterator[Row]:
    """What tables 6 and 7 of Chen1996 list, for a stand-in of one of its lost objects: ratios."""
    streams = np.random.SeedSequence(3, spawn_key=(6,)).spawn(SEEDS + ORDERS)
    rngs = [np.random.default_rng(s) for s in streams]
    trees = [bsp.prepare(made.polygons, "fewest", rng=r) for r in rngs[:SEEDS]]
    static = feudal.prepare(made.polygons, "static", closed=True)
    tried = feudal.prepare(made.polygons, "static", closed=True, lookahead=LOOKAHEAD)
    dynamic = [feudal.prepare(made.polygons, "dynamic", True, rng=r) for r in rngs[SEEDS:]]

    def mean(prepared: Sequence[Prepared], what: str) -> float:
        return float(np.mean([getattr(p.stats, what) for p in prepared]))

    name = made.name
    for what in ("splits", "outputs", "relations"):
        base = mean(trees, what)
        yield row(f"{what}, BSP (mean of {SEEDS})", name, base, "")
        for label, value in (
            ("static", mean([static], what)),
            (f"static, lookahead {LOOKAHEAD}", mean([tried], what)),
            (f"dynamic (mean of {ORDERS})", mean(dynamic, what)),
        ):
            yield row(f"{what}, feudal {label}", name, value, "")
    for figure, what, must, aim in (
        ("splits", "splits", 0.2, 0.07), ("output polygons", "outputs", 0.7, 0.57),
    ):  # fmt: skip
        base = mean(trees, what)
        ratio = getattr(tried.stats, what) / base
        yield row(f"{figure}, feudal (lookahead) / BSP", name, ratio, "", must, aim)
        ratio = getattr(static.stats, what) / base
        yield row(f"{figure}, feudal by the paper's rule / BSP", name, ratio, "")
    # No output is fewer than the input: what a feudal version without a cut would reach.
    least = len(made.polygons) / mean(trees, "outputs")
    yield row("output polygons, least possible / BSP", name, least, "")
    tested = mean(trees, "relations")
    yield row("relations, dynamic / BSP", name, mean(dynamic, "relations") / tested, "", 1)
    yield row("relations, BSP / static", name, tested / static.stats.relations, "", 1)
    views = rngs[1].normal(size=(LISTS, 3))
    ratios = [
        len(static.classes(view=v)) / len(p.classes(view=v)) for p in dynamic[:TIMED] for v in views
    ]
    label = f"priority list, static / dynamic, worst of {len(ratios)}"
    yield row(label, name, max(ratios), "", 1)
    yield from postprocessing(made, rngs)


def postprocessing(made: TranslucentScene, rngs: list[np.random.Generator]) -> Iterator[Row]:
    """A new view of a closed volume, its far sides culled: see `benchmarks.postprocessing`."""
    trees = [bsp.prepare(made.polygons, "fewest", rng=r, closed=True) for r in rngs[:TIMED]]
    feudals = [feudal.prepare(made.polygons, "dynamic", True, rng=r) for r in rngs[-TIMED:]]
    took = microseconds(trees, feudals, rngs[0].normal(size=(VIEWS, 3)))
    for what, micro in took.items():
        yield row(f"postprocessing, {what}", made.name, micro, "µs")
    for what, must, aim in (("", 3, 10), (" triangles", 3, 10)):
        ratio = took["bsp" + what] / took["feudal" + what]
        label = f"postprocessing, BSP / feudal dynamic{what and ', as triangles'}"
        yield row(label, made.name, ratio, "", must, aim, more=True)
    walked = took["walk"] / took["feudal"]
    yield row("postprocessing, BSP walked / feudal dynamic", made.name, walked, "", None, None)


def panels_per_second() -> Row:
    """300 parallel panels, ordered by their boxes from eyes all around; drawing not included."""
    made = scene("panels300")
    prepared = boxes.prepare(made.polygons)
    eyes = made.eyes(50, np.random.default_rng(np.random.SeedSequence(3, spawn_key=(7,))))
    prepared.arrange(eye=eyes[0])
    seconds = fastest(lambda: [prepared.arrange(eye=eye) for eye in eyes], 7) / len(eyes)
    return row(
        "300 panels ordered by boxes (published 55)", made.name, 1 / seconds, "/s", 300, 1000, True
    )


def large_soup() -> Iterator[Row]:
    """A BSP of 10⁵ triangles: build and order."""
    made = scene("soup100000")
    bsp.prepare(bare(scene("soup1000").polygons))
    polygons = bare(made.polygons)
    prepared = bsp.prepare(polygons)
    build = fastest(lambda: bsp.prepare(polygons), 4)
    eyes = made.eyes(8, np.random.default_rng(np.random.SeedSequence(3, spawn_key=(8,))))
    order = min(fastest(partial(prepared.order, eye=e), 4) for e in eyes)
    yield row("BSP fragments for each triangle", made.name, prepared.stats.outputs / 1e5, "")
    yield row("BSP build", made.name, build, "s", 1.2, 0.8)
    yield row("BSP, one order", made.name, order * 1e3, "ms", 15, 5)


def crossing(count: int) -> Polygons:
    """Triangles that all cross one another: each through the middle of all, turned at random."""
    rng = np.random.default_rng(np.random.SeedSequence(3, spawn_key=(10,)))
    around = np.array([[np.cos(a), np.sin(a), 0.0] for a in (0.0, 2.1, 4.2)])
    axes = np.linalg.qr(rng.normal(size=(count, 3, 3)))[0]
    moved = np.einsum("kij,cj->kci", axes, around) + 0.05 * rng.normal(size=(count, 1, 3))
    return polygons_from(list(moved))


def dense() -> Iterator[Row]:
    """What cutting costs where everything crosses everything: pieces grow with the cube."""
    for count in (25, 50, 100):
        outputs = bsp.prepare(crossing(count)).stats.outputs
        yield row("output polygons, BSP, all crossing", f"{count} triangles", outputs, "")


def image_errors() -> Iterator[Row]:
    """Pixels more than 1/255 off the exact picture, in the worst of many random eyes."""
    from seethrough.benchmarks.orderings.painted_scene import PaintedScene as Bench

    for name in IMAGE_SCENES:
        made = scene(name)
        bench = Bench(made, PICTURE)
        eyes = made.eyes(EYES, np.random.default_rng(np.random.SeedSequence(3, spawn_key=(9,))))
        for method, prepared in (
            ("bsp", bsp.prepare(made.polygons)),
            ("feudal", feudal.prepare(made.polygons)),
        ):
            off = max(bench.off(prepared, eye) for eye in eyes)
            label = f"pixels over 1/255, {method}, worst of {EYES} eyes"
            yield row(label, name, 100 * off, "%", 0.1, 0.0)
        bench.release()


def _child(code: str, **environment: str) -> str:
    """What a fresh Python prints: compilation is a process's own."""
    done = subprocess.run(
        [sys.executable, "-c", code], env={**os.environ, **environment}, check=True,
        capture_output=True, text=True,
    )  # fmt: skip
    return done.stdout


def main() -> None:
    """Print the table, and write it and the figure of error against time where asked."""
    parser = argparse.ArgumentParser(description=HELP)
    parser.add_argument("--json", type=Path, metavar="FILE")
    parser.add_argument("--figure", type=Path, metavar="FILE")
    chosen = parser.parse_args()
    rows = []
    for made in figures():
        rows.append(made)
        bound = (
            ""
            if made["must"] is None
            else f"must {made['must']:g}: {'met' if made['met'] else 'NOT MET'}"
        )
        print(
            f"{made['figure']:52s} {made['scene']:12s} {made['value']:10.4g} "
            f"{made['unit']:4s} {bound}",
            flush=True,
        )
    if chosen.json:
        chosen.json.write_text(json.dumps(rows, indent=1, ensure_ascii=False) + "\n", "utf-8")
    if chosen.figure:
        from seethrough.benchmarks.orderings.ordering_accuracy import draw_figure, measure_all

        draw_figure(measure_all(), chosen.figure)


if __name__ == "__main__":
    main()
