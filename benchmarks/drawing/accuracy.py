"""How far each way of drawing is from the exact picture, and what it costs.

`seethrough bench accuracy --json FILE --figure FILE.svg` compares every order of objects, on the
three scenes of Elmqvist2009 and on scenes built to break each order, with the exact picture of the
GPU (which the tests hold to the float64 reference): the share of pixels that differ by more than
2/255, the mean, 99.9th percentile and largest difference, the share of pixels with a wrong order,
FLIP where flip-evaluator is installed, and the frame's time against the standard frame's. Then it
says what the target that loses most keeps, and what jumps along paths (guarantee.py), sweeps what
masks are made of (mask_sweep.py) and compares with VTK's depth peeling, where vtk is installed
(vtk_peeling.py).

Wrong order: with a depth buffer, an object drawn after one in front of it is not drawn at all. So
a pixel is counted where the exact picture shows an object with a share of at least 1/64 that the
way never drew there. Inside parts that a way sorts by pixel the order is right by construction.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from seethrough.benchmarks.drawing import guarantee, mask_sweep, vtk_peeling
from seethrough.benchmarks.drawing.breaking import BREAKING
from seethrough.benchmarks.drawing.picture_errors import drawn, errors
from seethrough.benchmarks.drawing.scenes import SCENES
from seethrough.benchmarks.drawing.speed import drawing, times
from seethrough.benchmarks.rows import Row as Figure
from seethrough.benchmarks.rows import row
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.plan.planner import plan
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.scene.visibility import SEEN
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard

SIZE, LOOK = (800, 600), (400, 300)
VIEWS = 4
EXACT = DynamicTransparency(exact=True)
DOUBTS = (0.0, 0.02, 0.05, 0.1, 1.0)
WAYS = {
    "centres": DynamicTransparency(order="centers"),
    **{f"planes, doubt {d:g}": DynamicTransparency(doubt=d) for d in DOUBTS},
    "polygons": DynamicTransparency(order="polygons"),
    "sorted by pixel": EXACT,
}
DEFAULT = f"planes, doubt {DynamicTransparency().doubt:g}"
MOST_OFF = 0.1  # % of the pixels, by more than 2/255, on the three scenes


def figures() -> Iterator[Figure]:
    """All rows, as they are measured."""
    context = standalone()
    renderer = Renderer(context, SIZE, without=frozenset({"still"}))
    for name, make in {**SCENES, **BREAKING}.items():
        scene, cameras = make(SIZE[0] / SIZE[1], VIEWS)
        yield from of_scene(renderer, name, scene, cameras, name in SCENES)
    yield from guarantee.figures(renderer, WAYS, DEFAULT)
    yield from mask_sweep.figures(renderer)
    yield from vtk_peeling.figures(renderer)


def of_scene(
    renderer: Renderer, name: str, scene: Scene, cameras: list[Camera], held: bool
) -> Iterator[Figure]:
    """The rows of one scene; `held` says whether the default must keep to its limit there."""
    draws = {
        way: drawing(renderer, scene, t) for way, t in {"standard": Standard(), **WAYS}.items()
    }
    spent = times(draws, cameras, renderer.context)
    truths = [drawn(renderer, scene, c, EXACT) for c in cameras]
    shown = [_shown(renderer, scene, c) for c in cameras]
    for way, technique in WAYS.items():
        where = f"{name}: {way}"
        must = MOST_OFF if way == DEFAULT and held else None
        pictures = [drawn(renderer, scene, c, technique) for c in cameras]
        yield from errors(where, truths, pictures, must)
        yield row("time / standard", where, spent[way] / spent["standard"], "×", None, None)
        if technique.order == "polygons":
            continue  # drawn without numbers of objects: what was drawn where is not known
        wrong = [
            wrong_order(renderer, scene, c, technique, s)
            for c, s in zip(cameras, shown, strict=True)
        ]
        yield row("pixels with a wrong order", where, 100 * float(np.mean(wrong)), "%", None, None)


def _keys(layers: list[tuple[np.ndarray, np.ndarray]], objects: int, least: float) -> np.ndarray:
    """(k,) pixel · objects + object, sorted, for what layers drew with at least that much."""
    found = [np.zeros(0, np.int64)]
    for ids, share in layers:
        where = np.nonzero((ids.ravel() > 0) & (share.ravel() >= least))[0]
        found.append(where * objects + ids.ravel()[where] - 1)
    return np.unique(np.concatenate(found))


def _shown(renderer: Renderer, scene: Scene, camera: Camera) -> np.ndarray:
    """The keys of what the exact picture shows."""
    return _keys(renderer.shares(scene, camera, EXACT, LOOK), len(scene.objects), SEEN)


def wrong_order(
    renderer: Renderer,
    scene: Scene,
    camera: Camera,
    technique: DynamicTransparency,
    shown: np.ndarray,
) -> float:
    """The share of pixels where an object that should show was never drawn (see above)."""
    if technique.per_pixel_only:
        return 0.0
    n = len(scene.objects)
    there = _keys(renderer.layers(scene, camera, technique, LOOK), n, 0.0)
    wrong = np.zeros(LOOK[0] * LOOK[1], dtype=bool)
    wrong[np.setdiff1d(shown, there, assume_unique=True) // n] = True
    wrong = wrong.reshape(LOOK[::-1])
    frame = plan(scene, camera, technique, LOOK, renderer.without, LOOK[1] / SIZE[1])
    parts = frame.doubtful.astype(int) if len(frame.doubtful) else frame.exact
    for left, top, right, bottom in parts.tolist():
        wrong[top:bottom, left:right] = False
    return float(wrong.mean())


def chart(rows: list[Figure], path: Path) -> None:
    """Error against time: one panel for each scene, one mark for each order of objects."""
    from matplotlib.figure import Figure as Picture

    found: dict[str, dict[str, dict[str, float]]] = {}
    for r in rows:
        scene, _, way = r["scene"].partition(": ")
        if way in WAYS:
            found.setdefault(scene, {}).setdefault(way, {})[r["figure"]] = r["value"]
    picture = Picture(figsize=(11, 6.5), layout="constrained")
    axes = picture.subplots(2, 3).ravel()
    for plot, (scene, ways) in zip(axes, found.items(), strict=False):
        for k, way in enumerate(WAYS):
            at = ways[way]["time / standard"], ways[way]["mean difference"]
            marks = {"marker": "os^vD<>*"[k], "color": f"C{k}", "label": way, "alpha": 0.8}
            plot.plot(*at, linestyle="", clip_on=False, zorder=3, **marks)
        plot.set(title=scene, xlabel="frame time / standard", ylabel="mean difference / 255")
        plot.set_yscale("symlog", linthresh=0.001)
        plot.set(xlim=(0, None), ylim=(0, None))
        plot.grid(alpha=0.3)
    handles, labels = axes[0].get_legend_handles_labels()
    picture.legend(handles, labels, loc="outside right center")
    picture.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None)
