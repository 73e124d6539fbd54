"""The whole report of twelve data folders, cell by cell, against R (tests/oracles/README.md)."""

from __future__ import annotations

import pytest
import r_values
from report_cases import CASES, Case
from report_folders import contents, make_case

from analysis.report import Options, make_report, tables_of


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_every_number_of_every_table_is_what_r_gives(case: Case, tmp_path) -> None:
    folder = make_case(case, tmp_path / "data")
    # else R's values belong to other data: run tests/oracles/make.py
    assert contents(folder) == r_values.about()["folders"][case.name]
    found = r_values.differences(tables_of(make_report(folder, Options())), case.name)
    assert not found, f"{len(found)} cells:\n" + "\n".join(found)
