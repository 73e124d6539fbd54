"""How far pictures are from the true ones."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from seethrough.benchmarks.rows import Row as Figure
from seethrough.benchmarks.rows import row
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.base import Parameters


def flip(truth: np.ndarray, picture: np.ndarray) -> float | None:
    """Mean FLIP of two (h, w, 3) uint8 pictures; None without the package."""
    try:
        import flip_evaluator
    except ModuleNotFoundError:
        return None
    one, two = (p.astype(np.float32) / 255 for p in (truth, picture))
    return float(flip_evaluator.evaluate(one, two, "LDR")[1])


def drawn(renderer: Renderer, scene: Scene, camera: Camera, technique: Parameters) -> np.ndarray:
    """(h, w, 3) the frame."""
    renderer.draw(scene, camera, technique)
    return renderer.read()


def errors(
    where: str, truths: list[np.ndarray], pictures: list[np.ndarray], must: float | None
) -> Iterator[Figure]:
    """The differences of some pictures from the true ones, as rows."""
    pairs = list(zip(truths, pictures, strict=True))
    apart = np.stack([np.abs(a.astype(int) - b).max(axis=2) for a, b in pairs])
    yield row(
        "pixels off by more than 2/255", where, 100 * float((apart > 2).mean()), "%", must, None
    )
    yield row("mean difference", where, float(apart.mean()), "/255", None, None)
    yield row("99.9th percentile", where, float(np.percentile(apart, 99.9)), "/255", None, None)
    yield row("largest difference", where, float(apart.max()), "/255", None, None)
    values = [value for a, b in pairs if (value := flip(a, b)) is not None]
    if len(values) == len(pairs):
        yield row("mean FLIP", where, float(np.mean(values)), "", None, None)
