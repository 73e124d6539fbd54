"""Priority lists: how long they are, what is culled, and that orders written out say the same."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from seethrough.renderer.models.translucent.scenes import scene
from seethrough.renderer.polygons import bsp
from seethrough.renderer.polygons.feudal import feudal
from seethrough.renderer.polygons.feudal.feudal_stretches import SWITCHES, knot_roots
from seethrough.renderer.polygons.polygons import polygons_from, triangles_from


def soup(count, seed):
    rng = np.random.default_rng(seed)
    return polygons_from(list(rng.random((count, 1, 3)) + rng.normal(size=(count, 3, 3)) * 0.3))


def bowls(seed):
    """A convex shell inside another, the inner one turned inside out: no group needs a switch."""
    rng = np.random.default_rng(seed)
    faces = []
    for radius, turn in ((1.0, 1), (3.0, -1)):
        points = rng.normal(size=(24, 3))
        points *= radius / np.linalg.norm(points, axis=1, keepdims=True)
        corners = points[ConvexHull(points).simplices]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        wrong = (normal * corners[:, 0]).sum(axis=1) * turn < 0
        corners[wrong] = corners[wrong][:, ::-1]
        faces.append(corners)
    together = np.concatenate(faces)
    return triangles_from(together.reshape(-1, 3), np.arange(3 * len(together)).reshape(-1, 3))


class OutsideIn:
    """A random order, the outer shell first: else an inner plane would part what is left."""

    def __init__(self, seed):
        self.rng = np.random.default_rng(seed)

    def permutation(self, group):
        inner, outer = np.split(group, 2)
        return np.concatenate([self.rng.permutation(outer), self.rng.permutation(inner)])


def views(count, seed=0):
    return np.random.default_rng(seed).normal(size=(count, 3))


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("version", feudal.VERSIONS)
@pytest.mark.parametrize("name", ["vise", "soup"])
def test_orders_written_out_are_the_lists_that_are_searched(name, version, closed):
    """`classes` walks the tree; `order` copies stretches between knots of switches."""
    polygons = scene("vise").polygons if name == "vise" else soup(60, 1)
    prepared = feudal.prepare(polygons, version, closed)
    assert len(prepared.program.stretches.knots) > 1
    bounds = prepared.drawable.bounds
    for view in views(20):
        listed = prepared.classes(view=view)
        owners = prepared.drawable.owner[prepared.order(view=view)]
        drawn = owners[np.flatnonzero(np.diff(owners, prepend=-1))]
        place = np.empty(len(bounds), int)
        place[np.concatenate(listed)] = np.repeat(np.arange(len(listed)), [len(c) for c in listed])
        assert sorted(drawn) == sorted(np.concatenate(listed))
        assert (np.diff(place[drawn]) >= 0).all()
        assert len(owners) == np.diff(bounds)[drawn].sum()


def test_knots_are_as_few_as_can_be():
    """A chain of switches falls into whole knots; of two full children one is left apart."""
    chain = np.array([[i + 1, -1] for i in range(12)] + [[-1, -1]])
    switches = np.array([*range(12), -1])
    assert knot_roots(chain, switches, 4).sum() == 3
    fork = np.array([[1, 2], [3, 4], [5, 6], *([[-1, -1]] * 4)])
    inner = np.array([0, 1, 2, -1, -1, -1, -1])
    assert list(np.flatnonzero(knot_roots(fork, inner, 3))) == [0]
    assert knot_roots(fork, inner, 2).sum() == 2
    assert SWITCHES == 5


def test_the_culled_bsp_draws_the_faces_that_look_towards_the_eye():
    polygons = scene("vise").polygons
    both, culled = (bsp.prepare(polygons, closed=closed) for closed in (False, True))
    planes = both.cuts.planes[both.drawable.source]
    for view in views(20):
        order = both.order(view=view)
        toward = planes[:, 3:6] @ -view > 0
        assert list(culled.order(view=view)) == list(order[toward[both.drawable.owner[order]]])


@pytest.mark.parametrize("seed", range(3))
def test_the_static_list_is_never_longer_where_both_list_one_group(seed):
    polygons = bowls(seed)
    static = feudal.prepare(polygons, "static")
    assert static.stats.nodes == {"connecting": 1, "switch": 0}
    shorter = 0
    for order in range(3):
        dynamic = feudal.prepare(polygons, "dynamic", rng=OutsideIn(order))
        assert dynamic.stats.nodes == static.stats.nodes
        for view in views(10, seed):
            lengths = [len(p.classes(view=view)) for p in (static, dynamic)]
            assert lengths[0] <= lengths[1]
            shorter += lengths[0] < lengths[1]
    assert shorter > 0


def test_the_static_list_can_be_longer_where_the_versions_split_differently():
    """Chen1996 says "always shorter than or at most equal": here is a view that it is not."""
    polygons = scene("vise").polygons
    static = feudal.prepare(polygons, "static", True, balance=1.0)
    longer, lengths = 0, []
    for order in range(3):
        rng = np.random.default_rng(order)
        dynamic = feudal.prepare(polygons, "dynamic", True, balance=1.0, rng=rng)
        pairs = [[len(p.classes(view=v)) for p in (static, dynamic)] for v in views(30, 2)]
        longer += sum(a > b for a, b in pairs)
        lengths += pairs
    assert longer > 0
    assert np.mean(lengths, axis=0)[0] < np.mean(lengths, axis=0)[1]


def test_lookahead_adds_fewer_polygons_and_undoes_its_trials():
    polygons = scene("leaves").polygons.take(np.arange(24))
    plain = feudal.prepare(polygons, "static")
    tried = feudal.prepare(polygons, "static", lookahead=2)
    assert plain.stats.splits > 0
    assert tried.stats.outputs < plain.stats.outputs
    used = int(tried.cuts.used[1])
    assert used == tried.stats.outputs + tried.stats.splits
    assert (tried.cuts.parent[:used] < used).all()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"balance": -1.0}, r"balance = -1\.0, expected a finite number, 0 or larger"),
        ({"balance": np.inf}, "balance = inf, expected a finite number"),
        ({"lookahead": -1}, "lookahead = -1, expected 0 candidates or more"),
    ],
)
def test_options_that_are_none_are_refused(options, message):
    with pytest.raises(ValueError, match=message):
        feudal.prepare(soup(3, 0), **options)
