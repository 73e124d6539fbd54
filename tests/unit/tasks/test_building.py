"""The building's promises, for any seed."""

from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from seethrough.renderer.scene import geometry
from seethrough.renderer.scene.transforms import moved
from seethrough.tasks.worlds.building.building import count_building, unique_building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters
from seethrough.tasks.worlds.building.floor import random_floor, room_at
from seethrough.tasks.worlds.building.walls import wall_with_doorway

SEEDS = st.integers(0, 2**32 - 1)
_MESHES = {
    "ball": geometry.sphere(0.8),
    "block": geometry.box(1, 1.5, 2),
    "cone": geometry.cone(0.5, 1.5),
    "drum": geometry.cylinder(0.7, 1),
    "plank": geometry.box(2, 0.3, 0.4),
    "ring": geometry.torus(0.6, 0.2),
}
MODELS = {name: (lambda mesh=mesh: mesh) for name, mesh in _MESHES.items()}


def cells(plan, grid):
    """(grid, grid) index of the room at each cell; every cell must belong to exactly one."""
    owner = np.full((grid, grid), -1)
    for index, room in enumerate(plan.rooms):
        assert (owner[room.x0 : room.x1, room.z0 : room.z1] == -1).all()
        owner[room.x0 : room.x1, room.z0 : room.z1] = index
    assert (owner >= 0).all()
    return owner


@settings(max_examples=60, deadline=None)
@given(SEEDS, st.integers(2, 20), st.integers(1, 5))
def test_one_wall_with_one_doorway_for_each_pair_of_adjacent_rooms(seed, grid, least):
    p = BuildingParameters(grid=grid, room=min(least, grid))
    plan = random_floor(np.random.default_rng(seed), p)
    owner = cells(plan, grid)
    # The oracle looks at cells: rooms are adjacent where two neighbouring cells differ.
    sides = Counter()
    for a, b in ((owner[:-1], owner[1:]), (owner[:, :-1], owner[:, 1:])):
        for pair in zip(a.ravel().tolist(), b.ravel().tolist(), strict=True):
            if pair[0] != pair[1]:
                sides[tuple(sorted(pair))] += 1
    assert sorted((w.a, w.b) for w in plan.walls) == sorted(sides)
    for wall in plan.walls:
        assert_allclose((wall.end - wall.start) / p.cell, sides[wall.a, wall.b], rtol=1e-12)
        assert wall.start + p.door_width / 2 < wall.door < wall.end - p.door_width / 2
        # Stepping through the doorway leads from one of the two rooms to the other.
        ways = [(wall.door, wall.level + d) for d in (-0.5, 0.5)]
        ends = {room_at(plan, *(w if wall.axis == 0 else w[::-1]), p) for w in ways}
        assert ends == {wall.a, wall.b}


def footprint(thing):
    """Centre (2,) and radius of a circle on the floor that holds the thing."""
    place = moved(thing.mesh.vertices, thing.transform)[:, [0, 2]]
    center = thing.transform[[0, 2], 3]
    return center, np.hypot(*(place - center).T).max() * (1 - 1e-12)


@settings(max_examples=8, deadline=None)
@given(SEEDS, st.booleans())
def test_everything_stands_free(seed, counting):
    p = BuildingParameters()
    make = count_building if counting else unique_building
    building = make(np.random.default_rng(seed), p, MODELS)
    things = [o for o in building.scene.objects if o.target]
    walls = [o for o in building.scene.objects if o.kind == "wall"]
    assert len(things) == 50 and len(walls) == len(building.floor.walls)
    circles = [footprint(o) for o in things]
    boxes = [moved(o.mesh.vertices, o.transform)[:, [0, 2]] for o in walls]
    for i, (center, radius) in enumerate(circles):
        assert np.abs(center).max() + radius <= 40
        for other, reach in circles[:i]:
            assert np.hypot(*(center - other)) >= radius + reach
        for box in boxes:
            nearest = np.clip(center, box.min(axis=0), box.max(axis=0))
            assert np.hypot(*(center - nearest)) >= radius
        for wall in building.floor.walls:
            door = (wall.door, wall.level) if wall.axis == 0 else (wall.level, wall.door)
            assert np.hypot(*(center - door)) > radius + 1.2
        assert np.hypot(*(center - building.start)) > radius + 3.0
    assert room_at(building.floor, *building.start, p) >= 0


@settings(max_examples=10, deadline=None)
@given(SEEDS)
def test_the_questions_have_their_answers(seed):
    unique = unique_building(np.random.default_rng(seed), BuildingParameters(), MODELS)
    kinds = Counter(o.kind for o in unique.scene.objects if o.target)
    assert [k for k, n in kinds.items() if n == 1] == [unique.asked]
    assert sum(kinds.values()) == 50
    counted = count_building(np.random.default_rng(seed), BuildingParameters(), MODELS)
    kinds = Counter(o.kind for o in counted.scene.objects if o.target)
    assert 4 <= kinds[counted.asked] == len(counted.asked_objects) <= 12
    assert sum(kinds.values()) == 50


def test_outer_walls_and_floor_are_impenetrable_and_inner_walls_are_not():
    building = unique_building(np.random.default_rng(1), BuildingParameters(), MODELS)
    opaque = Counter(o.kind for o in building.scene.objects if o.impenetrable)
    assert opaque == {"outer wall": 4, "floor": 1}
    outside = np.concatenate(
        [moved(o.mesh.vertices, o.transform) for o in building.scene.objects if o.kind != "floor"]
    )
    assert np.abs(outside[:, [0, 2]]).max() <= 40.3 + 1e-9
    for wall in (o for o in building.scene.objects if o.kind == "outer wall"):
        corners = np.abs(moved(wall.mesh.vertices, wall.transform)[:, [0, 2]])
        assert corners.max(axis=1).min() >= 40 - 1e-9  # outside of the rooms


def test_buildings_share_meshes_and_come_back():
    first, again = (
        count_building(np.random.default_rng(8), BuildingParameters(), MODELS) for _ in range(2)
    )
    assert np.array_equal(first.scene.transforms, again.scene.transforms)
    things = [o for o in first.scene.objects if o.target]
    assert {id(o.mesh) for o in things} <= {id(m) for m in _MESHES.values()}


def test_models_are_scaled_into_their_range():
    building = count_building(np.random.default_rng(8), BuildingParameters(), MODELS)
    for thing in (o for o in building.scene.objects if o.target):
        scale = np.linalg.norm(thing.transform[:3, 0])
        assert 1.0 - 1e-12 <= scale * thing.mesh.radius <= 2.2 + 1e-12


def test_the_models_that_ship_can_furnish_a_building():
    building = unique_building(np.random.default_rng(1), BuildingParameters())
    assert len({o.kind for o in building.scene.objects if o.target}) >= 12


def area_and_volume(mesh):
    corners = mesh.vertices[mesh.triangles]
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    ).sum()
    return area / 2, np.linalg.det(corners).sum() / 6


def test_a_wall_is_one_closed_surface_with_a_doorway():
    mesh = wall_with_doorway(10.0, 5.0, 0.3, (2.0, 4.5), 4.0)
    area, volume = area_and_volume(mesh)
    assert_allclose(volume, (10 * 5 - 2.5 * 4) * 0.3, rtol=1e-12)
    # Front and back, the outline's edges, and no face inside: an n-shape's perimeter.
    perimeter = 10 + 2 * 5 + (10 - 2.5) + 2 * 4 + 2.5
    assert_allclose(area, 2 * (10 * 5 - 2.5 * 4) + perimeter * 0.3, rtol=1e-12)


@pytest.mark.parametrize(
    "changes, message",
    [
        ({"grid": 1}, r"grid = 1, expected a whole number from 2 to 64"),
        ({"room": 17}, r"room = 17, expected a whole number from 1 to `grid` \(16\)"),
        ({"door_width": 4.0}, r"door_width = 4.0, expected"),
        ({"door_height": 5.0}, r"door_height = 5.0, expected"),
        ({"eye_height": 5.0}, r"eye_height = 5.0, expected"),
        (
            {"count": (9, 3)},
            r"count = \[9, 3\], expected \[lowest, highest\], whole .* to `objects` \(50\)",
        ),
        ({"object_radius": (2.2, 1.0)}, r"object_radius = \[2.2, 1.0\], expected"),
        ({"speed": 0}, r"speed = 0, expected"),
    ],
)
def test_parameters_are_refused_by_name(changes, message):
    with pytest.raises(ValueError, match=message):
        BuildingParameters(**changes)


def test_what_cannot_be_built_is_refused():
    rng = np.random.default_rng(1)
    with pytest.raises(ValueError, match=r"types = \['unicorn'\], expected some of \['ball'"):
        count_building(rng, BuildingParameters(types=("unicorn",)), MODELS)
    with pytest.raises(ValueError, match=r"types = \['ball'\]: expected at least two"):
        count_building(rng, BuildingParameters(types=("ball",)), MODELS)
    with pytest.raises(ValueError, match=r"expected one object of one type"):
        unique_building(rng, BuildingParameters(types=("ball",)), MODELS)
    with pytest.raises(ValueError, match=r"objects = 900, .*expected room for them on a floor"):
        count_building(rng, BuildingParameters(objects=900), MODELS)
