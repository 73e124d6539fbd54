"""What a design says of its cells and factors, and what of it nobody met: cases made by hand."""

from types import SimpleNamespace

import pandas as pd
import pytest

from seethrough.analysis.design import Design, Factor, Task
from seethrough.analysis.sections.participants import _unmet

VIEW = Factor("view", "within", ("plain", "cut"), "plain")
CLUTTER = Factor("clutter", "within", ("low", "high"), "low", scenes="changed")
GONE = ({"view": "cut", "clutter": "high"},)


@pytest.mark.parametrize(
    ("cell", "gone"),
    [
        ({"view": "cut", "clutter": "high"}, True),
        ({"view": "cut", "clutter": "high", "task": "count"}, True),
        ({"view": "cut", "clutter": "low"}, False),
        ({"view": "cut"}, False),  # some of its cells are there
        ({}, False),
    ],
)
def test_a_cell_is_left_out_where_all_agrees_that_an_entry_says(cell, gone):
    assert Design((VIEW, CLUTTER), (), GONE).left_out(cell) == gone


def test_people_are_followed_over_levels_that_leave_scenes_alone_if_there_are_any():
    group = Factor("group", "between", ("a", "b"), "a")
    assert Design((group, CLUTTER, VIEW), ()).main is VIEW
    assert Design((VIEW, CLUTTER), ()).main is VIEW
    assert Design((group, CLUTTER), ()).main is CLUTTER
    assert Design((group,), ()).main is None


@pytest.mark.parametrize(
    ("met", "said"),
    [
        ("plain-low plain-high cut-low", ""),  # cut-high is left out for everybody
        ("plain-low cut-low", "Nobody has a trial that counts of: T1 count, plain, high."),
        ("plain-low plain-low",
         "Nobody has a trial that counts of: T1 count, plain, high; T1 count, cut, low."),
    ],
)  # fmt: skip
def test_what_nobody_met_is_named_but_for_what_is_left_out(met, said):
    rows = [dict(zip(("view", "clutter"), at.split("-"), strict=True)) for at in met.split()]
    sidecar = {"provenance": {"study": {"design": {
        "tasks": ["count"], "view": ["plain", "cut"], "clutter": ["low", "high"]}}}}  # fmt: skip
    context = SimpleNamespace(
        design=Design((VIEW, CLUTTER), (Task("count", "T1", ()),), GONE),
        trials=pd.DataFrame([{"task": "count", **row} for row in rows]),
        study=SimpleNamespace(sidecars={"a": sidecar}),
    )
    assert "".join(str(run) for block in _unmet(context) for run in block.runs) == said
