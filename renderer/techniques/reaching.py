"""Which objects reach into parts of the picture: what most techniques touch at most."""

from __future__ import annotations

import numpy as np

from seethrough.renderer.scene.projection import screen_boxes
from seethrough.renderer.techniques.base import Bools, Floats, Shot


def before_targets(shot: Shot) -> Bools:
    """(n,) penetrable objects that overlap a target on the screen and reach nearer than its end."""
    boxes = screen_boxes(shot.scene.corners, shot.camera, shot.size)
    among = shot.scene.targets & boxes.inside
    return reached(shot, boxes.extents[among] + [-1, -1, 1, 1], boxes.far[among])


def reached(shot: Shot, extents: Floats, depth: Floats) -> Bools:
    """(n,) penetrable objects that reach into one of some parts of the picture (k, 4: left, top,
    right, bottom in pixels) and before the view depth (k,) that belongs to it."""
    scene = shot.scene
    found = np.zeros(len(scene.objects), dtype=bool)
    if len(extents):
        boxes = screen_boxes(scene.corners, shot.camera, shot.size)
        low = (boxes.extents[:, None, :2] <= extents[None, :, 2:]).all(axis=2)
        high = (boxes.extents[:, None, 2:] >= extents[None, :, :2]).all(axis=2)
        found = np.any(low & high & (boxes.near[:, None] <= depth), axis=1)
    return found & ~scene.targets & ~scene.impenetrable


def whole(shot: Shot, count: int) -> Floats:
    """(count, 4) the whole picture, so many times."""
    return np.tile(np.array([0.0, 0.0, *shot.size]), (count, 1))
