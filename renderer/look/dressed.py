"""A scene with a look: what the look adds to the things in it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from seethrough.renderer.look.floor import KIND
from seethrough.renderer.scene import geometry
from seethrough.renderer.scene.look import Look
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import placed

MARGIN = 0.15  # of the things' width, by which the floor below them is wider on each side
PALE = (0.86, 0.86, 0.87)
_UNIT = geometry.quad()


def dressed(scene: Scene, look: Look) -> Scene:
    """The scene as it looks: the same one whenever it is asked for, itself if nothing is changed.

    Where something is drawn on the floor and there is none, a floor lies below all things. It comes
    after them, so that they keep their indices, and never turns transparent.
    """
    bare = scene.bare or scene
    if look == bare.look:
        return bare
    if look not in bare.dresses:
        things = bare.objects
        if look.has_floor and not any(thing.kind == KIND for thing in things):
            things = (*things, below(bare))
        if look.occlusion > 0:
            # Its kernels take a moment to load, and few pictures need them.
            from seethrough.renderer.look.corners import cornered
            from seethrough.renderer.look.occlusion import occluded

            things = tuple(
                replace(thing, mesh=occluded(thing.mesh, look.occlusion)) for thing in things
            )
            things = cornered(things, look.occlusion)
        bare.dresses[look] = replace(bare, objects=things, look=look, bare=bare)
    return bare.dresses[look]


def below(scene: Scene) -> Object:
    """A floor at the lowest corner of a scene's boxes."""
    corners = scene.corners.reshape(-1, 3)
    if not len(corners):
        corners = np.zeros((1, 3))
    low, high = corners.min(axis=0), corners.max(axis=0)
    side = float(max(high[0] - low[0], high[2] - low[2], 1.0)) * (1 + 2 * MARGIN)
    middle = (low + high) / 2
    place = placed((float(middle[0]), float(low[1]), float(middle[2])), scale=(side, 1.0, side))
    return Object(_UNIT, place, PALE, impenetrable=True, kind=KIND)
