"""The static depth test: who is nearer, against a projection and against all pairs."""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.experiment.pages.pages import PICTURE_ASPECT, Choice, Picture
from seethrough.experiment.questions.depth_test.depth_pairs import (
    APART,
    PAIRS,
    RATIO,
    SMALLEST,
    _around,
    _depths,
    _pairs,
    depth_test,
)
from seethrough.experiment.study.config import load
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.geometry import sphere
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import translation
from seethrough.tasks.kit.base import View

FOV = 0.9


def camera(fov=FOV):
    return look_at(
        np.array([1.0, 2.0, 9.0]), np.array([0.5, 0.0, -3.0]), fov_y=fov, near=0.1, far=90
    )


def test_places_are_those_of_tangents():
    """A point that is so many tangents of half the lens up lies there, at any depth."""
    seen_from = camera()
    half = np.tan(FOV / 2)
    rng = np.random.default_rng(1)
    places, depths = rng.uniform(-1.5, 1.5, (40, 2)), rng.uniform(0.5, 60, 40)
    right, up, back = seen_from.rotation.T
    points = seen_from.eye + depths[:, None] * (
        half * (places[:, :1] * right + places[:, 1:] * up) - back
    )
    np.testing.assert_allclose(seen_from.places(points), places, atol=1e-9)


def things(*rows):
    """A view of balls: (place on the picture, depth, radius on the picture, kind)."""
    seen_from, half = camera(), np.tan(FOV / 2)
    right, up, back = seen_from.rotation.T
    objects = []
    for (x, y), depth, size, kind in rows:
        at = seen_from.eye + depth * (half * (x * right + y * up) - back)
        ball = sphere(1.0, 3)
        scale = np.diag([*[size * depth * half / ball.radius] * 3, 1.0])
        objects.append(Object(ball, translation(*at) @ scale, target=True, kind=kind))
    wall = Object(sphere(1.0, 1), translation(0, 0, 0), kind="wall")
    return View(Scene((*objects, wall)), seen_from)


def test_what_counts_is_large_whole_alone_and_of_its_own_kind():
    s = SMALLEST
    view = things(
        ((0.0, 0.0), 10.0, 1.01 * s, "large"),
        ((0.5, 0.5), 12.0, 0.99 * s, "small"),
        ((-0.9, 0.8), 8.0, 1.5 * s, "inside"),
        ((0.9, -0.9), 9.0, 1.5 * s, "cut"),
        ((-0.5, 0.0), 7.0, 1.2 * s, "twice"),
        ((-0.5, 0.5), 30.0, 1.2 * s, "twice"),
        ((-1.0, -0.5), 11.0, 1.2 * s, "close"),
        ((-1.0 + 0.99 * APART * 2.4 * s, -0.5), 15.0, 1.2 * s, "too close"),
        ((0.9, 0.2), 11.0, 1.2 * s, "apart"),
        ((0.9 + 1.01 * APART * 2.4 * s, 0.2), 15.0, 1.2 * s, "far enough"),
    )
    found = _depths(view)
    assert found == pytest.approx({"large": 10.0, "inside": 8.0, "apart": 11.0, "far enough": 15.0})


def test_what_lies_behind_or_just_beside_the_picture():
    """A second one of a kind counts where some of it may show: a seventh beyond the border."""
    second = [((0.0, 1.1), 10.0, 0.1, "b"), ((0.0, 1.2), 10.0, 0.1, "c"),
              ((PICTURE_ASPECT * 1.1, 0.0), 10.0, 0.1, "d"),
              ((PICTURE_ASPECT * 1.2, 0.0), 10.0, 0.1, "e")]  # fmt: skip
    first = [((0.25 * n - 0.6, 0.4), 10.0, 0.1, kind) for n, kind in enumerate("bcde")]
    behind = [((0.0, 0.0), -10.0, -0.1, "behind")]
    assert set(_depths(things(*first, *second, *behind))) == {"c", "e"}


def test_pairs_by_hand():
    depths = {"a": 10.0, "b": 11.9, "c": 12.0, "d": 5.0, "e": 6.0, "f": 7.0, "g": 30.0, "h": 1.0}
    assert _pairs(["a", "b", "c"], depths) == (("a", "c"),)
    assert _pairs(["b", "a", "c"], depths) == (("a", "c"),)
    assert _pairs(list("dfeghabc"), depths) == (("d", "f"), ("e", "g"), ("h", "a"))
    assert _pairs(["a"], depths) == _pairs([], depths) == ()


@pytest.fixture(scope="module")
def made():
    study = load("published")
    return depth_test(study.general.seed, "building", study.parameters("world", "building"))


def test_the_studys_own_test_asks_what_can_be_told(made):
    """Six kinds, each in one pair, whose depths differ by the ratio; the nearer one is right."""
    names = [name for pair in made.pairs for name in pair]
    assert len(made.pairs) == len(made.nearer) == PAIRS
    assert len(set(names)) == 2 * PAIRS
    depth = {}
    for thing, center in zip(made.view.scene.objects, made.view.scene.centers, strict=True):
        if thing.target:
            depth.setdefault(thing.kind, []).append(float(made.view.camera.depth(center[None])[0]))
    counted = _depths(made.view)
    for number, pair in enumerate(made.pairs):
        near, far = sorted(counted[name] for name in pair)
        assert far >= RATIO * near > 0
        assert counted[pair[made.nearer[number]]] == near
        assert near in depth[pair[made.nearer[number]]]
        for answer in ("0", "1"):
            right = made.right(number, {f"pair_{number}": answer})
            assert right == (int(answer) == made.nearer[number])


def test_each_pair_has_its_page(made):
    pages = made.pages(None)
    assert [p.name for p in pages] == ["depth test 0", "depth test 1", "depth test 2"]
    for number, page in enumerate(pages):
        picture, choice = page.blocks
        assert isinstance(picture, Picture) and isinstance(choice, Choice)
        assert picture.view is made.view and 0.4 < picture.height < 0.7
        assert choice.name == f"pair_{number}"
        assert choice.options == tuple(f"kind.{k}" for k in made.pairs[number])


def test_headings_go_round_in_equal_steps():
    first = camera()
    around = _around(first)
    ways = np.array([c.rotation[:, 2] for c in around])
    assert len(around) == 24 and np.allclose(ways[0], first.rotation[:, 2])
    assert np.allclose([c.eye for c in around], first.eye)
    assert {(c.fov_y, c.near, c.far) for c in around} == {(first.fov_y, first.near, first.far)}
    flat = np.arctan2(ways[:, 0], ways[:, 2])
    steps = np.mod(np.diff([*flat, flat[0]]), 2 * np.pi)
    assert np.allclose(steps, 2 * np.pi / 24) and np.allclose(ways[:, 1], ways[0, 1])
