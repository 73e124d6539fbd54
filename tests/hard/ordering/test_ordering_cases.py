"""BSP and feudal priority on geometry that breaks others, against the rational oracle."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seethrough.renderer.polygons import bsp
from seethrough.renderer.polygons.feudal import feudal
from seethrough.renderer.polygons.polygons import Polygons, polygons_from, triangles_from
from seethrough.renderer.polygons.predicates import paper_sides, plane_corners


def first(polygons):
    return bsp.prepare(polygons, "first")


def fewest(polygons):
    return bsp.prepare(polygons, "fewest")


def sampled(polygons):
    return bsp.prepare(polygons, "sampled")


def static(polygons):
    return feudal.prepare(polygons, "static")


def dynamic(polygons):
    return feudal.prepare(polygons, "dynamic")


METHODS = (first, fewest, sampled, static, dynamic)

TRIANGLE = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]])
UPRIGHT = np.array([[0.5, 0.5, -1.0], [0.6, 0.5, 1.0], [0.5, 1.4, 0.7]])


def soup(count, seed, scale=1.0, offset=0.0):
    rng = np.random.default_rng(seed)
    corners = rng.random((count, 1, 3)) + rng.normal(size=(count, 3, 3)) * 0.4
    return list(corners * scale + offset)


def coplanar():
    turned_over = TRIANGLE[::-1] + np.array([0.3, 0.2, 0.0])
    return [TRIANGLE, TRIANGLE + np.array([1.0, 0.1, 0.0]), turned_over, UPRIGHT]


def near_coplanar():
    sheets = []
    for i in range(5):
        tilt = np.array([[0, 0, 1], [0, 0, -1], [0, 0, 0.5]]) * 1e-12 * i
        sheets.append(TRIANGLE + tilt + [0.05 * i, 0.0, 0.0])
    return [*sheets, UPRIGHT]


def duplicate():
    return [TRIANGLE, TRIANGLE.copy(), TRIANGLE[[1, 2, 0]], TRIANGLE[::-1], UPRIGHT, UPRIGHT]


def zero_area():
    point = np.tile([[0.3, 0.3, 0.3]], (3, 1))
    line = np.array([[0.1, 0.1, 0.1], [0.2, 0.2, 0.2], [0.7, 0.7, 0.7]])
    return [point, TRIANGLE, line, UPRIGHT, point + 0.1]


def needles():
    # The last corner is one float off the line, so the float filter sees no area.
    slim = np.array([[0.1, 0.1, 0.1], [0.9, 0.9, 0.9], [0.5, 0.5, np.nextafter(0.5, 1)]])
    long = np.array([[-1e3, 0.3, 0.2], [1e3, 0.3 + 1e-7, 0.2], [0.0, 0.3, 0.2 + 1e-9]])
    return [slim, long, TRIANGLE, UPRIGHT]


def cyclic():
    """Three bars, each over the next."""
    bar = np.array([[-2.0, -0.3, -0.4], [2.0, -0.3, 0.4], [2.0, 0.3, 0.4], [-2.0, 0.3, -0.4]])
    bars = []
    for k in range(3):
        a = 2 * np.pi * k / 3
        turn = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
        moved = (bar + np.array([0.0, 0.9, 0.0])) @ turn.T
        bars += [moved[[0, 1, 2]], moved[[0, 2, 3]]]
    return bars


def t_junctions():
    wide = np.array([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [2.0, 3.0, 0.1]])
    left = np.array([[0.0, 0.0, 0.0], [1.3, -2.0, 0.7], [1.7, 0.0, 0.0]])
    right = np.array([[1.7, 0.0, 0.0], [2.9, -2.0, -0.6], [4.0, 0.0, 0.0]])
    return [wide, left, right, np.array([[1.0, -2.0, -2.0], [3.0, 1.0, 2.0], [1.2, 2.0, -1.0]])]


def csg_js_11():
    """The triangle and quadrilateral of csg.js issue 11; its corners are rounded to 10⁻⁵, so
    the quadrilateral is not flat and goes in as two triangles."""
    triangle = [
        [1.23079, 0.35525, -0.39928],
        [1.26563, 0.28906, -0.40625],
        [1.24346, 0.44424, -0.41733],
    ]
    quad = np.array(CSG_JS_11_QUAD)
    return [np.array(triangle), quad[[0, 1, 2]], quad[[0, 2, 3]]]


CSG_JS_11_QUAD = [
    [1.26216, 0.46369, -0.43822],
    [1.36719, 0.29688, -0.50000],
    [1.35204, 0.32133, -0.34461],
    [1.25679, 0.47373, -0.34461],
]


def concave():
    """A comb that a plane cuts into many pieces, a holed sheet, and sheets through both."""
    comb = [
        [0, 0],
        [9, 0],
        [9, 3],
        [8, 3],
        [8, 1],
        [7, 1],
        [7, 3],
        [5, 3],
        [5, 1],
        [3, 1],
        [3, 3],
        [1, 3],
        [1, 1],
        [0, 1],
    ]
    ring = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0], [1, 1], [1, 3], [3, 3], [3, 1], [1, 1]]
    flat = np.column_stack([np.array(comb, float), np.zeros(len(comb))])
    holed = np.column_stack([np.array(ring, float), np.full(len(ring), 0.5)])
    holed += np.array([2.0, -1.0, 0.0])
    knife = np.array([[-1.0, 2.0, -2.0], [10.0, 2.0, -2.0], [10.0, 2.0, 2.0], [-1.0, 2.0, 2.0]])
    slant = np.array([[-1.0, 0.5, -2.0], [10.0, 2.5, -2.0], [10.0, 2.5, 2.0], [-1.0, 0.5, 2.0]])
    return [flat, holed, knife, slant]


CASES = {
    "soup": lambda: soup(22, 5),
    "far": lambda: soup(14, 6, offset=1e6),
    "tiny": lambda: soup(14, 7, scale=1e-6),
    "coplanar": coplanar,
    "near_coplanar": near_coplanar,
    "duplicate": duplicate,
    "zero_area": zero_area,
    "needles": needles,
    "cyclic": cyclic,
    "t_junctions": t_junctions,
    "csg_js_11": csg_js_11,
    "concave": concave,
}


@pytest.mark.parametrize("method", METHODS, ids=lambda m: m.__name__)
@pytest.mark.parametrize("case", CASES)
def test_order_is_valid_and_nothing_is_lost(case, method, oracle):
    polygons = polygons_from(CASES[case]())
    prepared = method(polygons)
    rng = np.random.default_rng(11)
    assert oracle.wrong_pairs(polygons, prepared, rng, eyes=3, rays=8) == []
    assert oracle.area_errors(polygons, prepared).max() <= 1.0
    uneven, _ = oracle.uneven_cuts(prepared.cuts, plane_corners(polygons))
    assert uneven == []


@pytest.mark.parametrize("method", METHODS, ids=lambda m: m.__name__)
@pytest.mark.parametrize("case", CASES)
def test_every_fragment_stays_in_the_plane_of_its_source(case, method):
    polygons = polygons_from(CASES[case]())
    drawn = method(polygons).drawable
    corners = plane_corners(polygons)
    for i, source in enumerate(drawn.source):
        a, b, c = corners[source]
        normal = np.cross(b - a, c - a)
        length = np.linalg.norm(normal)
        points = drawn.polygons.corners(i)
        # Cut points are rounded along an edge of the plane: a few units in the last place.
        band = 16 * np.finfo(float).eps * max(1.0, np.abs(points).max()) * (1 if length else 0)
        if length:
            widest = np.abs((points - a) @ (normal / length)).max()
            # The plane's own normal is as uncertain as the needle is slim.
            slim = np.linalg.norm(np.ptp(polygons.corners(source), axis=0)) ** 2 / length
            assert widest <= band * max(1.0, slim)


def test_the_tree_scrambled_on_purpose_is_caught(oracle):
    """The negative control: LabBSP2010's tree that deals polygons to the sides at random."""
    polygons = polygons_from(soup(22, 5))
    prepared = sampled(polygons)
    rng = np.random.default_rng(0)
    flipped = prepared.tree.children.copy()
    some = rng.random(len(flipped)) < 0.5
    flipped[some] = flipped[some][:, ::-1]
    scrambled = replace(prepared, tree=replace(prepared.tree, children=flipped))
    assert oracle.wrong_pairs(polygons, scrambled, np.random.default_rng(1)) != []


def test_a_lost_fragment_is_caught(oracle):
    polygons = polygons_from(soup(10, 5))
    prepared = sampled(polygons)
    drawn = prepared.drawable
    kept = np.arange(len(drawn.polygons)) != int(np.argmax(np.bincount(drawn.source)))
    smaller = type(drawn)(
        drawn.polygons.take(np.flatnonzero(kept)), drawn.source[kept], drawn.triangles, drawn.bounds
    )
    lossy = bsp.PreparedBsp(smaller, prepared.tree, prepared.stats, prepared.cuts)
    assert oracle.area_errors(polygons, lossy).max() > 1.0


def test_the_quadrilateral_of_csg_js_11_is_refused_as_not_flat():
    with pytest.raises(ValueError, match=r"polygon 0: vertex \d lies .* off its plane"):
        polygons_from([CSG_JS_11_QUAD])


def test_near_coplanar_sheets_are_told_apart():
    """10⁻¹² apart is far more than rounding: each sheet keeps its place in the stack."""
    sheets = [TRIANGLE + np.array([0, 0, 1e-12 * i]) for i in range(6)]
    for method in METHODS:
        prepared = method(polygons_from(sheets))
        above = prepared.drawable.source[
            prepared.drawable.owner[prepared.order(eye=np.array([0.5, 0.5, 9.0]))]
        ]
        assert list(above) == list(range(6)), method.__name__
        below = prepared.drawable.source[
            prepared.drawable.owner[prepared.order(eye=np.array([0.5, 0.5, -9.0]))]
        ]
        assert list(below) == list(range(6))[::-1], method.__name__


def test_the_papers_tolerance_fails_at_a_million_in_float32():
    """Most triangles lie more than 10⁻³ off their own plane there; the exact test says 0 always."""
    rng = np.random.default_rng(2)
    corners = (rng.random((500, 3, 3)) + 1e6).astype(np.float32).astype(float)
    own = np.repeat(corners, 3, axis=0)
    points = corners.reshape(-1, 3)
    off = (paper_sides(own, points, 1e-3, np.float32) != 0).reshape(-1, 3).any(axis=1)
    assert off.mean() > 0.3
    assert not (paper_sides(own, points, 1e-3, np.float64) != 0).any()


def test_the_papers_tolerance_merges_what_is_smaller(oracle):
    polygons = polygons_from(soup(14, 7, scale=1e-6))
    merged = bsp.prepare(polygons, "first", tolerance=1e-3)
    assert merged.stats.nodes["switch"] == 1
    assert oracle.wrong_pairs(polygons, merged, np.random.default_rng(3)) != []


def test_neighbours_are_cut_at_the_very_same_point():
    """A fan around an edge, given in both directions and cut by one plane: no crack."""
    a, b = np.array([0.1, 0.2, 0.3]), np.array([1.7, 1.1, 0.9])
    tips = [np.array([1.0, 0.0, 2.0]), np.array([0.0, 1.5, -1.0]), np.array([2.0, 2.0, 0.1])]
    fan = [np.array([a, b, t]) if i % 2 else np.array([b, a, t]) for i, t in enumerate(tips)]
    knife = np.array([[0.77, -9.0, -9.0], [0.83, 9.0, -9.0], [0.91, 0.0, 9.0]])
    prepared = bsp.prepare(polygons_from([knife, *fan]), "first")
    edge = (b - a) / np.linalg.norm(b - a)
    points = prepared.drawable.polygons.vertices
    apart = np.linalg.norm(np.cross(points - a, edge), axis=1)
    inner = (
        (apart < 1e-12) & (np.abs(points - a).max(1) > 1e-9) & (np.abs(points - b).max(1) > 1e-9)
    )
    assert inner.sum() >= 6
    assert len(np.unique(points[inner], axis=0)) == 1


def test_a_convex_ball_is_deep_but_needs_no_recursion():
    """Every face has all others behind it: a tree as deep as it has faces."""
    rng = np.random.default_rng(4)
    from scipy.spatial import ConvexHull

    points = rng.normal(size=(900, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    hull = ConvexHull(points)
    faces = points[hull.simplices]
    outward = (np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]) * faces[:, 0]).sum(1)
    faces[outward < 0] = faces[outward < 0][:, ::-1]
    polygons = triangles_from(faces.reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3))
    prepared = bsp.prepare(polygons, "first")
    assert prepared.stats.depth == len(faces) > 1000
    assert prepared.stats.splits == 0
    flat = feudal.prepare(polygons.take(np.arange(0, len(faces), 8)))
    assert flat.stats.nodes == {"connecting": 1, "switch": 0}


def test_equal_distances_lose_no_polygon():
    """A map keyed by distance, as WebSorting writes it, keeps one polygon of each distance."""
    from seethrough.renderer.polygons import distance

    ring = [
        TRIANGLE @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1))
    ]
    polygons = polygons_from(ring)
    eye = np.array([0.0, 0.0, 5.0])
    by_distance = {np.linalg.norm(r.mean(axis=0) - eye): i for i, r in enumerate(ring)}
    assert len(by_distance) == 1
    assert sorted(distance.prepare(polygons).order(eye=eye)) == [0, 1, 2, 3]


def test_an_empty_set_has_an_empty_order():
    nothing = Polygons(
        np.empty((0, 3)), np.zeros(1, np.int64), np.empty((0, 0)), np.empty(0, np.int64)
    )
    for method in METHODS:
        assert len(method(nothing).order(eye=np.zeros(3))) == 0
