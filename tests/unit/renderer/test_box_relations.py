"""Which boxes overlap in the picture and which is in front, against what their corners say."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from seethrough.renderer.polygons.boxes.box_geometry import Boxes, contour_table
from seethrough.renderer.polygons.boxes.box_relations import APART, FIRST, SECOND, relate

CLOSE = 1e-9  # of the picture: outlines that nearly touch may be taken for either


def turned(rng):
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return q * np.sign(np.linalg.det(q))


def scattered(rng, count=14):
    """Boxes of every shape, turned every way, some of which meet."""
    centers = rng.uniform(-3, 3, (count, 3))
    return Boxes(centers, np.array([turned(rng) for _ in range(count)]),
                 rng.uniform(0.05, 1.2, (count, 3)))  # fmt: skip


def related(made, point, exact):
    corners = np.ascontiguousarray(made.corners())
    return relate(made.centers, made.axes, made.halves, corners, point, *contour_table(), exact)


def outlines(made, point):
    """(b,) convex outlines in a picture: (k, 2) places of corners."""
    way = -point[:3] / np.linalg.norm(point[:3])
    across = np.linalg.svd(way[None])[2][1:]
    found = []
    for corners in made.corners():
        if point[3]:
            away = corners - point[:3]
            assert (away @ way > 0).all()
            flat = away @ across.T / (away @ way)[:, None]
        else:
            flat = corners @ across.T
        found.append(flat[ConvexHull(flat).vertices])
    return found


def gap(a, b):
    """How far two convex outlines are apart along the normal that parts them most."""
    best = -np.inf
    for loop in (a, b):
        sides = np.roll(loop, -1, axis=0) - loop
        normals = np.column_stack([sides[:, 1], -sides[:, 0]])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        first, second = a @ normals.T, b @ normals.T
        ahead, behind = second.min(0) - first.max(0), first.min(0) - second.max(0)
        best = max(best, ahead.max(), behind.max())
    return best


def paper(made, i, j, point):
    """The paper's rule, corner by corner: j's planes with all of i in front, else the nearest."""
    one, other = made.corners()[i], made.corners()[j]
    walls = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            normal = sign * made.axes[j, axis]
            wall = (other @ normal).max()
            if (one @ normal >= wall).all():
                walls.append((normal, wall))
    if len(walls) == 1:
        ((normal, wall),) = walls
        return FIRST if point[:3] @ normal > wall * point[3] else SECOND
    if point[3]:
        near = [np.linalg.norm(c - point[:3], axis=1).min() for c in (one, other)]
    else:
        near = [(-c @ point[:3]).min() for c in (one, other)]
    return FIRST if near[0] < near[1] else SECOND


POINTS = [(w, seed) for w in (1.0, 0.0) for seed in range(8)]


def seen_from(rng, w):
    way = rng.normal(size=3)
    return np.array([*(way / np.linalg.norm(way) * (12.0 if w else 1.0)), w])


@pytest.mark.parametrize(("w", "seed"), POINTS)
def test_pairs_that_are_tested_are_those_whose_outlines_overlap(w, seed):
    """From an eye and along a direction: two outlines overlap where no line parts them."""
    rng = np.random.default_rng(seed)
    made, point = scattered(rng), seen_from(rng, w)
    loops = outlines(made, point)
    gaps = {(i, j): gap(loops[i], loops[j]) for i, j in combinations(range(len(loops)), 2)}
    assert min(abs(g) for g in gaps.values()) > CLOSE
    relations, tested = related(made, point, True)
    overlapping = {pair for pair, apart in gaps.items() if apart < 0}
    assert 10 < len(overlapping) < len(gaps) - 10
    assert tested == len(overlapping)
    assert {(int(i), int(j)) for i, j in np.argwhere(relations != APART)} == overlapping


@pytest.mark.parametrize(("w", "seed"), POINTS)
def test_the_papers_rule_is_what_the_corners_say(w, seed):
    rng = np.random.default_rng(seed)
    made, point = scattered(rng), seen_from(rng, w)
    relations, _ = related(made, point, False)
    found = {(int(i), int(j)): int(relations[i, j]) for i, j in np.argwhere(relations != APART)}
    assert found == {(i, j): paper(made, i, j, point) for i, j in found}
    assert set(found.values()) == {FIRST, SECOND}


@pytest.mark.parametrize("seed", range(6))
def test_a_direction_is_an_eye_far_away(seed):
    """What is in front along a direction is so from a point a million sizes back on it."""
    rng = np.random.default_rng(seed)
    made, way = scattered(rng), seen_from(rng, 0.0)
    far = np.array([*(way[:3] * 1e6), 1.0])
    for exact in (True, False):
        along, beside = related(made, way, exact)[0], related(made, far, exact)[0]
        both = (along != APART) & (beside != APART)
        assert both.sum() > 10
        assert np.array_equal(along[both], beside[both])
