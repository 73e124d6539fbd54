"""The design's balance, counted."""

import hashlib
from collections import Counter
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import CellPlan, Design, generator, session_for
from seethrough.experiment.study.design.factors import BETWEEN, Factor, Level, every_cell
from seethrough.experiment.study.design.items import letters, rotation
from seethrough.experiment.study.design.squares import MIXED, latin_rows, square, williams_rows

PUBLISHED = load("published").plan
BEFORE = "7bff85ab6bbae8c07520eb60501753e1a68649f0351a8d05459d9d66455dffca"


def order_of(slot, k):
    rows = williams_rows(k)
    return rows[(slot - 1) % len(rows)]


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


def test_sixteen_slots_cross_order_task_order_and_scene_set_completely():
    crossed = Counter()
    for slot in range(1, 17):
        trials = [t for s in session_for(slot, PUBLISHED) for t in s.trials]
        walk = [t for t in trials if t.world == "building"]
        order = tuple(dict.fromkeys(tuple(t.levels.values()) for t in trials))
        tasks = tuple(dict.fromkeys(t.task for t in walk))
        first = next(t.scene.split("-")[1] for t in walk if t.levels["transparency"] == "standard")
        crossed[order, tasks, first] += 1
    assert len(crossed) == 16 and set(crossed.values()) == {1}


def test_the_published_plan_is_the_one_of_before_there_were_factors():
    """Every trial of 16 slots as the fixed 2 × 2 design had it: the hash of its words."""
    lines = [
        f"{slot} {t.number} {t.block} {t.task_set} {t.in_set} {t.levels['transparency']} "
        f"{t.levels['scenario']} {t.task} {t.scene} {t.stream} {t.training}"
        for slot in range(1, 17)
        for s in session_for(slot, PUBLISHED)
        for t in (*s.training, *s.trials)
    ]
    assert len(lines) == 512
    assert hashlib.sha256("\n".join(lines).encode()).hexdigest() == BEFORE


@given(sets=st.integers(1, 9), rows=st.integers(1, 30))
def test_within_as_many_passes_as_there_are_sets_each_row_meets_each_rotation(sets, rows):
    for row in range(rows):
        met = {rotation(row, passes, sets) for passes in range(sets)}
        assert met == set(range(sets))


def test_sets_have_names_without_end():
    assert [letters(n) for n in (0, 8, 9, 25, 26, 27, 701, 702)] == [
        "A", "I", "J", "Z", "AA", "AB", "ZZ", "AAA",
    ]  # fmt: skip


@given(k=st.integers(1, 12))
def test_a_latin_square_has_each_thing_once_in_each_row_and_column(k):
    rows = latin_rows(k)
    assert all(sorted(line) == list(range(k)) for line in (*rows, *zip(*rows, strict=True)))


def test_an_order_that_there_is_not_is_named():
    with pytest.raises(ValueError, match="order = 'magic', expected one of williams, latin"):
        square("magic", 3)


def test_published_session_has_every_cell_three_times_and_sixteen_make_384():
    sessions = [session_for(slot, PUBLISHED) for slot in range(1, 17)]
    trials = [trial for session in sessions for s in session for trial in s.trials]
    assert len(trials) == 384
    for session in sessions:
        assert len(session) == 8
        own = [t for s in session for t in s.trials]
        assert [t.number for t in own] == list(range(1, 25))
        cells = Counter((*t.levels.values(), t.task) for t in own)
        assert len(cells) == 8 and set(cells.values()) == {3}


def test_walkthrough_scenes_are_shared_and_sets_never_meet_both_levels_in_one_session():
    for slot in range(1, 17):
        trials = [t for s in session_for(slot, PUBLISHED) for t in s.trials]
        walk = [t for t in trials if t.world == "building"]
        sets = {
            t.levels["transparency"]: {
                u.scene.split("-")[1]
                for u in walk
                if u.levels["transparency"] == t.levels["transparency"]
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
        if t.world == "building"
    }
    assert len(scenes) == 12 and len(set(scenes.values())) == 12


def test_abstract_scenes_and_training_have_streams_of_their_own():
    streams = [
        t.stream
        for slot in range(1, 17)
        for s in session_for(slot, PUBLISHED)
        for t in (*s.trials, *s.training)
        if t.world == "abstract"
    ]
    assert len(streams) == len(set(streams)) == 16 * 4 * 4


def test_a_stream_gives_the_same_numbers_again_and_neighbours_differ():
    a = generator(1, (1, 2, 3)).random(4)
    assert np.array_equal(a, generator(1, (1, 2, 3)).random(4))
    assert not np.array_equal(a, generator(1, (1, 2, 4)).random(4))
    assert not np.array_equal(a, generator(2, (1, 2, 3)).random(4))


def test_slots_start_at_one():
    with pytest.raises(ValueError, match="slot = 0, expected at least 1"):
        session_for(0, PUBLISHED)


def plain_levels(*names):
    return tuple(Level(name) for name in names)


def of_factors(*factors, practice=0, people=8, shared=False, trials=2):
    plan = CellPlan("abstract", ("count",), trials, practice, shared)
    return Design(factors, dict.fromkeys(every_cell(factors), plan), "williams", people)


def test_places_fill_in_step_with_what_each_group_still_needs():
    """Two wanted of one group, six of the other: one person in four goes to the first."""
    group = Factor("group", plain_levels("few", "many"), BETWEEN, people=(2, 6))
    design = of_factors(group)
    # (group, number): slot 1 + group + 2 (number − 1); a tie is the first group's
    assert design.slots(8) == [1, 2, 4, 6, 3, 8, 10, 12]


def test_practice_meets_the_mixed_cells_in_turn():
    mixed = Factor("size", plain_levels("small", "large"), order=MIXED)
    (task_set,) = session_for(1, of_factors(mixed, practice=5))
    met = [t.levels["size"] for t in task_set.training]
    assert sorted(Counter(met).values()) == [2, 3]
    assert all(a != b for a, b in pairwise(met))
    assert len({(t.stream, t.levels["size"]) for t in task_set.training}) == 5
    whole = [t.levels["size"] for t in task_set.trials]
    assert Counter(whole) == {"small": 2, "large": 2}


def test_a_scene_is_drawn_again_as_often_as_it_is_named():
    """Each time from another stream: its last word counts how often."""
    plain = of_factors(Factor("size", plain_levels("a", "b")), shared=True)

    def streams(*redraw):
        sets = session_for(1, replace(plain, redraw=redraw))
        return {t.scene: t.stream for s in sets for t in s.trials}

    scene, *others = before = streams()
    for times in (1, 2, 3):
        after = streams(*[scene] * times)
        assert after[scene] == (*before[scene], times)
        assert [after[name] for name in others] == [before[name] for name in others]


@pytest.mark.parametrize(("outer", "inner"), [(2, 2), (2, 4), (4, 2)])
def test_orders_that_nest_cross_each_row_of_one_with_each_of_the_other(outer, inner):
    a = Factor("a", plain_levels(*"stuv"[:outer]), order="williams")
    b = Factor("b", plain_levels(*"wxyz"[:inner]), order="latin")
    met = Counter()
    for slot in range(1, outer * inner + 1):
        blocks = [s.trials[0].levels for s in session_for(slot, of_factors(a, b))]
        of_a = tuple(dict.fromkeys(levels["a"] for levels in blocks))
        of_b = {tuple(at["b"] for at in blocks if at["a"] == one) for one in of_a}
        assert len(of_b) == 1  # the same within each level of the outer factor
        met[of_a, of_b.pop()] += 1
    assert len(met) == outer * inner and set(met.values()) == {1}


def test_branches_of_unequal_size_begin_again_together():
    """Two levels within one, three within the other: 2 outer rows × lcm(2, 3) slots."""
    a, b = (
        Factor("a", plain_levels("s", "t")),
        Factor("b", plain_levels("x", "y", "z"), order="latin"),
    )
    gone = ({"a": "s", "b": "z"},)
    plan = CellPlan("abstract", ("count",), 1, 0)
    design = Design((a, b), dict.fromkeys(every_cell((a, b), gone), plan), "williams", 12, 0, gone)
    assert design.rows(0) == 12
    met = {"s": Counter(), "t": Counter()}
    for slot in range(1, 13):
        blocks = [s.trials[0].levels for s in session_for(slot, design)]
        first = blocks[0]["a"]
        for one, counts in met.items():
            counts[first, tuple(at["b"] for at in blocks if at["a"] == one)] += 1
    assert sorted(met["s"].values()) == [3] * 4 and sorted(met["t"].values()) == [2] * 6


def test_random_orders_within_levels_are_drawn_for_each_level_anew():
    """The same in all three only by chance: in 1 of 36 slots, so not in a third of 60."""
    a = Factor("a", plain_levels("s", "t", "u"))
    b = Factor("b", plain_levels("x", "y", "z"), order="random")
    alike, orders = 0, Counter()
    for slot in range(1, 61):
        blocks = [s.trials[0].levels for s in session_for(slot, of_factors(a, b))]
        within = [tuple(at["b"] for at in blocks if at["a"] == one) for one in "stu"]
        alike += len(set(within)) == 1
        orders.update(within)
    assert alike < 20
    assert len(orders) == 6  # of 180 draws each of the six orders: missing one has 6 (5/6)^180
