"""Reports of many designs against the script in R that each comes with (tests/oracles/README.md).

R's tables were made once by `tests/oracles/make.py`, which runs the report's own `analysis.R`:
afex, emmeans and lme4, from the same CSV files. Every number of R's must be ours; every number of
ours is R's, or `WITHOUT` and `TABLES` say why not.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path

import pytest
import r_values
from made_designs import DESIGNS, EASE, make_design

from seethrough.analysis.page.tables_csv import as_csv
from seethrough.analysis.report import Options, make_report, tables_of

FIT = 1e-4
"""Of a standard error: two optimisers of one function, lme4's own differ by 1e-5."""
HELD = "the function that the twelve folders' tables are held to R by (test_report_against_r.py)"
DRAWN = "drawn permutations: held there, too, within Monte-Carlo error"
WITHOUT: Mapping[tuple[str, str], str] = {
    **{("tests_", c): HELD for c in (
        "within_half ges pes_low pes_high dz_low dz_high bf10 ratio_low ratio_high tost_margin "
        "tost_p noninferior_p low90 high90 df1").split()},
    **{("anova_", c): HELD for c in (
        "n p_lower mauchly_w mauchly_p pes_low pes_high bf10 negligible_p ss_effect "
        "ss_error").split()},
    **{("friedman_", c): HELD for c in (
        "sd_baseline sd_level difference tost_margin tost_p noninferior_p low90 high90").split()},
    **{("mixed_", c): "follows from estimate, error and df" for c in "t p ratio low high".split()},
    **{("mixed_", c): "counts, held by unit tests" for c in "n trials df scenes".split()},
    ("mixed_model", "sd_slope"): HELD,
    ("mixed_model", "sd_task_slope"): HELD,
    ("groups_", "p_exact"): DRAWN,
    ("friedman_", "p_exact"): DRAWN,
    ("reliability", "omega"): HELD,
    ("contrasts_", "least"): "a count",
    ("contrasts_", "error"): "follows from estimate and t",
    **{("contrasts_", c): "follows from the estimate and its interval"
       for c in "ratio ratio_low ratio_high".split()},
    **{("contrasts_", c): "held by tests/unit/analysis/test_split_plot.py"
       for c in "tost_margin tost_p noninferior_p".split()},
    **{("pairwise_", c): "as in contrasts" for c in (
        "least error ratio ratio_low ratio_high").split()},
    ("_cells", "trials"): "a count",
    **{("aligned_", c): "R says F and df; the rest follows, as in every ANOVA" for c in (
        "n p p_gg eps eps_hf p_hf p_lower mauchly_w mauchly_p ges pes pes_low pes_high bf10 "
        "negligible_p ss_effect ss_error").split()},
}  # fmt: skip
"""(part of a table's name, column) that the script has no value of, and why."""
TABLES: Mapping[str, str] = {
    "tests_combined": HELD,
    "tradeoff": HELD,
    "conditional_accuracy": HELD,
    "smallest_effect": HELD,
    "robust": HELD,
    "learning": HELD,
    "learning_curve": HELD,
    "order": HELD,
    "difficulty": HELD,
    "single_items": HELD,
    "predictions": "each p that decides stands in another table, too, and is held there",
    **dict.fromkeys("participants totals trials_by_cell flow faults files missing excluded".split(),
                    "counts, held by unit tests"),
    **dict.fromkeys("ran dictionary".split(), "words"),
}  # fmt: skip
"""Tables that the script has none of, and why."""


@pytest.mark.parametrize("name", DESIGNS)
def test_every_number_of_the_script_is_in_the_report(name: str, tmp_path: Path) -> None:
    made = make_report(make_design(tmp_path / "data", DESIGNS[name]), Options())
    ours = {table.key: table for table in tables_of(made)}
    theirs = {p.stem: p for p in (r_values.DESIGN_FOLDER / name).glob("*.csv")}
    models = {key for key in theirs if key.startswith("model_")}
    assert set(theirs) - models == set(ours) - set(TABLES)
    found = []
    for key in set(theirs) - models:
        found += _of_table(key, theirs[key], as_csv(ours[key]))
    assert not found, "\n".join(found)


@pytest.mark.parametrize("name", [n for n, d in DESIGNS.items() if EASE in d.measures])
def test_models_of_ordinal_answers_and_of_right_ones_are_fitted(name: str) -> None:
    """The report has none: what the script gives has finite errors and says its formula."""
    for measure in ("ease", "correct"):
        rows = _read(r_values.DESIGN_FOLDER / name / f"model_{measure}.csv")
        assert all(float(row["error"]) > 0 and "participant" in row["model"] for row in rows)


def _read(path: Path) -> list[dict[str, str]]:
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def _of_table(key: str, path: Path, text: str) -> list[str]:
    rows = _read(path)
    first = next(iter(rows[0]))
    own = {row[first]: row for row in csv.DictReader(text.splitlines())}
    if {row[first] for row in rows} != set(own):
        return [f"{key}: rows {sorted(own)}, in R {sorted(row[first] for row in rows)}"]
    mine = next(iter(own.values()))
    given = {c for c in rows[0] if any(row[c] not in ("NA", "") for row in rows)}
    found = [f"{key}.{c}: no value in R, nor a reason" for c in sorted(_numeric(own) - given)
             if not any(part in key and column == c for part, column in WITHOUT)]  # fmt: skip
    for row in rows:
        for column in (c for c in row if c != first and c in mine):
            ours, wanted = own[row[first]][column], row[column]
            if ours == "" or column not in given:  # no family: no Holm
                continue
            if wanted in ("NA", ""):
                if not ours.startswith("undefined") and not _drawn(key, column):
                    found.append(f"{key}/{row[first]}/{column}: {ours}, in R undefined")
                continue
            try:
                apart = abs(float(ours) - float(wanted))
            except ValueError:
                found.append(f"{key}/{row[first]}/{column}: {ours}, in R {wanted}")
                continue
            room = _room(key, column, row)
            if not apart <= room:
                found.append(f"{key}/{row[first]}/{column}: {ours}, in R {wanted} ± {room:.2g}")
    return found


def _drawn(key: str, column: str) -> bool:
    """Whether R's script has no p where ours is drawn."""
    return column == "p_exact" and key.startswith(("groups_", "friedman_"))


def _numeric(rows: Mapping[str, Mapping[str, str]]) -> set[str]:
    """The columns that hold a number anywhere."""
    found = set()
    for row in list(rows.values()):
        for column in list(row)[1:]:
            try:
                float(row[column])
            except ValueError:
                continue
            found.add(column)
    # levels that are numbers are parts of the key
    return found - {"clutter"}


def _room(key: str, column: str, row: dict[str, str]) -> float:
    """Eight digits of what has a closed form; of a fit, a ten-thousandth of its standard error."""
    if key in ("mixed_model", "mixed_scenes"):
        return FIT * float(row["error"])
    digits = r_values.SHAPIRO if column == "shapiro_p" else r_values.CLOSED
    return digits * abs(float(row[column])) + 1e-12
