"""What a person makes of a look: the same with the eyes open, from a table, and worked out anew."""

from dataclasses import asdict, replace

import numpy as np
import pytest

from seethrough.experiment.people.runs.looks import KeptLooks
from seethrough.renderer.events import KeyPress, KeyRelease, PointerMove, Tick
from seethrough.renderer.scene import geometry
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.visibility import Visibility
from seethrough.tasks.kit.controls import changed, walk
from seethrough.tasks.kit.skills.glance import CLEAR, WINDOW_PIXELS, likely
from seethrough.tasks.kit.skills.profile import AVERAGE
from seethrough.tasks.kit.skills.sight import sight
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

THINGS = (True, False, True, True, False, True)  # what stands about; the others are walls
SCENE = Scene(tuple(Object(geometry.box(), kind="cat" if t else "wall") for t in THINGS))


def look():
    pixels = np.array([0, 30, 12, 1, 700, 0])
    seen = pixels > 0
    share = np.array([0, 0.4, 1, 0.1, 1, 0])
    position = np.where(seen[:, None], np.linspace(0, 1, 12).reshape(6, 2), np.nan)
    return Visibility(pixels, share, position, seen * 0.15, pixels / 30_000 * share)


def kept():
    looks = KeptLooks()
    looks.put("a", (0, 0, 0), look())
    return looks.get("a", len(THINGS), (0, 0, 0))


@pytest.mark.parametrize("seen", [look(), kept()])
def test_a_sight_says_of_each_thing_that_may_be_asked_for_what_the_arrays_say(seen):
    found = sight(seen, SCENE, AVERAGE)
    assert [t.number for t in found.things] == [2, 3]
    walls = likely(look().area[[1, 4]] * WINDOW_PIXELS, AVERAGE.recognise, AVERAGE.recognise_spread)
    assert found.walls == pytest.approx({1: walls[0], 4: walls[1]}, rel=1e-12)
    pixels = look().area * WINDOW_PIXELS
    p = AVERAGE
    for thing in found.things:
        i = thing.number
        notice = likely(0.15 * np.sqrt(pixels[i]), p.notice, p.notice_spread)
        clear = likely(pixels[i] * 0.15 / CLEAR, p.recognise, p.recognise_spread)
        # The same formula for one number: a few units in the last place.
        assert thing.notice == pytest.approx(notice, rel=1e-12)
        assert thing.recognise == pytest.approx(clear, rel=1e-12)
        assert thing.clear == pytest.approx(pixels[i] * 0.15 / CLEAR, rel=1e-12)


def test_what_is_a_target_of_the_technique_is_nobodys_knowledge():
    """Walls and things are told apart by what they look like, not by a flag."""
    marked = Scene(tuple(replace(thing, target=not thing.target) for thing in SCENE.objects))
    a, b = sight(look(), SCENE, AVERAGE), sight(look(), marked, AVERAGE)
    assert a.things == b.things and a.walls == b.walls


def test_one_pixel_of_wall_is_one_pixel_of_wall():
    one = look()
    one = replace(one, area=np.full(6, 1 / WINDOW_PIXELS), pixels=np.ones(6, int))
    assert max(sight(one, SCENE, AVERAGE).walls.values()) < 1e-4


def test_a_kept_look_serves_one_profile_after_the_other():
    seen = kept()
    first = sight(seen, SCENE, AVERAGE)
    assert sight(seen, SCENE, AVERAGE) is first
    other = replace(AVERAGE, notice=AVERAGE.notice * 3)
    fewer = sight(seen, SCENE, other).things
    assert all(a.notice < b.notice for a, b in zip(fewer, first.things, strict=True))
    assert sight(seen, SCENE, AVERAGE).things == first.things


@pytest.mark.parametrize("eyes", ["notice", "notice_spread", "recognise", "recognise_spread"])
def test_each_constant_of_the_eyes_makes_a_kept_look_another(eyes):
    seen = kept()
    before = sight(seen, SCENE, AVERAGE)
    other = replace(AVERAGE, **{eyes: 2 * getattr(AVERAGE, eyes)})
    assert sight(seen, SCENE, other).things == sight(look(), SCENE, other).things != before.things


def test_a_value_changed_is_the_value_replaced():
    walker = walk(BuildingParameters(), (1.0, 2.0), 0.3)
    new = changed(walker, x=5.0, yaw=-1.0)
    assert new == replace(walker, x=5.0, yaw=-1.0) and walker.x == 1.0
    assert asdict(new).keys() == asdict(walker).keys()


def test_a_tick_without_time_leaves_the_walker_and_one_with_time_moves_him():
    walker = walk(BuildingParameters(), (1.0, 2.0)).on_event(KeyPress(1.0, "up"))
    assert walker.on_event(Tick(1.0)) is walker
    assert walker.on_event(Tick(2.0)).z == pytest.approx(2.0 - walker.speed)
    still = walker.on_event(KeyRelease(1.0, "up"))
    assert still.on_event(Tick(9.0)).held.time == 9.0  # the turning picture lives on it
    assert still.on_event(PointerMove(1.0, 0, 0, 0.1, 0)).yaw == pytest.approx(-0.1 * still.gain)
