"""How far each way of drawing is from the exact picture, and what it costs.

`seethrough bench accuracy --json FILE` compares, on the three scenes of paper 004 and on one built
to break each way, with the exact picture of the GPU (which the tests hold to the reference): the
share of pixels that differ by more than 2/255, the mean, 99.9th percentile and largest difference,
FLIP where flip-evaluator is installed, and the frame's time against the standard frame's.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from benchmarks.scenes import SCENES, breaking
from benchmarks.speed import Figure, row, times
from renderer.gpu.context import standalone
from renderer.gpu.renderer import Renderer
from renderer.techniques.dynamic import DynamicTransparency
from renderer.techniques.standard import Standard

SIZE = (800, 600)
VIEWS = 4
EXACT = DynamicTransparency(exact=True)
WAYS = {
    "default": DynamicTransparency(),
    "centers": DynamicTransparency(order="centers"),
    "ring masks": DynamicTransparency(mask="ring"),
    "exact": EXACT,
}


def flip(truth: np.ndarray, picture: np.ndarray) -> float | None:
    """Mean FLIP of two (h, w, 3) uint8 pictures; None without the package."""
    try:
        import flip_evaluator
    except ModuleNotFoundError:
        return None
    one, two = (p.astype(np.float32) / 255 for p in (truth, picture))
    return float(flip_evaluator.evaluate(one, two, "LDR")[1])


def figures() -> Iterator[Figure]:
    """All rows, as they are measured."""
    context = standalone()
    renderer = Renderer(context, SIZE, without=frozenset({"still"}))
    for name, make in {**SCENES, "breaking": breaking}.items():
        scene, cameras = make(SIZE[0] / SIZE[1], VIEWS)
        draws: dict[str, Any] = {
            way: (lambda c, s=scene, t=t: renderer.draw(s, c, t))  # type: ignore[misc]
            for way, t in {"standard": Standard(), **WAYS}.items()
        }
        spent = times(draws, cameras, context)
        truths = [_drawn(renderer, scene, c, EXACT) for c in cameras]
        for way, technique in WAYS.items():
            must = 0.001 if way == "default" and name != "breaking" else None
            pictures = [_drawn(renderer, scene, c, technique) for c in cameras]
            yield from _errors(f"{name}: {way}", truths, pictures, must)
            value = spent[way] / spent["standard"]
            yield row("time / standard", f"{name}: {way}", value, "×", None, None)


def _drawn(renderer, scene, camera, technique) -> np.ndarray:  # type: ignore[no-untyped-def]
    renderer.draw(scene, camera, technique)
    return renderer.read()


def _errors(
    where: str, truths: list[np.ndarray], pictures: list[np.ndarray], must: float | None
) -> Iterator[Figure]:
    pairs = list(zip(truths, pictures, strict=True))
    apart = np.stack([np.abs(a.astype(int) - b).max(axis=2) for a, b in pairs])
    yield row("share off by more than 2/255", where, float((apart > 2).mean()), "", must, must)
    yield row("mean difference", where, float(apart.mean()), "/255", None, None)
    yield row("99.9th percentile", where, float(np.percentile(apart, 99.9)), "/255", None, None)
    yield row("largest difference", where, float(apart.max()), "/255", None, None)
    values = [flip(a, b) for a, b in pairs]
    if None not in values:
        yield row("mean FLIP", where, float(np.mean(values)), "", None, None)  # type: ignore[arg-type]
