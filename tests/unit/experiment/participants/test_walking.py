"""What a walker makes of single looks: what shines through, what is known, how far it is."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from plain_trials import MODELS
from played_tasks import begin

from seethrough.renderer.scene.visibility import Visibility
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.skills.effects import plan_effects
from seethrough.tasks.kit.skills.glance import CLEAR, Glance
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.places import crossed
from seethrough.tasks.kit.skills.profile import AVERAGE
from seethrough.tasks.kit.skills.sight import Sight, Thing
from seethrough.tasks.kit.skills.walking import Walker
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


def thing(index, weight=1.0, contrast=0.1):
    return Thing(index, 1.0, 1.0, weight, contrast)


def behind_walls(person):
    """(things,) their indices; and which of them a wall hides from where one stands."""
    things = np.nonzero(BUILDING.scene.targets)[0]
    places = BUILDING.scene.transforms[things][:, [0, 2], 3]
    return things, crossed(np.array(person.eye), places, person.known.layout.segments)


def test_only_what_shines_through_a_known_wall_teaches_that_things_do():
    person = walker()
    things, hidden = behind_walls(person)
    assert hidden.any() and not hidden.all()
    far, near = int(things[hidden][0]), int(things[~hidden][0])
    person._see_through([thing(far, weight=0.5)])
    assert person.through == []  # no wall is known yet
    person.known.walls[:] = True
    person._see_through([thing(near, weight=0.5), thing(far, weight=1.0)])
    assert person.through == []  # nothing is before the one, and the other is opaque
    person._see_through([thing(near, weight=0.5), thing(far, weight=0.5)])
    assert person.through == [0.1 / CLEAR]


def test_what_is_known_is_not_made_out_again_in_passing():
    n = len(BUILDING.scene.objects)
    on = np.ones(n)
    clear = Visibility(np.full(n, 900), on, np.zeros((n, 2)), on, 0.1 * on)
    person = walker(lambda: clear)
    person.pass_by()
    asked = set(np.nonzero(person._asked)[0].tolist())
    assert person.passed == asked and len(asked) > 2
    person.passed.clear()
    person.pass_by()
    assert person.passed == set() and asked <= person.recognised


@pytest.mark.parametrize("whole, extra", [(True, 0.0), (False, AVERAGE.through_noise)])
def test_what_shines_through_something_is_placed_less_surely(whole, extra):
    """By hand: the logarithm of the distance is off by the spread times one normal deviate."""
    person = walker(seed=7)
    index = int(np.nonzero(BUILDING.scene.targets)[0][0])
    sight = Sight([], frozenset({index} if whole else ()), frozenset())
    there = BUILDING.scene.transforms[index, [0, 2], 3] - person.eye
    found = np.array(person.place(index, sight)) - person.eye
    distance = np.hypot(*there)
    biased = distance * (1 - (1 - AVERAGE.depth_bias) * min(1, distance / 30))
    spread = np.hypot(AVERAGE.depth_noise, extra)
    deviate = np.random.default_rng(7).standard_normal()
    assert_allclose(np.hypot(*found), biased * np.exp(spread * deviate), rtol=1e-12)
    assert_allclose(found / np.hypot(*found), there / distance, atol=1e-12)


def test_without_depth_noise_things_stand_where_they_are():
    person = walker()
    person.mood = replace(
        person.mood, effects=plan_effects(TASK.simulate.effects, 0, frozenset({"depth_noise"}))
    )
    index = int(np.nonzero(BUILDING.scene.targets)[0][0])
    found = np.array(person.place(index, Sight([], frozenset(), frozenset())))
    assert_allclose(found, BUILDING.scene.transforms[index, [0, 2], 3], atol=1e-12)
