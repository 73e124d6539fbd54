"""Scenes that break renderers: cameras inside things, odd targets, far numbers, odd sizes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from sample_scenes import SHAPES, before_column, column

from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard

SIZE = (96, 72)
TECHNIQUE = DynamicTransparency(width=6)
SORTED = replace(TECHNIQUE, exact=True)
ALL = (TECHNIQUE, SORTED, Standard())
RED = (0.9, 0.1, 0.1)


def at(shape, x, y, z, scale=1.0, turn=None, **kinds):
    return Object(SHAPES[shape], transforms.placed((x, y, z), turn, scale), **kinds)


def agree(context, scene, camera, techniques=ALL, size=SIZE, share=0.0, edges=0.03):
    """GPU and reference within 2/255 off the edges, but for a `share` of the pixels."""
    renderer = Renderer(context, size)
    for technique in techniques:
        renderer.draw(scene, camera, technique)
        truth = exact(scene, camera, technique, size)
        apart = np.abs(renderer.read() - truth.picture * 255).max(axis=2)[~truth.near_edge]
        assert truth.near_edge.mean() <= edges
        assert (apart > 2).sum() <= share * apart.size, (technique, apart.max())


def towards_minus_z(eye=(0.0, 0.0, 0.0), near=0.1, far=100.0):
    return Camera(np.asarray(eye, float), np.eye(3), 0.9, near, far)


CENTRE_PIECES = (
    at(0, 0, 0, 0, 2.0, color=(0.3, 0.5, 0.9)),
    at(3, 0.5, 0, -6, 1.5, color=RED, target=True),
    at(2, -0.6, 0.3, -4, 1.0, color=(0.3, 0.8, 0.3)),
)


@pytest.mark.parametrize("eye", [(0, 0, 0), (0, 0, 1.0), (0, 0.2, -3.35), (0.3, 0, -5.8)])
def test_camera_inside_an_object_or_on_its_face(context, eye):
    """In the sphere's middle, on a box's face, inside the torus that is the target."""
    agree(context, Scene(CENTRE_PIECES), towards_minus_z(eye))


@pytest.mark.parametrize("z", [-0.35, -0.6, 0.2])
@pytest.mark.parametrize("shape", range(4))
def test_target_cut_by_the_near_plane(context, shape, z):
    """With its mask open towards the viewer; an occluder is cut as well."""
    scene = Scene(
        (
            at(shape, 0.2, 0.1, z - 0.4, 0.8, color=RED, target=True),
            Object(geometry.box(3, 0.5, 0.05), transforms.translation(0, 0, -0.2), (0.2, 0.4, 0.9)),
            at(0, -0.5, -0.3, -4, color=(0.2, 0.8, 0.3)),
        )
    )
    agree(context, scene, towards_minus_z(near=0.15), (SORTED, Standard()))
    Renderer(context, SIZE).draw(scene, towards_minus_z(near=0.15), TECHNIQUE)


@pytest.mark.parametrize(
    ("x", "z", "scale"),
    [(0.0, -50.0, 0.01), (3.4, -6.0, 1.0), (0.0, 6.0, 1.0), (40.0, -6.0, 1.0), (-3.9, -6.0, 1.0)],
)
def test_target_tiny_or_half_or_wholly_out_of_view(context, x, z, scale):
    """Smaller than a pixel; half outside, with its mask still in; behind the camera; far away."""
    scene = Scene(
        (
            at(3, x, 0.0, z, scale, color=RED, target=True),
            Object(geometry.box(9, 9, 0.1), transforms.translation(0, 0, -3), (0.2, 0.4, 0.9)),
        )
    )
    agree(context, scene, towards_minus_z())


@pytest.mark.parametrize("targets", [0, 1, 200])
def test_none_one_and_two_hundred_targets(context, targets):
    """All in view, objects overlapping by chance: the exact path is exact, the fast one near."""
    rng = np.random.default_rng(5)
    objects = []
    for i in range(200):
        turn, place = transforms.random_rotation(rng), rng.uniform(-4, 4, 3)
        color = tuple(rng.uniform(0.2, 1, 3))
        objects.append(at(i % 4, *place, 0.35, turn, color=color, target=i < targets))
    camera = look_at(np.array([0, 0, 14.0]), np.zeros(3), fov_y=0.7, near=1, far=60)
    agree(context, Scene(tuple(objects)), camera, (SORTED,))
    # Where objects straddle the depth at which a mask lies beside its target, order is not enough.
    agree(context, Scene(tuple(objects)), camera, (TECHNIQUE,), share=0.02)


def test_fifty_targets_in_one_line_of_sight(context):
    """All targets, 50 layers deep: .3 of .3 of …, in 16-bit floats within 2/255 of float64."""
    objects = tuple(
        at(0, 0, 0, -2.5 * i, color=tuple(np.random.default_rng(i).random(3)), target=True)
        for i in range(50)
    )
    camera = look_at(np.array([0, 0, 4.0]), np.zeros(3), fov_y=0.9, near=0.5, far=300)
    agree(context, Scene(objects), camera, (TECHNIQUE, replace(TECHNIQUE, combine="min")))
    agree(context, Scene(objects), camera, (SORTED, replace(SORTED, combine="min")))


def test_two_hundred_layers_do_not_drift(context):
    """Panes before one target, α .05 each, leave the float64 picture within 1/255."""
    panes = tuple(
        Object(
            geometry.box(6, 6, 0.01),
            transforms.translation(0, 0, -0.1 * i),
            tuple(np.random.default_rng(i).random(3)),
        )
        for i in range(200)
    )
    scene = Scene((*panes, at(2, 0, 0, -22, 2.0, color=RED, target=True)))
    technique = DynamicTransparency(alpha_target=0.05, alpha_edge=0.02, width=4)
    camera = towards_minus_z((0, 0, 5))
    renderer = Renderer(context, (48, 36))
    renderer.draw(scene, camera, technique)
    truth = exact(scene, camera, technique, (48, 36))
    apart = np.abs(renderer.read() - truth.picture * 255).max(axis=2)[~truth.near_edge]
    # Half a step of rounding on top of the 1/255 that blending may cost.
    assert apart.max() <= 1.5


@pytest.mark.parametrize("distance", [0.0, 0.4, 1.0, 2.0])
def test_objects_that_coincide_intersect_or_touch(context, distance):
    """Two boxes at one place, crossing, and face to face in one plane, with a target behind."""
    turn = transforms.rotation_y(0.4)
    boxes = [
        Object(geometry.box(2, 2, 2), transforms.placed((x, 0, 0), turn), color)
        for x, color in ((0.0, (0.2, 0.4, 0.9)), (distance, (0.9, 0.7, 0.2)))
    ]
    scene = Scene((*boxes, at(0, 0.5, 0, -5, 1.5, color=RED, target=True)))
    camera = look_at(np.array([0, 1.0, 8.0]), np.zeros(3), fov_y=0.8, near=0.5, far=50)
    renderer = Renderer(context, SIZE)
    renderer.draw(scene, camera, replace(TECHNIQUE, doubt=0.0))  # leave nothing to chance
    fast = renderer.read().astype(int)
    renderer.draw(scene, camera, SORTED)
    if distance:  # which of two equal surfaces is in front is rounding
        agree(context, scene, camera, (SORTED,), share=0.002)
        assert (np.abs(fast - renderer.read()).max(axis=2) > 2).mean() < 0.002


def test_walls_longer_than_the_room_they_hide(context):
    """A wall whose centre lies farther away than the target that it hides."""
    wall = geometry.box(0.2, 4, 40)
    scene = Scene(
        (
            Object(wall, transforms.translation(-1.5, 0, -19), (0.7, 0.7, 0.6)),
            at(3, -4.0, 0, -9, color=RED, target=True),
            at(0, 1.0, 0, -12, color=(0.3, 0.6, 0.9), target=True),
        )
    )
    centers = towards_minus_z().depth(scene.centers)
    assert centers[0] > centers[1]
    agree(context, scene, towards_minus_z())


def test_coordinates_at_a_million_with_details_of_a_hundredth(context):
    """The picture is that of the same scene at the origin."""
    scene, camera = column(4, count=8), before_column(4)
    small = transforms.scaling(0.01)
    shift = np.array([1e6, -1e6, 1e6])
    here = Scene(tuple(replace(o, transform=small @ o.transform) for o in scene.objects))
    moved = tuple(
        replace(o, transform=transforms.translation(*shift) @ o.transform) for o in here.objects
    )
    near = replace(camera, eye=camera.eye * 0.01, near=0.005, far=2.0)
    far = replace(near, eye=near.eye + shift)
    renderer = Renderer(context, SIZE)
    renderer.draw(here, near, TECHNIQUE)
    expected = renderer.read().astype(int)
    renderer.draw(Scene(moved), far, TECHNIQUE)
    # A coordinate of 1e6 has 1e-10 in float64: a millionth of a pixel, but edges may flip.
    assert (np.abs(renderer.read() - expected).max(axis=2) > 2).mean() < 0.002


def test_near_to_far_of_one_to_a_million(context):
    """A thing at arm's length before a mountain range: the range used is that of what is seen."""
    scene = Scene(
        (
            at(0, 0.02, 0, -0.4, 0.1, color=(0.3, 0.5, 0.9)),
            at(2, 0, 0, -3.0, 0.8, color=RED, target=True),
            at(1, 900, 0, -60_000, 9_000.0, color=(0.4, 0.8, 0.4)),
        )
    )
    agree(context, scene, towards_minus_z(near=0.1, far=100_000.0))


@pytest.mark.parametrize("size", [(1, 1), (1, 200), (301, 7)])
def test_odd_windows(context, size):
    """Down to one pixel."""
    agree(context, column(1, count=8), before_column(1), size=size, share=0.02, edges=1.0)


def test_a_window_of_4096_pixels_resized_while_drawing(context):
    """Large and back: the small picture is the same as before; parts are sorted in bands."""
    scene, camera = column(2, count=6), before_column(2)
    renderer = Renderer(context, SIZE)
    renderer.draw(scene, camera, TECHNIQUE)
    before = renderer.read()
    renderer.resize((4096, 4096))
    renderer.draw(scene, camera, TECHNIQUE)
    assert renderer.read().shape == (4096, 4096, 3)
    renderer.resize(SIZE)
    renderer.draw(scene, camera, TECHNIQUE)
    np.testing.assert_array_equal(renderer.read(), before)


@pytest.mark.parametrize("size", [(0, 10), (10, -1), (20000, 10), (1.5, 2)])
def test_impossible_windows_are_refused(context, size):
    """By name."""
    with pytest.raises(ValueError, match=r"size = .*, expected \(width, height\)"):
        Renderer(context, size)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_transforms_that_are_not_finite_are_refused_by_name(value):
    """Before anything is drawn."""
    matrix = np.eye(4)
    matrix[0, 3] = value
    with pytest.raises(ValueError, match="transform of lamp has a value that is not finite"):
        Object(SHAPES[0], matrix, kind="lamp")


def test_mirrored_objects_show_their_outside(context):
    """A transform of negative determinant turns the triangles round."""
    mirror = transforms.placed((0, 0, -5), transforms.rotation_y(0.5), (-1, 1, 1))
    scene = Scene(
        (
            Object(SHAPES[1], mirror, RED, target=True),
            Object(SHAPES[3], transforms.placed((0, 0, -3), None, (1, -1, 1)), (0.2, 0.5, 0.9)),
        )
    )
    agree(context, scene, towards_minus_z())


def test_an_empty_scene_is_its_background(context):
    """No objects, no error."""
    renderer = Renderer(context, SIZE)
    for technique in (Standard(), TECHNIQUE, SORTED):
        renderer.draw(Scene((), (0.2, 0.4, 0.6)), towards_minus_z(), technique)
        np.testing.assert_array_equal(renderer.read()[3, 3], [51, 102, 153])
        assert renderer.look(Scene(()), towards_minus_z(), technique).pixels.shape == (0,)


def test_slices_lose_no_fragment(context):
    """Drivers have lost writes: the fragments in all slices are as many as the reference has."""
    from seethrough.renderer.reference.pixel_fragments import fragments

    scene, camera = column(9, count=12), before_column(9)
    renderer = Renderer(context, SIZE)
    seen = renderer.look(scene, camera, replace(SORTED, alpha_target=0.02), SIZE)
    truth = exact(scene, camera, replace(SORTED, alpha_target=0.02), SIZE)
    shown = (truth.weights >= 1 / 64).sum(axis=(1, 2))
    edge = fragments(scene, camera, SIZE).near_edge.sum()
    assert np.abs(seen.pixels - shown).sum() <= max(2 * edge, 8)
