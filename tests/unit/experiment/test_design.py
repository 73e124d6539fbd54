"""The design's balance, counted."""

from collections import Counter
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from seethrough.experiment.study.design import (
    Factors,
    generator,
    order_of,
    scene_set,
    session_for,
    task_order,
    williams_rows,
)

PUBLISHED = Factors(
    transparency=("standard", "dynamic"),
    tasks={"abstract": ("count", "pattern"), "walkthrough": ("unique", "count_in_building")},
    trials=3,
    training=1,
    static_scenarios=("walkthrough",),
)


@given(k=st.integers(2, 9), passes=st.integers(1, 7))
def test_whole_passes_balance_positions_and_successions_exactly(k, passes):
    rows = len(williams_rows(k))
    assert rows == (k if k % 2 == 0 else 2 * k)
    orders = [order_of(slot, k) for slot in range(1, passes * rows + 1)]
    at_position = Counter((p, c) for order in orders for p, c in enumerate(order))
    follows = Counter(pair for order in orders for pair in pairwise(order))
    assert len(at_position) == k * k and len(set(at_position.values())) == 1
    assert len(follows) == k * (k - 1) and len(set(follows.values())) == 1


@given(k=st.integers(2, 9), participants=st.integers(1, 64))
def test_row_counts_differ_by_at_most_one_at_any_number_of_participants(k, participants):
    rows = Counter(order_of(slot, k) for slot in range(1, participants + 1))
    counts = [rows.get(row, 0) for row in williams_rows(k)]
    assert max(counts) - min(counts) <= 1
    assert sum(counts) == participants
    assert all(sorted(row) == list(range(k)) for row in rows)


@given(k=st.integers(2, 9), participants=st.integers(1, 64), tasks=st.integers(1, 4))
def test_task_orders_are_permutations_and_used_equally_often_to_within_one_pass(
    k, participants, tasks
):
    orders = [task_order(slot, k, tasks) for slot in range(1, participants + 1)]
    assert all(sorted(order) == list(range(tasks)) for order in orders)
    used = Counter(orders)
    # The swap at each pass through the rows can repeat one order: one more for each pass begun.
    passes = -(-participants // len(williams_rows(k)))
    assert max(used.values()) - min(used.get(o, 0) for o in williams_rows(tasks)) <= 1 + passes


def test_sixteen_slots_cross_order_task_order_and_scene_set_completely():
    crossed = Counter(
        (order_of(slot, 4), task_order(slot, 4, 2), scene_set(slot, 0, 2)) for slot in range(1, 17)
    )
    assert len(crossed) == 16 and set(crossed.values()) == {1}


def test_published_session_has_every_cell_three_times_and_sixteen_make_384():
    sessions = [session_for(slot, PUBLISHED) for slot in range(1, 17)]
    trials = [trial for session in sessions for s in session for trial in s.trials]
    assert len(trials) == 384
    for session in sessions:
        assert len(session) == 8
        own = [t for s in session for t in s.trials]
        assert [t.number for t in own] == list(range(1, 25))
        cells = Counter((t.transparency, t.scenario, t.task) for t in own)
        assert len(cells) == 8 and set(cells.values()) == {3}


def test_walkthrough_scenes_are_shared_and_sets_never_meet_both_levels_in_one_session():
    for slot in range(1, 17):
        trials = [t for s in session_for(slot, PUBLISHED) for t in s.trials]
        walk = [t for t in trials if t.scenario == "walkthrough"]
        sets = {
            t.transparency: {
                u.scene.split("-")[1] for u in walk if u.transparency == t.transparency
            }
            for t in walk
        }
        assert all(len(s) == 1 for s in sets.values())
        assert sets["standard"] != sets["dynamic"]
    scenes = {
        t.scene: t.stream
        for slot in range(1, 17)
        for s in session_for(slot, PUBLISHED)
        for t in s.trials
        if t.scenario == "walkthrough"
    }
    assert len(scenes) == 12 and len(set(scenes.values())) == 12


def test_abstract_scenes_and_training_have_streams_of_their_own():
    streams = [
        t.stream
        for slot in range(1, 17)
        for s in session_for(slot, PUBLISHED)
        for t in (*s.trials, *s.training)
        if t.scenario == "abstract"
    ]
    assert len(streams) == len(set(streams)) == 16 * 4 * 4


def test_a_stream_gives_the_same_numbers_again_and_neighbours_differ():
    a = generator(1, (1, 2, 3)).random(4)
    assert np.array_equal(a, generator(1, (1, 2, 3)).random(4))
    assert not np.array_equal(a, generator(1, (1, 2, 4)).random(4))
    assert not np.array_equal(a, generator(2, (1, 2, 3)).random(4))


def test_slots_start_at_one():
    with pytest.raises(ValueError, match="slot = 0, expected at least 1"):
        order_of(0, 4)
