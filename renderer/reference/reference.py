"""The exact picture, on the CPU in float64: what every shader is measured against.

A technique's `rule` says of all surfaces at a pixel (surfaces.py), front and back, which are kept
and how strongly each shows; here they are lit and added up from front to back. A surface's share of
its pixel is w = a · T, with a its opacity and T what those in front leave: the product of their
1 − a, or in the additive model 1 less their sum, 0 at least.

Nothing here knows a technique, a plan or a shader. What it shares with the shaders is the light
(scene/lighting.py), the projection (scene/projection.py), and of dynamic transparency what
techniques/dynamic/exact.py names.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.look import floor, fog
from seethrough.renderer.look.shadows import shadowed
from seethrough.renderer.reference.surfaces import surfaces
from seethrough.renderer.scene import lighting
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.base import Bools, Floats, Parameters, Shot
from seethrough.renderer.techniques.seen import Look, Surfaces


@dataclass(frozen=True, eq=False)
class ExactPicture:
    """picture (h, w, 3) in [0, 1]; weights (n, h, w): each object's share of the pixel;
    depth (n, h, w) of each object's first kept surface, inf where there is none; near_edge (h, w):
    pixels not to be compared, within 1/256 pixel of a projected edge (surfaces.py) or of a line
    where surfaces cross, or in doubt by the technique's rule."""

    picture: NDArray[np.float64]
    weights: NDArray[np.float64]
    depth: NDArray[np.float64]
    near_edge: NDArray[np.bool_]


def exact(
    scene: Scene, camera: Camera, technique: Parameters, size: tuple[int, int],
    state: object = None, scale: float = 1.0,
) -> ExactPicture:  # fmt: skip
    """The picture of `size` (width, height) as a technique with these parameters defines it,
    without approximation. Without a `state` it is the one before the first event; `scale` is the
    picture's size over the window's."""
    rules = technique.technique
    state = rules.begin(technique) if state is None else state
    shot = Shot(scene, camera, size, scale)
    shot = replace(shot, scene=rules.shown(technique, state, shot).scene)
    seen, edges = surfaces(shot)
    known = rules.known(technique, state, seen)
    return _composed(seen, rules.rule(technique, state, seen, known), edges)


def _composed(seen: Surfaces, look: Look, edges: Bools) -> ExactPicture:
    """Add up each pixel from front to back."""
    width, height = seen.shot.size
    pixels, n = width * height, len(seen.shot.scene.objects)
    rows = np.nonzero(look.kept & (look.opacity > 0))[0]
    pixel, owner, alpha = seen.pixel[rows], seen.object[rows], look.opacity[rows]
    before = _left(pixel, alpha, look.additive)
    share = np.minimum(before, alpha) if look.additive else before * alpha
    shown = np.zeros(pixels)
    np.add.at(shown, pixel, share)
    picture = (1 - shown)[:, None] * np.array(seen.shot.scene.background)
    np.add.at(picture, pixel, share[:, None] * _lit(seen, look, rows))
    weights = np.zeros((n, pixels))
    np.add.at(weights, (owner, pixel), share)
    depth = np.full((n, pixels), np.inf)
    first = seen.first(look.kept & (look.opacity > 0))[rows]
    depth[owner[first], pixel[first]] = seen.depth[rows[first]]
    near = edges[0].ravel() | _crossing(seen, look, rows, before)
    near |= (edges[1] & (look.kept & ~seen.front).any()).ravel()
    if look.doubt is not None:
        near |= _doubtful(seen, look.doubt, rows, before * (1 - alpha))
    shape = (n, height, width)
    return ExactPicture(
        picture.reshape(height, width, 3),
        weights.reshape(shape),
        depth.reshape(shape),
        near.reshape(height, width),
    )


def exact_shares(
    seen: Surfaces, look: Look, pixel: int
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Object and share of each surface that shows at a pixel, from the front."""
    here = np.arange(seen.starts[pixel], seen.starts[pixel + 1])
    rows = here[look.kept[here] & (look.opacity[here] > 0)]
    alpha = look.opacity[rows]
    before = _left(seen.pixel[rows], alpha, look.additive)
    share = np.minimum(before, alpha) if look.additive else before * alpha
    return seen.object[rows], share


def _doubtful(seen: Surfaces, doubt: Bools, rows: NDArray[np.int64], after: Floats) -> Bools:
    """(h·w,) pixels with a surface in doubt that nothing opaque hides."""
    last = np.full(len(seen.starts) - 1, np.inf)  # depth behind which no light goes
    stops = rows[after <= 0]
    np.minimum.at(last, seen.pixel[stops], seen.depth[stops])
    found = np.zeros(len(last), dtype=bool)
    seen_ = doubt & (seen.depth <= last[seen.pixel] + seen.slack)
    found[seen.pixel[seen_]] = True
    return found


def _left(pixel: NDArray[np.int64], alpha: Floats, additive: bool) -> Floats:
    """(k,) what is left by the rows in front of each; rows come by pixel, from the front."""
    rank = np.arange(len(pixel)) - np.searchsorted(pixel, pixel)
    left = np.ones(len(pixel))
    for k in range(1, int(rank.max(initial=0)) + 1):
        here = np.nonzero(rank == k)[0]
        nearer = here - 1
        if additive:
            left[here] = np.maximum(left[nearer] - alpha[nearer], 0.0)
        else:
            left[here] = left[nearer] * (1 - alpha[nearer])
    return left


def _lit(seen: Surfaces, look: Look, rows: NDArray[np.int64]) -> Floats:
    """(k, 3) colours as shown: lit from the side that is seen, drawn on where it is a floor, then
    tinted, and all of that seen through fog."""
    normal = np.where(seen.front[rows, None], seen.normal[rows], -seen.normal[rows])
    factor = lighting.shade(normal, -seen.offset[rows])
    lit = np.minimum(seen.color[rows] * factor[:, None], 1.0)
    scene, camera = seen.shot.scene, seen.shot.camera
    if scene.look.has_floor:
        own = floor.floors(tuple(o.kind for o in scene.objects))[seen.object[rows]]
        lit[own] = floor.painted(
            lit[own], seen.offset[rows][own], normal[own], camera.eye,
            camera.pixel(seen.shot.size[1]), scene.look,
        )  # fmt: skip
        if scene.look.ground_shadows > 0:
            lit[own] = shadowed(lit[own], seen.offset[rows][own] + camera.eye, normal[own], scene)
    if look.tint is not None:
        tint = look.tint[rows]
        lit = lit + tint[:, 3:] * (tint[:, :3] - lit)
    return fog.hazed(lit, seen.offset[rows], scene.background, scene.look)


def _crossing(seen: Surfaces, look: Look, rows: NDArray[np.int64], before: Floats) -> Bools:
    """(h·w,) pixels where two kept surfaces that can be seen lie so close together that float32
    and float64 may sort them differently."""
    found = np.zeros(len(seen.starts) - 1, dtype=bool)
    pixel, depth, slack = seen.pixel[rows], seen.depth[rows], seen.slack[rows]
    same = (pixel[1:] == pixel[:-1]) & (before[:-1] > 0)
    close = same & (np.diff(depth) <= slack[1:] + slack[:-1])
    found[pixel[1:][close]] = True
    return found
