"""The shape tools of the model library, against closed forms."""

import numpy as np
import pytest

from seethrough.renderer.models.forms.blend import Limb, body
from seethrough.renderer.models.forms.outline import outline
from seethrough.renderer.models.forms.shapes import assemble, join, shade
from seethrough.renderer.models.forms.surfaces import (
    ball,
    box,
    boxes,
    circle,
    copies,
    curve,
    disc,
    lathe,
    pillow,
    ring,
    rod,
    rounded,
    slab,
    spun,
    sweep,
    tube,
)
from seethrough.renderer.scene.transforms import rotation

RED = (1.0, 0.0, 0.0)
BLUE = (0.0, 0.0, 1.0)


def volume(shape):
    """Divergence theorem: the sum of the signed tetrahedra to the origin."""
    a, b, c = np.moveaxis(shape.vertices[shape.triangles], 1, 0)
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


def polygon_area(n, radius=1.0):
    """Of the regular n-gon in the circle."""
    return n / 2 * np.sin(2 * np.pi / n) * radius**2


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        (box((1, 2, 3), RED), 6.0),
        (disc(2.0, 3.0, RED, 10), 3 * polygon_area(10, 2.0)),
        (lathe([(1, 0), (1, 2), (0, 3)], RED, 12), (2 + 1 / 3) * polygon_area(12)),
        (rod((1, 1, 1), (1, 3, 1), 0.5, RED, 10), 2 * polygon_area(10, 0.5)),
        (rod((0, 0, 0), (3, 4, 0), 0.5, RED, 10), 5 * polygon_area(10, 0.5)),
        (slab([(0, 0), (4, 0), (4, 3), (0, 3)], 2, RED), 24.0),
        # Bevels of .5: the middle 1 thick, above and below prismatoids from 4 × 3 to 3 × 2.
        (
            slab([(0, 0), (4, 0), (4, 3), (0, 3)], 2, RED, 0.5),
            12 + 2 * 0.5 / 6 * (4 * 3 + 4 * 3.5 * 2.5 + 3 * 2),
        ),
        (copies(box((1, 1, 1), RED), [(0, 0, 0), (5, 0, 0), (9, 9, 9)]), 3.0),
        (spun(box((1, 1, 1), RED).at(y=4), 7), 7.0),
        (boxes([(1, 2, 3), (2, 2, 2)], [(0, 0, 0), (9, 0, 0)], [RED, BLUE], 1e-6), 14.0),
        # Pappus: the section's area times the path of its middle, a polygon of 10 equal sectors.
        (
            ring([(3, 0), (4, 0), (4, 2), (3, 2)], RED, 10),
            2 * (polygon_area(10, 4.0) - polygon_area(10, 3.0)),
        ),
    ],
)
def test_volumes_are_those_of_the_polyhedra(shape, expected):
    assert volume(shape) == pytest.approx(expected, rel=1e-5)  # boxes() has bevels of 1e-6


def test_a_rounded_box_has_steiners_volume():
    """Box, plus slabs on its faces, quarter cylinders at its edges and a ball at its corners."""
    r, inner = 0.2, np.array([0.6, 1.6, 2.6])
    faces = 2 * (inner[0] * inner[1] + inner[1] * inner[2] + inner[2] * inner[0])
    edges, corners = np.pi * r**2 * inner.sum(), 4 / 3 * np.pi * r**3
    exact = inner.prod() + r * faces + edges + corners
    made = volume(box((1, 2, 3), RED, r, 12))
    # A circle of chords over the angle t has sin(t)/t of the area; a ball loses that twice.
    loss = 1 - np.sin(np.pi / 24) / (np.pi / 24)
    assert exact - made == pytest.approx(loss * (edges + 2 * corners), rel=0.05)


def test_ellipsoids_and_pillows_lie_between_ball_and_box():
    sizes = np.array([2.0, 1.0, 3.0])
    ellipsoid = 4 / 3 * np.pi * (sizes / 2).prod()
    assert volume(ball(sizes / 2, RED, 64)) == pytest.approx(ellipsoid, rel=0.005)
    assert volume(pillow(sizes, RED, 1.0, 64)) == pytest.approx(ellipsoid, rel=0.005)
    volumes = [volume(pillow(sizes, RED, r, 64)) for r in (1.0, 0.6, 0.3, 0.05)]
    assert np.all(np.diff(volumes) > 0)
    assert volumes[-1] < sizes.prod()


@pytest.mark.parametrize("closed", [False, True])
def test_a_sweep_has_the_volume_of_its_bends(closed):
    """Pappus, for the whole torus and for half of it."""
    n = 400
    angle = np.linspace(0, 2 * np.pi if closed else np.pi, n, endpoint=not closed)
    path = np.column_stack([3 * np.cos(angle), 0 * angle, 3 * np.sin(angle)])
    made = volume(sweep(path, 0.5, RED, 24, closed=closed))
    exact = polygon_area(24, 0.5) * 3 * (2 * np.pi if closed else np.pi)
    assert made == pytest.approx(exact, rel=1e-3)  # 400 steps; the half's ends are one-sided


def test_curve_passes_through_its_points_and_keeps_straight_lines():
    line = curve([(0, 0), (1, 2), (3, 6)], 31)
    np.testing.assert_allclose(line[:, 1], 2 * line[:, 0], atol=1e-12)
    points = np.array([(0.0, 0.0), (3.0, 0.0), (3.0, 4.0), (0.0, 4.0)])  # knots at 0, 3, 7, 10
    np.testing.assert_allclose(curve(points, 11)[[0, 3, 7, 10]], points, atol=1e-12)


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_turned_is_the_right_handed_rotation(axis):
    one = box((1, 2, 3), RED).at(0.3, 0.2, 0.1)
    matrix = rotation(np.eye(3)["xyz".index(axis)], np.radians(37))[:3, :3]
    np.testing.assert_allclose(one.turned(axis, 37).vertices, one.vertices @ matrix.T, atol=1e-12)


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_a_mirror_image_keeps_its_outside_out(axis):
    one = join(box((1, 2, 3), RED, 0.1), ball(1.0, BLUE)).at(2, 3, 4)
    image = one.mirrored(axis)
    assert volume(image) == pytest.approx(volume(one))
    assert image.vertices[:, "xyz".index(axis)].max() < 0
    assert volume(one.both(axis)) == pytest.approx(2 * volume(one))


def test_assemble_stands_and_centres_and_scales():
    low, high = (v(assemble(box((2, 8, 4), RED).at(5, 6, 7), size=2.0).vertices, axis=0)
                 for v in (np.min, np.max))  # fmt: skip
    np.testing.assert_allclose(low, [-0.25, 0.0, -0.5], atol=1e-12)
    np.testing.assert_allclose(high, [0.25, 2.0, 0.5], atol=1e-12)


def test_boxes_have_flat_faces_and_balls_round_ones():
    flat = shade(box((1, 2, 3), RED))
    assert np.sort(np.abs(flat.normals), axis=1) == pytest.approx(
        np.tile([0, 0, 1], (len(flat.normals), 1))
    )
    round_ = shade(ball(1.0, RED, 32))
    cosine = (round_.normals * round_.vertices).sum(axis=1)
    assert cosine.min() > np.cos(np.pi / 32)  # within half a step between the sphere's rings
    assert len(round_.vertices) == 2 + 15 * 32  # every vertex once: no seam


def test_a_cylinder_is_sharp_at_its_rims_only():
    mesh = shade(disc(1.0, 2.0, RED, 16))
    assert len(mesh.vertices) == 4 * 16 + 2
    upright = np.abs(mesh.normals[:, 1]) > 1e-9
    np.testing.assert_allclose(
        np.abs(mesh.normals[upright]), np.tile([0, 1, 0], (34, 1)), atol=1e-12
    )
    side = ~upright
    np.testing.assert_allclose(
        mesh.normals[side][:, [0, 2]], mesh.vertices[side][:, [0, 2]], atol=1e-12
    )


def test_a_colour_border_is_crisp_where_painted_and_soft_where_tinted():
    one = ball(1.0, RED, 16)
    painted = shade(one.painted(BLUE, lambda p: p[:, 1] > 0))
    assert {tuple(c) for c in painted.colors} == {RED, BLUE}
    assert len(painted.vertices) == len(one.vertices) + 16  # the equator twice
    tinted = shade(one.tinted(BLUE, lambda p: (p[:, 1] + 1) / 2))
    assert len(tinted.vertices) == len(one.vertices)
    np.testing.assert_allclose(tinted.colors[:, 2], (tinted.vertices[:, 1] + 1) / 2, atol=1e-12)


def test_shading_parts_together_or_alone_is_the_same():
    parts = [ball(1.0, RED, 12), box((1, 1, 1), BLUE, 0.1), disc(1.0, 1.0, RED, 12).at(y=3)]
    together, alone = shade(join(*parts)), [shade(p) for p in parts]
    for name in ("vertices", "normals", "colors"):
        np.testing.assert_array_equal(
            getattr(together, name), np.concatenate([getattr(m, name) for m in alone])
        )


def test_a_soft_ball_is_a_ball():
    """Surface nets lie within a third of a cell of the level surface."""
    cell = 0.05
    made = body([Limb((0, 0, 0), (0, 0, 0), 1.0, 1.0, RED)], cell)
    radius = np.linalg.norm(made.vertices, axis=1)
    assert np.abs(radius - 1).max() < cell / 3
    assert volume(made) == pytest.approx(4 / 3 * np.pi, rel=0.01)


def test_soft_unions_swell_at_the_joint_and_nowhere_else():
    limbs = [
        Limb((-0.5, 0, 0), (0.5, 0, 0), 0.3, 0.3, RED),
        Limb((0, 0, 0), (0, 1, 0), 0.2, 0.2, BLUE),
    ]
    hard, soft = (
        body([Limb(m.a, m.b, m.ra, m.rb, m.color, soft=s) for m in limbs], 0.03)
        for s in (1e-3, 0.2)
    )
    assert volume(soft) > 1.02 * volume(hard)
    # The far ends of both bars lie where they lay, to an eighth of a cell.
    ends = (soft.vertices.max(axis=0) - hard.vertices.max(axis=0))[:2]
    np.testing.assert_allclose(ends, 0, atol=0.03 / 8)
    assert {tuple(c) for c in soft.colors.reshape(-1, 3)} == {RED, BLUE}


def test_a_body_has_no_edge_of_four_triangles():
    """Two balls that nearly touch give ambiguous cells."""
    for gap in np.linspace(-0.08, 0.08, 9):
        limbs = [Limb((x, x, 0), (x, x, 0), 0.5, 0.5, RED, soft=1e-3)
                 for x in (-0.3536 - gap / 2, 0.3536 + gap / 2)]  # fmt: skip
        made = body(limbs, 0.11)
        edges = np.sort(made.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()


def test_a_tube_cap_of_strips_closes_a_crescent():
    angle = np.linspace(0.2, np.pi - 0.2, 20)
    outer = np.column_stack([np.cos(angle), np.sin(angle)])
    crescent = np.concatenate([outer, (outer * (1, 0.8))[::-1]])
    rings = [np.column_stack([crescent, np.full(40, z)]) for z in (0.0, 1.0)]
    made = tube(rings, RED, strips=True)
    x, y = crescent.T
    area = 0.5 * abs((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())
    assert volume(made) == pytest.approx(area)
    seen = outline(shade(made), np.pi, 0.0, 200)
    assert seen.facing[seen.covered].all()


def test_rounded_rectangles_have_the_area_of_their_polygon():
    x, y = rounded(3.0, 2.0, 0.5, 40).T
    area = 0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum()
    assert area == pytest.approx(6 - (4 - np.pi) * 0.25, abs=1e-3)  # positive: counter-clockwise


def test_outlines_cover_what_the_shape_covers():
    """A ball fills π/4 of the square about it; turned inside out, its back shows."""
    one = ball(1.0, RED, 96)
    seen = outline(shade(one), 0.7, 0.4, 200)
    assert seen.covered.mean() == pytest.approx(np.pi / 4, abs=0.003)
    assert seen.facing[seen.covered].all()
    inside_out = outline(shade(one), 0.7, 0.4, 200)
    mesh = shade(one)
    flipped = type(mesh)(mesh.vertices, mesh.normals, mesh.colors, mesh.triangles[:, ::-1])
    seen = outline(flipped, 0.7, 0.4, 200)
    np.testing.assert_array_equal(seen.covered, inside_out.covered)
    assert not seen.facing[seen.covered].any()


def test_the_viewer_of_an_outline_stands_before_the_front():
    """Yaw 0 looks at the −z side, with +x on the viewer's left; yaw 90° at the +x side."""
    low = box((1, 1, 1), RED)
    arrow = shade(join(low, box((1, 0.2, 0.2), RED).at(x=1.0)))
    front = outline(arrow, 0.0, 0.0).covered.sum(axis=0)
    assert front[:8].max() < front[-8:].min()  # the thin end is on the left
    assert outline(arrow, np.pi / 2, 0.0).covered.all()  # seen end on: a square
    assert circle(5).shape == (5, 2)
