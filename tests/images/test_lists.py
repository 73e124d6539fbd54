"""Lists of surfaces at a pixel: what one pass gathers is what layer by layer gives."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from seethrough.experiment.suites.technique_hard import deep, many
from seethrough.experiment.suites.technique_scenes import cases
from seethrough.renderer.errors import CannotDraw
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.gpu.rules import painters
from seethrough.renderer.gpu.rules.lists import Lists
from seethrough.renderer.gpu.rules.scope import halves
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques import changed, named

SIZE = (160, 120)
WAYS = {
    "constant": changed(named("constant"), alpha=0.4, surfaces="all"),
    "two layers": changed(named("constant"), alpha=0.4, layers=2),
    "opaque": changed(named("constant"), alpha=1.0, surfaces="all", things="everything"),
    "importance": named("importance"),
    "view_dependent": named("view_dependent"),
    "blueprint": named("blueprint"),
    "lined, all sides": changed(named("blueprint"), surfaces="all", layers=None),
}
CASES = {case.name: case for case in (*cases(), many(), deep())}


def drawn(context, case, p, size=SIZE, samples=0):
    renderer = Renderer(context, size, samples=samples)
    renderer.draw(case.scene, case.camera, p)
    return renderer.read().astype(int)


@pytest.mark.parametrize("where", CASES)
@pytest.mark.parametrize("way", WAYS)
def test_lists_and_layers_are_one_picture(context, monkeypatch, where, way):
    """But where surfaces lie at one depth: layers lose all but one of those."""
    listed = drawn(context, CASES[where], WAYS[way])
    monkeypatch.setattr(painters, "NEEDED", 10_000)  # as on a driver without OpenGL 4.3
    layered = drawn(context, CASES[where], WAYS[way])
    apart = np.abs(listed - layered).max(axis=2)
    assert (apart > 1).mean() < 0.01  # 1 of 255: sums are rounded in another order
    assert (apart == 0).mean() > 0.5


@pytest.mark.parametrize(("size", "samples"), [((157, 117), 0), ((150, 123), 4)])
@pytest.mark.parametrize("way", ["constant", "blueprint", "lined, all sides"])
def test_blocks_at_the_border_are_whole(context, monkeypatch, size, samples, way):
    """Where the picture is no whole number of blocks, and with several samples a pixel."""
    case, p = CASES["50 layers"], WAYS[way]
    listed = drawn(context, case, p, size, samples)
    monkeypatch.setattr(painters, "NEEDED", 10_000)
    apart = np.abs(listed - drawn(context, case, p, size, samples)).max(axis=2)
    # At the samples of an edge, lists and layers differ: a list is of the middle of its pixel.
    assert (apart > 1).mean() < (0.2 if samples else 0.01)
    border = np.ones(apart.shape, bool)
    border[8:-8, 8:-8] = False
    assert (apart[border] > 1).mean() <= max((apart[~border] > 1).mean(), 0.01)


@pytest.mark.parametrize("way", ["constant", "blueprint", "lined, all sides"])
def test_what_the_frame_before_left_is_not_seen(context, way):
    """A plate from nearby, then from where it ends with a block of pixels: it lay beyond before."""
    camera = Camera(np.array([0, 0, 8.0]), np.eye(3), 0.6, 0.5, 50)
    side = 2 * 24 * 8 / camera.lens(SIZE[1])  # three blocks to each side of the middle
    plate = Object(geometry.quad(side, side), transforms.rotation_x(np.pi / 2), (0.8, 0.5, 0.2))
    ball = Object(geometry.sphere(0.2, 2), transforms.translation(0, 0, -6), target=True)
    scene, p = Scene((plate, ball)), WAYS[way]
    alone, after = Renderer(context, SIZE), Renderer(context, SIZE)
    alone.draw(scene, camera, p)
    for z in (5.0, 8.0):
        after.draw(scene, replace(camera, eye=np.array([0, 0, z])), p)
    assert np.array_equal(after.read(), alone.read())
    assert (alone.read() != alone.read()[0, 0]).any(axis=2).sum() == 48 * 48


@pytest.mark.parametrize("layers", [None, 20])
def test_a_list_longer_than_is_sorted_at_once_is_added_up_whole(context, layers):
    """Forty panes behind each other, in any order."""
    rng = np.random.default_rng(5)
    panes = [
        Object(
            geometry.quad(4, 4),
            transforms.placed((0, 0, z), transforms.rotation_x(np.pi / 2)),
            tuple(rng.uniform(0.2, 1, 3)),
        )
        for z in rng.permutation(np.linspace(-4, -8, 40))
    ]
    scene, camera = Scene(tuple(panes)), Camera(np.zeros(3), np.eye(3), 0.5, 0.5, 50)
    p = changed(named("constant"), alpha=0.08, layers=layers)
    renderer = Renderer(context, SIZE)
    renderer.draw(scene, camera, p)
    truth = exact(scene, camera, p if layers is None else changed(p, layers=None), SIZE)
    off = np.abs(renderer.read() - 255 * truth.picture).max(axis=2)[~truth.near_edge]
    assert len(off) > 10_000
    # Layers are half floats: 40 of them are .5 of 255 off at most, and pictures whole numbers.
    if layers is None:
        assert off.max() <= 1.0
    else:  # 20 panes more cover what shows through the first: .92 ^ 20 = .19 of it
        assert 5 < off.max() < 0.2 * 255


@pytest.mark.parametrize("limit", [500, 5000, 40_000])
@pytest.mark.parametrize("way", ["constant", "blueprint"])
def test_what_one_buffer_cannot_hold_is_drawn_otherwise(context, monkeypatch, limit, way):
    """In parts, or with lines layer by layer; the same picture, and the same layers for who
    looks."""
    case, p = CASES["50 layers"], WAYS[way]
    whole, seen = drawn(context, case, p), looked(context, case, p)
    made = Lists.__init__

    def small(self, *args, **more):
        made(self, *args, **more)
        self.limit = limit
        self.surfaces.orphan(100 * self.words * 4)

    monkeypatch.setattr(Lists, "__init__", small)
    again = np.abs(drawn(context, case, p) - whole)
    # Layers drawn anew are added up in a buffer of another kind: a sum may round otherwise.
    assert again.max() <= (way == "blueprint") and (again > 0).mean() < 0.001
    again = looked(context, case, p)
    # Pixels of a layer come in another order, so their sums are rounded otherwise.
    assert_allclose(again.area, seen.area, rtol=1e-12)
    assert_allclose(again.contrast, seen.contrast, rtol=1e-12)


def looked(context, case, p):
    return Renderer(context, SIZE).look(case.scene, case.camera, p, SIZE)


def test_halves_are_all_of_a_rectangle():
    for scope in ((3, 5, 7, 4), (0, 0, 1, 9), (2, 2, 9, 1), (1, 1, 2, 1)):
        hit = np.zeros((20, 20), int)
        for x, y, width, height in halves(scope):
            hit[y : y + height, x : x + width] += 1
        x, y, width, height = scope
        assert hit[y : y + height, x : x + width].min() == hit.max() == 1
        assert hit.sum() == width * height
    with pytest.raises(CannotDraw, match="at one pixel"):
        halves((4, 4, 1, 1))
