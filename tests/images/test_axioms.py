"""The axioms of dynamic transparency (Elmqvist2009 §III-C), measured in pictures, and the
guarantee."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from sample_scenes import SHAPES, before_column, column

from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.reference.pixel_fragments import fragments
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard

SIZE = (120, 90)
TECHNIQUE = DynamicTransparency(width=6)
CAMERA = look_at(np.array([0.0, 0.0, 10.0]), np.zeros(3), fov_y=0.6, near=0.5, far=100.0)


def panel(z, color=(0.2, 0.4, 0.9), **kinds):
    return Object(geometry.box(8, 8, 0.2), transforms.translation(0, 0, z), color, **kinds)


def ball(z, color=(1.0, 0.0, 0.0), target=True):
    return Object(SHAPES[0], transforms.translation(0, 0, z), color, target=target)


def centre(context, *objects, technique=TECHNIQUE):
    """Colour of the pixel in the middle, [0, 1]."""
    renderer = Renderer(context, SIZE)
    renderer.draw(Scene(objects), CAMERA, technique)
    return renderer.read()[SIZE[1] // 2, SIZE[0] // 2] / 255.0


def test_a_target_behind_an_occluder_is_visible_by_one_minus_alpha(context):
    """The middle pixel shows .3 of the panel and .7 of the ball; one step of rounding each."""
    alone = centre(context, ball(-3), technique=Standard())
    before = centre(context, panel(2), technique=Standard())
    both = centre(context, panel(2), ball(-3))
    np.testing.assert_allclose(both, 0.3 * before + 0.7 * alone, atol=2 / 255)


def test_what_lies_behind_a_target_stays_opaque(context):
    """A panel behind the target and its mask shows nothing of what is behind itself."""
    scene = (ball(3), panel(0), ball(-3, (0, 1, 0), target=False))
    technique = replace(TECHNIQUE, width=20)
    renderer = Renderer(context, SIZE)
    renderer.draw(Scene(scene), CAMERA, technique)
    shown = renderer.read()
    renderer.draw(Scene(scene), CAMERA, Standard())
    np.testing.assert_array_equal(shown, renderer.read())


def test_an_occluder_away_from_the_target_stays_opaque(context):
    """Farther than the mask's width from the target's outline, the picture is the standard one."""
    scene = Scene((panel(2), ball(-3)))
    renderer = Renderer(context, SIZE)
    renderer.draw(scene, CAMERA, TECHNIQUE)
    shown = renderer.read()
    renderer.draw(scene, CAMERA, Standard())
    changed = (shown != renderer.read()).any(axis=2)
    rows, columns = np.nonzero(changed)
    from_middle = np.hypot(rows + 0.5 - SIZE[1] / 2, columns + 0.5 - SIZE[0] / 2)
    radius = SIZE[1] / 2 / np.tan(0.3) / 13.0  # of the ball's outline, from above at most
    assert changed.any()
    assert from_middle.max() <= radius * 1.01 + TECHNIQUE.width


def test_impenetrable_objects_never_turn_transparent(context):
    """An impenetrable panel hides the target; a penetrable one in front of it shows the panel."""
    hidden = centre(context, panel(2, impenetrable=True), ball(-3))
    np.testing.assert_array_equal(
        hidden, centre(context, panel(2, impenetrable=True), technique=Standard())
    )
    wall = centre(context, panel(1, (0.9, 0.9, 0.2), impenetrable=True), technique=Standard())
    front = centre(context, panel(3), technique=Standard())
    both = centre(context, panel(3), panel(1, (0.9, 0.9, 0.2), impenetrable=True), ball(-3))
    np.testing.assert_allclose(both, 0.3 * front + 0.7 * wall, atol=2 / 255)


def test_objects_stay_solid(context):
    """A torus edge-on in front of a target: its near side shows the target, not its far side."""
    turned = transforms.placed((0, 0, 2), transforms.rotation_x(0.15), 2.0)
    ring = Object(SHAPES[3], turned, (0.1, 0.8, 0.3))
    without_back = Renderer(context, SIZE).look(Scene((ring, ball(-3))), CAMERA, TECHNIQUE, SIZE)
    assert without_back.weight[0] > 0
    layers = Renderer(context, SIZE).layers(Scene((ring, ball(-3))), CAMERA, TECHNIQUE, SIZE)
    drawn = sum((ids == 1).astype(int) for ids, _ in layers)
    assert drawn.max() == 1  # one surface of the ring at every pixel
    renderer = Renderer(context, SIZE)
    renderer.draw(Scene((ring, ball(-3))), CAMERA, TECHNIQUE)
    fast = renderer.read().astype(int)
    renderer.draw(Scene((ring, ball(-3))), CAMERA, replace(TECHNIQUE, exact=True))
    assert np.abs(fast - renderer.read()).max() <= 2


def test_nested_dolls_in_a_group_are_drawn_from_the_inside_out(context):
    """Boxes about one centre: no plane separates them, their order in the group is the order."""
    sizes = (0.8, 1.4, 2.0)
    colors = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    dolls = tuple(
        Object(geometry.box(s, s, s), np.eye(4), c, target=s == 0.8, group=7)
        for s, c in zip(sizes, colors, strict=True)
    )
    red, green, blue = (
        centre(context, replace(doll, target=False, group=None), technique=Standard())
        for doll in dolls
    )
    expected = 0.3 * blue + 0.7 * (0.3 * green + 0.7 * red)
    renderer = Renderer(context, SIZE)
    renderer.draw(Scene(dolls), CAMERA, TECHNIQUE)
    assert renderer.plan is not None
    assert not len(renderer.plan.exact)  # the group says the order
    middle = renderer.read()[SIZE[1] // 2, SIZE[0] // 2] / 255.0
    np.testing.assert_allclose(middle, expected, atol=2 / 255)


def transmittances(layers, scene):
    """(n, h, w) what the layers drawn over each object leave of it; 0 where it was not drawn."""
    found = np.zeros((len(scene.objects), *layers[0][0].shape))
    left = np.ones(layers[0][0].shape)
    rows, columns = np.indices(left.shape)
    for ids, opacity in reversed(layers):
        there = ids > 0
        found[ids[there] - 1, rows[there], columns[there]] = left[there]
        left = np.where(there, left * (1 - opacity), left)
    return found


@pytest.mark.parametrize("tau", [0.2, 0.5])
def test_a_thousand_frames_keep_the_least_transmittance(context, tau):
    """At every pixel of every target that nothing impenetrable and no part of itself hides.

    500 frames for each τ: 50 worlds, 10 views of each, from the layers as they were drawn. Where
    the target is, the reference says; pixels on projected edges are left out.
    """
    size = (40, 30)
    renderer = Renderer(context, size)
    technique = DynamicTransparency(0.6, width=4, min_transmittance=tau)
    worst, pixels, reduced = 1.0, 0, 0
    for world in range(50):
        scene = column(100 + world, 14, targets=0.3, impenetrable=0.05, spread=0.5)
        for view in range(10):
            camera = before_column(view)
            seen = fragments(scene, camera, size)
            wall = seen.depth[scene.impenetrable].min(axis=0, initial=np.inf)
            shows = (seen.depth < wall) & scene.targets[:, None, None] & ~seen.near_edge
            kept = transmittances(renderer.layers(scene, camera, technique, size), scene)[shows]
            worst = min(worst, kept.min(initial=1.0))
            pixels += kept.size
            reduced += int((kept < tau + 0.1).sum())
    assert pixels > 15_000
    assert reduced > 100  # the guarantee had something to do
    assert worst >= tau - 1 / 255
