"""Levels keep to who lies before whom; in a circle, what gives way is said, and is no target."""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.renderer.plan.comparing import BEHIND, IN_FRONT
from seethrough.renderer.plan.gathering import gathered
from seethrough.renderer.plan.levels import levels
from seethrough.renderer.plan.order import Placed, Related, decide, doubtful, near_each_other

WIDE = np.tile([0.0, 0, 100, 100], (6, 1))  # every box overlaps every other


def drawn(relation, blended, masked, extents=None):
    n = len(relation)
    boxes = WIDE[:n] if extents is None else extents
    reach = boxes + np.array([-10.0, -10, 10, 10])
    related = Related(np.arange(n), boxes, reach, relation, blended, masked)
    return levels(related), related


@pytest.mark.parametrize("seed", range(60))
def test_what_is_not_broken_holds(seed):
    """Of any relation, circles included: who is in front and not said to give way comes later."""
    rng = np.random.default_rng(seed)
    n = 6
    relation = np.triu(rng.choice(np.array([-1, 0, 1], np.int8), (n, n)), 1)
    relation -= relation.T
    masked, blended = rng.random(n) < 0.5, rng.random(n) < 0.8
    (of_object, of_mask, broken), _ = drawn(relation, blended, masked)
    assert (of_object[blended] >= 0).all() and (of_mask[masked] >= -1).all()
    for i in np.nonzero(blended)[0]:
        for j in np.nonzero(relation[i] == IN_FRONT)[0]:
            if not (broken[i, j] or broken[j, i]):
                assert not blended[j] or of_object[i] > of_object[j]
                assert not masked[j] or of_object[i] > of_mask[j]
            assert relation[j, i] == BEHIND
        assert not masked[i] or of_mask[i] >= of_object[i]
        if of_object[i] > 0 and not broken.any():  # no later than what it waits for has it
            behind = relation[i] == IN_FRONT
            assert of_object[i] - 1 in (*of_object[behind & blended], *of_mask[behind & masked])


def groups(of_object, meshes):
    """How many draws the objects take: one for each mesh of each level."""
    return len({(k, m) for k, m in zip(of_object.tolist(), meshes.tolist(), strict=True) if k >= 0})


def test_what_can_wait_goes_with_others_of_its_mesh():
    """0 lies free, 1 behind 2, which has the mesh of 0; so has 3, which no other may wait for."""
    relation = np.array([[0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, -1], [0, 0, 1, 0]], np.int8)
    yes, no = np.ones(4, bool), np.zeros(4, bool)
    (of_object, of_mask, _), related = drawn(relation, yes, no)
    assert of_object.tolist() == [0, 0, 1, 2]
    found, _ = gathered(related, np.array([0, 1, 0, 1]), yes, of_object, of_mask)
    assert found.tolist() == [1, 0, 1, 2]
    found, _ = gathered(related, np.array([0, 1, 1, 0]), yes, of_object, of_mask)
    assert found.tolist() == [2, 0, 1, 2]


def test_gathered_levels_keep_to_the_order_in_fewer_draws():
    """Boxes at random, put in order by depth: whoever overlaps another keeps to it, there are no
    more levels, and of all draws that the first levels take at least a tenth is gone."""
    first = second = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        n = 40
        low = rng.uniform(0, 200, (n, 2))
        extents = np.concatenate([low, low + rng.exponential(15, (n, 2))], axis=1)
        relation = np.sign(np.arange(n)[:, None] - np.arange(n)).astype(np.int8)
        masked, blended = rng.random(n) < 0.4, rng.random(n) < 0.8
        meshes, solid = rng.integers(0, 3, n), rng.random(n) < 0.5
        (of_object, of_mask, broken), related = drawn(relation, blended, masked, extents)
        reach = related.reach
        new_object, new_mask = gathered(related, meshes, solid, of_object, of_mask)
        assert not broken.any()
        assert max(new_object.max(), new_mask.max()) == max(of_object.max(), of_mask.max())
        assert ((new_object >= 0) == blended).all() and ((new_mask >= -1) == masked).all()
        for i in np.nonzero(blended)[0]:
            assert not masked[i] or new_mask[i] >= new_object[i]
            for j in range(i):  # behind i
                over = (extents[i, :2] <= extents[j, 2:]) & (extents[i, 2:] >= extents[j, :2])
                assert not (over.all() and blended[j]) or new_object[i] > new_object[j]
                over = (extents[i, :2] <= reach[j, 2:]) & (extents[i, 2:] >= reach[j, :2])
                assert not (over.all() and masked[j]) or new_object[i] > new_mask[j]
            for j in range(i + 1, n):
                over = (extents[i, :2] <= reach[j, 2:]) & (extents[i, 2:] >= reach[j, :2])
                assert not (over.all() and masked[j]) or new_mask[j] >= new_object[i]
        first, second = first + groups(of_object, meshes), second + groups(new_object, meshes)
    assert second < 0.9 * first


@pytest.mark.parametrize("seed", range(20))
def test_all_that_overlap_are_compared(seed):
    """By brute force over all pairs of boxes at random, of targets what their masks reach; some lie
    behind the eye, with boxes from ∞ to −∞."""
    rng = np.random.default_rng(seed)
    n = 30
    low = rng.uniform(0, 100, (n, 2))
    extents = np.concatenate([low, low + rng.exponential(15, (n, 2))], axis=1)
    extents[rng.random(n) < 0.1] = np.array([np.inf, np.inf, -np.inf, -np.inf])
    reach = extents + np.array([-8.0, -8, 8, 8])
    targets, order = rng.random(n) < 0.4, rng.permutation(n)[:25]
    zeros = np.zeros(n)
    placed = Placed(
        *(order, extents, reach, np.zeros((n, 3)), np.zeros((n, 3, 3)), zeros, zeros, zeros),
        *(targets, np.zeros(n, bool)),
    )
    boxes = np.where(targets[:, None], reach, extents)[order]
    expected = {
        (a, b) for a in range(25) for b in range(a)
        if (boxes[a, :2] <= boxes[b, 2:]).all() and (boxes[a, 2:] >= boxes[b, :2]).all()
    }  # fmt: skip
    found = [tuple(pair) for pair in near_each_other(placed).tolist()]
    assert len(found) == len(set(found)) and set(found) == expected


def test_of_a_circle_with_a_target_the_target_loses_nothing():
    """0 before 1 before 2 before 0, each in turn the target: never drawn after what hides it."""
    relation = np.array([[0, 1, -1], [-1, 0, 1], [1, -1, 0]], np.int8)
    for target in range(3):
        masked = np.arange(3) == target
        (of_object, of_mask, broken), related = drawn(relation, np.ones(3, bool), masked)
        assert broken.any()
        front = int(np.nonzero(relation[:, target] == IN_FRONT)[0][0])
        assert of_object[front] > max(of_object[target], of_mask[target])
        no = np.zeros((3, 3), bool)
        found, must = doubtful(related, no, broken, no, np.array([100.0, 100.0]))
        assert len(found) and not must.any()


def test_a_circle_of_targets_must_be_sorted():
    """One of three is lost whoever goes first, unless hardly any of it lies where they overlap."""
    relation = np.array([[0, 1, -1], [-1, 0, 1], [1, -1, 0]], np.int8)
    yes, no, size = np.ones(3, bool), np.zeros((3, 3), bool), np.array([100.0, 100.0])
    corners = np.array([[0.0, 0, 50, 50], [48, 48, 98, 98], [47, 0, 97, 49]])
    for extents, expected in ((WIDE[:3], True), (corners, False)):
        (_, _, broken), related = drawn(relation, yes, yes, extents)
        assert doubtful(related, no, broken, no, size)[1].any() == expected


def decided(targets, hard=(False, False), swapped=False):
    """Two cubes that reach into one another, the first the nearer one unless `swapped`."""
    sides = np.tile(np.eye(3), (2, 1, 1))
    centers = np.array([[0.0, 0, -5.0], [0.3, 0, -5.2]])
    order = np.array([0, 1]) if swapped else np.array([1, 0])  # from far to near
    boxes = WIDE[:2]
    near, far = np.array([4.0, 4.2]), np.array([6.0, 6.2])
    no = np.zeros(2, bool)
    known = np.full((2, 2), 2, np.int8)
    placed = Placed(
        *(order, boxes, boxes, centers, sides, np.full(2, 1.8), near, far),
        *(np.array(targets), np.array(hard)),
    )
    return decide(placed, near_each_other(placed), no, no, known, False)


@pytest.mark.parametrize("swapped", [False, True])
def test_a_target_in_doubt_counts_as_behind(swapped):
    """Whichever centre is nearer; and an impenetrable one behind one that is not."""
    for first, second, hard in (
        (True, False, (False, False)),
        (True, True, (True, False)),
    ):
        relation, uncertain, _, _ = decided((first, second), hard, swapped)
        assert uncertain[0, 1]
        assert relation[0, 1] == BEHIND and relation[1, 0] == IN_FRONT
        relation = decided((second, first), hard[::-1], swapped)[0]
        assert relation[1, 0] == BEHIND


def test_of_two_targets_the_centres_decide_at_first():
    assert decided((True, True))[0][0, 1] == IN_FRONT
    assert decided((True, True), swapped=True)[0][0, 1] == BEHIND
