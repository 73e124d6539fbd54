"""A simulated participant gains nothing from transparency where nothing is hidden."""

from dataclasses import replace

import numpy as np
import pytest
from played_tasks import begin

from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.scene import geometry
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import placed
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import RED, Cloud, unit_mesh
from seethrough.tasks.worlds.building.building import count_building, unique_building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

ASPECT = 4 / 3


@pytest.fixture(scope="module")
def renderer():
    return Renderer(standalone(), (800, 600))


def open_world():
    """A column of things so far apart that none hides another or its outline, from any side."""
    things = []
    for k, y in enumerate(range(-42, 43, 14)):
        color = RED if k % 2 == 0 else (0.0, 0.8, 0.6)
        matrix = placed((0.0, float(y), 0.0), scale=2.5)
        things.append(Object(unit_mesh("sphere"), matrix, color, color == RED, kind="sphere"))
    return Scene(tuple(things))


def walled_world():
    """The same column with every red thing in a box: nobody sees one without help."""
    boxes = [
        Object(unit_mesh("box"), placed(o.transform[:3, 3], scale=6.0), (0.0, 0.5, 0.5), kind="box")
        for o in open_world().objects
        if o.target
    ]
    return Scene((*open_world().objects, *boxes))


def one_room(name):
    """Three things far apart in a building of one room: whatever is in the view is seen whole."""
    parameters = BuildingParameters(grid=4, room=4, objects=3, count=(2, 2))
    models = {"ball": lambda: geometry.sphere(0.8), "block": lambda: geometry.box(1, 1.5, 2)}
    make = unique_building if name == "unique" else count_building
    # Of world 1 no view shows one thing before another: pictures are equal to the last pixel.
    return parameters, make(np.random.default_rng(1), parameters, models)


def play(renderer, scene, technique, seed, name="count", seen=lambda sight: sight):
    """Events and outcome of one trial; `seen` changes what the eyes report."""
    task = TASKS[name]
    place, made = (AbstractParameters(), Cloud(scene)) if name == "count" else scene
    state = begin(name, place, made)
    participant = SimulatedParticipant(np.random.default_rng(seed))
    participant.begin_trial(name, 0.0)
    now, events = 0.0, []
    while task.outcome(state) is None:
        view = task.view(state)
        batch = participant.events(
            view, lambda v=view: seen(renderer.look(v.scene, v.camera, technique)), now, name
        )
        for event in batch:
            state = task.on_event(state, event)
        now = batch[-1].time
        events += batch
    return events, task.outcome(state)


@pytest.mark.parametrize("seed", range(6))
def test_where_nothing_is_hidden_the_techniques_are_equal_event_for_event(renderer, seed):
    """Equivalent within a bound of nothing at all: the same seed, the same session."""
    first = play(renderer, open_world(), Standard(), seed)
    second = play(renderer, open_world(), DynamicTransparency(), seed)
    assert first == second


@pytest.mark.parametrize("name", ["unique", "count_in_building"])
@pytest.mark.parametrize("seed", range(2))
def test_walkers_gain_nothing_either_where_nothing_is_hidden(renderer, name, seed):
    first = play(renderer, one_room(name), Standard(), seed, name)
    second = play(renderer, one_room(name), DynamicTransparency(), seed, name)
    assert first == second and first[1].correct is not None


def test_an_advantage_of_one_thing_in_one_look_would_be_noticed(renderer):
    """The comparison can fail: whoever misses one of four red things does something else."""

    def without_first(sight):
        pixels = sight.pixels.copy()
        pixels[0] = 0
        return replace(sight, pixels=pixels)

    whole = play(renderer, open_world(), DynamicTransparency(), 0)
    assert play(renderer, open_world(), Standard(), 0, seen=without_first) != whole


def test_what_is_hidden_is_counted_only_through_transparency(renderer):
    hidden = [play(renderer, walled_world(), Standard(), seed)[1] for seed in range(4)]
    shown = [play(renderer, walled_world(), DynamicTransparency(), seed)[1] for seed in range(4)]
    assert all(o.answer == "0" for o in hidden)
    assert all(int(o.answer) >= 3 for o in shown)  # of 4
