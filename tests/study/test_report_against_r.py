"""The whole report of twelve data folders, cell by cell, against R (tests/oracles/README.md)."""

from __future__ import annotations

import csv
import statistics

import numpy as np
import pytest
import r_values
from report_cases import CASES, Case
from report_folders import PUBLISHED, contents, make_case, published_data

from seethrough.analysis.page.blocks import Column, Table
from seethrough.analysis.published.grim import fitting_whole_numbers
from seethrough.analysis.published.numbers import load_published
from seethrough.analysis.report import Options, make_published, make_report, tables_of


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_every_number_of_every_table_is_what_r_gives(case: Case, tmp_path) -> None:
    folder = make_case(case, tmp_path / "data")
    # else R's values belong to other data: run tests/oracles/make.py
    assert contents(folder) == r_values.about()["folders"][case.name]
    found = r_values.differences(tables_of(make_report(folder, Options())), case.name)
    assert not found, f"{len(found)} cells:\n" + "\n".join(found)


def test_every_number_of_the_published_report_is_what_r_gives() -> None:
    found = r_values.differences(tables_of(make_published()), "published")
    assert not found, f"{len(found)} cells:\n" + "\n".join(found)


def test_r_was_given_the_data_that_the_published_report_makes() -> None:
    with open(r_values.FOLDER / PUBLISHED, newline="") as file:
        kept = [
            (r["measure"], float(r["standard"]), float(r["dynamic"])) for r in csv.DictReader(file)
        ]
    made = published_data()
    assert [m for m, *_ in made] == [m for m, *_ in kept]
    np.testing.assert_allclose([v for _, *v in made], [v for _, *v in kept], rtol=1e-12)


def test_the_examples_of_answers_have_the_printed_moments() -> None:
    """R says that there are such answers; which ones the report names is its own choice."""
    published = load_published()
    for item in published.single:
        answers = fitting_whole_numbers(item.moments, published.participants, item.highest)
        assert answers is not None
        assert item.moments.mean.fits(statistics.mean(answers))
        assert item.moments.sd.fits(statistics.stdev(answers))


def _table(**cells: object) -> Table:
    return Table(
        "totals", "", tuple(Column(c, c) for c in ("what", *cells)), ({"what": "x", **cells},)
    )


def test_a_column_without_an_oracle_is_found(monkeypatch) -> None:
    """What holds the report to R is itself held: to a new column, a new row, a new table."""
    rows = r_values.Rows(("what", "count"), {"x": {"what": "x", "count": "3"}})
    monkeypatch.setattr(r_values, "stored", lambda case: {"totals": rows})
    assert r_values.differences([_table(count=3)], "any") == []
    assert r_values.differences([_table(count=3, share=0.5)], "any") == [
        "totals.share: ours has no value in R, nor a reason"
    ]
    assert r_values.differences([], "any") == ["totals: only in one of the two"]
    assert "4, in R 3" in r_values.differences([_table(count=4)], "any")[0]
    assert r_values.differences([_table(count=3, label="words")], "any") == []
    assert "a number" in r_values.differences([_table(count=3, label=0.5)], "any")[0]
