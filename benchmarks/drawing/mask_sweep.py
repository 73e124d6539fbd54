"""What masks are made of: resolution, width and opacity, with error, visibility and time.

The defaults of the technique (Elmqvist2009 prints only 128 × 128) are chosen by these tables:

- *Resolution*: the paper's ring growth on coarse cells against the exact distance to the outline,
  all else equal and sorted by pixel, so that the masks alone differ.
- *Width*: how much of the picture a mask changes beside its target, how well its border sets the
  target off (contrast of targets with what surrounds them), and the time it costs.
- *Opacities*: what share of its pixels a covered target has, and what the occluders keep of theirs
  where they lie in front.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from seethrough.benchmarks.drawing.picture_errors import drawn, errors
from seethrough.benchmarks.drawing.scenes import SCENES
from seethrough.benchmarks.drawing.speed import drawing, times
from seethrough.benchmarks.rows import Row as Figure
from seethrough.benchmarks.rows import row
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.base import Parameters
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard

VIEWS = 4
DEFAULT = DynamicTransparency()
CELLS = (32, 64, 128, 256)
WIDTHS = (0.0, 5.0, 10.0, 20.0, 40.0)
TARGET_ALPHAS = (0.1, 0.2, 0.3, 0.4, 0.5)
EDGE_ALPHAS = (0.0, 0.1, 0.2, 0.3)


def figures(renderer: Renderer) -> Iterator[Figure]:
    """The rows of the sweeps, on the abstract world and in the building."""
    width, height = renderer.size
    for name in ("abstract", "walkthrough"):
        scene, cameras = SCENES[name](width / height, VIEWS)
        yield from _resolutions(renderer, name, scene, cameras)
        yield from _looks(renderer, name, scene, cameras, _variants())


def _variants() -> dict[str, DynamicTransparency]:
    """The techniques to look at, by what differs from the default."""
    return {
        **{f"width {w:g}": replace(DEFAULT, width=w) for w in WIDTHS},
        **{f"alpha_target {a:g}": replace(DEFAULT, alpha_target=a) for a in TARGET_ALPHAS},
        **{f"alpha_edge {a:g}": replace(DEFAULT, alpha_edge=a) for a in EDGE_ALPHAS},
    }


def _spent(
    renderer: Renderer, scene: Scene, cameras: list[Camera], ways: Mapping[str, Parameters]
) -> dict[str, float]:
    """Times of each way, as multiples of the standard frame's."""
    draws = {
        way: drawing(renderer, scene, t) for way, t in {"standard": Standard(), **ways}.items()
    }
    found = times(draws, cameras, renderer.context)
    return {way: found[way] / found["standard"] for way in ways}


def _resolutions(
    renderer: Renderer, name: str, scene: Scene, cameras: list[Camera]
) -> Iterator[Figure]:
    ways = {
        "outline": DEFAULT,
        **{f"ring {n} × {n}": replace(DEFAULT, mask="ring", ring_size=n) for n in CELLS},
    }
    spent = _spent(renderer, scene, cameras, ways)
    truths = [drawn(renderer, scene, c, replace(DEFAULT, exact=True)) for c in cameras]
    for way, technique in ways.items():
        where = f"{name}: mask {way}"
        exact = replace(technique, exact=True)
        yield from errors(where, truths, [drawn(renderer, scene, c, exact) for c in cameras], None)
        yield row("time / standard", where, spent[way], "×", None, None)


def _looks(
    renderer: Renderer,
    name: str,
    scene: Scene,
    cameras: list[Camera],
    ways: dict[str, DynamicTransparency],
) -> Iterator[Figure]:
    spent = _spent(renderer, scene, cameras, ways)
    plain = [drawn(renderer, scene, c, Standard()) for c in cameras]
    hidden = [_covered(renderer, scene, c) for c in cameras]
    for way, technique in ways.items():
        where = f"{name}: {way}"
        pictures = [drawn(renderer, scene, c, technique) for c in cameras]
        changed = np.mean(
            [(a != b).any(axis=2).mean() for a, b in zip(pictures, plain, strict=True)]
        )
        seen = [renderer.look(scene, c, technique) for c in cameras]
        shares = [s.weight[h] for s, h in zip(seen, hidden, strict=True)]
        contrasts = [s.contrast[h] for s, h in zip(seen, hidden, strict=True)]
        kept = [s.weight[~scene.targets & ~scene.impenetrable & (s.pixels > 0)] for s in seen]
        yield row("picture changed", where, 100 * float(changed), "%", None, None)
        yield row("share of covered targets", where, 100 * _mean(shares), "%", None, None)
        yield row("contrast of covered targets", where, _mean(contrasts), "", None, None)
        yield row("share of occluders", where, 100 * _mean(kept), "%", None, None)
        yield row("time / standard", where, spent[way], "×", None, None)


def _covered(renderer: Renderer, scene: Scene, camera: Camera) -> np.ndarray:
    """(n,) targets of which standard rendering shows less than half of what it could."""
    plain = renderer.look(scene, camera, Standard()).pixels
    alone = renderer.look(scene, camera, DEFAULT).pixels
    return scene.targets & (alone > 0) & (plain < 0.5 * alone)


def _mean(values: list[np.ndarray]) -> float:
    return float(np.concatenate(values).mean())
