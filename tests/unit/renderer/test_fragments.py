"""Pieces know where they come from: which polygon, which piece, and what cut them."""

import numpy as np

from seethrough.renderer.polygons.fragments import CUT, Fragments
from seethrough.renderer.polygons.polygons import newell, polygons_from

SQUARE = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])


def test_pieces_of_a_square_that_two_others_cut():
    across, along = SQUARE[:, [2, 1, 0]], SQUARE[:, [0, 2, 1]]
    made = polygons_from([SQUARE, across, along])
    fragments = Fragments(made)
    assert fragments.parent.tolist() == fragments.cutter.tolist() == [-1, -1, -1]
    whole, by = np.array([0]), np.array([1])
    assert fragments.classify(whole, by).tolist() == [CUT]
    halves, parents, sides = fragments.cut(whole, by)
    assert sorted(sides.tolist()) != [sides[0]] * 2 and parents.tolist() == [0, 0]
    again = np.full(2, 2)
    assert fragments.classify(halves, again).tolist() == [CUT, CUT]
    quarters, parents, _ = fragments.cut(halves, again)
    assert sorted(parents.tolist()) == [0, 0, 1, 1]
    used = fragments.used[1]
    assert used == 3 + 2 + 4
    assert fragments.source[:used].tolist() == [0, 1, 2, *[0] * 6]
    assert fragments.parent[halves].tolist() == [0, 0]
    assert fragments.cutter[halves].tolist() == [1, 1]
    assert fragments.parent[quarters].tolist() == halves[parents].tolist()
    assert fragments.cutter[quarters].tolist() == [2] * 4
    cut = fragments.polygons(quarters)
    areas = np.linalg.norm(newell(cut), axis=1)
    assert np.allclose(areas / areas.sum(), 0.25)
    middles = [cut.corners(k).mean(axis=0) for k in range(4)]
    assert sorted(map(tuple, np.round(middles, 12))) == [
        (x, y, 0.0) for x in (-0.5, 0.5) for y in (-0.5, 0.5)
    ]
