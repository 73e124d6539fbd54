"""Boxes: contours against a convex hull, the order against rays through the boxes."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from seethrough.renderer.polygons.boxes import boxes
from seethrough.renderer.polygons.boxes.box_geometry import Boxes, contour_table, fit
from seethrough.renderer.polygons.boxes.box_overlap import shared_views
from seethrough.renderer.polygons.polygons import Polygons, polygons_from

NOTHING = Polygons(np.empty((0, 3)), np.zeros(1, np.int64), np.empty((0, 0)), np.empty(0, np.int64))


def faces_of(made):
    """Six rectangles for each box."""
    loops = [(0, 2, 6, 4), (1, 5, 7, 3), (0, 4, 5, 1), (2, 3, 7, 6), (0, 1, 3, 2), (4, 6, 7, 5)]
    faces = [c[list(loop)] for c in made.corners() for loop in loops]
    return polygons_from(faces, objects=np.repeat(np.arange(len(made.centers)), 6))


def rotation(rng):
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return q if np.linalg.det(q) > 0 else -q


def scattered(rng, count, upright=False):
    """Boxes on a grid with room to turn, so that none intersect."""
    cells = rng.permutation(4**3)[:count]
    centers = np.stack(np.unravel_index(cells, (4, 4, 4)), axis=1) * 2.0
    halves = rng.uniform(0.02, 0.55, (count, 3))
    axes = np.array([np.eye(3) if upright else rotation(rng) for _ in range(count)])
    return Boxes(centers, axes, halves)


def entry(made, eye, direction):
    """(b, 2) where a ray enters and leaves each box (slabs); infinity where it misses."""
    local_eye = np.einsum("bij,bj->bi", made.axes, eye - made.centers)
    local_way = np.einsum("bij,j->bi", made.axes, direction)
    low, high = ((side * made.halves - local_eye) / local_way for side in (-1, 1))
    near, far = np.minimum(low, high).max(axis=1), np.maximum(low, high).min(axis=1)
    hit = (near < far) & (near > 0)
    return np.where(hit, near, np.inf)


def wrong_rays(made, arranged, eye, rng, rays=400):
    """Pairs of boxes that a ray meets in another order than they are drawn."""
    place = np.empty(len(made.centers), int)
    place[arranged.objects] = np.arange(len(place))
    wrong = 0
    for target in made.centers[rng.integers(len(made.centers), size=rays)]:
        way = target + rng.normal(size=3) * 0.4 - eye
        near = entry(made, eye, way)
        met = np.flatnonzero(np.isfinite(near))
        drawn = met[np.argsort(-near[met])]
        wrong += int((np.diff(place[drawn]) < 0).sum())
    return wrong


def test_contours_are_the_convex_hull_of_the_picture():
    rng = np.random.default_rng(1)
    table, sizes = contour_table()
    assert (sizes > 0).sum() == 26
    one = Boxes(np.zeros((1, 3)), rotation(rng)[None], np.array([[1.0, 0.5, 0.2]]))
    corners = one.corners()[0]
    for _ in range(200):
        eye = rng.normal(size=3) * 3
        local = one.axes[0] @ eye
        if (np.abs(local) < one.halves[0]).all():
            continue
        code = sum(
            1 << (2 * a + s)
            for a in range(3)
            for s in (0, 1)
            if (1 - 2 * s) * local[a] > one.halves[0, a]
        )
        way = -eye / np.linalg.norm(eye)
        away = corners - eye
        frame = np.linalg.svd(way[None])[2][1:]
        if (away @ way <= 1e-6).any():
            continue
        flat = away @ frame.T / (away @ way)[:, None]
        assert set(table[code, : sizes[code]]) == set(ConvexHull(flat).vertices)


@pytest.mark.parametrize("seed", range(6))
def test_the_plane_rule_agrees_with_every_ray(seed):
    rng = np.random.default_rng(seed)
    made = scattered(rng, 30)
    prepared = boxes.prepare(faces_of(made), made)
    for eye in rng.uniform(-8, 14, (6, 3)):
        arranged = prepared.arrange(eye=eye)
        assert arranged.intersecting == ()
        if not arranged.cycles and not (np.abs(eye - made.centers) < 1.3).all(axis=1).any():
            assert wrong_rays(made, arranged, eye, rng) == 0


def test_the_papers_rule_is_wrong_for_a_wall_that_passes_beside_the_eye():
    """No face of the cup, which stands cornerwise, has the whole wall in front: so the nearest
    corner decides, and the wall's is beside the eye, though the cup stands before the wall."""
    c = np.sqrt(0.5)
    cornerwise = np.array([[c, 0, c], [0, 1, 0], [-c, 0, c]])
    made = Boxes(
        np.array([[4.0, 0.0, 0.0], [4.0, 0.5, 0.6]]),
        np.array([np.eye(3), cornerwise]),
        np.array([[5.0, 2.0, 0.1], [0.2, 0.2, 0.2]]),
    )
    eye = np.array([-0.5, 0.5, 2.0])
    by_plane = boxes.prepare(faces_of(made), made, rule="plane").arrange(eye=eye)
    by_paper = boxes.prepare(faces_of(made), made, rule="paper").arrange(eye=eye)
    assert list(by_plane.objects) == [0, 1]
    assert list(by_paper.objects) == [1, 0]
    assert wrong_rays(made, by_plane, eye, np.random.default_rng(0)) == 0
    assert wrong_rays(made, by_paper, eye, np.random.default_rng(0)) > 0


def turn(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, s, 0], [-s, c, 0], [0, 0, 1.0]])


PAIRS = [(0, 1), (0, 2), (1, 2)]


def circle(widths):
    """Three bars, each over the next, of half widths of their own."""
    axes = [turn(2 * np.pi * k / 3 + 0.2) for k in range(3)]
    tilt = np.eye(3)
    tilt[0, 2] = 0.35
    tilt[0] /= np.linalg.norm(tilt[0])
    tilt[2] = np.cross(tilt[0], tilt[1])
    return Boxes(
        np.array([a.T @ np.array([0.0, 0.9, 0.0]) for a in axes]),
        np.array([tilt @ a for a in axes]),
        np.array([[2.2, width, 0.02] for width in widths]),
    )


def shared_rays(made, camera, rng, rays=40_000):
    """How many of many rays meet both of 0 and 1, 0 and 2, 1 and 2 (slabs)."""
    spots = np.column_stack([rng.uniform(-2.5, 2.5, (rays, 2)), np.zeros(rays)])
    if "eye" in camera:
        start, way = camera["eye"][None], spots - camera["eye"]
    else:
        start, way = spots - 30 * camera["view"], camera["view"][None]
    local = np.einsum("bij,rbj->rbi", made.axes, start[:, None] - made.centers)
    local_way = np.einsum("bij,rj->rbi", made.axes, way)
    low, high = ((side * made.halves - local) / local_way for side in (-1, 1))
    near, far = np.minimum(low, high).max(axis=2), np.maximum(low, high).min(axis=2)
    met = (near < far) & (near > 0)
    return [int((met[:, i] & met[:, j]).sum()) for i, j in PAIRS]


@pytest.mark.parametrize("camera", [{"eye": [0.3, 0.2, 12.0]}, {"view": [0.01, 0.02, -1.0]}])
@pytest.mark.parametrize("wide", range(3))
def test_a_circle_is_reported_and_broken_at_the_least_overlap(wide, camera):
    """The pair that fewest rays meet both of: not where upright rectangles overlap least, which
    say little of bars that lie aslant."""
    camera = {name: np.array(value) for name, value in camera.items()}
    widths = np.array([0.12, 0.12, 0.12])
    widths[wide] = 0.3
    made = circle(widths)
    arranged = boxes.prepare(faces_of(made), made).arrange(**camera)
    assert arranged.cycles == ((0, 1, 2),)
    assert sorted(arranged.objects) == [0, 1, 2]
    (pair,) = arranged.broken
    shared = shared_rays(made, camera, np.random.default_rng(4))
    least = PAIRS[int(np.argmin(shared))]
    assert tuple(sorted(pair)) == least
    assert wide not in least


def test_what_two_squares_share_is_their_overlap_in_closed_form():
    """A rectangle of half sides a and b at distance d fills 4 asin(ab / sqrt((a²+d²)(b²+d²)))."""
    flat = [0.7, 0.7, 1e-9]
    made = Boxes(
        np.array([[0.2, 0.0, -3.0], [-0.2, 0.0, -3.0], [0.0, 0.0, -3.0], [5.0, 0.0, -3.0]]),
        np.array([np.eye(3), np.eye(3), turn(np.pi / 4), np.eye(3)]),
        np.array([flat, flat, flat, flat]),
    )
    table, sizes = contour_table()
    first, second = np.array([0, 2, 0]), np.array([1, 2, 3])

    def shared(point):
        corners = np.ascontiguousarray(made.corners())
        return shared_views(
            made.centers, made.axes, made.halves, corners, point, table, sizes, first, second
        )

    a, b, d = 0.5, 0.7, 3.0
    angle = 4 * np.arcsin(a * b / np.sqrt((a**2 + d**2) * (b**2 + d**2)))
    square = 4 * np.arcsin(0.49 / (0.49 + d**2))
    # The boxes are 2e-9 thick: that much nearer, and so much larger, at most.
    assert shared(np.array([0.0, 0, 0, 1])) == pytest.approx([angle, square, 0.0], abs=1e-8)
    assert shared(np.array([0.0, 0, 2, 0])) == pytest.approx([4 * a * b, 1.96, 0.0], abs=1e-8)


def test_a_box_around_the_eye_shares_all_of_another():
    made = Boxes(np.array([[0.0, 0, 0], [0.0, 0, -3]]), np.array([np.eye(3)] * 2), np.ones((2, 3)))
    table, sizes = contour_table()
    rest = (np.ascontiguousarray(made.corners()), np.array([0.0, 0, 0, 1]), table, sizes)
    pairs = np.array([[0, 1, 0], [1, 1, 0]])
    shared = shared_views(made.centers, made.axes, made.halves, *rest, *pairs)
    face = 4 * np.arcsin(1 / (1 + 2.0**2))
    assert shared == pytest.approx([face, face, 4 * np.pi])


def test_intersecting_boxes_are_reported():
    made = Boxes(
        np.array([[0.0, 0, 0], [0.3, 0.2, 0.1]]), np.array([np.eye(3), turn(0.5)]), np.ones((2, 3))
    )
    arranged = boxes.prepare(faces_of(made), made).arrange(eye=np.array([0.0, 0.0, 9.0]))
    assert arranged.intersecting == ((0, 1),)


def test_what_overlaps_nothing_is_free():
    made = Boxes(
        np.array([[0.0, 0, 0], [9.0, 0, 0], [0.0, 0, -5]]),
        np.array([np.eye(3)] * 3),
        np.ones((3, 3)),
    )
    arranged = boxes.prepare(faces_of(made), made).arrange(eye=np.array([0.0, 0.0, 9.0]))
    assert arranged.tested == 1
    assert list(arranged.layers) == [1, 0, 0]


def test_a_parallel_picture_has_an_order_too():
    made = Boxes(np.array([[0.0, 0, 0], [0.5, 0, -5]]), np.array([np.eye(3)] * 2), np.ones((2, 3)))
    prepared = boxes.prepare(faces_of(made), made)
    assert list(prepared.arrange(view=np.array([0.0, 0.0, -1.0])).objects) == [1, 0]
    assert list(prepared.arrange(view=np.array([0.0, 0.0, 1.0])).objects) == [0, 1]


@pytest.mark.parametrize("seed", range(3))
def test_a_box_is_fitted_exactly(seed):
    made = scattered(np.random.default_rng(seed), 5)
    found = fit(faces_of(made))
    assert np.allclose(found.centers, made.centers)
    assert np.allclose(np.sort(found.halves, axis=1), np.sort(made.halves, axis=1))


def test_every_triangle_is_drawn_once_and_far_faces_first():
    made = scattered(np.random.default_rng(3), 4)
    prepared = boxes.prepare(faces_of(made), made)
    order = prepared.order(eye=np.array([9.0, 8.0, 7.0]))
    assert sorted(order) == list(range(len(prepared.drawable.triangles)))


def test_an_unknown_rule_is_refused():
    with pytest.raises(ValueError, match="rule = 'guess', expected one of plane, paper"):
        boxes.prepare(NOTHING, rule="guess")
