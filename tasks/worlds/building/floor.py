"""A random floor plan: rooms on a grid, and the walls that adjacent rooms share (Elmqvist2009
§VI)."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.random import Generator

from seethrough.tasks.worlds.building.building_parameters import BuildingParameters


@dataclass(frozen=True)
class Room:
    """Cells x0 ≤ x < x1, z0 ≤ z < z1 of the grid."""

    x0: int
    z0: int
    x1: int
    z1: int


@dataclass(frozen=True)
class Wall:
    """What rooms `a` and `b` share: along `axis` (0 is x, 2 is z) at `level` on the other axis.

    `start` and `end` are where it begins and ends along the axis, `door` where its doorway's
    middle lies; all in world units, walls between grid lines.
    """

    a: int
    b: int
    axis: int
    level: float
    start: float
    end: float
    door: float


@dataclass(frozen=True)
class Floor:
    """The rooms of one floor, and one wall with one doorway for each pair of adjacent rooms."""

    rooms: tuple[Room, ...]
    walls: tuple[Wall, ...] = field(default=())


def random_floor(rng: Generator, parameters: BuildingParameters) -> Floor:
    """Rooms by cutting the grid in two, again and again, down to rooms `room` cells wide at least.

    The doorway lies at a random place of its wall, clear of the walls that meet it.
    """
    p = parameters
    rooms = tuple(_split(rng, Room(0, 0, p.grid, p.grid), p.room))
    walls = []
    for a in range(len(rooms)):
        for b in range(a + 1, len(rooms)):
            shared = _shared(rooms[a], rooms[b])
            if shared is not None:
                axis, *numbers = shared
                level, start, end = (n * p.cell - p.side / 2 for n in numbers)
                clear = p.door_width / 2 + 2 * p.wall_thickness
                door = rng.uniform(start + clear, end - clear)
                walls.append(Wall(a, b, axis, level, start, end, float(door)))
    return Floor(rooms, tuple(walls))


def _split(rng: Generator, room: Room, least: int) -> list[Room]:
    """The room, or what it is cut into: across its longer side, until that is too short."""
    width, depth = room.x1 - room.x0, room.z1 - room.z0
    # Rooms up to half as long again as they must be stay whole half of the time.
    longest = max(width, depth)
    if longest < 2 * least or (longest < 3 * least and rng.random() < 0.5):
        return [room]
    across_x = width > depth or (width == depth and rng.random() < 0.5)
    low, high = (room.x0, room.x1) if across_x else (room.z0, room.z1)
    cut = int(rng.integers(low + least, high - least + 1))
    if across_x:
        halves = (Room(room.x0, room.z0, cut, room.z1), Room(cut, room.z0, room.x1, room.z1))
    else:
        halves = (Room(room.x0, room.z0, room.x1, cut), Room(room.x0, cut, room.x1, room.z1))
    return [r for half in halves for r in _split(rng, half, least)]


def _shared(a: Room, b: Room) -> tuple[int, int, int, int] | None:
    """(axis, level, start, end) in cells of the wall between two rooms, None if they share none."""
    for axis, (a0, a1, b0, b1), (lo_a, hi_a, lo_b, hi_b) in (
        (2, (a.x0, a.x1, b.x0, b.x1), (a.z0, a.z1, b.z0, b.z1)),
        (0, (a.z0, a.z1, b.z0, b.z1), (a.x0, a.x1, b.x0, b.x1)),
    ):
        start, end = max(lo_a, lo_b), min(hi_a, hi_b)
        if start < end and (a1 == b0 or b1 == a0):
            return axis, a1 if a1 == b0 else b1, start, end
    return None


def built_lengths(
    walls: tuple[Wall, ...], thickness: float, half_side: float
) -> list[tuple[float, float]]:
    """Where each wall's masonry begins and ends, so that walls touch and never overlap.

    Where walls meet, those along an axis with one on both sides run through, up to the corner;
    the others stop at their face. The outer walls stand outside of ±half_side.
    """
    at: dict[tuple[float, float], set[tuple[int, int]]] = {}
    for wall in walls:
        for end, sign in ((wall.start, 1), (wall.end, -1)):
            at.setdefault(_corner(wall, end), set()).add((wall.axis, sign))
    lengths = []
    for wall in walls:
        ends = []
        for end, sign in ((wall.start, 1), (wall.end, -1)):
            meets = at[_corner(wall, end)]
            x_through = {(0, 1), (0, -1)} <= meets
            through = 0 if x_through else 2
            butts = abs(end) < half_side - 1e-9 and wall.axis != through
            ends.append(end + sign * thickness / 2 if butts else end)
        lengths.append((ends[0], ends[1]))
    return lengths


def _corner(wall: Wall, end: float) -> tuple[float, float]:
    place = (end, wall.level) if wall.axis == 0 else (wall.level, end)
    return (round(place[0], 6), round(place[1], 6))


def room_at(plan: Floor, x: float, z: float, parameters: BuildingParameters) -> int:
    """Index of the room in which the point lies, −1 outside of the building."""
    p = parameters
    i, j = np.floor((np.array([x, z]) + p.side / 2) / p.cell).astype(int)
    for index, room in enumerate(plan.rooms):
        if room.x0 <= i < room.x1 and room.z0 <= j < room.z1:
            return index
    return -1
