"""What dynamic transparency is, exactly, from all surfaces at a pixel: its rule in float64.

One fragment counts for each object and pixel, its front-most; at each pixel they are sorted from
front to back, i = 1…m. Object i shows with opacity a_i, the product of the masks M_s of the targets
s behind it (1 where it is impenetrable). On its silhouette a mask lies where its target lies,
beside it at the depth of the target's centre.

With a least transmittance τ the mask of t on t itself is min(α_T, 1 − τ^(1/k)), with k the
penetrable fragments in front of t: other masks only lower a_j, so T_t ≥ τ however targets line up.
Shared with the shaders are the gradient, the hull and the ellipses of renderer/masks/masks.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from seethrough.renderer.masks import masks
from seethrough.renderer.reference.pixel_fragments import covered, distances
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.base import Bools, Floats, Indices
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.seen import Look, Surfaces


@dataclass(frozen=True, eq=False)
class Mask:
    """One target's mask, a number for each pixel (h·w,): opacity, where it has α_T, its depth, and
    the light on it."""

    opacity: Floats
    core: Bools
    place: Floats
    light: Floats


def known(p: DynamicTransparency, seen: Surfaces) -> dict[int, Mask]:
    """Target → its mask."""
    p = replace(p, width=p.width * seen.shot.scale)
    light = masks.light(seen.shot.size, p)
    front = seen.first(seen.front)
    targets = np.nonzero(seen.shot.scene.targets)[0]
    return {int(s): _mask(p, seen, front, int(s), light) for s in targets}


def rule(p: DynamicTransparency, seen: Surfaces, made: Mapping[int, Mask]) -> Look:
    """Opacity of the front-most surface of each object; nothing else is kept."""
    shot = seen.shot
    hard = impenetrable(shot.scene, shot.camera, p)
    kept = seen.first(seen.front)
    front = _Front(seen, np.nonzero(kept)[0], hard)
    alpha = _by_pixel(front, made, p) if p.granularity == "pixel" else _by_part(front, made, p)
    alpha[hard[front.object]] = 1.0
    if p.layers is not None:
        alpha = _limited(front, alpha, p.layers)
    opacity = np.zeros(len(kept))
    opacity[front.rows] = alpha
    return Look(kept, opacity, doubt=_doubt(seen, kept, made), additive=p.model == "additive")


def _doubt(seen: Surfaces, kept: Bools, made: Mapping[int, Mask]) -> Bools:
    """(m,) fragments at the depth of a mask that reaches there, beside its target."""
    found = np.zeros(len(kept), dtype=bool)
    for s, mask in made.items():
        at = np.abs(seen.depth - mask.place[seen.pixel]) <= seen.slack
        found |= at & kept & (seen.object != s) & (mask.opacity[seen.pixel] < 1)
    return found


def impenetrable(scene: Scene, camera: Camera, p: DynamicTransparency) -> Bools:
    """(n,) what never turns transparent: that, and what is farther than `penetrable_within` from
    the eye to the nearest point of its upright box."""
    hard = []
    for thing in scene.objects:
        (x0, y0, z0), (x1, y1, z1) = thing.mesh.bounds
        local = [(x, y, z, 1.0) for x in (x0, x1) for y in (y0, y1) for z in (z0, z1)]
        corners = [(thing.transform @ corner)[:3] for corner in local]
        nearest = np.clip(camera.eye, np.min(corners, axis=0), np.max(corners, axis=0))
        away = float(((nearest - camera.eye) ** 2).sum()) ** 0.5
        within = p.penetrable_within
        hard.append(thing.impenetrable or (within is not None and away > within))
    return np.array(hard, dtype=bool)


class _Front:
    """The front-most fragments: rows of Surfaces, still by pixel and depth."""

    def __init__(self, seen: Surfaces, rows: Indices, hard: Bools) -> None:
        self.seen, self.rows, self.hard = seen, rows, hard
        self.pixel, self.depth = seen.pixel[rows], seen.depth[rows]
        self.object, self.triangle = seen.object[rows], seen.triangle[rows]

    def running(self, values: Floats) -> Floats:
        """At each row the sum over its pixel's rows up to it."""
        total = np.cumsum(values)
        first = np.searchsorted(self.pixel, self.pixel)
        return total - np.where(first > 0, total[first - 1], 0.0)


def _mask(p: DynamicTransparency, seen: Surfaces, front: Bools, s: int, light: Floats) -> Mask:
    width, height = seen.shot.size
    camera, scene = seen.shot.camera, seen.shot.scene
    depth = seen.nearest(front & (seen.object == s)).reshape(height, width)
    there = np.isfinite(depth)
    place = np.where(there, depth, camera.depth(scene.centers[s]))
    opacity, core = _shape(p, seen, s, there)
    opacity = 1 - light * (1 - opacity)
    return Mask(opacity.ravel(), core.ravel(), place.ravel(), light.ravel())


def _shape(p: DynamicTransparency, seen: Surfaces, s: int, there: Bools) -> tuple[Floats, Bools]:
    """Opacity (h, w) of a target's mask in full light, and where it has alpha_target."""
    height, width = there.shape
    outline = seen.outlines[s]
    if not len(outline):
        return np.ones((height, width)), np.zeros((height, width), dtype=bool)
    if p.mask == "ring":
        return _ring(outline, there, p), there
    if p.mask == "outline":
        distance = distances(outline, height, width, p.width)
        distance[there] = 0.0
    elif p.mask == "hull":
        hull = masks.convex_hull(np.ascontiguousarray(outline.reshape(-1, 2)))
        fan = np.array([[hull[0], hull[k], hull[k + 1]] for k in range(1, len(hull) - 1)])
        rim = np.stack([hull, np.roll(hull, -1, axis=0), hull], axis=1)
        distance = distances(rim, height, width, p.width)
        distance[covered(fan.reshape(-1, 3, 2), height, width)] = 0.0
    else:
        along = masks.long_axis(seen.shot.scene.objects[s], seen.shot.camera)
        ellipse = masks.bounding_ellipse(outline.reshape(-1, 2), p.mask, along)
        distance = masks.ellipse_distance(ellipse, (width, height))
    return masks.opacity(distance, p), distance <= 0


def _ring(outline: Floats, there: Bools, p: DynamicTransparency) -> Floats:
    """The paper's mask: rings of cells grown on a coarse grid, looked up bilinearly, and the
    target's own region drawn again at full resolution (Elmqvist2009 §V-D, algorithm 2)."""
    height, width = there.shape
    n = p.ring_size
    cells = covered(outline * [n / width, n / height], n, n)
    rings = masks.ring_opacities(p, (width, height))
    values = np.where(cells, p.alpha_target, 1.0)
    grown = cells
    for value in rings:
        wider = np.pad(grown, 1)
        wider = np.any([wider[r : r + n, c : c + n] for r in range(3) for c in range(3)], axis=0)
        values[wider & ~grown] = value
        grown = wider
    y = np.clip((np.arange(height) + 0.5) * n / height - 0.5, 0, n - 1)
    x = np.clip((np.arange(width) + 0.5) * n / width - 0.5, 0, n - 1)
    i, j = np.minimum(y.astype(int), n - 2), np.minimum(x.astype(int), n - 2)
    u, v = (y - i)[:, None], (x - j)[None]
    i, j = i[:, None], j[None]
    low = (1 - v) * values[i, j] + v * values[i, j + 1]
    high = (1 - v) * values[i + 1, j] + v * values[i + 1, j + 1]
    return np.where(there, p.alpha_target, (1 - u) * low + u * high)


def _cap(front: _Front, s: int, p: DynamicTransparency) -> Floats:
    """(rows,) the most opaque an occluder of target s may be, for its least transmittance."""
    if p.min_transmittance == 0:
        return np.ones(len(front.rows))
    mine = front.object == s
    place = np.full(len(front.seen.starts) - 1, -np.inf)
    place[front.pixel[mine]] = front.depth[mine]
    before = (front.depth < place[front.pixel]) & ~front.hard[front.object]
    count = np.bincount(front.pixel, before, len(place)).astype(np.int64)
    return masks.cap(count, p)[front.pixel]


def _by_pixel(front: _Front, made: Mapping[int, Mask], p: DynamicTransparency) -> Floats:
    """(rows,) the masks behind each fragment, multiplied, or the least of them."""
    alpha = np.ones(len(front.rows))
    join: np.ufunc = np.multiply if p.combine == "product" else np.minimum
    for s, mask in made.items():
        reduced = np.minimum(mask.opacity[front.pixel], _cap(front, s, p))
        alpha = join(alpha, np.where(front.depth < mask.place[front.pixel], reduced, 1.0))
    return alpha


def _by_part(front: _Front, made: Mapping[int, Mask], p: DynamicTransparency) -> Floats:
    """(rows,) alpha_target for whole surfaces, objects or groups in front of a mask's core."""
    lit = np.zeros(len(front.rows))  # light on the masks in front of which a fragment lies
    cap = np.ones(len(front.rows))
    for s, mask in made.items():
        before = front.depth < mask.place[front.pixel]
        lit = np.maximum(lit, np.where(before & mask.core[front.pixel], mask.light[front.pixel], 0))
        cap = np.minimum(cap, np.where(before, _cap(front, s, p), 1.0))
    lit[front.hard[front.object]] = 0.0
    scene = front.seen.shot.scene
    if p.granularity == "surface":
        part = np.cumsum([0, *scene.triangle_counts])[front.object] + front.triangle
    else:
        part = scene.group_of[front.object] if p.granularity == "region" else front.object
    best = np.zeros(int(part.max(initial=-1)) + 1)
    np.maximum.at(best, part, lit)
    return np.minimum(1 - (1 - p.alpha_target) * best[part], cap)


def _limited(front: _Front, alpha: Floats, layers: int) -> Floats:
    """Opacities with all but the first `layers` transparent fragments of a pixel opaque."""
    clear = alpha < 1
    rank = front.running(clear.astype(float))
    return np.where(clear & (rank > layers + 0.5), 1.0, alpha)
