"""Balance over random studies, counted from the trials; and the counting itself."""

from collections import Counter
from dataclasses import replace

import pytest
from designs import designs, played
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from seethrough.experiment.study.design import conditions, design, items, squares
from seethrough.experiment.study.design.balance import Met, counted, cycle, repeated
from seethrough.experiment.study.design.design import CellPlan, Design, session_for
from seethrough.experiment.study.design.factors import Factor, Level

MOST_SLOTS = 400  # of a complete cycle that is played
FEW = settings(max_examples=40, deadline=None)


def whole_cycle(made, group):
    """The slots of a complete cycle of a group."""
    length = cycle(made, group)
    assume(length <= MOST_SLOTS and length * len(made.groups[group].cells) <= 4 * MOST_SLOTS)
    return [made.slot_of(group, n) for n in range(1, length + 1)]


@FEW
@given(made=designs(), data=st.data())
def test_every_promise_holds_over_a_complete_cycle(made, data):
    group = data.draw(st.integers(0, len(made.groups) - 1))
    trials = played(made, whole_cycle(made, group))
    uneven = {(c.what, c.where): c.uneven for c in counted(made, trials) if c.group == group}
    assert not {key: n for key, n in uneven.items() if n}


@FEW
@given(made=designs(), slot=st.integers(1, 96))
def test_each_session_holds_each_task_of_each_cell_of_its_group_as_often_as_asked(made, slot):
    group = made.groups[made.group_of(slot)[0]]
    trials = [t for s in session_for(slot, made) for t in s.trials]
    found = Counter((tuple(t.levels[n] for n in made.names), t.task) for t in trials)
    wanted = {(c, task): made.plans[c].trials for c in group.cells for task in made.plans[c].tasks}
    assert found == wanted
    assert [t.number for t in trials] == list(range(1, len(trials) + 1))


@FEW
@given(made=designs(), slot=st.integers(1, 96))
def test_a_block_is_a_condition_and_no_condition_comes_twice(made, slot):
    block = [f.name for f in made.factors if f.block]
    found = {}
    for task_set in session_for(slot, made):
        for t in (*task_set.training, *task_set.trials):
            found.setdefault(t.block, set()).add(tuple(t.levels[n] for n in block))
    assert all(len(levels) == 1 for levels in found.values())
    assert len({next(iter(levels)) for levels in found.values()}) == len(found)


@FEW
@given(made=designs(), slots=st.sets(st.integers(1, 96), min_size=1, max_size=4))
def test_nobody_meets_an_item_twice_and_no_two_trials_share_a_stream(made, slots):
    assert not repeated(made, played(made, slots))
    for slot in slots:
        streams = [t.stream for s in session_for(slot, made) for t in (*s.training, *s.trials)]
        assert len(set(streams)) == len(streams)


@FEW
@given(made=designs(), slot=st.integers(1, 96))
def test_every_round_of_a_task_set_holds_every_mixed_cell_once(made, slot):
    mixed = [f.name for f in made.factors if f.mixed]
    for task_set in session_for(slot, made):
        cells = [tuple(t.levels[n] for n in mixed) for t in task_set.trials]
        size = len(set(cells))
        rounds = [cells[i : i + size] for i in range(0, len(cells), size)]
        assert all(sorted(r) == sorted(set(cells)) for r in rounds)


@FEW
@given(made=designs())
def test_each_group_has_people_and_together_they_are_all_where_no_cell_is_left_out(made):
    assert sum(g.people for g in made.groups) == made.people or made.excluded
    sizes = Counter()
    for group in made.groups:
        for name, level in group.levels.items():
            sizes[name, level] += group.people
    for factor in made.factors:
        own = [sizes[factor.name, level] for level in factor.names if (factor.name, level) in sizes]
        assert not own or made.excluded or max(own) - min(own) <= 1


@FEW
@given(made=designs(), slot=st.integers(1, 96))
def test_a_new_last_factors_first_level_leaves_every_scene_as_it_was(made, slot):
    more = Factor("new", (Level("old"), Level("other")), scenes="alone")
    wider = replace(
        made,
        factors=(*made.factors, replace(more, order="mixed")),
        plans={(*c, lv): p for c, p in made.plans.items() for lv in more.names},
    )
    assume(not any(p.shared for p in made.plans.values()))
    before = {t.stream: t.levels for s in session_for(slot, made) for t in s.trials}
    after = [t for s in session_for(slot, wider) for t in s.trials if t.levels["new"] == "old"]
    assert {t.stream for t in after} == set(before)
    assert all({n: t.levels[n] for n in made.names} == dict(before[t.stream]) for t in after)


def three_views(order="williams"):
    """Three views and two clutters, scenes shared: items rotate over three cells."""
    view = Factor("view", tuple(map(Level, ("plain", "xray", "cut"))))
    clutter = Factor("clutter", (Level("few"), Level("many")), scenes="changed")
    plan = CellPlan("building", ("count", "unique"), 2, 1, shared=True)
    cells = [(v, c) for v in view.names for c in clutter.names]
    return Design((view, clutter), dict.fromkeys(cells, plan), order, people=18)


def test_items_of_three_levels_meet_each_cell_and_row_equally_often():
    made = three_views()
    counts = counted(made, played(made, range(1, cycle(made, 0) + 1)))
    items_ = [c for c in counts if c.what.startswith("item")]
    assert items_ and all(len(set(c.counts.values())) == 1 for c in items_)
    assert all(min(c.counts.values()) > 0 for c in counts)


@pytest.mark.parametrize(
    ("where", "name", "broken", "what"),
    [
        (items, "rotation", lambda row, passes, sets: (row + row // 2) % sets, "item × cell × row"),
        (items, "rotation", lambda row, passes, sets: 0, "item × cell"),
        (squares, "williams_rows", squares.latin_rows, "successor"),
        (squares, "williams_rows", lambda k: (tuple(range(k)),) * k, "level × position"),
    ],
    ids=["rows meet one rotation", "sets stay", "latin for williams", "one order"],
)  # fmt: skip
def test_a_broken_generator_is_noticed(monkeypatch, request, where, name, broken, what):
    made = three_views()
    monkeypatch.setattr(where, name, broken)
    for module in (design, conditions):
        if hasattr(module, name):
            monkeypatch.setattr(module, name, broken)
    slots = range(1, 6 * 3 * 2 + 1)
    squares.square.cache_clear()
    request.addfinalizer(squares.square.cache_clear)
    assert any(c.what == what and c.uneven for c in counted(made, played(made, slots)))


def test_who_meets_an_item_twice_is_named_and_nobody_else():
    met = [Met(slot, 1, {}, "count", scene) for slot, scene in
           ((1, "A"), (2, "A"), (2, "B"), (3, "B"), (2, "A"))]  # fmt: skip
    assert repeated(None, met) == ["slot 2: A 2 times"]
