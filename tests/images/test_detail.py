"""Pictures in levels of detail against those of whole models."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.look.dressed import dressed
from seethrough.renderer.models import MODELS
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.geometry import box
from seethrough.renderer.scene.look import Look
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import placed, scaling, translation
from seethrough.renderer.techniques import named

SIZE = (320, 240)
EYE, AHEAD = np.array([0.0, 2.0, 0.0]), np.array([0.0, -0.1, -1.0])
SHADE = 16  # of 255: across a bend of few triangles the light runs otherwise
NAMES = ("cat", "bike", "piano", "car", "chair", "plant", "lamp", "dog")


def hall(distance: float) -> tuple[Scene, object]:
    """Models in a row so far away, all of them targets, and a wall before half of them."""
    things = [
        Object(MODELS[name](), placed((1.6 * (k - 3.5), 0.0, -distance)), target=True, kind=name)
        for k, name in enumerate(NAMES)
    ]
    wall = Object(box(8, 6, 0.2), placed((4.0, 3.0, -distance / 2)), kind="wall")
    return Scene((*things, wall)), look_at(EYE, EYE + AHEAD, fov_y=1.0, far=200)


@pytest.fixture(scope="module")
def renderer(context):
    return Renderer(context, SIZE, without=frozenset({"still"}))


def picture(renderer, scene, camera, technique, error):
    renderer.draw(dressed(scene, Look(detail_error=error)), camera, named(technique))
    return renderer.read().astype(int)


def triangles(renderer, scene, camera, error):
    """How many triangles a standard frame draws, counted where they are drawn."""
    scene = dressed(scene, Look(detail_error=error))
    table = renderer._table(scene)
    slope = error * camera.pixel(SIZE[1])
    _, runs = table.sequence([np.arange(len(scene.objects))], camera, slope=slope)
    return sum(mesh._indices.size // 12 * count for mesh, _, count in runs[0])


@pytest.mark.parametrize("technique", ["standard", "dynamic"])
@pytest.mark.parametrize("distance", [4.0, 8.0, 20.0, 60.0])
def test_nothing_moves_by_a_pixel(renderer, technique, distance):
    """With half a pixel, a pixel shows what the whole models show there or in a pixel beside it:
    things thinner than a pixel, as spokes and leaves, may come and go."""
    scene, camera = hall(distance)
    whole = picture(renderer, scene, camera, technique, 0.0)
    coarse = picture(renderer, scene, camera, technique, 0.5)
    beside = [np.roll(whole, (i, j), (0, 1)) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    low, high = np.min(beside, axis=0) - SHADE, np.max(beside, axis=0) + SHADE
    other = ((coarse < low) | (coarse > high)).any(axis=2)
    changed = (np.abs(whole - coarse) > 2).any(axis=2)
    assert other.mean() <= 0.0005
    # Along walks it is a tenth of that (`bench paths`): here eight models fill the small picture.
    assert changed.mean() <= 0.015


def test_the_farther_and_the_looser_the_fewer(renderer):
    """And whole models where nothing may be off, or the eye is in their midst."""
    counts = [triangles(renderer, *hall(d), 0.5) for d in (4.0, 8.0, 20.0, 60.0)]
    assert counts == sorted(counts, reverse=True) and counts[-1] < 0.4 * counts[0]
    bounds = [triangles(renderer, *hall(20.0), e) for e in (0.0, 0.05, 0.25, 1.0)]
    assert bounds == sorted(bounds, reverse=True) and bounds[-1] < 0.6 * bounds[1]
    scene, _ = hall(20.0)
    whole = sum(len(thing.mesh.triangles) for thing in scene.objects)
    assert bounds[0] == whole
    assert triangles(renderer, *hall(0.5), 0.5) == whole


@pytest.mark.parametrize("size", [0.2, 5.0])
def test_the_bound_goes_by_the_size_in_the_world(renderer, size):
    """A thing as large and as far away in proportion is drawn in the same triangles."""
    scene, camera = hall(12.0)
    grown = [replace(o, transform=scaling(*[size] * 3) @ o.transform) for o in scene.objects]
    there = replace(camera, eye=camera.eye * size, near=camera.near * size, far=camera.far * size)
    assert triangles(renderer, Scene(tuple(grown)), there, 0.5) == triangles(
        renderer, scene, camera, 0.5
    )


def test_a_mirrored_thing_is_the_mirrored_picture(renderer):
    """Its triangles are turned round in every level."""
    mesh = MODELS["car"]()
    camera = look_at(np.array([0, 0.5, 14.0]), np.zeros(3), fov_y=0.3)
    pictures = []
    for sign in (1.0, -1.0):
        scene = Scene((Object(mesh, scaling(sign, 1, 1) @ translation(0.4, 0, 0), kind="car"),))
        pictures.append(picture(renderer, scene, camera, "standard", 2.0))
    shown = (pictures[0] != pictures[0][0, 0]).any(axis=2)
    mirrored = (pictures[1] != pictures[1][0, 0]).any(axis=2)[:, ::-1]
    # Light falls from one side, so the shapes are compared: they share all but pixels at edges.
    assert (shown != mirrored).sum() <= 0.01 * shown.sum() and shown.sum() > 500
