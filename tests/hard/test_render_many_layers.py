"""More objects and masks on one line of sight than the fast programs hold, and than fit at once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from sample_scenes import before_column, column

from seethrough.renderer.gpu.per_pixel import exact_painter
from seethrough.renderer.gpu.per_pixel.exact_painter import bands
from seethrough.renderer.gpu.per_pixel.pixel_cells import MOST, Cells
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

SIZE = (36, 27)
CAMERA = look_at(np.array([0, 0, 9.0]), np.zeros(3), fov_y=0.7, near=0.5, far=60)
BASE = DynamicTransparency(alpha_target=0.04, alpha_edge=0.02, width=3, exact=True)


def panes(count: int) -> Scene:
    """Thin panes that cross each other, all before one target."""
    rng = np.random.default_rng(1)
    objects = [
        Object(
            geometry.box(7, 5, 0.01),
            transforms.placed((0, 0, 2 - 0.03 * i), transforms.rotation_y(rng.uniform(-0.3, 0.3))),
            tuple(rng.random(3)),
        )
        for i in range(count)
    ]
    ball = Object(geometry.sphere(1.3, 2), transforms.translation(0.4, 0, -9), (1, 0.1, 0), True)
    return Scene((*objects, ball))


def line(count: int) -> Scene:
    """Targets one behind the other, each with a mask over all that are nearer."""
    rng = np.random.default_rng(2)
    ball = geometry.sphere(1.5, 1)
    places = [transforms.translation(0.02 * i, 0, 2 - 0.2 * i) for i in range(count)]
    return Scene(tuple(Object(ball, place, tuple(rng.random(3)), True) for place in places))


def furthest(context, scene, technique):
    renderer = Renderer(context, SIZE)
    renderer.draw(scene, CAMERA, technique)
    truth = exact(scene, CAMERA, technique, SIZE)
    # Many crossings: many pixels have one within 1/256 pixel, where float32 may sort otherwise.
    assert truth.near_edge.mean() < 0.75
    return np.abs(renderer.read() - truth.picture * 255).max(axis=2)[~truth.near_edge].max()


@pytest.mark.parametrize(
    "options",
    [{}, {"granularity": "object"}, {"layers": 100}, {"min_transmittance": 0.4}],
    ids=str,
)
def test_two_hundred_panes_that_cross_before_a_target(context, options):
    """Within 1/255 of the reference, and half a step of rounding."""
    scene = panes(200)
    assert len(scene.objects) > 3 * MOST
    assert furthest(context, scene, replace(BASE, **options)) <= 1.5


@pytest.mark.parametrize("options", [{}, {"combine": "min"}, {"granularity": "object"}], ids=str)
def test_a_hundred_masks_in_one_line_of_sight(context, options):
    """Every object but the last lies before a mask of each that is farther."""
    scene = line(100)
    technique = replace(BASE, alpha_target=0.9, alpha_edge=0.8, **options)
    assert furthest(context, scene, technique) <= 1.5


def test_a_hundred_panes_in_doubt_before_a_part_of_a_target(context):
    """Only there are they sorted: a ball in the corner between them is neither lost nor unseen."""
    target = Object(geometry.box(9, 7, 0.2), transforms.translation(0, 0, -4), (1, 0.1, 0), True)
    ball = Object(geometry.sphere(0.5, 2), transforms.translation(0.9, -0.7, 0), (0, 0.4, 0.9))
    crossed = [
        replace(pane, transform=transforms.translation(*move) @ pane.transform @ np.diag(scale))
        for scale, move in (((0.5, 0.1, 1, 1), (0, 1.2, 0)), ((0.1, 0.6, 1, 1), (-1.3, 0, 0)))
        for pane in panes(36).objects[:-1]
    ]
    scene, size = Scene((*crossed, ball, target)), (100, 75)
    renderer, sorted_ = Renderer(context, size), Renderer(context, size)
    technique = replace(BASE, exact=False, doubt=0.0)
    renderer.draw(scene, CAMERA, technique)
    assert len(renderer.plan.doubtful) and len(renderer.plan.levels)
    assert len(renderer.plan.exact) == 1
    sorted_.draw(scene, CAMERA, BASE)
    apart = np.abs(renderer.read().astype(int) - sorted_.read()).max(axis=2)
    # A triangle's edge may fall to the other side of a pixel's centre in a cell.
    assert (apart > 2).mean() <= 0.01
    assert renderer.look(scene, CAMERA, technique, size).pixels[-2] > 50


def test_what_a_hundred_layers_show_is_found_as_drawn(context):
    """The shares of a pixel come from the same program."""
    scene = panes(100)
    technique = replace(BASE, alpha_target=0.02)
    seen = Renderer(context, SIZE).look(scene, CAMERA, technique, SIZE)
    truth = exact(scene, CAMERA, technique, SIZE)
    shown = (truth.weights >= 1 / 64).sum(axis=(1, 2))
    assert abs(int(seen.pixels[-1]) - int(shown[-1])) <= 4
    np.testing.assert_allclose(seen.pixels.sum(), shown.sum(), rtol=0.02)


def test_parts_are_cut_to_fit_into_a_texture(context, monkeypatch):
    """As on a card whose textures are small: the same picture, in bands."""
    scene, camera = column(3, count=10), before_column(3)
    size = (96, 72)
    renderer = Renderer(context, size)
    technique = DynamicTransparency(exact=True)
    renderer.draw(scene, camera, technique)
    whole = renderer.read()
    painter = renderer._layer(False, scene)._exact
    heights = []
    arrange = Cells._arrange
    monkeypatch.setattr("seethrough.renderer.gpu.per_pixel.pixel_cells.WIDTH", 96)
    painter._tallest = 60
    painter._slices = painter._entries = None

    def noted(cells, size, count):
        arrange(cells, size, count)
        heights.append(cells.whole[1])

    monkeypatch.setattr(Cells, "_arrange", noted)
    renderer.draw(replace(scene), camera, technique)
    assert max(heights) <= 60 and len(heights) >= 8
    np.testing.assert_array_equal(renderer.read(), whole)


@pytest.mark.parametrize(("cells", "width"), [(60, 1280), (64, 1100), (200, 800), (3, 16000)])
def test_bands_cover_a_part_and_fit(cells, width):
    """Row after row, none left out, in textures of 16,384 rows and 24 million texels."""
    found = bands(np.array([7, 5, 7 + width, 965]), cells, 16384)
    assert [b[1] for b in found] == [5, *(b[3] for b in found[:-1])] and found[-1][3] == 965
    for left, top, right, bottom in found:
        columns = max(1, 2048 // (right - left))
        assert -(-cells // columns) * (bottom - top) <= 16384
        assert cells * (right - left) * (bottom - top) <= exact_painter.TEXELS


def test_ring_masks_of_two_hundred_targets(context, monkeypatch):
    """Their grids lie in rows, for above each other 200 of 128 cells fit into no texture. A few
    are the same picture in rows, above each other, and in textures that were there before."""
    ball, rng = geometry.sphere(0.12, 1), np.random.default_rng(5)
    wall = Object(geometry.box(9, 7, 0.1), transforms.translation(0, 0, 2), (0.2, 0.5, 0.8))
    places = [np.array([0.34 * (i % 20) - 3.2, 0.44 * (i // 20) - 2, 0]) for i in range(200)]
    balls = [Object(ball, transforms.placed(p), tuple(rng.random(3)), True) for p in places]
    technique = DynamicTransparency(mask="ring", width=4, ring_size=128)
    some = Scene((wall, *balls[90:120]))
    pictures = []
    for width in (128, 2048):
        monkeypatch.setattr("seethrough.renderer.gpu.device.tiles.WIDTH", width)
        renderer = Renderer(context, (120, 90))
        renderer.draw(some, CAMERA, technique)
        pictures.append(renderer.read())
    assert (
        renderer.draw(Scene((wall, *balls)), CAMERA, replace(technique, ring_size=150)).masks > 190
    )
    renderer.draw(some, CAMERA, technique)
    pictures.append(renderer.read())
    np.testing.assert_array_equal(pictures[0], pictures[1])
    np.testing.assert_array_equal(pictures[0], pictures[2])
    renderer.draw(some, CAMERA, replace(technique, mask="outline"))
    assert (renderer.read() != pictures[0]).any()
