"""A simulated participant gains nothing from transparency where nothing is hidden."""

import numpy as np
import pytest

from experiment.participants.participant import SimulatedParticipant
from renderer.gpu.context import standalone
from renderer.gpu.renderer import Renderer
from renderer.scene import Object, Scene
from renderer.techniques.dynamic import DynamicTransparency
from renderer.techniques.standard import Standard
from renderer.transforms import placed
from tasks.abstract_scene import RED, unit_mesh
from tasks.catalog import TASKS
from tasks.parameters import AbstractParameters

ASPECT = 4 / 3
TASK = TASKS["count"]


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


def play(renderer, scene, technique, seed):
    """Events and outcome of one count."""
    state = TASK.begin(np.random.default_rng(1), AbstractParameters(), ASPECT, scene)
    participant = SimulatedParticipant(np.random.default_rng(seed))
    participant.begin_trial("count", 0.0)
    now, events = 0.0, []
    while TASK.outcome(state) is None:
        view = TASK.view(state)
        batch = participant.events(
            view, lambda v=view: renderer.look(v.scene, v.camera, technique), now, "count"
        )
        for event in batch:
            state = TASK.on_event(state, event)
        now = batch[-1].time
        events += batch
    return events, TASK.outcome(state)


@pytest.mark.parametrize("seed", range(6))
def test_where_nothing_is_hidden_the_techniques_are_equal_event_for_event(renderer, seed):
    """Equivalent within a bound of nothing at all: the same seed, the same session."""
    first = play(renderer, open_world(), Standard(), seed)
    second = play(renderer, open_world(), DynamicTransparency(), seed)
    assert first == second


def test_what_is_hidden_is_counted_only_through_transparency(renderer):
    hidden = [play(renderer, walled_world(), Standard(), seed)[1] for seed in range(4)]
    shown = [play(renderer, walled_world(), DynamicTransparency(), seed)[1] for seed in range(4)]
    assert all(o.answer == "0" for o in hidden)
    assert all(int(o.answer) >= 3 for o in shown)  # of 4
