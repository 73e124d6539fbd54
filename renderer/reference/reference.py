"""The exact picture, on the CPU in float64: what every shader is measured against.

One fragment for each object and pixel, its front-most; at each pixel the objects are sorted from
front to back, i = 1…m. Object i shows with opacity a_i, the product of the masks M_s of the
targets s behind it (1 where it is impenetrable), and its share of the pixel is
w_i = a_i · T_i with T_i = Π_{j before i} (1 − a_j), what the objects in front leave. On its
silhouette a mask lies where its target lies, beside it at the depth of the target's centre.

The options change a_i only (techniques/dynamic.py says what they mean), but for the additive
model, in which T_i = max(0, 1 − Σ_{j before i} a_j). With a least transmittance τ the mask of t on
t itself is min(α_T, 1 − τ^(1/k)), with k the penetrable fragments in front of t: other masks only
lower a_j, so T_t ≥ τ however targets line up. Nothing here is shared with the shaders but the
light, the gradient and the projection.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.masks import masks
from seethrough.renderer.plan.planner import Technique
from seethrough.renderer.reference.pixel_fragments import Fragments, covered, distances, fragments
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard


@dataclass(frozen=True, eq=False)
class ExactPicture:
    """picture (h, w, 3) in [0, 1]; weights (n, h, w): each object's share of the pixel;
    transmittance (n, h, w): what the objects in front leave, 1 where the object is not; depth
    (n, h, w) of each object; near_edge (h, w): pixels not to be compared, within 1/256 pixel of
    a projected edge (fragments.py) or of a line where surfaces cross."""

    picture: NDArray[np.float64]
    weights: NDArray[np.float64]
    transmittance: NDArray[np.float64]
    depth: NDArray[np.float64]
    near_edge: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class _Mask:
    """One target's mask (h, w): opacity, where it has α_T, its depth, and the light on it."""

    opacity: NDArray[np.float64]
    core: NDArray[np.bool_]
    place: NDArray[np.float64]
    light: NDArray[np.float64]


def exact(
    scene: Scene, camera: Camera, technique: Technique, size: tuple[int, int]
) -> ExactPicture:
    """The picture of `size` (width, height) as `technique` defines it, without approximation."""
    seen = fragments(scene, camera, size)
    if isinstance(technique, Standard):
        alpha = np.isfinite(seen.depth).astype(float)
        return _composed(scene, seen, alpha, additive=False, beside=np.zeros(0))
    hard = impenetrable(scene, camera, technique)
    light = masks.light(size, technique)
    made = {
        int(s): _mask(scene, camera, technique, seen, int(s), light)
        for s in np.nonzero(scene.targets)[0]
    }
    if technique.granularity == "pixel":
        alpha = _by_pixel(seen, made, hard, technique)
    else:
        alpha = _by_part(scene, seen, made, hard, technique)
    alpha[hard] = 1.0
    alpha[~np.isfinite(seen.depth)] = 0.0
    if technique.layers is not None:
        alpha = _limited(seen, alpha, technique.layers)
    beside = camera.depth(scene.centers[scene.targets])
    return _composed(scene, seen, alpha, technique.model == "additive", beside)


def impenetrable(scene: Scene, camera: Camera, technique: DynamicTransparency) -> NDArray[np.bool_]:
    """(n,) what never turns transparent: that, and what is farther than `penetrable_within` from
    the eye to the nearest point of its upright box (techniques/dynamic.py)."""
    hard = []
    for thing in scene.objects:
        (x0, y0, z0), (x1, y1, z1) = thing.mesh.bounds
        local = [(x, y, z, 1.0) for x in (x0, x1) for y in (y0, y1) for z in (z0, z1)]
        corners = [(thing.transform @ corner)[:3] for corner in local]
        nearest = np.clip(camera.eye, np.min(corners, axis=0), np.max(corners, axis=0))
        away = float(((nearest - camera.eye) ** 2).sum()) ** 0.5
        within = technique.penetrable_within
        hard.append(thing.impenetrable or (within is not None and away > within))
    return np.array(hard, dtype=bool)


def _mask(scene, camera, technique, seen, s, light):  # type: ignore[no-untyped-def]
    there = np.isfinite(seen.depth[s])
    place = np.where(there, seen.depth[s], camera.depth(scene.centers[s]))
    opacity, core = _shape(scene, camera, technique, seen, s, there)
    return _Mask(1 - light * (1 - opacity), core, place, light)


def _shape(scene, camera, technique, seen, s, there):  # type: ignore[no-untyped-def]
    """Opacity (h, w) of a target's mask in full light, and where it has alpha_target."""
    height, width = there.shape
    outline = seen.outlines[s]
    if not len(outline):
        return np.ones((height, width)), np.zeros((height, width), dtype=bool)
    if technique.mask == "ring":
        return _ring(outline, there, technique), there
    if technique.mask == "outline":
        distance = distances(outline, height, width, technique.width)
        distance[there] = 0.0
    elif technique.mask == "hull":
        hull = masks.convex_hull(np.ascontiguousarray(outline.reshape(-1, 2)))
        fan = np.array([[hull[0], hull[k], hull[k + 1]] for k in range(1, len(hull) - 1)])
        rim = np.stack([hull, np.roll(hull, -1, axis=0), hull], axis=1)
        distance = distances(rim, height, width, technique.width)
        distance[covered(fan.reshape(-1, 3, 2), height, width)] = 0.0
    else:
        along = masks.long_axis(scene.objects[s], camera)
        ellipse = masks.bounding_ellipse(outline.reshape(-1, 2), technique.mask, along)
        distance = masks.ellipse_distance(ellipse, (width, height))
    return masks.opacity(distance, technique), distance <= 0


def _ring(outline, there, technique):  # type: ignore[no-untyped-def]
    """The paper's mask: rings of cells grown on a coarse grid, looked up bilinearly, and the
    target's own region drawn again at full resolution (004 §V-D, algorithm 2)."""
    height, width = there.shape
    n = technique.ring_size
    cells = covered(outline * [n / width, n / height], n, n)
    rings = masks.ring_opacities(technique, (width, height))
    values = np.where(cells, technique.alpha_target, 1.0)
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
    return np.where(there, technique.alpha_target, (1 - u) * low + u * high)


def _in_front(seen: Fragments, hard: NDArray[np.bool_], s: int) -> NDArray[np.int64]:
    """(h, w) penetrable fragments in front of target s, 0 where s is not."""
    count = ((seen.depth < seen.depth[s]) & ~hard[:, None, None]).sum(axis=0)
    return np.where(np.isfinite(seen.depth[s]), count, 0)


def _cap(seen, hard, s, technique):  # type: ignore[no-untyped-def]
    """(h, w) the most opaque an occluder of target s may be, for its least transmittance."""
    if technique.min_transmittance == 0:
        return np.ones(seen.near_edge.shape)
    count = _in_front(seen, hard, s)
    return masks.cap(count, technique)


def _by_pixel(seen, made, hard, technique):  # type: ignore[no-untyped-def]
    """(n, h, w) the masks behind each fragment, multiplied, or the least of them."""
    alpha = np.ones_like(seen.depth)
    join = np.multiply if technique.combine == "product" else np.minimum
    for s, mask in made.items():
        reduced = np.minimum(mask.opacity, _cap(seen, hard, s, technique))
        alpha = join(alpha, np.where(seen.depth < mask.place, reduced, 1.0))
    return alpha


def _by_part(scene, seen, made, hard, technique):  # type: ignore[no-untyped-def]
    """(n, h, w) alpha_target for whole surfaces, objects or groups in front of a mask's core."""
    n = len(seen.depth)
    lit = np.zeros_like(seen.depth)  # light on the masks in front of which a fragment lies
    cap = np.ones_like(seen.depth)
    for s, mask in made.items():
        before = seen.depth < mask.place
        lit = np.maximum(lit, np.where(before & mask.core, mask.light, 0.0))
        cap = np.minimum(cap, np.where(before, _cap(seen, hard, s, technique), 1.0))
    lit[hard] = 0.0
    strength = np.zeros_like(lit)
    if technique.granularity == "surface":
        for i in range(n):
            best = np.zeros(len(scene.objects[i].mesh.triangles))
            np.maximum.at(best, seen.surface[i].ravel(), lit[i].ravel())
            strength[i] = best[seen.surface[i]]
    else:
        best = lit.max(axis=(1, 2), initial=0.0)
        if technique.granularity == "region":
            groups = np.zeros(int(scene.group_of.max(initial=-1)) + 1)
            np.maximum.at(groups, scene.group_of, best)
            best = groups[scene.group_of]
        strength[:] = best[:, None, None]
    return np.minimum(1 - (1 - technique.alpha_target) * strength, cap)


def _limited(seen: Fragments, alpha: NDArray[np.float64], layers: int) -> NDArray[np.float64]:
    """Opacities with all but the first `layers` transparent fragments of a pixel opaque."""
    order = _front_to_back(seen)
    front = np.take_along_axis(alpha, order, axis=0)
    there = np.isfinite(np.take_along_axis(seen.depth, order, axis=0))
    clear = there & (front < 1)
    rank = np.cumsum(clear, axis=0)
    front[clear & (rank > layers)] = 1.0
    limited = np.empty_like(alpha)
    np.put_along_axis(limited, order, front, axis=0)
    return limited


def _front_to_back(seen: Fragments) -> NDArray[np.int64]:
    """(n, h, w) objects by depth; of two at the same depth the later one is in front."""
    n = len(seen.depth)
    return n - 1 - np.argsort(seen.depth[::-1], axis=0, kind="stable")


def crossings(
    depth: NDArray[np.float64], order: NDArray[np.int64], beside: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(h, w) pixels within 1/256 pixel of a line where two surfaces, or a surface and the depth
    of a mask beside its target, cross: there float32 and float64 may sort them differently."""
    there = np.isfinite(depth)
    known = np.where(there, depth, np.nan)
    slope = np.zeros_like(depth)
    for axis in (1, 2):
        step = np.abs(np.diff(known, axis=axis))
        pads = [(0, 0), (0, 0), (0, 0)]
        for side in ((1, 0), (0, 1)):
            pads[axis] = side
            slope = np.fmax(slope, np.pad(step, pads, constant_values=np.nan))
    slack = np.where(there, slope / 256 + 1e-6 * np.where(there, depth, 0.0), 0.0)
    front = np.take_along_axis(depth, order, axis=0)
    about = np.take_along_axis(slack, order, axis=0)
    both = np.isfinite(front[1:])
    gap = np.where(both, front[1:], 0.0) - np.where(both, front[:-1], 0.0)
    close = (both & (gap <= about[1:] + about[:-1])).any(axis=0)
    for level in beside:
        close |= (there & (np.abs(np.where(there, depth, 0.0) - level) <= slack)).any(axis=0)
    return close


def _composed(
    scene: Scene,
    seen: Fragments,
    alpha: NDArray[np.float64],
    additive: bool,
    beside: NDArray[np.float64],
) -> ExactPicture:
    """Add up each pixel from front to back."""
    background = np.broadcast_to(np.array(scene.background), (*seen.near_edge.shape, 3))
    if not len(alpha):
        empty = alpha.copy()
        return ExactPicture(background.copy(), alpha, empty, seen.depth, seen.near_edge)
    order = _front_to_back(seen)
    front = np.take_along_axis(alpha, order, axis=0)
    if additive:
        through = np.maximum(1 - np.cumsum(front, axis=0), 0.0)
    else:
        through = np.cumprod(1 - front, axis=0)
    before = np.concatenate([np.ones_like(through[:1]), through[:-1]])
    weights, transmittance = np.empty_like(alpha), np.empty_like(alpha)
    np.put_along_axis(weights, order, before - through, axis=0)
    np.put_along_axis(transmittance, order, before, axis=0)
    transmittance[~np.isfinite(seen.depth)] = 1.0
    near_edge = seen.near_edge | crossings(seen.depth, order, beside)
    picture = np.einsum("nhw,nhwc->hwc", weights, seen.color) + through[-1][..., None] * background
    return ExactPicture(picture, weights, transmittance, seen.depth, near_edge)
