"""What doorways do not show is left out of a standard frame, and nothing of the picture changes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.look.dressed import dressed
from seethrough.renderer.plan.explain import explain
from seethrough.renderer.plan.planner import plan
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.look import Look
from seethrough.renderer.scene.transforms import placed
from seethrough.renderer.techniques import named
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.kit.controls import turned, walk
from seethrough.tasks.worlds.building.building import unique_building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

SIZE = (240, 180)
KINDS = ("chair", "table", "cat", "lamp", "sofa")
# The published floor with fewer kinds of things, one of few large rooms, one with thick walls.
HOUSES = {
    "published": BuildingParameters(objects=40, types=KINDS),
    "small": BuildingParameters(grid=6, objects=8, count=(1, 3), types=KINDS),
    "thick": BuildingParameters(
        grid=9, objects=12, types=KINDS, wall_thickness=0.6, door_width=1.0, door_height=4.9
    ),
}
POSES = 20  # of each place a walker can be at, in each house


def house(name: str, seed: int = 3):
    return unique_building(np.random.default_rng(seed), HOUSES[name])


def anywhere(rng, building):
    half = building.parameters.side / 2
    return rng.uniform(-half, half, 2)


def in_a_door_frame(rng, building):
    """In the frame, at its sides, in the masonry beside it, or a step before it."""
    p, wall = building.parameters, rng.choice(building.floor.walls)
    along = wall.door + rng.uniform(-0.6, 0.6) * p.door_width
    across = wall.level + rng.normal(0, p.wall_thickness)
    return (along, across) if wall.axis == 0 else (across, along)


def in_a_wall(rng, building):
    """In its masonry, or so near that the near plane cuts it; at its ends others begin."""
    p, wall = building.parameters, rng.choice(building.floor.walls)
    along = rng.choice([wall.start, wall.end, rng.uniform(wall.start, wall.end)])
    across = wall.level + rng.uniform(-1.5, 1.5) * p.wall_thickness
    return (along, across) if wall.axis == 0 else (across, along)


def at_the_edge(rng, building):
    """Outside, in an outer wall, or just within it."""
    half = building.parameters.side / 2
    x, z = rng.choice([-1, 1]) * (half + rng.uniform(-0.2, 0.5)), rng.uniform(-half, half)
    return (x, z) if rng.random() < 0.5 else (z, x)


def cameras(place, name):
    """Walkers' views from such places, every other along the walls; every fourth from some height,
    looking up or down."""
    building, rng = house(name), np.random.default_rng(17)
    p = building.parameters
    for k in range(POSES):
        x, z = place(rng, building)
        tilted = k % 4 == 0
        y = rng.uniform(0.02, 1.2 * p.wall_height) if tilted else p.eye_height
        yaw = rng.uniform(0, 2 * np.pi)
        if k % 2:
            yaw = rng.integers(4) * np.pi / 2 + rng.normal(0, 0.2)
        turn = turned(yaw, rng.uniform(-0.7, 0.7) if tilted else 0.0)
        yield building.scene, Camera(np.array([x, y, z]), turn, p.fov_y, 0.1, 2 * p.side)


@pytest.fixture(scope="module")
def renderers(context):
    return [Renderer(context, SIZE, without=w) for w in ({"still"}, {"still", "rooms"})]


def pictures(renderers, scene, camera, technique):
    found = []
    for renderer in renderers:
        renderer.draw(scene, camera, technique)
        found.append(renderer.read().astype(int))
    return found


@pytest.mark.parametrize("name", HOUSES)
@pytest.mark.parametrize("place", [anywhere, in_a_door_frame, in_a_wall, at_the_edge])
def test_not_a_pixel_is_another(renderers, place, name):
    """Against the whole frame, equal to the bit."""
    for scene, camera in cameras(place, name):
        short, long = pictures(renderers, scene, camera, Standard())
        assert np.array_equal(short, long), f"{place.__name__}: eye {camera.eye}"


def test_most_of_the_building_is_left_out(renderers):
    """From rooms of the published floor, less than a half of what lies in the view is drawn."""
    drawn = np.zeros(2)
    for scene, camera in cameras(anywhere, "published"):
        if camera.eye[1] == 3.2:
            pictures(renderers, scene, camera, Standard())
            drawn += [len(renderer.plan.opaque) for renderer in renderers]
    assert drawn[0] < 0.5 * drawn[1]


def test_what_is_higher_than_the_walls_is_seen_over_them(renderers):
    """A pole in the farthest corner shows in every picture that looks there."""
    building = house("published")
    scene, p = building.scene, building.parameters
    pole = scene.objects[-1]
    corner = p.side / 2 - 3
    high = placed((corner, p.wall_height, corner), scale=(0.5, 60 * p.wall_height, 0.5))
    tall = replace(scene, objects=(*scene.objects, replace(pole, transform=high, kind="pole")))
    eye = np.array([-corner, p.eye_height, -corner])
    camera = Camera(eye, turned(-0.75 * np.pi), p.fov_y, 0.1, 2 * p.side)
    short, long = pictures(renderers, tall, camera, Standard())
    assert np.array_equal(short, long)
    assert len(scene.objects) in renderers[0].plan.opaque  # it comes after all others
    without = pictures(renderers, scene, camera, Standard())[0]
    assert (without != short).any()


def test_walls_that_moved_or_are_not_there_hide_nothing():
    """A technique may move things, a bench leave some out: then no rooms are known."""
    scene = house("small").scene
    assert scene.in_room is not None
    walls = [i for i, o in enumerate(scene.objects) if o.kind == "wall"]
    moved = list(scene.objects)
    shifted = moved[walls[0]].transform + np.eye(4, k=3)
    moved[walls[0]] = replace(moved[walls[0]], transform=shifted)
    assert replace(scene, objects=tuple(moved)).in_room is None
    things = tuple(o for o in scene.objects if o.target)
    assert replace(scene, objects=things).in_room is None


@pytest.mark.parametrize("name", ["dynamic", "see_through", "constant", "cutaway", "lens"])
def test_a_technique_that_shows_what_is_behind_walls_draws_it(renderers, name):
    """The shortcut is for frames that touch nothing; every other picture is the same too."""
    for scene, camera in list(cameras(anywhere, "small"))[:12]:
        short, long = pictures(renderers, scene, camera, named(name))
        assert np.array_equal(short, long)


LOOKS = (Look(ground_shadows=0.5, fog=20.0), Look(outlines=2.0), Look(antialiasing="edges"))


@pytest.mark.parametrize("look", LOOKS, ids=lambda look: look.on[0])
def test_looks_are_the_same(renderers, look):
    """Shadows, fog, lines along outlines and smooth edges of what is seen."""
    for scene, camera in list(cameras(in_a_door_frame, "small"))[:12]:
        short, long = pictures(renderers, dressed(scene, look), camera, Standard())
        assert np.array_equal(short, long)


def test_lines_of_what_no_doorway_shows_do_not_shine_through_walls(context):
    """What stands against a far wall's other side is no farther off than lines on it may be. Where
    leaving that out changes a smoothed picture it comes nearer to sixteen samples a pixel."""
    wide, high = size = (480, 360)
    both = [Renderer(context, size, without=w) for w in ({"still"}, {"still", "rooms"})]
    fine = Renderer(context, (4 * wide, 4 * high), window=high)
    off, pixels = np.zeros(2), 0
    for place in (anywhere, in_a_wall):
        for scene, camera in cameras(place, "published"):
            found = pictures(both, dressed(scene, LOOKS[2]), camera, Standard())
            at = (found[0] != found[1]).any(axis=2)
            if at.any():
                fine.draw(scene, camera, Standard())
                want = fine.read().reshape(high, 4, wide, 4, 3).mean(axis=(1, 3))
                off += [np.abs(one - want)[at].sum() for one in found]
                pixels += int(at.sum())
    assert 0 < pixels < 1e-5 * 2 * POSES * wide * high
    assert off[0] < 0.5 * off[1]


def test_a_plan_says_what_no_doorway_shows():
    """And it can be told to draw everything."""
    building = house("published")
    camera = walk(building.parameters, building.start, 0.3).camera()
    frame = plan(building.scene, camera, Standard(), SIZE)
    text = "\n".join(explain(building.scene, frame))
    assert "not drawn: no doorway on any way there shows it" in text and "rooms" in text
    whole = plan(building.scene, camera, Standard(), SIZE, {"rooms"})
    assert set(frame.opaque) < set(whole.opaque)
    assert "no doorway" not in "\n".join(explain(building.scene, whole))
