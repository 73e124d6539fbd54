"""What reaches to both sides of a mask's border is told from it by depth, as sorted pixels are; and
along a path nothing jumps where a border's place in the order turns round."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from sample_scenes import SHAPES

from seethrough.benchmarks.drawing import guarantee
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.plan import planner, straddling, swapping
from seethrough.renderer.plan.explain import explain
from seethrough.renderer.plan.frame_plan import SHORTCUTS
from seethrough.renderer.plan.planner import plan
from seethrough.renderer.reference.surfaces import surfaces
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.base import Shot
from seethrough.renderer.techniques.dynamic import exact
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

SIZE = (320, 240)
TECHNIQUE = DynamicTransparency(width=24)
SORTED = replace(TECHNIQUE, exact=True)
EYE = Camera(np.zeros(3), np.eye(3), 0.8, 0.5, 60.0)
CONVEX = [mesh for mesh in SHAPES if mesh.convex]
TORUS = geometry.torus(0.75, 0.28, 16, 8)


def beside(seed, mesh=None):
    """A target, something long beside it from before its centre to behind, and what lies behind
    both: a wall of another target, which makes all blend, and bars."""
    rng = np.random.default_rng(seed)
    mesh = CONVEX[rng.integers(len(CONVEX))] if mesh is None else mesh
    turn = rng.uniform(0, 2 * np.pi)
    away = np.array([np.cos(turn), np.sin(turn), 0])
    pose = transforms.placed(
        np.array([*rng.uniform(-0.4, 0.4, 2), -8.0]), transforms.random_rotation(rng), np.ones(3)
    )
    center = (pose @ [*mesh.center, 1])[:3]
    long = geometry.box(0.9, 0.9, 3.0) if seed % 2 else geometry.sphere(1.0, 2)
    scale = np.ones(3) if seed % 2 else np.array([0.6, 0.6, 1.5])
    place = center + away * rng.uniform(1.6, 1.8) + [0, 0, rng.uniform(-0.4, 0.4)]
    tilt = transforms.rotation_y(rng.uniform(-0.3, 0.3))
    things = [
        Object(mesh, pose, (0.9, 0.2, 0.1), target=True),
        Object(long, transforms.placed(place, tilt, scale), (0.1, 0.6, 0.9)),
        Object(geometry.box(2.5, 2.5, 0.2), transforms.translation(0.5, 0, -14), (0.9, 0.8, 0.2),
               target=True),
    ]  # fmt: skip
    return Scene(tuple(things[k] for k in rng.permutation(3)), (0.95, 0.95, 0.95))


@pytest.fixture(scope="module")
def renderer(context):
    return Renderer(context, SIZE, without=frozenset({"still"}))


def drawn(renderer, scene, technique, camera=EYE):
    renderer.draw(scene, camera, technique)
    return renderer.read().astype(int)


def in_order_alone(monkeypatch):
    """As though nothing but the order were looked at."""
    monkeypatch.setattr(planner.straddling, "found", lambda *_: straddling.NO_ONE)
    monkeypatch.setattr(planner.swaps, "swapping", lambda *_: (swapping.NONE, np.zeros(0)))


@pytest.fixture
def wherever(monkeypatch):
    """Borders are told however far the eye is from where the order turns round."""
    monkeypatch.setattr(straddling, "CLOSE", 1e9)
    monkeypatch.setattr(straddling, "DEEP", 1e9)


def test_borders_look_as_sorted_pixels_do(renderer, monkeypatch, wherever):
    """Of 40 scenes, within a step of 8 bits but for single pixels at edges wherever all of a
    border is told; without that a hundred pixels a scene are far off."""
    told, wrong, off = 0, 0, 0
    for seed in range(40):
        scene = beside(seed)
        frame = plan(scene, EYE, TECHNIQUE, SIZE)
        if not len(frame.straddling) or frame.strength.min() < 0.999:
            continue
        assert not len(frame.exact)
        told += 1
        truth = drawn(renderer, scene, SORTED)
        wrong += int((np.abs(drawn(renderer, scene, TECHNIQUE) - truth).max(axis=2) > 1).sum())
        with monkeypatch.context() as patch:
            in_order_alone(patch)
            plain = drawn(renderer, scene, TECHNIQUE)
        off += int((np.abs(plain - truth).max(axis=2) > 40).sum())
    assert told > 15
    assert wrong <= 12
    assert off > 40 * told


def test_pixels_are_counted_as_they_are(monkeypatch, wherever):
    """Over a border, nearer and farther than its target's centre, against surfaces found pixel by
    pixel: to a quarter, or 30 pixels. That is enough, for what is told changes with it little by
    little."""
    monkeypatch.setattr(straddling, "SEEN", 0.0)  # all of the border
    some = 0
    for seed in range(40):
        scene = beside(seed)
        target, thing = (
            next(k for k, o in enumerate(scene.objects) if o.color[2] == blue)
            for blue in (0.1, 0.9)
        )
        across = looked_at(scene)
        seen, _ = surfaces(Shot(scene, EYE, SIZE))
        mask = exact.known(TECHNIQUE, seen)[target]
        border = ~mask.core & (mask.opacity < 1)
        mine = seen.first(seen.front) & (seen.object == thing) & border[seen.pixel]
        near = seen.depth[mine] < EYE.depth(scene.centers[[target]])[0]
        found = (across.pairs == [thing, target]).all(axis=1)
        if not found.any():
            assert min(near.sum(), (~near).sum()) <= straddling.FEW
            continue
        counts = across.nearer[found][0], across.farther[found][0]
        some += min(counts) > straddling.FEW
        np.testing.assert_allclose(counts, (near.sum(), (~near).sum()), rtol=0.25, atol=30)
    assert some > 5


def looked_at(scene):
    """What the plan finds across borders."""
    found = []
    with pytest.MonkeyPatch.context() as patch:
        real = straddling.found
        patch.setattr(planner.straddling, "found", lambda *a: found.append(real(*a)) or found[-1])
        plan(scene, EYE, TECHNIQUE, SIZE)
    return found[0]


# The world of an orbit and the frame; pixels that jumped there when the order alone decided: of
# borders of masks, of the last two where two distractors that no plane separates swap their places.
JUMPED = [(3, 174, 98), (6, 183, 67), (9, 242, 57), (7, 153, 56), (1, 126, 54), (2, 45, 51),
          (5, 261, 41), (8, 175, 56), (10, 250, 45)]  # fmt: skip


@pytest.mark.parametrize(("world", "frame", "before"), JUMPED)
def test_paths_that_jumped_do_not(context, world, frame, before):
    def some(seed, aspect):
        scene, cameras = guarantee.orbit_path(seed, aspect)
        return scene, cameras[frame - 1 : frame + 1]

    def worst():
        renderer = Renderer(context, guarantee.PATH_SIZE)
        found = guarantee.most_jumping(
            renderer, some, range(world, world + 1), {"default": DynamicTransparency()}
        )
        return found["default"].value

    assert worst() <= guarantee.JUMPING
    with pytest.MonkeyPatch.context() as patch:
        in_order_alone(patch)
        assert worst() == before > guarantee.JUMPING


@pytest.mark.parametrize(("wrong", "close", "strength"), [
    (100, 1.0, 1.0), (100, 0.25, 0.25), (18, 1.0, 0.5), (18, 0.5, 0.25), (12, 1.0, None),
])  # fmt: skip
def test_a_border_is_told_by_how_many_pixels_and_how_close(wrong, close, strength):
    """Wholly from twice twelve pixels on, where the order turns round."""
    these = straddling.Straddling(np.array([[0, 1]]), *np.array([[0.0], [wrong], [close]]))
    levels = np.array([3, 2]), np.array([-2, 2])  # of the objects, and of the target's mask
    told, found = straddling.kept(these, *levels, np.zeros(2, bool))
    if strength is None:
        assert not len(told)
    else:
        np.testing.assert_allclose(found, [strength])
        assert told.tolist() == [[0, 1, 1]]


def test_a_target_before_two_that_swap_is_not_drawn_over(context):
    """Were the last one drawn behind what is there, a target would keep .877 of its shares."""

    def some(seed, aspect):
        scene, cameras = guarantee.abstract_views(seed, aspect)
        return scene, cameras[:1]

    ways = {"default": DynamicTransparency()}
    found = guarantee.least_kept(Renderer(context, (800, 600)), some, range(78, 79), ways)
    assert found["default"].value > 0.99
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(swapping, "_hidden", lambda *_: False)
        found = guarantee.least_kept(Renderer(context, (800, 600)), some, range(78, 79), ways)
    assert found["default"].value < 0.9


@pytest.mark.parametrize("frame", [72, 106])
def test_where_two_walls_meet_a_column_does_not_jump_early(context, frame):
    """One lies a hand's breadth before the other, far away: a few steps of the depth buffer. Sorted
    pixels that took these for one depth had a column change a frame before depth buffers do."""

    def some(seed, aspect):
        scene, cameras = guarantee.walk_path(seed, aspect)
        return scene, cameras[frame - 1 : frame + 1]

    renderer = Renderer(context, guarantee.PATH_SIZE)
    found = guarantee.most_jumping(renderer, some, range(9, 10), {"default": DynamicTransparency()})
    assert found["default"].value <= guarantee.JUMPING


@pytest.mark.parametrize("shortcut", sorted(set(SHORTCUTS) - {"still"}))
def test_shortcuts_leave_told_borders_as_they_are(context, shortcut, wherever):
    told = 0
    for seed in range(6):
        scene = beside(seed)
        pictures = []
        for without in ({"still"}, {"still", shortcut}):
            own = Renderer(context, SIZE, without=frozenset(without))
            pictures.append(drawn(own, scene, TECHNIQUE))
            told += len(own.plan.straddling)
        assert np.abs(pictures[0] - pictures[1]).max() <= (1 if shortcut == "hulls" else 0)
    assert told > 6


def test_what_is_seen_of_them_is_the_same(renderer, wherever):
    """Of each object, what a look finds in layers and what sorted pixels have of it."""
    told = 0
    for seed in range(12):
        scene = beside(seed)
        frame = plan(scene, EYE, TECHNIQUE, SIZE)
        if not len(frame.straddling) or frame.strength.min() < 0.999:
            continue
        told += 1
        ours, theirs = (renderer.look(scene, EYE, t, SIZE) for t in (TECHNIQUE, SORTED))
        np.testing.assert_allclose(ours.area, theirs.area, rtol=0.01, atol=1.0)
    assert told > 3


def test_the_plan_says_of_whom_it_is_told(wherever):
    seed = next(s for s in range(40) if len(plan(beside(s), EYE, TECHNIQUE, SIZE).straddling))
    scene = beside(seed)
    frame = plan(scene, EYE, TECHNIQUE, SIZE)
    (thing, target, _), lines = frame.straddling[0].tolist(), explain(scene, frame)
    line = next(line for line in lines if line.startswith(f"object {thing}: blended"))
    assert f", told by depth from the border of object {target}" in line


REFUSED = {
    "the least mask counts": {"combine": "min"},
    "a border leaves nothing": {"alpha_edge": 0.0},
    "a light is guaranteed": {"min_transmittance": 0.2},
    "another kind of mask": {"mask": "hull"},
    "no border": {"width": 0.0},
}


@pytest.mark.parametrize("why", REFUSED)
def test_other_masks_keep_to_the_order(why):
    for seed in range(6):
        frame = plan(beside(seed), EYE, replace(TECHNIQUE, **REFUSED[why]), SIZE)
        assert not len(frame.straddling)
