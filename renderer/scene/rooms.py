"""What can be seen of a scene that walls divide into rooms: what shows through their doorways.

A line of sight leaves a room only where a doorway is, so a thing is seen only within what the
doorways on some way to its room show of it on the screen (Luebke1995). What is left
out would have been hidden by a wall, pixel for pixel, as long as walls are opaque.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bools, Floats
from seethrough.renderer.scene.camera import Camera

_BITS = np.array([[k >> 2 & 1, k >> 1 & 1, k & 1] for k in range(8)])
_AXES = np.arange(3)
SLACK = 1e-6  # world units by which a thing may reach into a room: what touches is in both
MARGIN = 1.0  # pixels round a doorway: its corners are worked out in 64 bits, drawn in 32


@dataclass(frozen=True, eq=False)
class Rooms:
    """Rectangular rooms between upright walls, which are solid but for doorways.

    boxes (r, 4): lowest x, z, highest x, z of each room, up to the middle planes of its walls;
    sides (d, 2): the rooms on the lower and the higher side of each doorway, along x or z;
    openings (d, 2, 3): its lowest and highest corner, in its wall's middle plane; walls (w,): the
    objects that are the walls, outer ones too; poses (w, 4, 4): where those have to stand;
    thickness: of the walls at most; low, high: y of their lower and upper side. World units.
    """

    boxes: NDArray[np.float64]
    sides: NDArray[np.int64]
    openings: NDArray[np.float64]
    walls: NDArray[np.int64]
    poses: NDArray[np.float64]
    thickness: float
    low: float
    high: float

    @cached_property
    def doorways(self) -> tuple[Floats, NDArray[np.int64], Floats]:
        """Corners (d, 8, 3) of the openings, the axis (d,) across each, and where its plane lies
        along that (d,)."""
        axis = (self.openings[:, 1] - self.openings[:, 0]).argmin(axis=1)
        plane = np.take_along_axis(self.openings[:, 0], axis[:, None], axis=1)[:, 0]
        return self.openings[:, _BITS, _AXES], axis, plane

    def stand(self, transforms: NDArray[np.float64]) -> bool:
        """Whether the walls are where they were, among objects (n, 4, 4)."""
        there = self.walls.max(initial=-1) < len(transforms)
        return bool(there and np.array_equal(transforms[self.walls], self.poses))

    def holding(self, corners: NDArray[np.float64]) -> Bools:
        """(n, r) which room each object may be in, by its box (n, 8, 3). What is higher than the
        walls, below them or in no room may be in any."""
        low, high = corners.min(axis=1), corners.max(axis=1)
        first, last = low[:, None, ::2], high[:, None, ::2]
        held = (first <= self.boxes[:, 2:] + SLACK) & (last >= self.boxes[:, :2] - SLACK)
        inside: Bools = held.all(axis=2)
        over = (high[:, 1] > self.high + SLACK) | (low[:, 1] < self.low - SLACK)
        inside[over | ~inside.any(axis=1)] = True
        return inside

    def around(self, camera: Camera, size: tuple[int, int]) -> NDArray[np.int64]:
        """Rooms that are seen as if there were no walls: those whose walls the eye or the near
        plane's part of the view can be in. None: the eye is where no walls hide anything."""
        slope = camera.pixel(size[1]) / 2
        reach = camera.near * float(np.sqrt(1 + (slope * size[0]) ** 2 + (slope * size[1]) ** 2))
        x, y, z = camera.eye.tolist()
        place = np.array([x, z])
        in_one = ((place >= self.boxes[:, :2]) & (place <= self.boxes[:, 2:])).all(axis=1).any()
        if not (in_one and self.low + reach < y < self.high - reach):
            return np.zeros(0, np.int64)
        grown = self.thickness / 2 + reach + SLACK
        near = (place >= self.boxes[:, :2] - grown) & (place <= self.boxes[:, 2:] + grown)
        return np.nonzero(near.all(axis=1))[0]


def seen(
    rooms: Rooms, held: Bools, extents: Floats, camera: Camera, size: tuple[int, int]
) -> Bools:
    """(n,) which objects may show in a picture of `size` (width, height).

    `held` (n, r) is what `rooms.holding` says of them, `extents` (n, 4) what they cover on the
    screen at most.
    """
    first = rooms.around(camera, size)
    if not len(first):
        return np.ones(len(extents), dtype=bool)
    views = _views(rooms, first.tolist(), camera, size)
    left, top, right, bottom = np.array([view for _, view in views]).T
    shown = (extents[:, :1] < right) & (extents[:, 1:2] < bottom)
    shown &= (extents[:, 2:3] > left) & (extents[:, 3:] > top)
    found: Bools = (shown & held[:, [room for room, _ in views]]).any(axis=1)
    return found


View = tuple[float, float, float, float]  # left, top, right, bottom in pixels


def _views(
    rooms: Rooms, first: list[int], camera: Camera, size: tuple[int, int]
) -> list[tuple[int, View]]:
    """Rooms and what of the screen shows each, once for every way of doorways that leads there."""
    from seethrough.renderer.scene.projection import screen_boxes  # worlds need no kernels

    corners, axis, plane = rooms.doorways
    boxes = screen_boxes(corners, camera, size)
    around = boxes.extents + np.array([-MARGIN, -MARGIN, MARGIN, MARGIN])
    beyond = (camera.eye[axis] < plane).tolist()  # the higher side lies beyond the doorway
    ways: dict[int, list[tuple[int, View]]] = {}
    for d in np.nonzero(boxes.within)[0].tolist():
        low, high = rooms.sides[d].tolist()
        here, there = (low, high) if beyond[d] else (high, low)
        ways.setdefault(here, []).append((there, tuple(around[d].tolist())))
    open_ = [(room, (0.0, 0.0, float(size[0]), float(size[1]))) for room in first]
    for room, view in open_:  # grows on the way; ends, as every step leads farther from the eye
        for there, door in ways.get(room, ()):
            left, top = max(view[0], door[0]), max(view[1], door[1])
            right, bottom = min(view[2], door[2]), min(view[3], door[3])
            if left < right and top < bottom:
                open_.append((there, (left, top, right, bottom)))
    return open_
