"""What each technique is for, and where it fails, measured on exact pictures."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest

from seethrough import registry
from seethrough.experiment.gallery.gallery_failures import CAMERA, SIZE, Failure, failures, hidden
from seethrough.renderer import events
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques import named
from seethrough.renderer.techniques.base import Shot

WALL = Object(geometry.box(7, 5, 0.2), transforms.translation(0, 0, 2), (0.7, 0.7, 0.65))
BALL = Object(geometry.sphere(0.8, 2), transforms.translation(0, 0, -2), (0.9, 0.2, 0.1), True)
CLOSED = Object(geometry.sphere(2.4, 3), transforms.translation(0, 0, 0), (0.3, 0.75, 0.35))


def test_every_technique_has_a_failure():
    """Ours all have one; whoever adds one finds where it fails."""
    assert set(failures()) == set(registry.known("technique"))


@pytest.mark.parametrize("name", failures())
def test_a_technique_fails_where_it_is_said_to(name):
    """The measure is beyond what a good picture keeps to."""
    failure = failures()[name]
    assert failure.parameters.technique.name == name
    assert failure.measured() > failure.bound


@pytest.mark.parametrize("name", failures())
def test_a_target_behind_a_wall_shows_as_the_technique_promises(name):
    """With the pointer at it, and the wall tagged: nothing of it is hidden where things are
    removed, and no more than the occluder's opacity elsewhere."""
    p = named(name)
    known = {field.name for field in fields(p)}
    p = replace(p, **({"kinds": ("",)} if "kinds" in known else {}))
    if name == "lens":
        p = replace(p, radius=0.25)
    state, shot = p.technique.begin(p), Shot(Scene((WALL, BALL)), CAMERA, SIZE)
    for event in (events.PointerMove(0, 2 / 3, 0.52, 0, 0), events.KeyPress(0, "q")):
        if name == "dig" or isinstance(event, events.PointerMove):
            state, _ = p.technique.on_event(p, state, event, shot)
    truth = exact(shot.scene, CAMERA, p, SIZE, state)
    alone = exact(Scene((BALL,)), CAMERA, named("standard"), SIZE)
    assert hidden(0)(truth, alone, alone) <= failures()[name].left + 0.01


def test_a_closed_thing_is_cut_with_a_wall_and_an_open_one_with_a_hole():
    """The same cut through a ball that is closed leaves no hole beside the target."""
    broken = failures()["cutaway"]
    closed = Failure("", broken.parameters, Scene((CLOSED, broken.scene.objects[1])),
                     broken.measure, broken.bound)  # fmt: skip
    assert broken.measured() > broken.bound > 0.1 > closed.measured()


def test_peeling_fewer_layers_than_there_are_loses_the_rest(context):
    """Five panes and three peels: the picture is that of the three nearest, exactly."""
    panes = [
        Object(geometry.box(5, 4, 0.05), transforms.translation(0, 0, 3 - 0.3 * k), (0.2, 0.5, 0.9))
        for k in range(5)
    ]
    renderer = Renderer(context, SIZE)
    pictures = []
    for count, layers in ((5, 3), (3, None), (5, None)):
        scene = Scene((*panes[:count], BALL))
        renderer.draw(scene, CAMERA, replace(named("constant"), layers=layers))
        pictures.append(renderer.read())
    np.testing.assert_array_equal(pictures[0], pictures[1])
    assert (pictures[0] != pictures[2]).mean() > 0.2
