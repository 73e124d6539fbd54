"""Kang2008's figures 4 to 6: what a missing order looks like, and what its order costs.

`python -m seethrough.benchmarks.orderings.ordering_accuracy --pictures FOLDER` draws them.
Unblended: nothing shows through. Unsorted: blended in the order the polygons happen to be stored.
Sorted: by `boxes`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from seethrough.benchmarks.orderings.painted_scene import PaintedScene, Picture
from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.translucent.scenes import TranslucentScene, panels, scene
from seethrough.renderer.polygons.boxes import boxes

SIZE = (480, 360)
# Where the scenes are seen from: a direction, and a distance in radii.
VIEWS = {"boxes": ((-0.6, 0.5, 1.0), 1.4), "panels100": ((0.4, 0.28, 1.0), 1.22)}
COUNTS = (10, 30, 100, 200, 300, 400)
RATED = (800, 600)
TURNS, EYES = 5, 5
# Table 1 of the paper: panels, frames per second (mean, worst, best), on its machine of 2009.
PUBLISHED = {100: (396.3, 209.4, 476.3), 300: (55.3, 49.6, 62.8)}


def draw_pictures(folder: Path) -> Iterator[str]:
    """Write the pictures; gives a line for each, and one for each frame rate."""
    from PIL import Image

    folder.mkdir(parents=True, exist_ok=True)
    for name in VIEWS:
        for way, (picture, off) in three_ways(scene(name)).items():
            path = folder / f"{name}-{way}.png"
            pixels = np.round(picture[..., :3].clip(0, 1) * 255).astype(np.uint8)
            Image.fromarray(pixels).save(path, optimize=True)
            yield f"{path.name}: {100 * off:.3f} % of the pixels more than 1/255 off"
    rates = {}
    for count in COUNTS:
        rates[count] = frame_rates(panels(count))
        shown = ", ".join(f"{what} {rate:.0f}" for what, rate in rates[count].items())
        yield f"{count} panels, frames per second: {shown}"
    draw_rates(rates, folder / "frame-rate.svg")
    yield "frame-rate.svg: frame rate against the number of panels"


def three_ways(made: TranslucentScene) -> dict[str, tuple[Picture, float]]:
    """Unblended, unsorted and sorted pictures, and the share of each that is not exact."""
    painted = PaintedScene(made, SIZE)
    way, radii = VIEWS[made.name]
    eye = made.center + radii * made.radius * np.array(way) / np.linalg.norm(way)
    camera, plain = painted.camera(eye), painted.plain
    pictures = {
        "unblended": painted.painter.painted(plain, None, camera, blend=False),
        "unsorted": painted.painter.painted(plain, None, camera),
        "sorted": painted.ordered(boxes.prepare(made.polygons), eye),
    }
    made_of = {name: (p, float(painted.wrong(p, eye).mean())) for name, p in pictures.items()}
    painted.release()
    return made_of


def frame_rates(made: TranslucentScene) -> dict[str, float]:
    """Frames per second: ordered by boxes and drawn, drawn unsorted, ordered and not drawn."""
    painted = PaintedScene(made, RATED)
    prepared = boxes.prepare(made.polygons)
    stream = np.random.SeedSequence(3, spawn_key=(11,))
    eyes = made.eyes(EYES, np.random.default_rng(stream))

    def unsorted(eye: Floats) -> None:
        painted.painter.paint(painted.plain, None, painted.camera(eye))

    ways: dict[str, Callable[[Floats], object]] = {
        "ordered and drawn": lambda eye: painted.paint(prepared, eye),
        "drawn unsorted": unsorted,
        "ordered only": lambda eye: prepared.arrange(eye=eye),
    }
    spent = {what: np.full(EYES, np.inf) for what in ways}
    for e, eye in enumerate(eyes):
        for _ in range(TURNS):
            for what, call in ways.items():
                start = time.perf_counter()
                call(eye)
                painted.painter.context.finish()
                spent[what][e] = min(spent[what][e], time.perf_counter() - start)
    painted.release()
    return {what: 1 / float(times.mean()) for what, times in spent.items()}


def draw_rates(rates: dict[int, dict[str, float]], path: Path) -> None:
    """Figure 6: frame rate against the number of panels."""
    from matplotlib.figure import Figure

    from seethrough.benchmarks.orderings.ordering_figures import INK, PAPER, plain, save

    figure = Figure(figsize=(6.4, 3.6), layout="constrained", facecolor=PAPER)
    axes = figure.subplots()
    colors = {
        "ordered and drawn": "#2f81d6",
        "drawn unsorted": "#8a8f98",
        "ordered only": "#2e9e4f",
    }
    for what, color in colors.items():
        axes.plot(list(rates), [r[what] for r in rates.values()], "-o", color=color, label=what)
    for count, (mean, worst, best) in PUBLISHED.items():
        label = "published: mean, worst, best" if count == min(PUBLISHED) else None
        reach = [[mean - worst], [best - mean]]
        axes.errorbar([count], [mean], yerr=reach, fmt="D", color="#d64f86", capsize=3, label=label)
    plain(axes)
    axes.set(yscale="log")
    axes.set_xlabel("parallel panels", color=INK)
    axes.set_ylabel("frames per second", color=INK)
    axes.legend(labelcolor=INK, frameon=False, fontsize=8)
    save(figure, path, "Frame rate against the number of parallel panels")
