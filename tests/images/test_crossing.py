"""Two targets that cross are drawn one within the other as sorted pixels show them, with their
borders; and where that is not so they are sorted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from sample_scenes import SHAPES

from seethrough.benchmarks.drawing.guarantee import Guarantee, abstract_views
from seethrough.renderer.gpu.levels import crossing_painter
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.plan.explain import explain
from seethrough.renderer.plan.planner import plan
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.look import Look
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

SIZE = (240, 180)
TECHNIQUE = DynamicTransparency(width=8)
SORTED = replace(TECHNIQUE, exact=True)
EYE = Camera(np.zeros(3), np.eye(3), 0.8, 0.5, 60.0)
TORUS = geometry.torus(0.75, 0.28, 16, 8)
CONVEX = [mesh for mesh in (*SHAPES, geometry.box(1.2, 0.8, 1.5)) if mesh.convex]


def turned(rng, mesh, place, scale, color):
    pose = transforms.placed(np.array(place), transforms.random_rotation(rng), scale)
    return Object(mesh, pose, color, target=True)


def pane(rng):
    """Something to see through, before all else."""
    place = (rng.uniform(-0.6, 0.6), 0, -3.6)
    pose = transforms.placed(np.array(place), transforms.random_rotation(rng), np.ones(3))
    return Object(geometry.box(0.9, 4, 0.05), pose, (0.8, 0.8, 0.2))


def crossed(seed, both_convex=True, apart=0.7):
    """Two targets that cross, `apart` from one another, at random, before a third, with a pane
    before a part of them."""
    rng = np.random.default_rng(seed)

    meshes = [CONVEX[k] for k in rng.integers(len(CONVEX), size=2)]
    if not both_convex:
        meshes[rng.integers(2)] = TORUS
    mirror = np.array([rng.choice([-1, 1]), 1, 1])
    middle = np.array([*rng.uniform(-0.6, 0.6, 2), -8.0])
    away = rng.normal(size=3)
    away *= apart / 2 / np.linalg.norm(away)
    things = (
        turned(rng, meshes[0], middle - away, 1.1 * mirror, (0.9, 0.3, 0.1)),
        turned(rng, meshes[1], middle + away, np.full(3, 1.1), (0.2, 0.4, 0.9)),
        turned(rng, CONVEX[0], (0, 0, -16), np.full(3, 3.4), (0.2, 0.8, 0.3)),
        pane(rng),
    )
    order = rng.permutation(len(things))
    return Scene(tuple(things[k] for k in order), (0.1, 0.1, 0.15))


def of_both(frame, scene, camera):
    """Every border of every pair."""
    return {(a, b) for pair in frame.crossing.tolist() for a, b in (pair, pair[::-1])}


@pytest.fixture(scope="module")
def renderer(context):
    return Renderer(context, SIZE, without=frozenset({"still"}))


def test_borders_that_change_nothing_are_not_drawn(renderer):
    """Of pairs that hardly cross a sixth of the draws of borders at least, of which each has four:
    with them all the pictures are the same, but for what dividing out leaves of 16 bits."""
    counts, pairs = {True: 0, False: 0}, 0
    for seed in range(60):
        scene = crossed(seed, seed % 2 == 0, apart=1.6)
        pictures = []
        for all_of_them in (True, False):
            with pytest.MonkeyPatch.context() as patch:
                if all_of_them:
                    patch.setattr(crossing_painter, "_telling", of_both)
                counts[all_of_them] += renderer.draw(scene, EYE, TECHNIQUE).draws
                pictures.append(renderer.read().astype(int))
        assert np.abs(pictures[0] - pictures[1]).max() <= 1, seed
        pairs += len(renderer.plan.crossing)
    assert pairs > 30 and counts[False] < counts[True] - 4 * pairs / 6


@pytest.mark.parametrize("both_convex", [True, False])
def test_they_look_as_sorted_pixels_do(renderer, both_convex):
    """Within a step of 8 bits, of 30 scenes of each kind, but for single pixels whose middle lies
    on an edge: there a target's mask and the target may be of two minds. What one hides of the
    other would show: without that, thousands of pixels are off."""
    wrong = off = 0
    for seed in range(30):
        scene = crossed(seed, both_convex)
        frame = plan(scene, EYE, TECHNIQUE, SIZE)
        assert len(frame.crossing) == 1 and not len(frame.exact), seed
        pictures = []
        for technique in (TECHNIQUE, SORTED):
            renderer.draw(scene, EYE, technique)
            pictures.append(renderer.read().astype(int))
        wrong += int((np.abs(pictures[0] - pictures[1]).max(axis=2) > 1).sum())
        standing = replace(scene, objects=scene.objects)
        standing.__dict__["settled"] = np.ones((4, 4), bool)  # as though their order were known
        renderer.draw(standing, EYE, TECHNIQUE)
        off += int((np.abs(renderer.read() - pictures[1]).max(axis=2) > 40).sum())
    assert wrong <= 3
    assert off > 3000


def test_each_of_a_chain_is_drawn_within_the_next(renderer):
    """Four in a row, each across the next: seen from aside and from along the row, behind a pane.
    Each target keeps what sorted pixels show of it, but where the border of one lies over another
    whose order is not in doubt."""
    several, least = 0, list[float]()
    for seed in range(12):
        rng = np.random.default_rng(seed)
        way = rng.normal(size=3)
        way *= 1.1 / np.linalg.norm(way)
        row = [
            turned(rng, CONVEX[k % len(CONVEX)], (0, 0, -8) + (k - 1.5) * way, np.full(3, 0.75),
                   tuple(rng.uniform(0.1, 1, 3)))
            for k in range(4)
        ]  # fmt: skip
        scene = Scene((*row, pane(rng)), (0.1, 0.1, 0.15))
        frame = plan(scene, EYE, TECHNIQUE, SIZE)
        assert len(frame.crossing) and not len(frame.exact)
        several += len(frame.crossing) > 2
        least.append(Guarantee(renderer, scene).kept(EYE, {"": TECHNIQUE}, SORTED)[1][""].min())
    assert several and min(least) > 0.99


def test_what_is_seen_of_them_is_the_same(context):
    """Of each object, what a look finds in layers and what it finds in sorted pixels."""
    ours = Renderer(context, SIZE)
    theirs = Renderer(context, SIZE, without=frozenset({"crossing"}))
    for seed in range(12):
        scene = crossed(seed, both_convex=seed % 2 == 0)
        found = [r.look(scene, EYE, TECHNIQUE, (160, 120)) for r in (ours, theirs)]
        for name in ("area", "contrast"):
            a, b = (getattr(f, name) for f in found)
            # Shares are summed in 16 bits on one way, in 32 on the other.
            np.testing.assert_allclose(a, b, rtol=0.01, atol=0.5 if name == "area" else 0.01)


def test_with_samples_each_is_told_by_itself(context, renderer):
    """Four a pixel come nearer to the mean of a sorted picture of four times the pixels than one
    does: half as far from it."""
    fine = Renderer(context, (2 * SIZE[0], 2 * SIZE[1]))
    rough = smooth = 0.0
    for seed in range(4):
        scene = crossed(seed)
        fine.draw(scene, EYE, replace(SORTED, width=2 * TECHNIQUE.width))
        truth = fine.read().astype(float).reshape(SIZE[1], 2, SIZE[0], 2, 3).mean(axis=(1, 3))
        renderer.draw(scene, EYE, TECHNIQUE)
        rough += np.abs(renderer.read() - truth).mean()
        renderer.draw(replace(scene, look=Look(antialiasing="4x")), EYE, TECHNIQUE)
        assert len(renderer.plan.crossing) == 1
        smooth += np.abs(renderer.read() - truth).mean()
    assert smooth < 0.5 * rough


def test_few_views_are_left_to_sort():
    """Of 32 of four abstract worlds, in most of which targets cross: fewer than a tenth of those
    that sort pixels otherwise, also where something lies between the two."""
    left, before = 0, 0
    for world in range(9, 13):
        scene, cameras = abstract_views(world, 4 / 3)
        for camera in cameras:
            frames = [
                plan(scene, camera, DynamicTransparency(), (800, 600), without)
                for without in (frozenset(), frozenset({"crossing"}))
            ]
            left, before = left + len(frames[0].exact), before + len(frames[1].exact)
            assert not len(frames[1].crossing)
    assert before > 20 and left < before / 10


def test_the_plan_says_who_crosses_whom():
    scene = crossed(3)
    frame = plan(scene, EYE, TECHNIQUE, SIZE)
    (first, last), lines = frame.crossing[0].tolist(), explain(scene, frame)
    assert "1 pairs of targets that cross, one drawn within the other" in lines
    for i, other in ((first, last), (last, first)):
        line = next(line for line in lines if line.startswith(f"object {i}: blended"))
        assert f", crosses object {other}" in line


WALL = Object(
    geometry.box(0.4, 9, 0.05), transforms.translation(0, 0, -6), (0.5, 0.5, 0.5),
    impenetrable=True,
)  # fmt: skip
REFUSED = {
    "a wall may stand before both": (lambda s: replace(s, objects=(*s.objects, WALL)), {}),
    "the least mask counts": (lambda s: s, {"combine": "min"}),
    "a border leaves nothing": (lambda s: s, {"alpha_edge": 0.0}),
    "a mask leaves nothing": (lambda s: s, {"alpha_target": 0.0}),
    "a light is guaranteed": (lambda s: s, {"min_transmittance": 0.2}),
    "another kind of mask": (lambda s: s, {"mask": "hull"}),
}


@pytest.mark.parametrize("why", REFUSED)
def test_what_can_not_be_told_by_depth_is_sorted(renderer, why):
    changed, options = REFUSED[why]
    scene = changed(crossed(3))
    frame = plan(scene, EYE, replace(TECHNIQUE, **options), SIZE)
    assert not len(frame.crossing) and len(frame.exact)


def test_two_rings_through_one_another_are_sorted():
    scene = crossed(1)
    both = tuple(replace(o, mesh=TORUS) if o.target and o.mesh is not CONVEX[0] else o
                 for o in scene.objects)  # fmt: skip
    frame = plan(replace(scene, objects=both), EYE, TECHNIQUE, SIZE)
    assert not len(frame.crossing)
