"""Error against time of every ordering and of the usual approximations, on the same scenes.

Which to pick: polygons that stand still and reach through one another, `bsp`; up to a few thousand
of them, solid things above all, `feudal`, which cuts less. Things that move and don't intersect,
`boxes`. Small polygons of one size, or when a wrong blend here and there does no harm, a sort by
distance or view depth, at the price of drawing unsorted. The axis tree is never the best choice,
and the paper's rule for boxes never better than the plane's. Without any order: the exact list
where OpenGL 4.3 and the memory are there; depth peeling, eight passes or more, where they aren't;
weighted blending when nobody looks closely; chance only to be averaged over many frames.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from renderer.camera import Camera, look_at
from renderer.gpu.approximations import PeelingPainter, StochasticPainter, WeightedPainter
from renderer.gpu.context import standalone
from renderer.gpu.polygons import Corners, ExactPainter, PolygonPainter
from renderer.models.translucent.scenes import TranslucentScene, scene
from renderer.ordering import axis_tree, boxes, bsp, distance, feudal
from renderer.ordering.polygons import Floats
from renderer.ordering.prepared import Drawable, Prepared, drawable

SCENES = ("panels100", "boxes", "leaves", "cow", "house", "soup1000")
SIZE = (400, 300)
EYES = 3
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


class Bench:
    """One scene on the GPU: the exact picture, and how far others are off it."""

    def __init__(self, made: TranslucentScene, size: tuple[int, int]) -> None:
        self.made = made
        self.painter = PolygonPainter(standalone(430), size, texture=made.texture)
        self.exact = ExactPainter(self.painter)
        self.plain = corners_of(drawable(made.polygons, np.arange(len(made.polygons))))
        if made.opaque is not None:
            self.painter.opaque = corners_of(drawable(made.opaque, np.arange(len(made.opaque))))
        self._corners: dict[int, tuple[Prepared, Corners]] = {}
        self._exact: dict[bytes, NDArray[np.float32]] = {}

    def release(self) -> None:
        """Give the GPU back."""
        self.painter.release()
        self.painter.context.release()

    def camera(self, eye: Floats) -> Camera:
        """Looks at the scene's middle."""
        radius = self.made.radius
        return look_at(eye, self.made.center, near=0.05 * radius, far=6 * radius)

    def truth(self, eye: Floats) -> NDArray[np.float32]:
        """The exact picture, kept."""
        key = eye.tobytes()
        if key not in self._exact:
            self._exact[key] = self.exact.painted(self.plain, self.camera(eye))
        return self._exact[key]

    def ordered(self, prepared: Prepared, eye: Floats) -> NDArray[np.float32]:
        """The picture painted in a method's order: order and drawing."""
        if id(prepared) not in self._corners:
            self._corners[id(prepared)] = (prepared, corners_of(prepared.drawable))
        camera = self.camera(eye)
        order = prepared.order(eye=eye, view=camera.forward)
        return self.painter.painted(self._corners[id(prepared)][1], order, camera)

    def off(self, prepared: Prepared, eye: Floats) -> float:
        """Share of pixels more than 1/255 off the exact picture."""
        truth = self.truth(eye)
        return float(
            (np.abs(self.ordered(prepared, eye) - truth)[..., :3].max(-1) > 1 / 255).mean()
        )


def corners_of(drawn: Drawable) -> Corners:
    """Triangles for the GPU."""
    return Corners.of(drawn.polygons.vertices, drawn.polygons.attributes, drawn.triangles)


def ways(bench: Bench) -> Iterator[tuple[str, Callable[[Floats], NDArray[np.float32]], float]]:
    """Every way to a picture of a scene: its name, the way, and seconds of preparation."""
    painter, plain = bench.painter, bench.plain
    for name, prepare in ORDERINGS.items():
        prepare(bench.made.polygons).order(eye=bench.made.center + 1e3, view=np.ones(3))
        start = time.perf_counter()
        prepared = prepare(bench.made.polygons)
        yield name, (lambda eye, p=prepared: bench.ordered(p, eye)), time.perf_counter() - start
    yield "unsorted", lambda eye: painter.painted(plain, None, bench.camera(eye)), 0.0
    weighted, peeling, chance = (
        WeightedPainter(painter),
        PeelingPainter(painter),
        StochasticPainter(painter),
    )

    def depths(eye: Floats) -> tuple[float, float]:
        away = float(np.linalg.norm(eye - bench.made.center))
        return away - bench.made.radius, away + bench.made.radius

    yield (
        "weighted blended",
        lambda eye: weighted.painted(plain, bench.camera(eye), depths(eye)),
        0.0,
    )
    for passes in (1, 2, 4, 8, 16):
        yield (
            f"depth peeling, {passes}",
            lambda eye, n=passes: peeling.painted(plain, bench.camera(eye), n),
            0.0,
        )
    for draws in (8, 32):
        yield (
            f"stochastic, {draws}",
            lambda eye, n=draws: chance.painted(plain, bench.camera(eye), n),
            0.0,
        )
    yield "exact list", lambda eye: bench.exact.painted(plain, bench.camera(eye)), 0.0


def measure_all(names: tuple[str, ...] = SCENES) -> list[dict[str, Any]]:
    """For each scene and way: error, and times of preparing and of a frame, read-back included."""
    results = []
    for name in names:
        bench = Bench(scene(name), SIZE)
        eyes = bench.made.eyes(
            EYES, np.random.default_rng(np.random.SeedSequence(3, spawn_key=(10,)))
        )
        for way, paint, preparing in ways(bench):
            paint(eyes[0])
            errors, times = [], []
            for eye in eyes:
                truth = bench.truth(eye)
                start = time.perf_counter()
                picture = paint(eye)
                times.append(time.perf_counter() - start)
                errors.append(((picture - truth)[..., :3] ** 2).mean())
            results.append(
                {
                    "scene": name, "way": way, "prepare_ms": 1e3 * preparing,
                    "frame_ms": 1e3 * min(times), "rmse": 255 * float(np.sqrt(np.mean(errors))),
                }
            )  # fmt: skip
        bench.release()
    return results


def figures() -> Iterator[dict[str, Any]]:
    """The table as rows of `seethrough bench`."""
    for result in measure_all():
        for what, unit in (("rmse", "/255"), ("frame_ms", "ms")):
            yield {
                "figure": f"{what}, {result['way']}", "scene": result["scene"],
                "value": float(f"{result[what]:.4g}"), "unit": unit,
                "must": None, "aim": None, "met": True,
            }  # fmt: skip


def draw_figure(results: list[dict[str, Any]], path: Path) -> None:
    """Error against time of a frame, one panel for each scene."""
    from matplotlib.figure import Figure

    names = list(dict.fromkeys(r["scene"] for r in results))
    labels = list(dict.fromkeys(r["way"] for r in results))
    marks = "osD^v<>Ph*XpH8d+x1234"
    picture = Figure(figsize=(11, 6.5), layout="constrained")
    axes = picture.subplots(2, (len(names) + 1) // 2).ravel()
    for plot, name in zip(axes, names, strict=False):
        for i, way in enumerate(labels):
            found = [r for r in results if r["scene"] == name and r["way"] == way]
            for r in found:
                plot.plot(
                    r["frame_ms"],
                    max(r["rmse"], 0.01),
                    marks[i % len(marks)],
                    color=f"C{i % 10}",
                    label=way,
                )
        plot.set(xscale="log", yscale="log", title=name, xlabel="ms a frame", ylabel="RMSE / 255")
        plot.grid(alpha=0.3)
    for unused in axes[len(names) :]:
        unused.remove()
    handles, shown = axes[0].get_legend_handles_labels()
    picture.legend(handles, shown, loc="outside right center", fontsize=8)
    picture.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None)
