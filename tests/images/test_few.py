"""Where few objects and masks can show, programs without loops sort the pixels: each of them
against the exact picture, with masks that they look up themselves and with masks in cells."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from sample_scenes import SHAPES

from seethrough.renderer.gpu.device.outlines import Outlines
from seethrough.renderer.gpu.per_pixel import exact_painter
from seethrough.renderer.gpu.per_pixel.few_sorter import MASKS, SLICES, FewSorter
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.plan import coverage
from seethrough.renderer.plan.planner import plan
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene import transforms
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

SIZE = (101, 77)  # ends within a block on two sides
EXACT = DynamicTransparency(width=6, exact=True)
CAMERA = look_at(np.array([0.0, 0.0, 12.0]), np.zeros(3), fov_y=0.6, near=1.0, far=60.0)
TORUS = 3
SMALL = np.array([[0.6, 0.6, 0.6, 1.0]] * 3 + [[1.0] * 4])  # times a transform: a smaller thing


def world(seed, count, targets, shapes=(0, 2, TORUS), hard=0.0, target_shape=TORUS):
    """Objects that reach into one another, `targets` of them of one shape."""
    rng = np.random.default_rng(seed)
    objects = []
    for i in range(count):
        target = i < targets
        shape = SHAPES[target_shape if target else shapes[rng.integers(len(shapes))]]
        position = rng.uniform(-1.6, 1.6, 3) * [1.2, 0.9, 2]
        place = transforms.placed(position, transforms.random_rotation(rng), rng.uniform(0.7, 1.3))
        color = tuple(rng.uniform(0.1, 1, 3))
        solid = bool(not target and rng.random() < hard)
        objects.append(Object(shape, place, color, target=target, impenetrable=solid))
    order = rng.permutation(count)
    return Scene(tuple(objects[k] for k in order))


@pytest.fixture
def used(monkeypatch):
    """Counts of objects and masks that programs were made for, and whether they look masks up."""
    found = set()
    program = FewSorter._program

    def noted(self, key):
        found.add(key)
        return program(self, key)

    monkeypatch.setattr(FewSorter, "_program", noted)
    return found


def difference(context, scene, technique):
    renderer = Renderer(context, SIZE)
    renderer.draw(scene, CAMERA, technique)
    truth = exact(scene, CAMERA, technique, SIZE)
    assert truth.near_edge.mean() < 0.02
    return np.abs(renderer.read() - truth.picture * 255).max(axis=2)[~truth.near_edge]


@pytest.mark.parametrize("combine", ["product", "min"])
@pytest.mark.parametrize("hard", [0.0, 0.4])
@pytest.mark.parametrize("count", [2, 4, 7, 12, 20])
def test_masks_are_looked_up(context, used, count, hard, combine):
    """Tori have no hull: their masks are looked up, opaque things among them or not."""
    scene = world(count, count, max(1, count // 3), hard=hard)
    technique = replace(EXACT, combine=combine)
    assert difference(context, scene, technique).max() <= 1.0
    assert all(key[3] for key in used if key[1])
    assert any(key[2] for key in used) == bool(scene.impenetrable.any())


def test_every_program_is_right(context, used):
    """From one object and no mask to 16 objects and 8 masks; what is more is left to the loops."""
    for seed in range(14):
        scene = world(100 + seed, 4 + 2 * seed, 1 + seed)
        assert difference(context, scene, EXACT).max() <= 1.0
    assert {key[0] for key in used} == set(SLICES.tolist())
    assert {key[1] for key in used} == set(MASKS.tolist())


@pytest.mark.parametrize("target_shape", [0, 2])
def test_masks_of_hulls_stay_in_cells(context, used, target_shape):
    scene = world(5, 9, 4, target_shape=target_shape)
    assert difference(context, scene, EXACT).max() <= 1.0
    assert used and not any(key[3] for key in used)


@pytest.mark.parametrize(
    "more",
    [{"min_transmittance": 0.4}, {"mode": "active", "pointer": (0.6, 0.5)}, {"mask": "circle"}],
)
def test_what_the_programs_do_not_know_is_left_to_cells(context, used, more):
    assert difference(context, world(8, 8, 3), replace(EXACT, **more)).max() <= 1.0
    assert not any(key[3] for key in used)


def test_few_and_many_draw_the_same_picture(context, monkeypatch):
    """The same blocks, all left to the loops."""
    scene = world(31, 12, 4)
    renderer = Renderer(context, SIZE)
    renderer.draw(scene, CAMERA, EXACT)
    few = renderer.read()
    monkeypatch.setattr(exact_painter, "too_many", lambda *bits: True)
    monkeypatch.setattr(FewSorter, "draw", lambda *a: (np.ones(len(a[4]), bool), 0))
    other = Renderer(context, SIZE)
    other.draw(scene, CAMERA, EXACT)
    assert np.abs(few.astype(int) - other.read()).max() <= 1


@pytest.mark.parametrize("shift", [-2.9, 2.9])
def test_a_mask_ends_with_its_tile(context, shift):
    """A target at the picture's side: beyond its tile lie those of others, which are not read."""
    objects = [
        Object(SHAPES[TORUS], transforms.placed((shift, y, 0), transforms.rotation_x(1.2), 0.5),
               (0.9, 0.1, 0.1), target=True)
        for y in (-2.2, 0.1, 2.3)
    ]  # fmt: skip
    wall = Object(SHAPES[2], transforms.placed((0, 0, 2), None, 6.0), (0.2, 0.4, 0.9))
    assert difference(context, Scene((*objects, wall)), EXACT).max() <= 1.0


@pytest.mark.parametrize("seed", range(8))
def test_of_coincident_objects_the_later_is_in_front(context, seed):
    """Three of one shape in one place, two of them targets: as if all had the last one's colour.

    Their depths are found in different places of one texture, and are not quite equal. Where a
    surface is seen edge-on they may be farther apart than what still counts as the same.
    """
    rng = np.random.default_rng(seed)
    place = transforms.placed(rng.uniform(-1, 1, 3), transforms.random_rotation(rng), 1.5)
    front = Object(SHAPES[0], transforms.placed((0.5, 0, 3), None, 1.0), (0.8, 0.8, 0.1))
    pictures = []
    for colors in (((1, 0, 0), (0, 1, 0), (0, 0, 1)), ((0, 0, 1),) * 3):
        same = [Object(SHAPES[TORUS], place, c, target=k != 1) for k, c in enumerate(colors)]
        renderer = Renderer(context, (404, 308))
        renderer.draw(Scene((*same, front)), CAMERA, EXACT)
        pictures.append(renderer.read())
    wrong = (pictures[0] != pictures[1]).any(axis=2).sum()
    shown = (pictures[1][..., 2] > pictures[1][..., 0] + 20).sum()  # blue
    assert shown > 2000
    assert wrong < 0.02 * shown


def test_each_of_several_parts_shows_its_own(context):
    """A heap of things on either side, of which one has more than the other."""
    things = [
        replace(thing, transform=transforms.translation(x, 0, 0) @ thing.transform * SMALL)
        for x, heap in ((-2.4, world(1, 4, 1)), (2.4, world(2, 9, 2)))
        for thing in heap.objects
    ]
    scene = Scene(tuple(things))
    assert len(plan(scene, CAMERA, EXACT, SIZE).exact) == 2
    assert difference(context, scene, EXACT).max() <= 1.0


@pytest.mark.parametrize("few", [0, 10**9])
def test_what_is_found_beside_the_drawing_is_waited_for(context, monkeypatch, few):
    """Of many triangles another thread finds what they cover: here one that only then begins."""
    begun = []

    def late(outlines, kernel, *args):
        begun.append(kernel)
        return SimpleNamespace(result=partial(kernel, *args))

    monkeypatch.setattr(exact_painter, "FEW", few)
    monkeypatch.setattr(Outlines, "beside", late)
    assert difference(context, world(3, 9, 2), EXACT).max() <= 1.0
    assert (coverage.cover in begun) == (few == 0)
