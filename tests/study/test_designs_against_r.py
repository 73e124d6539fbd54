"""Reports of eight designs against the script in R that each comes with (tests/oracles/README.md).

R's tables were made once by `tests/oracles/make.py`, which runs the report's own `analysis.R`:
afex, emmeans and lme4, from the same CSV files. Every number of R's must be ours.
"""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
import r_values
from made_designs import DESIGNS, make_design

from seethrough.analysis.page.tables_csv import as_csv
from seethrough.analysis.report import Options, make_report, tables_of

OURS = ("anova_", "tests_", "contrasts_")
"""Tables that R has to have, but for the combined scores, which its script leaves out."""
FIT = 1e-4
"""Of a standard error: two optimisers of one function, lme4's own differ by 1e-5."""


@pytest.mark.parametrize("name", DESIGNS)
def test_every_number_of_the_script_is_in_the_report(name: str, tmp_path: Path) -> None:
    made = make_report(make_design(tmp_path / "data", DESIGNS[name]), Options())
    ours = {table.key: table for table in tables_of(made)}
    theirs = {p.stem: p for p in (r_values.DESIGN_FOLDER / name).glob("*.csv")}
    needed = {k for k in ours if k.startswith(OURS)} - {"tests_combined"}
    needed |= {"mixed_model"} & ours.keys()
    assert set(theirs) == needed
    found = []
    for key, path in theirs.items():
        found += _of_table(key, path, as_csv(ours[key]))
    assert not found, "\n".join(found)


def _of_table(key: str, path: Path, text: str) -> list[str]:
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    first = next(iter(rows[0]))
    own = {row[first]: row for row in csv.DictReader(text.splitlines())}
    if {row[first] for row in rows} != set(own):
        return [f"{key}: rows {sorted(own)}, in R {sorted(row[first] for row in rows)}"]
    found, compared = [], 0
    for row in rows:
        for column, wanted in row.items():
            mine = own[row[first]].get(column, "")
            if column == first or mine == "":  # no family: no Holm
                continue
            compared += 1
            if wanted in ("NA", ""):
                if not mine.startswith("undefined"):
                    found.append(f"{key}/{row[first]}/{column}: {mine}, in R undefined")
                continue
            room = _room(key, column, row)
            if not abs(float(mine) - float(wanted)) <= room:
                found.append(f"{key}/{row[first]}/{column}: {mine}, in R {wanted} ± {room:.2g}")
    assert compared >= 2 * len(rows)
    return found


def _room(key: str, column: str, row: dict[str, str]) -> float:
    """Eight digits of what has a closed form; of a fit, a ten-thousandth of its standard error."""
    if key == "mixed_model":
        return FIT * float(row["error"])
    return r_values.CLOSED * abs(float(row[column])) + 1e-12
