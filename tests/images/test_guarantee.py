"""No target is lost behind what should be transparent: views that lost some, and scenes to lose
more; and the measure itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from sample_scenes import SHAPES

from seethrough.benchmarks.drawing import guarantee
from seethrough.benchmarks.drawing.guarantee import (
    KEPT,
    Guarantee,
    abstract_views,
    building_views,
    orbit_path,
)
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

DEFAULT = DynamicTransparency()


@pytest.fixture(scope="module")
def large(context):
    return Renderer(context, (800, 600), without=frozenset({"still"}))


# World and turn of eight; what of a target was left there when centres decided what no plane does.
LOST = [(28, 2, 0.06), (13, 4, 0.10), (29, 6, 0.12), (12, 6, 0.27), (10, 4, 0.62), (17, 2, 0.66)]


@pytest.mark.parametrize(("world", "turn", "before"), LOST)
def test_worlds_that_lost_targets_keep_them(large, world, turn, before):
    scene, cameras = abstract_views(world, 4 / 3)
    targets, kept = Guarantee(large, scene).kept(cameras[turn], {"": DEFAULT})
    assert len(targets) > 15
    assert kept[""].min() >= KEPT > before


@pytest.mark.parametrize(("world", "turn"), [(22, 7), (3, 7)])
def test_buildings_that_lost_things_keep_them(large, world, turn):
    """.34 and .52 of a thing were left."""
    scene, cameras = building_views(world, 4 / 3)
    _, kept = Guarantee(large, scene).kept(cameras[turn], {"": DEFAULT})
    assert kept[""].min() >= KEPT


def test_no_target_comes_and_goes_along_an_orbit(context):
    """The stretch of world 2's orbit where a target was gone for 23 frames."""
    renderer = Renderer(context, (640, 480), without=frozenset({"still"}))
    scene, _ = orbit_path(2, 4 / 3)
    start = abstract_views(2, 4 / 3)[1][0]
    gone = Guarantee(renderer, scene)
    for step in (150, 160, 167, 175):
        turn = transforms.rotation_y(np.radians(0.2 * step))[:3, :3]
        camera = replace(start, eye=turn @ start.eye, rotation=turn @ start.rotation)
        assert gone.kept(camera, {"": DEFAULT})[1][""].min() >= KEPT


def strewn(seed, kind):
    """Things that reach into one another: `many` targets, `hard` ones among them, in `groups`,
    one in another (`nested`), `near` the eye; all of them mirrored or not."""
    rng = np.random.default_rng(seed)
    meshes = (*SHAPES, geometry.box(4, 3, 0.1), geometry.torus(1.6, 0.12, 32, 10))
    objects = []
    for _ in range(8 if kind == "nested" else 16):
        z = rng.uniform(-12, 0.6 if kind == "near" else -4)
        spread = 0.2 * max(0.6, -z) + 0.2
        scale = rng.uniform(0.4, 1.2, 3) * rng.choice([-1, 1], 3)
        place = (*rng.uniform(-spread, spread, 2), z)
        thing = Object(
            meshes[rng.integers(6)],
            transforms.placed(place, transforms.random_rotation(rng), scale),
            target=bool(rng.random() < (0.9 if kind == "many" else 0.35)),
            impenetrable=bool(kind == "hard" and rng.random() < 0.25),
            group=int(rng.integers(4)) if kind == "groups" else None,
        )
        objects.append(thing)
        if kind == "nested":
            inner = thing.transform.copy()
            inner[:3, :3] *= 0.4
            mesh = meshes[rng.integers(6)]
            objects.append(replace(thing, mesh=mesh, transform=inner, target=not thing.target))
    return Scene(tuple(objects)), Camera(np.zeros(3), np.eye(3), 0.9, 0.15, 50.0)


OPTIONS = {
    "default": {},
    "no doubt allowed": {"doubt": 0.0},
    "all doubt allowed": {"doubt": 1.0},
    "by polygon": {"doubt": 1.0, "order": "polygons"},
    "least mask": {"doubt": 1.0, "combine": "min"},
    "no border": {"doubt": 1.0, "width": 0.0},
    "least transmittance": {"doubt": 1.0, "min_transmittance": 0.3},
    "near the viewer": {"doubt": 1.0, "penetrable_within": 7.0},
    "hull": {"doubt": 1.0, "mask": "hull"},
    "circle": {"doubt": 1.0, "mask": "circle"},
}


@pytest.mark.parametrize("kind", ["plain", "near", "many", "hard", "groups", "nested"])
def test_what_no_order_gets_right_loses_no_target(context, kind):
    renderer = Renderer(context, (160, 120), without=frozenset({"still"}))
    views = 0
    for seed in range(2):
        scene, camera = strewn(seed, kind)
        made = Guarantee(renderer, scene)
        for name, options in OPTIONS.items():
            technique = replace(DynamicTransparency(width=2), **options)  # 10 of 600
            truth = replace(technique, order="planes", exact=True)
            _, kept = made.kept(camera, {name: technique}, truth)
            assert kept[name].min(initial=1.0) >= KEPT, (seed, name)
            views += len(kept[name])
    assert views > 20


def test_the_measure_is_that_of_the_reference(context):
    """A wall whose centre lies behind a target that its near end hides in half: by centres the
    target is drawn last and what the wall hides of it is lost, the rest is kept."""
    wall = Object(geometry.box(0.2, 4, 40), transforms.translation(-1.5, 0, -19), (0.7, 0.7, 0.6))
    ball = Object(geometry.sphere(0.8, 3), transforms.translation(-3.6, 0, -9), (1, 0, 0), True)
    scene = Scene((wall, ball))
    camera = look_at(np.zeros(3), np.array([-2.0, 0, -9]), fov_y=0.9, near=0.1, far=100)
    size, by_centers = (240, 180), DynamicTransparency(order="centers")
    truth = exact(scene, camera, DynamicTransparency(), size)
    hidden = truth.depth[0] < truth.depth[1]
    expected = truth.weights[1][~hidden].sum() / truth.weights[1].sum()
    assert 0 <= expected < 0.9
    renderer = Renderer(context, size, without=frozenset({"still"}))
    ways = {"centers": by_centers, "planes": DynamicTransparency()}
    targets, kept = Guarantee(renderer, scene).kept(camera, ways)
    assert targets.tolist() == [1]
    assert kept["centers"][0] == pytest.approx(expected, abs=0.01)
    assert kept["planes"][0] == pytest.approx(1.0, abs=0.01)


def test_what_jumps_alone_is_counted(context, monkeypatch):
    """A target that one way loses from the second frame on; the edges that move in both do not."""
    wall = Object(geometry.box(0.2, 4, 40), transforms.translation(-1.5, 0, -19), (0.7, 0.7, 0.6))
    ball = Object(geometry.sphere(0.8, 2), transforms.translation(-4, 0, -9), (1, 0, 0), True)
    aim = np.array([-2.0, 0, -9])
    eyes = [np.array([x, 0, 0]) for x in (0.0, 0.01, 0.02)]
    cameras = [look_at(eye, aim, fov_y=0.9, near=0.1, far=100) for eye in eyes]
    renderer = Renderer(context, (160, 120), without=frozenset({"still"}))
    sequence = iter([DynamicTransparency(), DynamicTransparency(order="centers")] * 2)

    def each_drawn(renderer, scene, camera, ways):
        for way, technique in ways.items():
            renderer.draw(scene, camera, technique if way == "" else next(sequence))
            yield way

    monkeypatch.setattr(guarantee, "each_drawn", each_drawn)
    path = lambda seed, aspect: (Scene((wall, ball)), cameras)  # noqa: E731
    worst = guarantee.most_jumping(renderer, path, range(7, 8), {"odd": DEFAULT})["odd"]
    assert worst.value > guarantee.JUMPING
    assert (worst.world, worst.count, worst.bad) == (7, 2, 2)
