"""What lies outside all masks: large objects are drawn opaque there, which is cheaper than to blend
all their pixels."""

from __future__ import annotations

import numpy as np

from seethrough.renderer.arrays import Floats, Ints
from seethrough.renderer.scene.projection import Boxes

WORTH = 64  # pixels to save by drawing a triangle once more


def holes(reach: Floats, size: tuple[int, int]) -> Ints:
    """(k, 4) whole pixels that each mask can cover, by its reach (m, 4)."""
    low = np.clip(np.floor(reach[:, :2]), 0, size)
    high = np.clip(np.ceil(reach[:, 2:]), 0, size)
    rows = np.concatenate([low, high], axis=1)[(low < high).all(axis=1)]
    return rows.astype(np.int64)


def wide(boxes: Boxes, blended: Ints, around: Ints, triangles: Ints, size: tuple[int, int]) -> Ints:
    """Blended objects of few triangles (n,) that cover much of the picture outside all holes.

    Drawing them twice costs little, blending all their pixels much.
    """
    if not len(around):
        return blended[:0]
    box = boxes.extents[blended]
    low, high = np.clip(box[:, :2], 0, size), np.clip(box[:, 2:], 0, size)
    scope = np.array([*around[:, :2].min(axis=0), *around[:, 2:].max(axis=0)])
    inside = np.clip(np.minimum(high, scope[2:]) - np.maximum(low, scope[:2]), 0, None)
    outside = (high - low).prod(axis=1) - inside.prod(axis=1)
    return blended[outside > WORTH * triangles[blended]]
