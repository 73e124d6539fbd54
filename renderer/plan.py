"""What a frame needs: which objects blend, in which order, and which targets need a mask.

An object in front of no target's mask is drawn opaque with all the others, in one pass. The rest
is put into levels: objects of one level do not overlap on the screen, so each level is a handful
of instanced draws, and their number grows with depth complexity instead of with the objects.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from renderer.camera import Camera
from renderer.projection import Boxes, screen_boxes
from renderer.scene import Scene
from renderer.techniques.dynamic import DynamicTransparency
from renderer.techniques.standard import Standard

Technique = Standard | DynamicTransparency
Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Level:
    """Objects (indices) that overlap nowhere on the screen, then the masks of targets."""

    objects: Indices
    masks: Indices


@dataclass(frozen=True, eq=False)
class FramePlan:
    """What to draw, in this order: `opaque` with a depth buffer, then each level.

    The first level holds masks only. `masked` are all targets that get a mask; `boxes` the
    extents of all objects on the screen.
    """

    opaque: Indices
    levels: tuple[Level, ...]
    masked: Indices
    ordered: int
    boxes: Boxes


def impenetrable(scene: Scene, camera: Camera, technique: DynamicTransparency) -> NDArray[np.bool_]:
    """(n,) what never turns transparent in this frame (004 §III-C.3)."""
    if technique.penetrable_within is None:
        return scene.impenetrable
    low, high = scene.corners.min(axis=1), scene.corners.max(axis=1)
    gap = np.maximum(np.maximum(low - camera.eye, camera.eye - high), 0.0)
    return scene.impenetrable | (np.linalg.norm(gap, axis=1) > technique.penetrable_within)


def plan(scene: Scene, camera: Camera, technique: Technique, size: tuple[int, int]) -> FramePlan:
    """Decide what the frame of `size` (width, height) in pixels needs. Pure."""
    boxes = screen_boxes(scene.corners, camera, size)
    drawn = np.nonzero(boxes.inside)[0]
    if isinstance(technique, Standard) or not scene.targets[drawn].any():
        return FramePlan(drawn, (), drawn[:0], 0, boxes)
    depth = camera.depth(scene.group_centers)
    # Farthest group first; a group's objects stay together, in their order in the scene.
    order = drawn[np.lexsort((drawn, scene.group_of[drawn], -depth[drawn]))]
    blended, masked, of_object, of_mask = _levels(
        order,
        boxes.extents,
        scene.targets,
        impenetrable(scene, camera, technique),
        float(technique.width),
    )
    levels = tuple(
        Level(np.nonzero(of_object == k)[0], np.nonzero(of_mask == k)[0])
        for k in range(-1, max(of_object.max(initial=-1), of_mask.max(initial=-1)) + 1)
    )
    opaque = drawn[~blended[drawn]]
    return FramePlan(opaque, levels, np.nonzero(masked)[0], int(blended.sum()), boxes)


@njit(cache=True)
def _overlap(extents, i, j, gap):  # type: ignore[no-untyped-def]
    """Whether box i comes within `gap` pixels of box j."""
    return (
        extents[i, 0] <= extents[j, 2] + gap
        and extents[i, 2] >= extents[j, 0] - gap
        and extents[i, 1] <= extents[j, 3] + gap
        and extents[i, 3] >= extents[j, 1] - gap
    )


@njit(cache=True)
def _levels(order, extents, targets, impenetrable, width):  # type: ignore[no-untyped-def]
    """Which objects blend, which targets are masked, and the level of each (−2: none).

    `order` runs from far to near. An object comes after every farther object and mask that it
    overlaps; a mask comes after its own target and everything farther, and before the rest.
    """
    n = len(extents)
    blended, masked = np.zeros(n, np.bool_), np.zeros(n, np.bool_)
    for a in range(len(order)):
        i = order[a]
        if impenetrable[i]:
            continue
        for b in range(a):
            j = order[b]
            if targets[j] and _overlap(extents, i, j, width):
                blended[i] = masked[j] = True
    of_object, of_mask = np.full(n, -2, np.int64), np.full(n, -2, np.int64)
    for a in range(len(order)):
        i = order[a]
        if blended[i]:
            of_object[i] = 0
            for b in range(a):
                j = order[b]
                if blended[j] and _overlap(extents, i, j, 0.0):
                    of_object[i] = max(of_object[i], of_object[j] + 1)
                if masked[j] and _overlap(extents, i, j, width):
                    of_object[i] = max(of_object[i], of_mask[j] + 1)
        if masked[i]:
            of_mask[i] = of_object[i] if blended[i] else -1
            for b in range(a):
                j = order[b]
                if blended[j] and _overlap(extents, j, i, width):
                    of_mask[i] = max(of_mask[i], of_object[j])
    return blended, masked, of_object, of_mask
