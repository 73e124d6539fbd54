"""Each key of [look]: the picture is the exact reference's, by every painter, and what the key is
for is in it. Other ways to work it out: closed forms, sums over many samples."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seethrough.experiment.suites import technique_scenes
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.look.dressed import dressed
from seethrough.renderer.look.shadows import _mark, floor_map
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.look import PLAIN, Look
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques import named

SIZE = (120, 90)
CASES = {case.name: case for case in technique_scenes.cases()}
LOOKS = {
    "fog": Look(fog=9.0, fog_start=3.0),
    "grid": Look(floor_grid=0.8),
    "shadows": Look(ground_shadows=0.9, shadow_reach=4.0),
    "all": Look(fog=12.0, floor_grid=1.5, ground_shadows=0.5, shadow_reach=6.0),
}
# One for each painter: depth buffer, levels and masks, pixels sorted, removal, peels.
WAYS = ("standard", "dynamic", "cutaway", "view_dependent")
EYE = np.array([0.0, 4.0, 8.0])


@pytest.fixture(scope="module")
def renderer(context):
    return Renderer(context, SIZE)


def drawn(renderer, scene, camera, p):
    renderer.draw(scene, camera, p)
    return renderer.read() / 255


@pytest.mark.parametrize("name", LOOKS)
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("case", ["scattered 1", "room"])
def test_every_painter_draws_what_the_reference_says(renderer, case, way, name):
    case, p = CASES[case], named(way)
    scene = dressed(case.scene, LOOKS[name])
    want = exact(scene, case.camera, p, SIZE)
    found = drawn(renderer, scene, case.camera, p.technique.exactly(p))
    off = np.abs(found - want.picture).max(axis=2)[~want.near_edge]
    assert want.near_edge.mean() < 0.02
    assert off.max() < 1 / 255  # half a step of 8 bits, and 16-bit floats below it
    plain = drawn(renderer, case.scene, case.camera, p.technique.exactly(p))
    assert (np.abs(plain - found).max(axis=2) > 0.02).mean() > 0.02  # and it is there


@pytest.mark.parametrize("way", ["standard", "dynamic"])
def test_what_is_off_changes_nothing(renderer, way):
    """Not a bit, whatever was drawn before."""
    case, p = CASES["scattered 1"], named(way)
    renderer.draw(case.scene, case.camera, p)
    before = renderer.raw()
    renderer.draw(dressed(case.scene, LOOKS["all"]), case.camera, p)
    assert renderer.raw() != before
    assert dressed(case.scene, PLAIN) is case.scene
    renderer.draw(replace(case.scene, look=Look()), case.camera, p)
    assert renderer.raw() == before


def test_a_dressed_scene_is_the_same_one_each_time_and_keeps_its_things():
    scene = CASES["room"].scene
    look = Look(floor_grid=1.0)
    one = dressed(scene, look)
    assert dressed(scene, Look(floor_grid=1.0)) is one and dressed(one, look) is one
    assert dressed(one, PLAIN) is scene
    assert one.objects[: len(scene.objects)] == scene.objects
    assert dressed(dressed(one, Look(fog=3.0)), look) is one


def test_a_floor_lies_below_all_things_where_there_is_none():
    scene = CASES["scattered 1"].scene
    (floor,) = dressed(scene, Look(floor_grid=1.0)).objects[len(scene.objects) :]
    corners = scene.corners.reshape(-1, 3)
    own = Scene((floor,)).corners.reshape(-1, 3)
    assert floor.impenetrable and not floor.target
    assert np.allclose(own[:, 1], corners[:, 1].min())
    assert (own.min(axis=0)[::2] < corners.min(axis=0)[::2]).all()
    assert (own.max(axis=0)[::2] > corners.max(axis=0)[::2]).all()
    tiled = Scene((*scene.objects, replace(floor, kind="floor")))
    assert len(dressed(tiled, Look(floor_grid=1.0)).objects) == len(tiled.objects)


def test_fog_halves_a_colour_over_its_distance_wherever_one_looks(renderer):
    """A white ball about the eye: each pixel is as far away, whatever its view depth."""
    ball = geometry.sphere(10.0, 4)
    inside = replace(ball, triangles=ball.triangles[:, ::-1].copy(), normals=-ball.normals)
    scene = Scene((Object(inside, color=(0.2, 0.2, 0.2)),), background=(1.0, 0.5, 0.0))
    camera = Camera(np.zeros(3), np.eye(3), fov_y=1.6, near=0.1, far=30)
    plain = drawn(renderer, scene, camera, named("standard"))
    for fog, start, left in ((10.0, 0.0, 0.5), (5.0, 0.0, 0.25), (6.0, 4.0, 0.5), (5.0, 10.5, 1)):
        foggy = dressed(scene, Look(fog=fog, fog_start=start))
        want = plain * left + np.array(scene.background) * (1 - left)
        found = drawn(renderer, foggy, camera, named("standard"))
        # The ball's facets lie up to .5 % nearer; both pictures are rounded to 8 bits.
        assert np.abs(found - want).max() < 1.6 / 255 + 0.004 * (left < 1)


def test_a_thing_behind_a_transparent_one_is_in_fog_of_its_own(renderer):
    """The nearer thing's fog takes nothing from what shows through it."""
    pane = Object(geometry.box(4, 4, 0.1), transforms.translation(0, 0, 2), (0.1, 0.5, 0.9))
    ball = Object(geometry.sphere(1.0, 2), transforms.translation(0, 0, -6), (0.9, 0.1, 0.1), True)
    scene = dressed(Scene((pane, ball)), Look(fog=4.0))
    camera = look_at(np.array([0, 0, 8.0]), np.zeros(3), fov_y=0.5, near=0.5, far=50)
    p = named("dynamic")
    alpha = p.alpha_target
    at = (SIZE[1] // 2, SIZE[0] // 2)
    both = drawn(renderer, scene, camera, p)[at]
    alone = [
        drawn(renderer, replace(scene, objects=(o,)), camera, named("standard"))[at]
        for o in (pane, ball)
    ]
    assert np.allclose(both, alpha * alone[0] + (1 - alpha) * alone[1], atol=1.5 / 255)


def test_lines_are_averaged_over_the_box_that_a_pixel_covers(renderer):
    """Against 10,000 points in the box of each pixel, worked out from rays through its middle."""
    spacing = 1.3
    plate = Object(geometry.quad(40, 40), color=(1, 1, 1), kind="floor", impenetrable=True)
    scene = Scene((plate,))
    camera = look_at(EYE, np.array([0.5, 0.0, 0.3]), fov_y=0.7, near=0.5, far=60)
    plain = drawn(renderer, scene, camera, named("standard"))
    lined = drawn(renderer, dressed(scene, Look(floor_grid=spacing)), camera, named("standard"))
    shown = 1 - (lined / plain).mean(axis=2)  # how much of the floor's colour the lines take
    steps = (np.arange(100) + 0.5) / 100 * 2 - 1
    worst = 0.0
    for row, column in ((20, 20), (45, 60), (70, 100), (60, 33), (80, 75), (30, 90)):
        slope = 2 * np.tan(camera.fov_y / 2) / SIZE[1]
        x, y = (column + 0.5 - SIZE[0] / 2) * slope, (SIZE[1] / 2 - row - 0.5) * slope
        ray = camera.rotation @ np.array([x, y, -1.0])
        offset = ray * (-EYE[1] / ray[1])
        far, level = np.linalg.norm(offset), np.hypot(offset[0], offset[2])
        across, along = slope * far / 2, slope * far * far / abs(offset[1]) / 2
        way = offset[[0, 2]] / level
        half = np.sqrt((along * way) ** 2 + (across * way[::-1]) ** 2)
        points = [(offset[k] + EYE[k] + half[k // 2] * steps) / spacing for k in (0, 2)]
        on = [np.abs(p - np.round(p)) <= 0.015 for p in points]
        left = 1 - (on[0][:, None] | on[1][None]).mean()
        worst = max(worst, abs(shown[row, column] - 0.35 * (1 - left)))
    # 100 points a side resolve a line's part of the box to 1 %, 8 bits of both pictures to 1/255.
    assert worst < 0.35 * 0.02 + 1.5 / 255
    assert shown.max() > 0.2 and shown.min() < 0.01


def test_a_floor_has_lines_on_top_alone():
    """Neither on its rim nor from below."""
    slab = Object(geometry.box(8, 1, 8), color=(0.5, 0.5, 0.5), kind="floor")
    scene = dressed(Scene((slab,)), Look(floor_grid=0.5))
    for eye in ([0, -6.0, 9.0], [0, 0.0, 9.0]):
        camera = look_at(np.array(eye), np.zeros(3), fov_y=0.8, near=1, far=60)
        pictures = [exact(s, camera, named("standard"), SIZE).picture for s in (scene, scene.bare)]
        assert np.array_equal(*pictures)


@pytest.mark.parametrize("kind", ["flat", "smooth", "tinted"])
def test_every_kind_of_floor_looks_as_the_reference_says(renderer, kind):
    """Flat ones are lit by a program of their own; one that is not has all drawn by the other."""
    quad, ball = geometry.quad(14, 9), geometry.sphere(2.5, 3)
    shades = np.linspace(0.3, 1.0, len(quad.vertices))[:, None]
    mesh = replace(quad, colors=quad.colors * shades) if kind == "tinted" else quad
    hill = ball if kind == "smooth" else geometry.box(4, 1, 3)
    tilt = transforms.placed((2.0, -0.4, 0.5), transforms.rotation_x(0.2), (1.0, -1.0, 1.3))
    things = (
        Object(mesh, color=(0.8, 0.7, 0.9), kind="floor", impenetrable=True),
        Object(hill, tilt, (0.6, 0.9, 0.7), kind="floor", impenetrable=True),
        Object(geometry.sphere(1.0, 2), transforms.translation(-2, 1.2, 1), (0.2, 0.4, 0.9)),
    )
    scene = dressed(
        Scene(things), Look(ground_shadows=1.0, shadow_reach=4.0, floor_grid=1.1)
    )  # fmt: skip
    camera = look_at(np.array([3.0, 5.0, 9.0]), np.zeros(3), fov_y=0.8, near=1, far=50)
    want = exact(scene, camera, named("standard"), SIZE)
    found = drawn(renderer, scene, camera, named("standard"))
    off = np.abs(found - want.picture).max(axis=2)[~want.near_edge]
    assert off.max() < 1 / 255
    assert renderer._table(scene).flat_floors == (kind == "flat")


def floating(height, plate=2.0, reach=8.0, strength=1.0):
    """The shadow map of a thin square plate above a floor of 20 × 20."""
    ground = Object(geometry.quad(20, 20), kind="floor", impenetrable=True)
    thing = Object(geometry.box(plate, 1e-6, plate), transforms.translation(1.0, height, -3.0))
    look = Look(ground_shadows=strength, shadow_reach=reach)
    return floor_map(dressed(Scene((ground, thing)), look))


def test_a_shadow_takes_what_its_layer_says_and_spreads_with_height():
    """Blurring moves light about but takes none: the sum of a shadow is that of the plate."""
    reach = 8.0
    bounds = reach * (2.0 ** np.arange(7) - 1) / 63
    darkest, widths = [], []
    for height in (0.01, 0.6, 1.5, 3.0):
        found = floating(height, reach=reach)
        taken = 1 - found.light.astype(float)
        texel = 20 / taken.shape[1]
        layer = np.searchsorted(bounds, height) - 1
        middle = bounds[layer : layer + 2].mean()
        share = 0.75 * (1 - middle / reach) ** 2
        # A plate of 51.2 texels a side covers 51 or 52 whole ones.
        assert taken.sum() * texel**2 == pytest.approx(share * 2.0**2, rel=0.04)
        darkest.append(taken.max())
        x = (np.arange(taken.shape[1]) + 0.5) * texel - 10
        across = taken.sum(axis=0) / taken.sum()
        assert across @ x == pytest.approx(1.0, abs=texel)
        widths.append(np.sqrt(across @ (x - across @ x) ** 2))
    assert all(np.diff(darkest) < 0) and all(np.diff(widths) > 0)
    assert widths[0] == pytest.approx(2 / np.sqrt(12), rel=0.03)  # all but sharp on the floor
    assert floating(reach + 0.1).light.min() == 1.0
    half = 1 - floating(0.6, strength=0.5).light
    assert np.allclose(2 * half, 1 - floating(0.6).light, atol=1e-6)


def test_a_shadow_has_the_shape_of_what_stands_there():
    """A table's legs are dark, the floor between them is not; a doorway's lintel is high up."""
    ground = Object(geometry.quad(10, 10), kind="floor")
    legs = [
        Object(geometry.box(0.2, 1.0, 0.2), transforms.translation(x, 0.5, z))
        for x in (-1.0, 1.0) for z in (-1.0, 1.0)
    ]  # fmt: skip
    top = Object(geometry.box(2.4, 0.05, 2.4), transforms.translation(0, 1.0, 0))
    look = Look(ground_shadows=1.0, shadow_reach=3.0)
    found = floor_map(dressed(Scene((ground, *legs, top)), look))
    points = np.array([[1.0, 1.0], [0.0, 0.0], [0.0, 1.0], [4.5, 4.5]])
    leg, under, edge, far = found.at(points[:, 0], points[:, 1])
    assert leg < under - 0.3 and leg < edge - 0.3 and under < 0.95 and far == 1.0


@pytest.mark.parametrize("way", ["dynamic", "constant"])
def test_what_turns_transparent_keeps_its_shadow(renderer, way):
    """The floor behind a transparent thing is as dark as the floor before an opaque one."""
    ground = Object(geometry.quad(30, 30), color=(0.8, 0.8, 0.8), kind="floor", impenetrable=True)
    box = Object(geometry.box(2, 2, 2), transforms.translation(0, 1.0, 0), (0.2, 0.4, 0.9))
    ball = Object(geometry.sphere(0.5, 2), transforms.translation(0, 0.6, -3), (1, 0, 0), True)
    look = Look(ground_shadows=1.0, shadow_reach=4.0)
    camera = look_at(np.array([0, 6.0, 9.0]), np.array([0, 0.5, -1]), fov_y=0.5, near=1, far=50)
    p = named(way)
    scene = dressed(Scene((ground, box, ball)), look)
    both, bare = (exact(s, camera, p, SIZE) for s in (scene, scene.bare))
    share = both.weights[0]
    through = (both.weights[1] > 0.05) & (share > 0.05) & ~both.near_edge
    assert through.sum() > 20
    alone = exact(Scene((ground,)), camera, p, SIZE).picture.mean(axis=2)
    # What the picture lost to the shadow, over what there is of the floor in it.
    light = 1 - ((bare.picture - both.picture).mean(axis=2) / (share * alone + 1e-9))[through]
    assert light.min() < 0.6
    row, column = np.nonzero(through)
    slope = camera.pixel(SIZE[1])
    x, y = (column + 0.5 - SIZE[0] / 2) * slope, (SIZE[1] / 2 - row - 0.5) * slope
    rays = np.stack([x, y, -np.ones_like(x)], axis=1) @ camera.rotation.T
    on_floor = camera.eye + rays * (-camera.eye[1] / rays[:, 1])[:, None]
    want = floor_map(scene).at(on_floor[:, 0], on_floor[:, 2])
    assert np.allclose(light, want, atol=1e-6)
    without = dressed(Scene((ground, ball)), look)  # and it is the box's own
    clear = floor_map(without).at(on_floor[:, 0], on_floor[:, 2])
    assert (want < clear - 0.04).any()


@pytest.mark.parametrize("seed", range(6))
def test_a_triangle_darkens_the_texels_whose_middles_it_covers(seed):
    """Against the sides of its edges, either way round; besides, the texels that hold a corner."""
    rng = np.random.default_rng(seed)
    flat = rng.uniform(-3, 23, (3, 2))
    there = np.zeros((2, 20, 20))
    triangles = np.array([[0, 1, 2] if seed % 2 else [0, 2, 1]], np.int32)
    _mark(flat, np.full(3, 1.5), triangles, there, np.array([0.0, 1.0, 2.0]))
    y, x = np.mgrid[0:20, 0:20] + 0.5
    sides = [
        (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])
        for a, b in zip(flat, np.roll(flat, -1, axis=0), strict=True)
    ]
    right = np.all(np.array(sides) > 0, axis=0) | np.all(np.array(sides) < 0, axis=0)
    assert right.any()
    for column, row in np.floor(flat).astype(int).tolist():
        if 0 <= column < 20 and 0 <= row < 20:
            right[row, column] = True
    np.testing.assert_array_equal(there[1].astype(bool), right)
    assert not there[0].any()  # 1.5 lies in the second layer alone
