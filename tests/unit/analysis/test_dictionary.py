"""The data dictionary of a report: every column of every table has a meaning."""

from __future__ import annotations

import pytest
from made_designs import DESIGNS, make_design

from seethrough.analysis.page.glossary import meaning
from seethrough.analysis.report import Options, make_report, tables_of


@pytest.mark.parametrize("name", ["two_by_three_ranked", "mixed_ordinal", "scenes", "nested"])
def test_no_meaning_is_empty(name, tmp_path):
    made = make_report(make_design(tmp_path / "data", DESIGNS[name]), Options())
    (table,) = [t for t in tables_of(made) if t.key == "dictionary"]
    assert not [r["column"] for r in table.rows if not r["about"]]


def test_a_column_says_itself_what_it_means_before_anything_else():
    assert meaning("n", "those who met both", frozenset()) == "those who met both"
    assert meaning("n", "", frozenset()) == "participants"
    assert meaning("view", "", frozenset({"view"})) == "level of the factor view"
