"""Masks as arrays, against closed forms and brute force."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_scenes import SHAPES
from scipy.spatial import ConvexHull

from seethrough.renderer.masks import contours, masks
from seethrough.renderer.masks.silhouettes import topology
from seethrough.renderer.masks.skirts import hulls_with_skirts
from seethrough.renderer.reference.pixel_fragments import distances, fragments
from seethrough.renderer.scene import transforms
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency


def test_the_gradient_jumps_at_the_border_and_rises_to_one():
    """α_T on the target, α_0 just outside, 1 from n pixels on (Elmqvist2009 §V-D, Fig. 3)."""
    technique = DynamicTransparency(0.3, 0.1, 10)
    found = masks.opacity(np.array([-1, 0, 1e-9, 5, 10, 11, np.inf]), technique)
    np.testing.assert_allclose(found, [0.3, 0.3, 0.1, 0.55, 1, 1, 1], atol=1e-8)


@given(st.lists(st.tuples(st.integers(-50, 50), st.integers(-50, 50)), min_size=3, max_size=60))
@settings(max_examples=60, deadline=None)
def test_the_hull_is_that_of_qhull(points):
    """Same area and corners, whatever coincides or lies in a row."""
    cloud = np.array(points, float)
    hull = masks.convex_hull(cloud)
    spread = np.linalg.matrix_rank(cloud - cloud[0])
    if spread < 2:
        assert len(hull) <= 2 or np.ptp(hull, axis=0).min() == 0
        return
    x, y = hull.T
    area = (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2
    truth = ConvexHull(cloud)
    assert area == pytest.approx(truth.volume)
    assert len(hull) == len(truth.vertices)


def test_a_hull_with_its_skirt_covers_hull_and_rim_once():
    """The area of the triangles is that of a square grown by the width on all sides."""
    square = np.array([[0, 0], [20, 0], [20, 20], [0, 20.0]])
    rows, first = hulls_with_skirts(square, np.array([0, 4]), 5.0)
    a, b, c = rows[:, :2].astype(float).reshape(-1, 3, 2).swapaxes(0, 1)
    u, v = b - a, c - a
    area = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2
    assert area == pytest.approx(30**2)
    assert first.tolist() == [0, len(rows)]


@st.composite
def outlines(draw):
    """Points about some place: round ones, needles, slivers and specks."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    spread = np.exp(rng.uniform(-3, 3.5, 2))
    turned = rng.normal(size=(draw(st.integers(3, 24)), 2)) * spread
    angle = rng.uniform(0, np.pi)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return turned @ turn + 60.0


@given(outlines(), st.floats(0.5, 25))
@settings(max_examples=150, deadline=None)
def test_a_skirt_says_how_far_away_the_hull_is(cloud, width):
    """At random places: in one triangle at most, in one up to the width, and there the distance to
    the nearest of Qhull's edges, as the shader makes it of what the corners carry."""
    rows, _ = hulls_with_skirts(cloud, np.array([0, len(cloud)]), width)
    rng = np.random.default_rng(1)
    low, high = cloud.min(axis=0) - 1.2 * width, cloud.max(axis=0) + 1.2 * width
    places = rng.uniform(low, high, (300, 2))
    hull = ConvexHull(cloud)
    inside = (hull.equations[:, :2] @ places.T + hull.equations[:, 2:]).max(axis=0)
    p, q = cloud[hull.simplices].swapaxes(0, 1)
    along = np.clip(
        ((places[:, None] - p) * (q - p)).sum(axis=2) / ((q - p) ** 2).sum(axis=1), 0, 1
    )
    away = np.linalg.norm(places[:, None] - p - along[..., None] * (q - p), axis=2).min(axis=1)
    truth = np.where(inside <= 0, 0.0, away)
    found, times = skirted(rows.astype(float), places)
    # Places on the sides of triangles to what float32 holds of 100 pixels are nobody's case here.
    assert (times <= 1).all() and (times[truth < width * (1 - 1e-3)] == 1).all()
    np.testing.assert_allclose(found[times == 1], truth[times == 1], atol=2e-4)


def skirted(rows, places):
    """What the shader finds at places, and in how many triangles each lies."""
    found, times = np.full(len(places), np.nan), np.zeros(len(places), int)
    for a, b, c in rows.reshape(-1, 3, 7):
        solid = np.array([b[:2] - a[:2], c[:2] - a[:2]]).T
        if abs(np.linalg.det(solid)) < 1e-9:
            continue
        u, v = np.linalg.solve(solid, (places - a[:2]).T)
        here = (u > 1e-7) & (v > 1e-7) & (u + v < 1 - 1e-7)
        offset = a[2:4] + u[:, None] * (b - a)[2:4] + v[:, None] * (c - a)[2:4]
        beyond = offset[:, 0] - np.clip(offset[:, 0], 0, a[5])
        found[here] = np.hypot(beyond, offset[:, 1])[here]
        times += here
    return found, times


@pytest.mark.parametrize("seed", range(12))
def test_distances_from_loops_are_those_to_the_triangles(seed):
    """Tori, cones, boxes and spheres at random, half of them tiny: brute force over all edges."""
    rng = np.random.default_rng(seed)
    size = (80, 60)
    camera = look_at(np.array([0, 0, 6.0]), np.zeros(3), fov_y=0.7, near=0.5, far=50)
    lens = (0.5 * size[1] / np.tan(camera.fov_y / 2), size[0] / 2, size[1] / 2)
    for mesh in SHAPES:
        scale = 0.3 if seed % 2 else 1.0
        pose = transforms.placed(rng.uniform(-1, 1, 3), transforms.random_rotation(rng), scale)
        shape = topology(mesh)
        eye = np.linalg.solve(pose[:3, :3], camera.eye - pose[:3, 3])
        turn = camera.rotation.T @ pose[:3, :3]
        move = camera.rotation.T @ (pose[:3, 3] - camera.eye)
        edges = contours.half_edges(shape)
        found = contours.distances(shape, edges, (eye, turn, move), lens, (0, 0, *size), 7.0, 0.0)
        seen = fragments(Scene((Object(mesh, pose),)), camera, size)
        truth = distances(seen.outlines[0], size[1], size[0], 7.0)
        truth = np.where(np.isinf(truth), contours.FAR, truth)
        truth[np.isfinite(seen.depth[0])] = -1
        off_edge = ~seen.near_edge
        # float32 holds a distance of 7 pixels to 5e-7.
        np.testing.assert_allclose(found[off_edge], truth[off_edge], atol=1e-5, rtol=0)


def test_the_cap_leaves_the_least_transmittance():
    """k layers at the cap leave exactly τ, in both models."""
    counts = np.arange(1, 40)
    multiply = masks.cap(counts, DynamicTransparency(min_transmittance=0.3))
    np.testing.assert_allclose((1 - multiply) ** counts, 0.3)
    add = masks.cap(counts, DynamicTransparency(min_transmittance=0.3, model="additive"))
    np.testing.assert_allclose(1 - add * counts, 0.3)
    assert masks.cap(np.zeros(1, int), DynamicTransparency(min_transmittance=0.3))[0] == 1


def test_a_circle_and_ellipses_hold_their_points():
    """Every point lies inside; beyond, the circle's distance is Euclidean."""
    rng = np.random.default_rng(3)
    points = rng.normal(size=(40, 2)) * [9, 3] + [50, 40]
    for shape in ("circle", "ellipse", "oriented-ellipse"):
        along = np.array([np.cos(0.4), np.sin(0.4)])
        cx, cy, ux, uy, a, b = masks.bounding_ellipse(points, shape, along)
        p = (points - [cx, cy]) @ np.array([[ux, -uy], [uy, ux]])
        assert np.hypot(p[:, 0] / a, p[:, 1] / b).max() <= 1 + 1e-9
    circle = masks.bounding_ellipse(points, "circle", np.array([1.0, 0.0]))
    distance = masks.ellipse_distance(circle, (100, 80))
    expected = np.hypot(10.5 - circle[0], 5.5 - circle[1]) - circle[4]
    assert distance[5, 10] == pytest.approx(expected)


@pytest.mark.parametrize(
    "points",
    [[(5, 5)], [(5, 5), (9, 5)], [(9, 5), (5, 5)], [(3, 8), (3, 2)], [(1, 1), (4, 3), (7, 5)],
     [(7, 1), (4, 3), (1, 5)]],
)  # fmt: skip
def test_what_is_seen_edge_on_gets_the_box_about_its_points(points):
    """A ten-thousandth of a pixel about them, however they lie and whichever comes first."""
    cloud = np.array(points, float)
    rows, _ = hulls_with_skirts(cloud, np.array([0, len(cloud)]), 0.0)
    low, high = cloud.min(axis=0) - 1e-4, cloud.max(axis=0) + 1e-4
    np.testing.assert_allclose(rows[:, :2].min(axis=0), low, atol=1e-6)  # they are float32
    np.testing.assert_allclose(rows[:, :2].max(axis=0), high, atol=1e-6)
    a, b, c = rows[:, :2].astype(float).reshape(-1, 3, 2).swapaxes(0, 1)
    u, v = b - a, c - a
    area = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2
    # Sides of 2e-4 pixels at places of up to 9, which float32 holds to 5e-7.
    assert area == pytest.approx(np.prod(high - low), rel=1e-2)
