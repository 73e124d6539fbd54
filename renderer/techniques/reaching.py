"""Which objects reach into parts of the picture: what most techniques touch at most."""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.techniques.base import Bools, Floats, Shot


def before_targets(shot: Shot) -> Bools:
    """(n,) penetrable objects that overlap a target on the screen and reach nearer than its end."""
    boxes = shot.boxes
    among = shot.scene.targets & boxes.inside
    return reached(shot, boxes.extents[among] + [-1, -1, 1, 1], boxes.far[among])


def reached(shot: Shot, extents: Floats, depth: Floats) -> Bools:
    """(n,) penetrable objects that reach into one of some parts of the picture (k, 4: left, top,
    right, bottom in pixels) and before the view depth (k,) that belongs to it."""
    scene, boxes = shot.scene, shot.boxes
    among = ~scene.targets & ~scene.impenetrable
    return _reached(boxes.extents, boxes.near, among, extents, depth)


@njit(cache=True)
def _reached(boxes: Floats, near: Floats, among: Bools, extents: Floats, depth: Floats) -> Bools:
    found = np.zeros(len(boxes), np.bool_)
    for i in range(len(boxes)):
        if not among[i]:
            continue
        for k in range(len(extents)):
            across = boxes[i, 0] <= extents[k, 2] and boxes[i, 2] >= extents[k, 0]
            down = boxes[i, 1] <= extents[k, 3] and boxes[i, 3] >= extents[k, 1]
            if across and down and near[i] <= depth[k]:
                found[i] = True
                break
    return found


def whole(shot: Shot, count: int) -> Floats:
    """(count, 4) the whole picture, so many times."""
    return np.tile(np.array([0.0, 0.0, *shot.size]), (count, 1))
