"""Break-away (Diepstraten, Weiskopf and Ertl 2003): a hole in the shape of each target.

What lies within the outline of a target's convex hull on the screen, or a margin about it, and
nearer than the target's farthest point, is removed. `jagged` breaks the margin into teeth, as if
the hole had been knocked into the wall. The hull is that of the points beyond the near plane.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Ints
from seethrough.renderer.declared import key
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques import reaching, removal
from seethrough.renderer.techniques.base import Bools, Floats, Shot
from seethrough.renderer.techniques.seen import Look, Surfaces


@dataclass(frozen=True)
class BreakawayParameters(removal.Removing):
    """How far the hole reaches beyond its target, and what its border is like."""

    margin: float = key(
        12.0, "how far the hole reaches beyond the target", "pixels of the window", low=0, high=1000
    )
    jagged: float = key(0.0, "part of the margin that teeth of the border take", low=0, high=1)
    teeth: int = key(11, "teeth about each target", low=3, high=200)


@dataclass(frozen=True, eq=False)
class Holes:
    """Before each of n targets: the `corners` of its hull in pixels (m, 2), one hull's after the
    other's, where each hull's begin (n + 1,), and the target's farthest depth (n,)."""

    corners: Floats
    starts: Ints
    depth: Floats


class Breakaway(removal.Removal[BreakawayParameters, None, Holes]):
    """Holes in the shape of targets."""

    name = "breakaway"
    title = "Break-away"
    instruction = "Whatever stands before a target has a hole in the target's shape."
    source = "Diepstraten2003"
    misses = "misses R2 (targets in line), R7"
    Parameters = BreakawayParameters
    removes = removal.CLIPPED

    def touches(self, p: BreakawayParameters, state: object, shot: Shot) -> Bools:
        """What reaches into a hole's rectangle, and nearer than its target's end."""
        made = holes(shot)
        grow = (p.margin * shot.scale + 1) * np.array([-1, -1, 1, 1])
        first = made.starts[:-1]
        low = np.minimum.reduceat(made.corners, first) if len(first) else made.corners
        high = np.maximum.reduceat(made.corners, first) if len(first) else made.corners
        return reaching.reached(shot, np.concatenate([low, high], axis=1) + grow, made.depth)

    def known(self, p: BreakawayParameters, state: object, seen: Surfaces) -> Holes:
        """The holes."""
        return holes(seen.shot)

    def rule(self, p: BreakawayParameters, state: object, seen: Surfaces, known: Holes) -> Look:
        """Removed within a hole, and before its target's end."""
        from seethrough.renderer.techniques.breakaway.border import room

        width, height = seen.shot.size
        pixels = np.stack(np.meshgrid(np.arange(width), np.arange(height)), axis=-1) + 0.5
        signed = np.full(len(seen.depth), -np.inf)
        doubt = np.zeros(len(seen.depth), dtype=bool)
        pierced = np.zeros(width * height, dtype=bool)
        teeth = (p.margin * seen.shot.scale, p.jagged, p.teeth)
        for k, depth in enumerate(known.depth):
            corners = known.corners[known.starts[k] : known.starts[k + 1]]
            inside = room(corners, pixels.reshape(-1, 2), *teeth)
            pierced |= inside > 0
            before = depth - seen.depth
            signed = np.maximum(signed, np.where(inside[seen.pixel] > 0, before, -np.inf))
            doubt |= (np.abs(inside) < 1e-3)[seen.pixel] & (before > 0)
        return removal.look(p, seen, signed, pierced, doubt)

    def pictures(
        self, p: BreakawayParameters, state: object, shot: Shot, needed: Mapping[str, object]
    ) -> Mapping[str, NDArray[np.float32]]:
        """The depth at which each pixel's line of sight leaves the hole."""
        from seethrough.renderer.techniques.breakaway.border import fill

        made = holes(shot)
        clip = np.zeros((shot.size[1], shot.size[0]), np.float32)
        teeth = (p.margin * shot.scale, p.jagged, p.teeth)
        fill(made.corners, made.starts, made.depth, shot.looked_up, *teeth, clip)
        return {"clip": clip}


def holes(shot: Shot) -> Holes:
    """One for each target of which something lies beyond the near plane."""
    return _holes(shot.scene, shot.camera, shot.size)


@lru_cache(maxsize=1)
def _holes(scene: Scene, camera: Camera, size: tuple[int, int]) -> Holes:
    """A frame's plan and its picture ask for the same ones."""
    from seethrough.renderer.techniques.breakaway.border import hulls

    width, height = size
    points, starts = scene.target_hulls
    lens = np.array([camera.lens(height), 0.5 * width, 0.5 * height, camera.near])
    return Holes(*hulls((points - camera.eye) @ camera.rotation, starts, lens))


TECHNIQUE = Breakaway()
