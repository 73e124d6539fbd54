"""Walls, doorways and the floor as meshes. One world unit is half a metre."""

from __future__ import annotations

from functools import cache

import numpy as np

from seethrough.renderer.scene import geometry
from seethrough.renderer.scene.geometry import Mesh
from seethrough.renderer.scene.rooms import Rooms
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import placed, rotation_y, scaling, translation
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters
from seethrough.tasks.worlds.building.floor import Floor, built_lengths

INNER = (0.87, 0.84, 0.78)
OUTER = (0.62, 0.61, 0.63)
FLOOR = (0.55, 0.50, 0.45)
FLOOR_DEPTH = 0.2

# A wall is 3 × 2 blocks, less the doorway in the middle of the lower row.
BLOCKS = ((0, 0), (0, 1), (1, 1), (2, 0), (2, 1))
NEIGHBOURS = ((1, 0), (-1, 0), (0, 1), (0, -1))


def wall_with_doorway(
    length: float, height: float, thickness: float, door: tuple[float, float], door_height: float
) -> Mesh:
    """A wall along x from 0 to `length`, on y = 0, about z = 0, with a doorway cut out.

    One watertight surface: no face lies inside, so that a transparent wall shows none. `door` is
    the doorway's extent along x.
    """
    xs, ys = (0.0, *door, length), (0.0, door_height, height)
    cube = unit_cube()
    facing = cube.normals[cube.triangles[:, 0], :2]
    vertices: list[np.ndarray] = []
    triangles: list[np.ndarray] = []
    for i, j in BLOCKS:
        low, high = np.array([xs[i], ys[j]]), np.array([xs[i + 1], ys[j + 1]])
        size, middle = [*(high - low), thickness], [*(low + high) / 2, 0.0]
        inside = [(facing == d).all(axis=1) for d in NEIGHBOURS if (i + d[0], j + d[1]) in BLOCKS]
        kept = cube.triangles[~np.any(inside, axis=0)]
        triangles.append(kept + len(vertices) * len(cube.vertices))
        vertices.append(cube.vertices * size + middle)
    return Mesh(
        np.concatenate(vertices),
        np.tile(cube.normals, (len(vertices), 1)),
        np.tile(cube.colors, (len(vertices), 1)),
        np.concatenate(triangles).astype(np.int32),
    )


@cache
def unit_cube() -> Mesh:
    """The one mesh of all plain walls and floors."""
    return geometry.box()


def inner_walls(floor: Floor, p: BuildingParameters) -> list[Object]:
    """One object for each pair of adjacent rooms; transparent where a target stands behind."""
    lengths = built_lengths(floor.walls, p.wall_thickness, p.side / 2)
    walls = []
    for wall, (start, end) in zip(floor.walls, lengths, strict=True):
        middle, half = wall.door - start, p.door_width / 2
        turn = np.eye(4)
        position = (start, 0.0, wall.level)
        if wall.axis == 2:
            # Turned by −90° about +y, the wall's x runs along the world's z.
            turn = rotation_y(-np.pi / 2)
            position = (wall.level, 0.0, start)
        mesh = wall_with_doorway(
            end - start,
            p.wall_height,
            p.wall_thickness,
            (middle - half, middle + half),
            p.door_height,
        )
        walls.append(Object(mesh, placed(position, turn), INNER, kind="wall"))
    return walls


def shell(p: BuildingParameters) -> list[Object]:
    """Four outer walls round the rooms and the floor below: they never turn transparent."""
    cube = unit_cube()
    half, t = p.side / 2, p.wall_thickness
    long = p.side + 2 * t
    pieces = []
    for x, z, width, depth in (
        (0.0, -half - t / 2, long, t),
        (0.0, half + t / 2, long, t),
        (-half - t / 2, 0.0, t, p.side),
        (half + t / 2, 0.0, t, p.side),
    ):
        matrix = placed((x, p.wall_height / 2, z), scale=(width, p.wall_height, depth))
        pieces.append(Object(cube, matrix, OUTER, impenetrable=True, kind="outer wall"))
    ground = translation(0, -FLOOR_DEPTH / 2, 0) @ scaling(long, FLOOR_DEPTH, long)
    return [Object(cube, ground, FLOOR, impenetrable=True, kind="floor"), *pieces]


def rooms(floor: Floor, p: BuildingParameters, scene: Scene) -> Rooms:
    """The floor's rooms, for a scene that holds its walls, inner and outer."""
    half_door, half = p.door_width / 2, p.side / 2
    boxes = [[r.x0, r.z0, r.x1, r.z1] for r in floor.rooms]
    sides, openings = [], []
    for wall in floor.walls:
        a, b = floor.rooms[wall.a], floor.rooms[wall.b]
        across = a.z0 < b.z0 if wall.axis == 0 else a.x0 < b.x0
        sides.append((wall.a, wall.b) if across else (wall.b, wall.a))
        along = wall.door - half_door, wall.door + half_door
        x, z = (along, (wall.level,) * 2) if wall.axis == 0 else ((wall.level,) * 2, along)
        openings.append([(x[0], 0.0, z[0]), (x[1], p.door_height, z[1])])
    walls = [i for i, o in enumerate(scene.objects) if o.kind in ("wall", "outer wall")]
    return Rooms(
        np.array(boxes) * p.cell - half,
        np.array(sides, np.int64).reshape(-1, 2),
        np.array(openings).reshape(-1, 2, 3),
        np.array(walls, np.int64),
        scene.transforms[walls],
        *(p.wall_thickness, 0.0, p.wall_height),
    )
