"""Which trials count: each that does not by one rule, the first, in a table made by hand."""

import pandas as pd

from seethrough.analysis.exclude import REPEATED, apply_rules

ROWS = [  # trial, attempt, time, time_clean, timed_out, source, the rules that it breaks
    (1, 1, 2.0, 2.0, 0, "human", ()),
    (2, 1, 2.0, 1.5, 1, "human", ("timed_out", "focus_lost")),
    (3, 1, 2.0, 1.5, 1, "human", (REPEATED,)),  # whatever else it broke
    (3, 2, 2.0, 2.0, 0, "human", ()),
    (4, 1, 0.1, 0.1, 0, "human", ("too_fast",)),
    (4, 1, 0.2, 0.2, 0, "other", ()),  # just slow enough; somebody else's first attempt
]


def table():
    columns = ("trial", "attempt", "time", "time_clean", "timed_out", "source")
    trials = pd.DataFrame([row[:6] for row in ROWS], columns=columns)
    names = [f"r{k}" for k in range(len(ROWS))]
    people = trials["source"].map({"human": "P1", "other": "P2"})
    return trials.assign(row_id=names, participant=people, _file="t.csv", _row=range(len(ROWS)))


def test_a_trial_is_left_out_by_the_first_rule_that_it_breaks():
    for order in (("timed_out", "focus_lost", "too_fast"), ("too_fast", "focus_lost", "timed_out")):
        kept, gone = apply_rules(table(), order)
        first = {
            f"r{k}": (broken if broken == (REPEATED,) else sorted(broken, key=order.index))[0]
            for k, (*_, broken) in enumerate(ROWS)
            if broken
        }
        assert {e.row_id: e.rule for e in gone} == first
        assert list(kept["row_id"]) == [f"r{k}" for k, row in enumerate(ROWS) if not row[6]]


def test_without_rules_only_earlier_attempts_go():
    kept, gone = apply_rules(table(), ())
    assert [(e.row_id, e.rule, e.participant, e.file, e.row) for e in gone] == [
        ("r2", REPEATED, "P1", "t.csv", 2)
    ]
    assert len(kept) == len(ROWS) - 1


def test_simulated_people_miss_no_frames_and_a_twentieth_is_allowed():
    frames = table().head(3).assign(
        attempt=1, trial=[1, 2, 3], frames=[100, 100, 100], frames_missed=[5, 6, 6],
        source=["human", "human", "simulated"],
    )  # fmt: skip
    _, gone = apply_rules(frames, ("frames_missed",))
    assert [e.row_id for e in gone] == ["r1"]
