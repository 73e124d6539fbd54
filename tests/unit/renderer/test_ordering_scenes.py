"""The two closed volumes after Chen1996: their size, and what the methods make of them."""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.renderer.models.translucent.scenes import scene
from seethrough.renderer.polygons import bsp
from seethrough.renderer.polygons.feudal import feudal
from seethrough.renderer.polygons.polygons import newell

# Polygons, and the splits of the paper's BSP trees (tables 6 and 7).
PUBLISHED = {"vise": (304, 275), "house": (736, 554)}


def baseline(polygons):
    streams = np.random.SeedSequence(3, spawn_key=(21,)).spawn(20)
    trees = [bsp.prepare(polygons, "fewest", rng=np.random.default_rng(s)) for s in streams]
    return np.mean([tree.stats.splits for tree in trees])


@pytest.mark.parametrize("name", PUBLISHED)
def test_scenes_are_closed_and_of_the_published_size(name):
    polygons = scene(name).polygons
    count, splits = PUBLISHED[name]
    areas = newell(polygons)
    heights = polygons.vertices[polygons.starts[:-1]]
    assert len(polygons) == count
    assert (polygons.counts > 4).sum() > 30
    assert np.abs(areas.sum(axis=0)).max() < 1e-9  # closed
    assert (areas * heights).sum() > 0  # and facing outwards
    # Within 30 %, and 3 % for the spread that a mean of 20 trees still has.
    assert abs(baseline(polygons) / splits - 1) < 0.33


@pytest.mark.parametrize("name", PUBLISHED)
def test_feudal_priority_splits_little_and_its_static_list_is_no_longer(name):
    polygons = scene(name).polygons
    static = feudal.prepare(polygons, "static", closed=True)
    dynamic = feudal.prepare(polygons, "dynamic", closed=True)
    assert static.stats.splits < 0.25 * baseline(polygons)
    assert dynamic.stats.relations < static.stats.relations
    rng = np.random.default_rng(5)
    views = rng.normal(size=(20, 3))
    lengths = [sum(len(made.classes(view=v)) for v in views) for made in (static, dynamic)]
    # The paper says never longer. It is not so where the two cut different polygons: on the vise
    # the static list is longer by some parts in a thousand.
    assert lengths[0] <= 1.01 * lengths[1]


def test_classes_hold_every_face_towards_the_viewer_once_and_order_agrees():
    polygons = scene("vise").polygons
    made = feudal.prepare(polygons, closed=True)
    view = np.array([0.3, -0.5, 0.8])
    members = np.concatenate(made.classes(view=view))
    normals = newell(polygons)[made.drawable.source]
    assert sorted(members) == list(np.flatnonzero(normals @ view < 0))
    drawn = made.drawable.owner[made.order(view=view)]
    _, first = np.unique(drawn, return_index=True)
    place = {int(p): i for i, p in enumerate(drawn[np.sort(first)])}
    begin = 0
    for group in made.classes(view=view):
        places = sorted(place[int(p)] for p in group)
        assert places == list(range(begin, begin + len(group)))
        begin += len(group)
