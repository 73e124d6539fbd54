"""The analysis reads what the recorder writes: neither imports the other, the files are between."""

from __future__ import annotations

import json
from pathlib import Path
from typing import get_args

import pytest
from published_design import columns, published

from seethrough.analysis import before, exclude
from seethrough.analysis.load import plan, schema
from seethrough.analysis.load.chain import link, seal_of, start_of
from seethrough.experiment.record import chain
from seethrough.experiment.study.tables import study_tables

BEFORE = before.design_before({})


@pytest.mark.parametrize(
    ("table", "read"),
    [("trials", schema.trial_columns(BEFORE)), ("questionnaire", schema.answer_columns(BEFORE))],
)
def test_every_column_read_is_written_with_the_same_type(table: str, read: dict[str, str]) -> None:
    """Names and types agree; the recorder may write more than the analysis reads."""
    written = {c.name: c.type for c in columns()[table]}
    assert {name: written.get(name) for name in read} == dict(read)


def test_levels_are_the_same() -> None:
    """A level that the recorder may write is one that the analysis knows."""
    written = {c.name: c.levels for c in columns()["trials"] if c.levels}
    written["task"] = tuple(task["name"] for task in published()["tasks"])
    assert {name: tuple(levels) for name, levels in schema.levels(BEFORE).items()} == written


def test_the_chain_is_the_same_chain(tmp_path: Path) -> None:
    """Both sides compute it by themselves, from the same words."""
    sidecar = {"study": "s", "a": [1, "ü"], "chain": {"follows": "x", "start": "ignored"}}
    again = json.loads(json.dumps(sidecar))
    assert start_of(again, "row_id,chain") == chain.start_of(sidecar, "row_id,chain")
    end = {"status": "complete", "seal": "ignored", "files": {"ü": "0"}, "chain": "y"}
    assert seal_of(end) == chain.seal_of(end)
    assert link("before", "row, text ü") == chain.link("before", "row, text ü")


def test_a_study_may_plan_what_the_analysis_knows() -> None:
    """The names of [analysis] are checked when a study is read, long before there are data."""
    assert set(get_args(study_tables.AnalysisTest)) == set(plan.TESTS)
    assert set(study_tables.EXCLUSIONS) == set(exclude.RULES)


def test_the_published_numbers_are_the_same_beside_the_data_and_in_the_package(root: Path) -> None:
    """The package needs them where it is installed, readers look for them in data/."""
    packed = root / "analysis" / "published" / "published.toml"
    assert packed.read_bytes() == (root / "data" / "published" / "published.toml").read_bytes()
