"""Cut-away (Diepstraten, Weiskopf and Ertl 2003): few planes by a target's box cut off what lies
before it.

The faces of the box about a target that are turned away from the viewer, moved outwards by a
margin, cut: what lies on the viewer's side of all of those chosen, and nearer than the box's
farthest corner, is removed, like a slice of a cake whose cut faces show. These half-spaces hold the
eye and the target, so nothing penetrable is left between them; and a line of sight leaves the hole
once: the hole is a depth at each pixel, the farthest of those of all targets. 1 / depth of a plane
is linear on the screen.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.declared import key
from seethrough.renderer.techniques import reaching, removal
from seethrough.renderer.techniques.base import Bools, Floats, Shot
from seethrough.renderer.techniques.seen import Look, Surfaces


@dataclass(frozen=True)
class CutawayParameters(removal.Removing):
    """How many planes cut, and how far from the target."""

    planes: int = key(3, "planes that cut about each target, the farthest from the viewer",
                      low=1, high=3)  # fmt: skip
    margin: float = key(
        0.1, "how far the planes lie outside the target's box", "halves of the box's side",
        low=0, high=10,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Wedges:
    """About each of n targets: unit normals (n, k, 3) of the planes, towards the eye, their
    distances from it along them (n, k), below 0, of planes that do not cut −∞, and the view depth
    (n,) of the box's farthest corner."""

    normals: Floats
    away: Floats
    depth: Floats


class Cutaway(removal.Removal[CutawayParameters, None, Wedges]):
    """Few planes cut off what stands before a target."""

    name = "cutaway"
    title = "Cut-away"
    instruction = "What stands before a target is cut off along planes, like a slice of a cake."
    source = "Diepstraten2003"
    misses = "misses R2 (targets in line), R7"
    Parameters = CutawayParameters
    removes = removal.CLIPPED

    def touches(self, p: CutawayParameters, state: object, shot: Shot) -> Bools:
        """What is nearer than the end of a wedge."""
        deepest = wedges(p, shot).depth.max(initial=-np.inf)
        return reaching.reached(shot, reaching.whole(shot, 1), np.array([deepest]))

    def known(self, p: CutawayParameters, state: object, seen: Surfaces) -> Wedges:
        """The wedges."""
        return wedges(p, seen.shot)

    def rule(self, p: CutawayParameters, state: object, seen: Surfaces, known: Wedges) -> Look:
        """Removed inside a wedge: before all its planes, and before the box's end."""
        signed = np.full(len(seen.depth), -np.inf)
        for normals, away, depth in zip(known.normals, known.away, known.depth, strict=True):
            outside = (seen.offset @ normals.T - away).min(axis=1)
            signed = np.maximum(signed, np.minimum(outside, depth - seen.depth))
        width, height = seen.shot.size
        pierced = np.full(width * height, len(known.depth) > 0)
        return removal.look(p, seen, signed, pierced)

    def pictures(
        self, p: CutawayParameters, state: object, shot: Shot, needed: Mapping[str, object]
    ) -> Mapping[str, NDArray[np.float32]]:
        """The depth at which each pixel's line of sight leaves the hole."""
        return {"clip": clip_depth(wedges(p, shot), shot)}


def wedges(p: CutawayParameters, shot: Shot) -> Wedges:
    """One for each target that reaches beyond the near plane and has a box of some volume."""
    scene, camera = shot.scene, shot.camera
    targets = np.nonzero(scene.targets)[0]
    center, sides = scene.centers[targets] - camera.eye, _thick(scene.box_sides[targets])
    across = np.cross(sides[:, [1, 2, 0]], sides[:, [2, 0, 1]])
    across *= np.sign((across * sides).sum(axis=2, keepdims=True))
    lengths = np.linalg.norm(across, axis=2, keepdims=True)
    reach = sides * (1 + p.margin)
    depth = center @ camera.forward + np.abs(reach @ camera.forward).sum(axis=1)
    flat = (lengths > 0).all(axis=(1, 2))
    across = across / np.where(lengths > 0, lengths, 1.0)
    normals = np.concatenate([-across, across], axis=1)
    middles = center[:, None] + np.concatenate([reach, -reach], axis=1)
    away = (normals * middles).sum(axis=2)
    order = np.argsort(away, axis=1, kind="stable")[:, : p.planes]
    away = np.take_along_axis(away, order, axis=1)
    normals = np.take_along_axis(normals, order[:, :, None], axis=1)
    there = (depth > camera.near) & flat
    return Wedges(normals[there], np.where(away < 0, away, -np.inf)[there], depth[there])


def _thick(sides: Floats) -> Floats:
    """(k, 3, 3) the sides of boxes, where one has no length a little of it: what is flat has two
    faces as well."""
    lengths = np.linalg.norm(sides, axis=2)
    flat = lengths.min(axis=1) <= 1e-9 * lengths.max(axis=1)
    found = sides.copy()
    for t in np.nonzero(flat)[0]:
        k = int(np.argmin(lengths[t]))
        across = np.cross(sides[t, (k + 1) % 3], sides[t, (k + 2) % 3])
        if across.any():
            found[t, k] = across / np.linalg.norm(across) * lengths[t].max() * 1e-6
    return found


def clip_depth(made: Wedges, shot: Shot) -> NDArray[np.float32]:
    """(h, w) the farthest depth of a hole at each pixel, 0 where there is none."""
    from seethrough.renderer.techniques.maps import least_of_greatest

    if not len(made.depth):
        return np.zeros(shot.size[::-1], np.float32)
    planes = linear(made, shot)
    starts = np.arange(len(planes) + 1) * planes.shape[1]
    return least_of_greatest(planes.reshape(-1, 3), starts, shot.size, shot.looked_up)


def linear(made: Wedges, shot: Shot) -> Floats:
    """(n, k + 1, 3) 1 / depth at which lines of sight leave each wedge, at most 0 where they
    never do: a · column + b · row + c at a pixel's middle."""
    axes = shot.camera.rotation * [1, 1, -1]
    lens = shot.camera.lens(shot.size[1])
    # A line of sight is depth · (forward + x right + y up); it meets n · p = away at 1 / depth
    # = n · (forward + x right + y up) / away.
    x, y, level = np.moveaxis(made.normals @ axes / made.away[..., None], 2, 0)
    x, y = x / lens, -y / lens
    middle = np.array(shot.size) / 2
    rows = np.stack([x, y, level - x * middle[0] - y * middle[1]], axis=2)
    ends = np.zeros((len(rows), 1, 3))
    ends[:, 0, 2] = 1.0 / made.depth
    return np.concatenate([rows, ends], axis=1)


TECHNIQUE = Cutaway()
