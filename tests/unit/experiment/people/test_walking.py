"""What a walker makes of single looks: what shines through, what is known, how far it is."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from plain_trials import MODELS
from played_tasks import begin

from seethrough.renderer.scene.visibility import Visibility
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.skills import walking
from seethrough.tasks.kit.skills.effects import plan_effects
from seethrough.tasks.kit.skills.glance import Glance, likely
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.places import COS_HALF_VIEW, crossed
from seethrough.tasks.kit.skills.profile import AVERAGE
from seethrough.tasks.kit.skills.sight import Sight, Thing
from seethrough.tasks.kit.skills.walking import FILLED, Walker
from seethrough.tasks.worlds.building.building import count_building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

TASK = TASKS["count_in_building"]
BUILDING = count_building(np.random.default_rng(1), BuildingParameters(), MODELS)


def walker(look=None, seed=1):
    """Somebody at the building's start."""
    state = begin("count_in_building", BUILDING.parameters, BUILDING)
    effects = plan_effects(TASK.simulate.effects, 0, frozenset())
    mood = Mood(np.random.default_rng(seed), AVERAGE, effects, 1.0, 1.0)
    return Walker(mood, Glance(TASK.view(state), look, 0.0))


def seen(*told):
    """A look at a building that shows things with these chances to be told."""
    return Sight([Thing(number, 1.0, chance, 400.0) for number, chance in told], {})


def in_view(person, things):
    """Which things lie in the view, left and right."""
    way = BUILDING.scene.transforms[things][:, [0, 2], 3] - person.eye
    ahead = way @ [-np.sin(person.yaw), -np.cos(person.yaw)]
    return ahead > COS_HALF_VIEW * np.linalg.norm(way, axis=1)


def behind_walls(person):
    """(things,) their indices; and which of them a wall hides from where one stands."""
    things = np.nonzero(BUILDING.scene.targets)[0]
    places = BUILDING.scene.transforms[things][:, [0, 2], 3]
    return things, crossed(np.array(person.eye), places, person.known.layout.segments)


def test_how_far_walls_hide_is_learned_from_places_not_from_what_shines_through():
    person = walker()
    things, hidden = behind_walls(person)
    ahead = in_view(person, things)
    far, near = things[hidden & ahead][:2], things[~hidden & ahead][:1]
    assert len(far) == 2 and len(near) == 1
    person._check(seen((int(far[0]), 1.0)))
    assert person.through.cases == 0  # it is not known to stand there
    person.recognised.update(map(int, (*far, *near)))
    person._check(seen((int(far[0]), 1.0)))
    assert person.through.cases == 0  # no wall is known yet
    person.known.walls[:] = True
    person._check(seen((int(far[0]), 0.5), (int(near[0]), 1.0)))
    distance = np.linalg.norm(BUILDING.scene.transforms[far][:, [0, 2], 3] - person.eye, axis=1)
    p = AVERAGE
    expected = likely(FILLED / distance**2, p.recognise, p.recognise_spread)
    # The other one was looked for as well, and nothing of it was there.
    assert person.through.cases == pytest.approx(expected.sum(), rel=1e-12)
    assert person.through.true == 0.5


@pytest.mark.parametrize("alpha", [0.0, 0.3, 1.0])
def test_what_is_believed_of_hidden_places_is_what_was_seen_of_them(alpha):
    """Belief follows clear pixels: a part of them seen is a part believed, and none is none."""
    person = walker()
    things, hidden = behind_walls(person)
    person.known.walls[:] = True
    person.recognised.update(things.tolist())
    distance = np.linalg.norm(BUILDING.scene.transforms[things][:, [0, 2], 3] - person.eye, axis=1)
    p = AVERAGE
    told = likely(FILLED / distance**2 * max(1 - alpha, 1e-9), p.recognise, p.recognise_spread)
    for _ in range(5):
        person._check(seen(*zip(things.tolist(), told.tolist(), strict=True)))
    ahead = hidden & in_view(person, things)
    whole = likely(FILLED / distance**2, p.recognise, p.recognise_spread)
    share = told[ahead].sum() / whole[ahead].sum()
    cases = 5 * whole[ahead].sum()
    assert person.through.mean == pytest.approx(share * cases / (1 + cases), rel=1e-9)


def test_what_is_known_is_not_made_out_again_in_passing():
    n = len(BUILDING.scene.objects)
    on = np.ones(n)
    clear = Visibility(np.full(n, 900), on, np.zeros((n, 2)), on, 0.1 * on)
    person = walker(lambda: clear)
    person.pass_by()
    asked = set(np.nonzero(person._asked)[0].tolist())
    assert set(person.passed) == asked and len(asked) > 2
    person.passed.clear()
    person.pass_by()
    assert person.passed == {} and asked <= person.recognised


@pytest.mark.parametrize("clear", [5.0, 100.0, 1e9])
def test_the_less_is_seen_of_a_thing_the_less_surely_it_is_placed(clear):
    """By hand: the logarithm of the distance is off by the spread times one normal deviate."""
    person = walker(seed=7)
    index = int(np.nonzero(BUILDING.scene.targets)[0][0])
    there = BUILDING.scene.transforms[index, [0, 2], 3] - person.eye
    found = np.array(person.place(index, clear)) - person.eye
    distance = np.hypot(*there)
    biased = distance * (1 - (1 - AVERAGE.depth_bias) * min(1, distance / 30))
    spread = AVERAGE.depth_noise * np.sqrt(1 + AVERAGE.recognise / clear)
    deviate = np.random.default_rng(7).standard_normal()
    assert_allclose(np.hypot(*found), biased * np.exp(spread * deviate), rtol=1e-12)
    assert_allclose(found / np.hypot(*found), there / distance, atol=1e-12)


def test_without_depth_noise_things_stand_where_they_are():
    person = walker()
    person.mood = replace(
        person.mood, effects=plan_effects(TASK.simulate.effects, 0, frozenset({"depth_noise"}))
    )
    index = int(np.nonzero(BUILDING.scene.targets)[0][0])
    found = np.array(person.place(index, 1.0))
    assert_allclose(found, BUILDING.scene.transforms[index, [0, 2], 3], atol=1e-12)


def test_no_more_is_kept_of_profiles_than_has_room(monkeypatch):
    """Calibration tries thousands: what is kept stays below the limit, and what comes out right."""
    monkeypatch.setattr(walking, "MOST_KEPT", 5)
    person = walker()
    grid = person.known.layout.grid
    kept = dict(grid.sure)
    grid.sure.clear()
    sizes = []
    try:
        for number in range(12):
            profile = replace(AVERAGE, recognise=50.0 + number)
            person.mood = Mood(np.random.default_rng(1), profile, person.mood.effects, 1.0, 1.0)
            distance = np.maximum(grid.ways(person.cell)[0], 1.0)
            right = likely(FILLED / distance**2, profile.recognise, profile.recognise_spread)
            assert_allclose(person._sure(), right)
            sizes.append(len(grid.sure))
    finally:
        grid.sure.clear()
        grid.sure.update(kept)
    assert max(sizes) == 5 and sizes[:5] == [1, 2, 3, 4, 5]


@pytest.mark.parametrize("most", [1.0, 0.4, 0.05])
def test_where_least_was_seen_one_goes_however_much_was_seen(most):
    """A single cell that is left, out of sight behind walls, is the goal."""
    person = walker()
    cells = len(person.known.layout.grid.centers)
    for far in (0, 255, 104):
        person.known._before = np.zeros(cells)
        person.known._before[far] = most
        person.known._hidden = np.ones(cells, bool)
        person._quality = None
        _, goal = person.choose()
        assert goal == tuple(person.known.layout.grid.centers[far].tolist())


def test_what_was_seen_half_as_well_again_is_no_goal():
    """Many cells that are nearly seen, near by, against one at which nobody has looked."""
    person = walker()
    grid = person.known.layout.grid
    person.known._before = np.full(len(grid.centers), 0.45)
    person.known._before[0] = 1.0
    person.known._hidden = np.ones(len(grid.centers), bool)
    person._quality = None
    assert person.choose()[1] == tuple(grid.centers[0].tolist())
