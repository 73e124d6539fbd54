"""Several samples a pixel: what is drawn in parts must not show where the parts end."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seethrough import registry
from seethrough.experiment.gallery.gallery_scenes import stage
from seethrough.renderer.events import PointerMove
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques import changed, named
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard

SIZE = (200, 150)
CAMERA = look_at(np.array([0, 0, 12.0]), np.zeros(3), fov_y=0.6, near=1, far=40)
RED = (0.9, 0.1, 0.1)
BASE = DynamicTransparency(width=6)


def panes() -> Scene:
    """Three targets of different sizes, far apart, each behind panes that cross each other."""
    objects = []
    for x, y, r in ((-3.0, 1.2, 0.9), (0.4, -1.8, 0.4), (3.2, 1.0, 0.6)):
        for turn in (0.5, -0.4):
            place = transforms.placed((x, y, 1.0), transforms.rotation_y(turn))
            color = (0.2, 0.5, 0.5 + turn)
            objects.append(Object(geometry.box(2.2 * r, 2.2 * r, 0.1), place, color))
        ball = Object(
            geometry.sphere(r, 2), transforms.translation(x, y, -1), (0.9, 0.1, 0.1), True
        )
        objects.append(ball)
    return Scene(tuple(objects))


def drawn(context, technique, samples=4):
    renderer = Renderer(context, SIZE, samples)
    renderer.draw(panes(), CAMERA, technique)
    return renderer.read().astype(int), renderer.plan


@pytest.mark.parametrize(
    "technique",
    [
        replace(BASE, exact=True),
        replace(BASE, doubt=0.0),
        replace(BASE, order="centers"),
        replace(BASE, mask="ring"),
        replace(BASE, mask="circle"),
    ],
    ids=("exact", "parts", "levels", "ring", "circle"),
)
def test_beyond_the_masks_the_picture_is_the_standard_picture(context, technique):
    """Pixel for pixel. llvmpipe lets half the samples beside a scissored part pass: they showed as
    grey lines along the left and the lower side of each part."""
    picture, plan = drawn(context, technique)
    plain, _ = drawn(context, Standard())
    beyond = np.ones(SIZE[::-1], dtype=bool)
    for left, top, right, bottom in plan.reach[plan.masked]:
        rows = slice(max(int(np.floor(top)), 0), int(np.ceil(bottom)))
        beyond[rows, max(int(np.floor(left)), 0) : int(np.ceil(right))] = False
    assert 0.2 < beyond.mean() < 0.9
    np.testing.assert_array_equal(picture[beyond], plain[beyond])


def test_a_part_sorted_by_pixel_does_not_show_in_its_mask(context):
    """Balls intersect before a large target: only they are sorted by pixel, and beside that
    part the flat pane and the target show what one sample shows."""
    objects = [
        Object(geometry.box(7, 5, 0.1), transforms.translation(0, 0, -3), RED, True),
        Object(geometry.box(6, 4, 0.1), transforms.translation(0, 0, -1), (0.2, 0.6, 0.3)),
    ]
    for x in (-1.2, 1.3):
        for aside in (0.3, -0.2):
            place = transforms.translation(x + aside, 0.3 * x, 1.0 + aside)
            objects.append(Object(geometry.sphere(0.6, 3), place, (0.2, 0.5, 0.5 + aside)))
    scene, technique = Scene(tuple(objects)), replace(BASE, doubt=0.0)
    pictures = []
    for samples in (0, 4):
        renderer = Renderer(context, SIZE, samples)
        renderer.draw(scene, CAMERA, technique)
        pictures.append(renderer.read().astype(int))
    assert len(renderer.plan.exact) == 2 and len(renderer.plan.levels)
    checked = 0
    for left, top, right, bottom in renderer.plan.exact.tolist():
        for rows, columns in (
            (slice(top, bottom), slice(left - 2, left)),
            (slice(top, bottom), slice(right, right + 2)),
            (slice(top - 2, top), slice(left, right)),
            (slice(bottom, bottom + 2), slice(left, right)),
        ):
            one, four = pictures[0][rows, columns], pictures[1][rows, columns]
            # Where the balls' own edges touch the border, the samples are meant to differ.
            assert (np.abs(one - four).max(axis=2) > 2).mean() < 0.2
            checked += 1
    assert checked == 8


@pytest.mark.parametrize("name", registry.known("technique"))
@pytest.mark.parametrize("size", [SIZE, (151, 150), (64, 200)])
def test_several_samples_change_nothing_but_edges(context, name, size):
    """A triangle that covers the picture may be cut in two, and pixels along the cut drawn twice:
    lists that the first took away showed as a line from corner to corner."""
    scene, camera = stage()
    pictures = []
    for samples in (0, 4):
        renderer = Renderer(context, size, samples)
        renderer.draw(scene, camera, named(name))
        pictures.append(renderer.read().astype(int))
    plain, smooth = pictures
    around = np.stack([np.roll(plain, (y, x), (0, 1)) for y in (-1, 0, 1) for x in (-1, 0, 1)])
    flat = np.ptp(around, axis=0).max(axis=2) <= 4  # of 255: shading alone
    assert flat.mean() > 0.2
    # Gaps between the planks that are thinner than a pixel lie between what is flat: few.
    apart = np.abs(plain - smooth).max(axis=2)[flat] > 6
    assert apart.mean() < 0.003


def test_nothing_shows_between_what_a_rule_is_asked_about_and_its_neighbour(context):
    """Two panes that meet within a pixel, the first of which fades elsewhere."""
    color = (0.3, 0.3, 0.3)
    panes = [
        Object(geometry.box(3, 6, 0.1), transforms.translation(x, 0, 0), color)
        for x in (-1.487, 1.513)
    ]
    ball = Object(geometry.sphere(0.2, 2), transforms.translation(-2, 0, -2), RED, True)
    renderer = Renderer(context, SIZE, 4)
    fade = changed(named("fade"), radius=0.05, softness=0.05)
    state, _ = fade.technique.on_event(
        fade, fade.technique.begin(fade), PointerMove(0.0, 0.4, 0.5, 0.0, 0.0), None
    )
    renderer.draw(Scene((*panes, ball)), CAMERA, fade, state=state)
    assert renderer.plan.ruled.tolist() == [0]  # the other lies beyond the pointer's reach
    row = renderer.read()[20].astype(int)  # above all of what fades
    inside = row[60:140]
    assert np.abs(inside - inside[0]).max() <= 3  # shading alone; the sky is brighter by 160
