"""CONVENTIONS.md, paragraph by paragraph."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import pi

import numpy as np
import pytest

from seethrough.experiment.study.design.design import generator
from seethrough.renderer.events import KeyPress, PointerMove, Tick
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.models import MODELS
from seethrough.renderer.scene import geometry
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import rotation_y, translation
from seethrough.renderer.scene.visibility import shares
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.kit.controls import orbit, turned, walk
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import abstract_scene
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

AHEAD = np.array([0.0, 0.0, -1.0])
LEFT = np.array([-1.0, 0.0, 0.0])
PRIMITIVES = {
    "box": geometry.box(),
    "sphere": geometry.sphere(),
    "cylinder": geometry.cylinder(),
    "cone": geometry.cone(),
    "torus": geometry.torus(),
}
# Rounding of a few products of numbers of about 1.
ROUNDING = 1e-12


def _face_normals(mesh: geometry.Mesh) -> np.ndarray:
    """(m, 3) twice the area of each triangle, in the direction its vertices turn about."""
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def _volume(mesh: geometry.Mesh) -> float:
    """Signed volume: positive where triangles are counter-clockwise seen from outside."""
    corners = mesh.vertices[mesh.triangles]
    return float(np.einsum("ij,ij->", corners[:, 0], _face_normals(mesh)) / 6)


def test_the_camera_looks_along_minus_z() -> None:
    """Untouched axes look along −z, with x to the right and y up in the picture."""
    camera = Camera(np.zeros(3), np.eye(3))
    assert np.array_equal(camera.forward, AHEAD)
    for offset, place in ((0, 0, -5), (0, 0)), ((1, 0, -5), (1, 0)), ((0, 1, -5), (0, 1)):
        x, y, _, w = camera.projection(1.0) @ camera.view() @ (*offset, 1)
        assert w > 0
        assert np.array_equal(np.sign([x, y]), place)


def test_view_depth_is_signed_along_the_view_vector() -> None:
    """What lies beside is as deep as what lies ahead; what lies behind is negative."""
    camera = look_at(np.array([1.0, 2, 3]), np.array([1.0, 2, -7]))
    places = np.array([[1.0, 2, 0], [9, 9, 0], [1, 2, 7]])
    assert np.allclose(camera.depth(places), [3, 3, -4], rtol=0, atol=ROUNDING)


def test_positive_yaw_turns_left() -> None:
    """A quarter turn looks along −x, in every function that takes a yaw."""
    assert np.allclose(-turned(pi / 2)[:, 2], LEFT, rtol=0, atol=ROUNDING)
    assert np.allclose(rotation_y(pi / 2)[:3, :3] @ AHEAD, LEFT, rtol=0, atol=ROUNDING)
    walker = walk(BuildingParameters(), (0.0, 0.0), yaw=pi / 2)
    assert np.allclose(walker.camera().forward, LEFT, rtol=0, atol=ROUNDING)
    orbiting = orbit(AbstractParameters(), 4 / 3, yaw=pi / 2).camera()
    assert orbiting.forward[0] < -0.9


def test_what_the_participant_moves_turns_and_walks_that_way() -> None:
    """Left arrow and the pointer to the left turn left; the up arrow walks ahead, along −z."""
    still = walk(BuildingParameters(), (0.0, 0.0)).on_event(Tick(0.0))
    turning = still.on_event(KeyPress(0.0, "left")).on_event(Tick(0.1))
    assert turning.yaw > 0
    assert still.on_event(PointerMove(0.0, 0.5, 0.5, -0.1, 0.0)).yaw > 0
    walking = still.on_event(KeyPress(0.0, "up")).on_event(Tick(0.1))
    assert walking.x == 0
    assert walking.z < 0


def test_matrices_apply_to_columns() -> None:
    """A translation's offset stands in the last column."""
    assert np.array_equal(translation(1, 2, 3) @ (0, 0, 0, 1), (1, 2, 3, 1))


@pytest.mark.parametrize("name", PRIMITIVES)
def test_triangles_turn_counter_clockwise_seen_from_outside(name: str) -> None:
    """Each triangle's own normal agrees with the outward normals of its corners."""
    mesh = PRIMITIVES[name]
    outward = mesh.normals[mesh.triangles].mean(axis=1)
    assert (np.einsum("ij,ij->i", _face_normals(mesh), outward) > 0).all()
    assert _volume(mesh) > 0


@pytest.mark.parametrize("name", MODELS)
def test_models_stand_on_the_floor_right_side_out(name: str) -> None:
    """A model stands on y = 0, encloses a positive volume and has colours in [0, 1]."""
    mesh = MODELS[name]()
    assert mesh.bounds[0, 1] == pytest.approx(0, abs=1e-9)  # rounding of a size of about 1
    assert _volume(mesh) > 0
    assert mesh.colors.min() >= 0
    assert mesh.colors.max() <= 1


def test_abstract_targets_are_red_and_nothing_else_has_red() -> None:
    """(1, 0, 0) means target, no red means distractor, and all stay inside the cube."""
    scene = abstract_scene(generator(7, (0, 1)), AbstractParameters())
    assert {thing.color for thing in scene.objects if thing.target} == {(1.0, 0.0, 0.0)}
    assert {thing.color[0] for thing in scene.objects if not thing.target} == {0.0}
    assert np.abs(scene.centers).max() <= 50


@pytest.fixture(scope="module")
def renderer() -> Iterator[Renderer]:
    """Draws small pictures without a window."""
    context = standalone()
    yield Renderer(context, (80, 60))
    context.release()


def _at(x: float, y: float, **more: object) -> Object:
    """A small box ahead of the camera at the origin."""
    thing = Object(geometry.box(), translation(x, y, -10), **more)  # type: ignore[arg-type]
    return replace(thing, color=(1.0, 0.0, 0.0))


def test_pictures_begin_with_the_top_row(renderer: Renderer) -> None:
    """What lies up and to the left is in the first rows and columns, as (row, column, RGB)."""
    scene = Scene((_at(-5, 4),), background=(0.0, 0.0, 1.0))
    renderer.draw(scene, Camera(np.zeros(3), np.eye(3)), Standard())
    picture = renderer.read()
    assert picture.shape == (60, 80, 3)
    rows, columns = np.nonzero(picture[..., 0] > picture[..., 2])
    assert rows.size
    assert rows.max() < 30
    assert columns.max() < 40


def test_view_units_grow_down_from_the_upper_left(renderer: Renderer) -> None:
    """Positions: x from 0 to the aspect ratio, y down from 0 to 1, whatever the resolution."""
    scene = Scene((_at(-5, 4), _at(0, 0), _at(5, -4)))
    seen = renderer.look(scene, Camera(np.zeros(3), np.eye(3)), Standard(), (80, 60))
    first, middle, last = seen.position
    assert (0 < first).all()
    assert (first < middle).all()
    assert (middle < last).all()
    assert np.allclose(middle, (80 / 60 / 2, 1 / 2), rtol=0, atol=0.5 / 60)  # half a pixel
    assert last[0] < 80 / 60
    assert last[1] < 1


def test_id_pictures_hold_the_index_plus_one() -> None:
    """0 is background; alpha is opacity, so what is opaque in front leaves nothing behind it."""
    behind = np.array([0, 1]), np.array([1, 1]), np.ones(2)
    before = np.array([1]), np.array([2]), np.ones(1)
    objects, pixels, share = shares([behind, before], 3)
    assert sorted(zip(objects, pixels, share, strict=True)) == [(0, 0, 1.0), (1, 1, 1.0)]


def test_streams_come_from_spawn_keys() -> None:
    """A stream is SeedSequence(seed, spawn_key=…), so neighbouring seeds share nothing."""
    key = (1, 4, 2)
    expected = np.random.Generator(np.random.PCG64(np.random.SeedSequence(9, spawn_key=key)))
    assert np.array_equal(generator(9, key).random(4), expected.random(4))
    assert not np.isin(generator(9, key).random(99), generator(10, key).random(99)).any()
