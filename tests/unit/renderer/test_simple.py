"""A building in models of few triangles shows what the building shows, for a fraction of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from seethrough.experiment.display.looking import HEIGHT, Looking
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.models import MODELS, proxy
from seethrough.renderer.models.simple import simplified
from seethrough.renderer.scene import geometry
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.controls import walk
from seethrough.tasks.worlds.building.building import unique_building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

PARAMETERS = BuildingParameters()
BUILDING = unique_building(np.random.default_rng(3), PARAMETERS)
SIZE = (200, HEIGHT)


def test_models_alone_give_way_to_their_proxies():
    """Where they stand, in their order; a box is no model, nor is a mesh of that name."""
    box, sofa = geometry.box(1, 1, 1), MODELS["sofa"]()
    moved = np.eye(4)
    moved[:3, 3] = 1, 2, 3
    things = (
        Object(sofa, moved, (0.5, 1, 1), target=True, kind="sofa"),
        Object(box, kind="wall", impenetrable=True),
        Object(box, kind="sofa"),
    )
    simple = simplified(Scene(things, (0, 0, 1)))
    assert [o.mesh for o in simple.objects] == [proxy("sofa"), box, box]
    for one, other in zip(simple.objects, things, strict=True):
        assert replace(one, mesh=other.mesh).__dict__ == other.__dict__
    assert simple.background == (0, 0, 1)


def test_a_building_has_a_tenth_of_its_triangles_left():
    """Once for each scene: who looks again gets the same one."""
    simple = simplified(BUILDING.scene)
    assert simplified(BUILDING.scene) is simple
    assert simple.triangle_counts.sum() < 0.1 * BUILDING.scene.triangle_counts.sum()


def test_as_much_is_seen_of_every_thing(context):
    """Pixels and share of each thing of more than a few pixels, from all around and through walls.

    An outline moves by less than a pixel (test_models.py): a fourth of the pixels of a small thing,
    a twentieth in the mean.
    """
    renderer, compared = Renderer(context, SIZE), 0
    for yaw in np.arange(0, 6.28, 0.8):
        camera = walk(PARAMETERS, BUILDING.start, float(yaw)).camera()
        for technique in (Standard(), DynamicTransparency()):
            whole, simple = (
                renderer.look(scene, camera, technique, SIZE)
                for scene in (BUILDING.scene, simplified(BUILDING.scene))
            )
            seen = BUILDING.scene.targets & (whole.pixels > 60)
            ratio = simple.pixels[seen] / whole.pixels[seen]
            assert np.abs(np.log(ratio)).max(initial=0) < np.log(1.25)
            assert abs(np.log(ratio).mean() if seen.any() else 0) < 0.05
            np.testing.assert_allclose(simple.weight[seen], whole.weight[seen], atol=0.06)
            compared += int(seen.sum())
    assert compared > 40


def test_eyes_take_simple_models_only_where_they_are_told_to(context):
    """Who measures how hard a scene is sees the models themselves."""
    view = View(BUILDING.scene, walk(PARAMETERS, BUILDING.start, 0.8).camera())
    renderer = Renderer(context, SIZE)
    for simple in (False, True):
        eyes = Looking(context, (800, 600), simple=simple)
        eyes.technique = Standard()
        scene = simplified(view.scene) if simple else view.scene
        expected = renderer.look(scene, view.camera, Standard(), SIZE)
        np.testing.assert_array_equal(eyes.look(view).pixels, expected.pixels)
