"""Where walls meet: they touch, never overlap, and leave no hole, for any floor."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from seethrough.renderer.scene.transforms import moved
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters
from seethrough.tasks.worlds.building.floor import random_floor
from seethrough.tasks.worlds.building.walls import inner_walls, shell


def footprints(objects):
    """(n, 2, 2) lowest and highest (x, z)."""
    places = [moved(o.mesh.vertices, o.transform)[:, [0, 2]] for o in objects]
    return np.array([[p.min(axis=0), p.max(axis=0)] for p in places]).reshape(-1, 2, 2)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(2, 10), st.integers(1, 4))
def test_walls_touch_without_overlap_or_hole(seed, grid, least):
    p = BuildingParameters(grid=grid, room=min(least, grid))
    floor = random_floor(np.random.default_rng(seed), p)
    boxes = footprints([*inner_walls(floor, p), *shell(p)[1:]])
    common = np.minimum(boxes[:, None, 1], boxes[None, :, 1]) - np.maximum(
        boxes[:, None, 0], boxes[None, :, 0]
    )
    overlap = (common > 1e-9).all(axis=2)  # rounding of positions up to 60 units is below 1e-13
    np.fill_diagonal(overlap, False)
    assert not overlap.any()
    # Every corner's square of one wall's thickness is covered, wherever inner walls meet there.
    t = p.wall_thickness / 2 * 0.99
    for wall in floor.walls:
        for end in (wall.start, wall.end):
            if abs(abs(end) - p.side / 2) < 1e-9:
                continue
            corner = np.array([end, wall.level] if wall.axis == 0 else [wall.level, end])
            for dx, dz in ((t, t), (t, -t), (-t, t), (-t, -t), (0, 0)):
                point = corner + np.array([dx, dz])
                inside = (boxes[:, 0] <= point + 1e-9) & (point - 1e-9 <= boxes[:, 1])
                # With walls on both sides, the strip on the far side of a T belongs to the wall
                # that runs through.
                assert inside.all(axis=1).any()


def test_four_rooms_about_one_corner():
    """A 2 × 2 grid of single cells: the one crossing, with two walls that run through."""
    p = BuildingParameters(grid=2, room=1)
    for seed in range(30):
        floor = random_floor(np.random.default_rng(seed), p)
        if len(floor.rooms) == 4:
            break
    assert len(floor.walls) == 4
    boxes = footprints(inner_walls(floor, p))
    area = np.prod(boxes[:, 1] - boxes[:, 0], axis=1).sum()
    # Two walls of full length that cross, their common square counted once.
    t = p.wall_thickness
    assert abs(area - (2 * p.side * t - t * t)) < 1e-9
