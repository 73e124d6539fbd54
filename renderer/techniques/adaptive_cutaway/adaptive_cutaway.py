"""Adaptive cut-away (Burns and Finkelstein 2008): a cone opens towards the viewer before each point
of a target.

What lies before a target's point q, and nearer to the line of sight through q than the tangent of
an angle times its distance before q, is removed; the hole is the union over all points of targets
that face the viewer within the picture. With slopes s = (x, y) / depth and T = tan θ, that is
|s − s_q| · z < (z_q − z) · T, so that a line of sight leaves the hole at the depth

    z = max over q of z_q · T / (|s − s_q| + T).

The axis of our cones is the line of sight, not the view vector: a target beside the middle of the
picture is uncovered as one in it. `exact` finds the greatest q at every pixel; else it is found for
blocks of 16 × 16 pixels, and a pixel takes the best of its block's and its neighbours'.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.declared import key
from seethrough.renderer.techniques import reaching, removal
from seethrough.renderer.techniques.base import TARGET_DEPTH, Bools, Floats, Shot
from seethrough.renderer.techniques.seen import Look, Surfaces


@dataclass(frozen=True)
class AdaptiveParameters(removal.Removing):
    """How wide the cones are."""

    angle: float = key(
        20.0, "between a cone's side and its axis, the line of sight", "degrees",
        low=0.1, high=85,
    )  # fmt: skip
    exact: bool = key(False, "find the hole at every pixel: slower, no approximation")


@dataclass(frozen=True, eq=False)
class Cones:
    """(h·w,) depth at which a line of sight leaves the hole, 0 where it does not meet it: as the
    targets' points are, and the least and the most that float32 may make of it."""

    depth: Floats
    least: Floats
    most: Floats


class AdaptiveCutaway(removal.Removal[AdaptiveParameters, None, Cones]):
    """Cones before the points of targets."""

    name = "adaptive_cutaway"
    title = "Adaptive cut-away"
    instruction = "Whatever stands before a target is cut away in a funnel that opens towards you."
    source = "Burns2008"
    Parameters = AdaptiveParameters
    removes = removal.CLIPPED
    needs = frozenset({TARGET_DEPTH})

    def touches(self, p: AdaptiveParameters, state: object, shot: Shot) -> Bools:
        """What is nearer than the farthest target."""
        far = shot.boxes.far[shot.scene.targets & shot.boxes.inside].max(initial=0.0)
        return reaching.reached(shot, reaching.whole(shot, 1), np.array([far]))

    def known(self, p: AdaptiveParameters, state: object, seen: Surfaces) -> Cones:
        """The hole, from every point of a target."""
        width, height = seen.shot.size
        front = seen.targets & seen.front
        depth = seen.farthest(front).reshape(height, width)
        most = np.zeros(height * width)
        np.maximum.at(most, seen.pixel[front], seen.slack[front])
        slack = most.reshape(height, width)
        sure = np.where(seen.edge.reshape(height, width), 0.0, depth - slack)
        wide = np.where(depth > 0, depth + slack, 0.0)
        around = np.pad(wide, 1)
        beside = [around[r : r + height, c : c + width] for r in range(3) for c in range(3)]
        wide = np.where(seen.edge.reshape(height, width), np.max(beside, axis=0), wide)
        made = (_hole(p, d, seen.shot) for d in (depth, sure, wide))
        return Cones(*made)

    def rule(self, p: AdaptiveParameters, state: object, seen: Surfaces, known: Cones) -> Look:
        """Removed before the depth at which the line of sight leaves the hole."""
        signed = known.depth[seen.pixel] - seen.depth
        slack = removal.uncertain(seen)
        doubt = seen.depth > known.least[seen.pixel] - slack
        doubt &= seen.depth < known.most[seen.pixel] + slack
        return removal.look(p, seen, signed, known.depth > 0, doubt)

    def pictures(
        self, p: AdaptiveParameters, state: object, shot: Shot, needed: Mapping[str, object]
    ) -> Mapping[str, NDArray[np.float32]]:
        """The hole, from the farthest target at each pixel."""
        from seethrough.renderer.techniques.adaptive_cutaway import cones

        depth = np.ascontiguousarray(needed["target_depth"], dtype=np.float32)
        slopes = shot.camera.lens(shot.size[1]), float(np.tan(np.radians(p.angle)))
        if p.exact:
            return {"clip": cones.of_pixels(depth, *slopes)}
        return {"clip": cones.of_blocks(depth, *slopes, shot.looked_up)}

    def exactly(self, p: AdaptiveParameters) -> AdaptiveParameters:
        """At every pixel."""
        return replace(p, exact=True)


def _hole(p: AdaptiveParameters, depth: Floats, shot: Shot) -> Floats:
    """(h·w,) the greatest of all cones at each pixel, tried one by one."""
    height, width = depth.shape
    wide = np.tan(np.radians(p.angle)) * shot.camera.lens(shot.size[1])  # slopes in pixels
    rows, columns = np.arange(1 - height, height), np.arange(1 - width, width)
    falls = np.hypot(rows[:, None], columns) + wide  # about a point in the middle
    found = np.zeros((height, width))
    for r, c in np.argwhere(depth > 0).tolist():
        about = falls[height - 1 - r : 2 * height - 1 - r, width - 1 - c : 2 * width - 1 - c]
        np.maximum(found, depth[r, c] * wide / about, out=found)
    return found.ravel()


TECHNIQUE = AdaptiveCutaway()
