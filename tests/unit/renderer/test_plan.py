"""Plans: which effects, which order, why; without a GPU."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from sample_scenes import SHAPES, before_column, column, room

from seethrough.renderer.plan import comparing
from seethrough.renderer.plan.blending import merged_parts
from seethrough.renderer.plan.explain import explain
from seethrough.renderer.plan.frame_plan import BLENDED, HARD, OUTSIDE
from seethrough.renderer.plan.planner import _counted, impenetrable, plan
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.projection import to_camera, to_pixels
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques import named
from seethrough.renderer.techniques.dynamic import exact
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard

SIZE = (400, 300)
TECHNIQUE = DynamicTransparency()


def place_of(frame, kind, index):
    """The level of an object or mask; −1 for masks before all, None if it has none."""
    for k, level in enumerate(frame.levels):
        if index in getattr(level, kind):
            return k - 1
    return None


def pixels_of(scene, camera):
    """The pixels (v, 2) of each object's corners."""
    points = [o.mesh.vertices @ o.transform[:3, :3].T + o.transform[:3, 3] for o in scene.objects]
    return [to_pixels(to_camera(p, camera), camera, SIZE) for p in points]


def apart(one, other, directions=90):
    """How far two sets of pixels are apart, at least: along the best of many directions."""
    angles = np.linspace(0, 2 * np.pi, directions, endpoint=False)
    ways = np.stack([np.cos(angles), np.sin(angles)])
    return ((one @ ways).min(axis=0) - (other @ ways).max(axis=0)).max()


@pytest.mark.parametrize("seed", range(10))
def test_order_and_masks_respect_depth(seed):
    """In a column every pair whose outlines overlap is drawn from back to front, masks in their
    place."""
    scene, camera = column(seed, count=20, spread=0.8), before_column(seed)
    frame = plan(scene, camera, TECHNIQUE, SIZE)
    depth, pixels = camera.depth(scene.centers), pixels_of(scene, camera)
    for i in np.nonzero(frame.reasons == BLENDED)[0]:
        for j in np.nonzero(frame.reasons == BLENDED)[0]:
            if i != j and depth[i] < depth[j] and apart(pixels[i], pixels[j]) <= 0:
                assert place_of(frame, "objects", i) > place_of(frame, "objects", j)
        for s in frame.masked:
            if i == s or apart(pixels[i], pixels[s]) > TECHNIQUE.width:
                continue
            before = place_of(frame, "masks", s) < place_of(frame, "objects", i)
            assert before == (depth[i] < depth[s])


@pytest.mark.parametrize(
    "without", [frozenset(), frozenset({"still"}), frozenset({"cull", "masks"})]
)
def test_without_a_target_in_view_nothing_is_put_in_order(without):
    """Whatever else is left out: not even pairs are compared, so the frame costs a standard one."""
    scene = column(3)
    free = replace(scene, objects=tuple(replace(o, target=False) for o in scene.objects))
    frame = plan(free, before_column(3), TECHNIQUE, SIZE, without)
    assert frame.relation.shape == (0, 0) and not frame.levels
    assert len(plan(scene, before_column(3), TECHNIQUE, SIZE, without).relation) == len(
        scene.objects
    )


def test_what_passes_masks_by_their_corners_stays_opaque():
    """Aside and above or below, farther than masks reach, though its box lies over theirs: told
    from the pixels of its corners, along both diagonals."""
    diagonals = np.array([[1.0, 1], [1, -1], [-1, 1], [-1, -1]]).T / np.sqrt(2)
    passed = 0
    for seed in range(20):
        scene, camera = column(seed, count=40, targets=0.1, spread=3.0), before_column(seed)
        frame, pixels = plan(scene, camera, TECHNIQUE, SIZE), pixels_of(scene, camera)
        boxes, reach = frame.boxes.extents, frame.reach[scene.targets]
        low, high = (np.array([f(p @ diagonals, axis=0) for p in pixels]) for f in (np.min, np.max))
        beyond = low[:, None] - high[scene.targets]
        beyond = beyond.max(axis=2) > TECHNIQUE.width + 1.1  # a pixel's margin, and for rounding
        over = (boxes[:, None, :2] <= reach[:, 2:]) & (boxes[:, None, 2:] >= reach[:, :2])
        over = over.all(axis=2)
        for i in np.nonzero(frame.boxes.inside & ~scene.targets & over.any(axis=1))[0]:
            if beyond[i][over[i]].all():
                passed += 1
                assert i in frame.opaque
    assert passed > 10


def test_reasons_name_what_is_hard_outside_and_blended():
    """The floor is impenetrable, the wall before targets blends, the free target has no mask."""
    scene, camera = room()
    away = Object(SHAPES[0], transforms.translation(0, 1, 500))
    scene = replace(scene, objects=(*scene.objects, away))
    frame = plan(scene, camera, TECHNIQUE, SIZE)
    assert frame.reasons[0] == HARD
    assert frame.reasons[1] == BLENDED
    assert frame.reasons[-1] == OUTSIDE
    assert 6 not in frame.masked
    assert scene.targets[frame.behind[1]]
    words = "\n".join(explain(scene, frame))
    assert "object 0: opaque, in one pass with all such: impenetrable" in words
    assert "object 1: blended, in front of object" in words
    assert "object 6: no mask: nothing penetrable in front" in words
    assert "object 7: not drawn: outside the view" in words


def test_boxes_that_no_plane_separates_are_sorted_by_pixel():
    """Two crossing bars before a target, only where they cross; none where they lie apart."""
    bar = geometry.box(6, 0.5, 0.5)
    target = Object(geometry.box(8, 8, 0.2), transforms.translation(0, 0, -4), target=True)
    camera = look_at(np.array([0, 0, 12.0]), np.zeros(3), fov_y=0.8, near=1, far=50)
    crossing = Scene((Object(bar), Object(bar, transforms.rotation_z(np.pi / 2)), target))
    strict = replace(TECHNIQUE, doubt=0.0)
    parts = plan(crossing, camera, strict, SIZE).exact
    assert len(parts) == 1
    left, top, right, bottom = parts[0]
    assert left < SIZE[0] / 2 < right
    assert top < SIZE[1] / 2 < bottom
    lifted = transforms.translation(0, 0, 1) @ transforms.rotation_z(np.pi / 2)
    apart = Scene((Object(bar), Object(bar, lifted), target))
    assert not len(plan(apart, camera, strict, SIZE).exact)


def test_things_are_as_far_as_the_nearest_point_of_their_box():
    """Beside a corner, an edge and a face of a box of 2 × 2 × 2: √3, √2 and 1 from it; 0 inside."""
    scene = Scene((Object(geometry.box(2, 2, 2), transforms.translation(5, 0, 0)),))
    for eye, away in (((3, 2, 2), 3**0.5), ((3, 2, 0.5), 2**0.5), ((3, 0, 0.5), 1), ((5, 0, 0), 0)):
        camera = look_at(np.array(eye, float), np.array([9.0, 0.1, 0]), fov_y=0.8, near=1, far=50)
        for within, hard in ((away - 1e-6, True), (away + 1e-6, False)):
            if within < 0:
                continue
            technique = replace(TECHNIQUE, penetrable_within=within)
            assert impenetrable(scene, camera, technique).tolist() == [hard]
            assert exact.impenetrable(scene, camera, technique).tolist() == [hard]


def test_a_standard_frame_needs_nothing():
    """One pass of everything in view."""
    scene, camera = room()
    frame = plan(scene, camera, Standard(), SIZE)
    assert not frame.levels
    assert len(frame.opaque) == frame.boxes.inside.sum()
    assert "the standard frame" in "\n".join(explain(scene, frame))


def test_parts_are_merged_until_none_overlap():
    """Their union covers every box; nearly everything becomes one part."""
    rng = np.random.default_rng(0)
    low = rng.uniform(0, 350, (12, 2))
    boxes = np.concatenate([low, low + rng.uniform(5, 30, (12, 2))], axis=1)
    parts = merged_parts(boxes, (1000, 1000))
    for a in range(len(parts)):
        for b in range(a):
            meet = (parts[a, :2] < parts[b, 2:]).all() and (parts[a, 2:] > parts[b, :2]).all()
            assert not meet
    for box in boxes:
        assert any((p[:2] <= box[:2]).all() and (p[2:] >= box[2:]).all() for p in parts)
    whole = merged_parts(np.array([[0, 0, 90, 90.0]]), (100, 100))
    assert whole.tolist() == [[0, 0, 100, 100]]


@pytest.mark.parametrize(
    ("tau", "alpha", "counted"),
    [
        (0.3, 0.5, [2]),  # log .3 / log .5 = 1.7: one may keep its opacity
        (0.25, 0.5, []),  # exactly two may
        (0.3, 1.0, [1, 2]),  # none may
        (0.3, 0.0, []),  # any number may
        (0.0, 0.5, []),  # nothing is promised
    ],
)
def test_targets_with_more_in_front_than_leave_enough_light_are_counted(tau, alpha, counted):
    """0, 1 and 2 things in front of three targets, 3 in front of what is no target."""
    relation = np.zeros((4, 4), np.int8)
    for target, number in enumerate(range(4)):
        relation[:number, target] = comparing.IN_FRONT
    masked = np.array([True, True, True, False])
    technique = DynamicTransparency(alpha_target=alpha, min_transmittance=tau)
    assert _counted(relation, masked, technique).tolist() == counted


def test_what_events_made_of_a_technique_is_planned():
    """A lens that a wheel pushed through the room reaches the wall, one pulled near nothing."""
    scene, camera = room()
    lens = named("lens")
    began = lens.technique.begin(lens)
    near, far = (replace(began, depth=depth) for depth in (1e-3, 1e3))
    assert not len(plan(scene, camera, lens, SIZE, state=near).ruled)
    assert 1 in plan(scene, camera, lens, SIZE, state=far).ruled
    plain, given = (plan(scene, camera, lens, SIZE, state=state).ruled for state in (None, began))
    np.testing.assert_array_equal(plain, given)
