"""Whole reports on data in which much is undefined: tables say why, and figures still come out."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

import pytest
from made_data import Made, make_folder

from seethrough.experiment.cli import main

FIGURES = ("time", "count_error", "ratings", "tradeoff", "learning")


def rewrite(folder: Path, change: Callable[[dict[str, str]], None]) -> None:
    """Change rows of every table."""
    for path in folder.glob("data/human/*/*_data.csv"):
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            change(row)
        with open(path, "w", newline="") as file:
            table = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
            table.writeheader()
            table.writerows(rows)


def constant(row: dict[str, str]) -> None:
    """Everybody alike everywhere: no variance at all."""
    row.update({k: v for k, v in (("time", "12.5"), ("time_clean", "12.5")) if k in row})
    right(row)


def right(row: dict[str, str]) -> None:
    """No errors, and every answer to a question the same."""
    if "truth" in row:
        row["correct"] = "true"
        if row["count_error"]:
            row.update(count_error="0", answer=row["truth"])
        if row["distance"]:
            row["distance"] = "0.0"
    elif "value" in row and row["transparency"]:
        row["value"] = "2"


def by_person(row: dict[str, str]) -> None:
    """Participants differ, the two conditions are identical."""
    right(row)
    if "time" in row:
        row["time"] = row["time_clean"] = repr(10.0 + len(row["participant"]) + int(row["slot"]))


def made(folder: Path, name: str) -> Path:
    people = 2 if name == "two participants" else 4
    make_folder(folder, Made(participants=people, trials=2))
    changes = {"no variance": constant, "identical conditions": by_person, "no errors": right}
    if name in changes:
        rewrite(folder, changes[name])
    return folder


def column(report: Path, table: str, name: str) -> set[str]:
    with open(report / "tables" / f"{table}.csv", newline="") as file:
        return {row[name] for row in csv.DictReader(file)}


EQUAL = {"undefined: all differences are equal"}
TIED = {"undefined: every participant gives all conditions the same value"}


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("no variance", {("tests_log_time", "p"): EQUAL, ("anova_time_task_log", "F"): EQUAL}),
        ("identical conditions", {("tests_time", "p"): EQUAL, ("tests_time", "bf10"): EQUAL}),
        ("no errors", {("tests_absolute_error", "p"): EQUAL, ("friedman_ratings", "chi2"): TIED}),
        ("two participants", {("tests_time", "n"): {"2"}}),
    ],
)
def test_what_does_not_exist_says_why_and_figures_come_out(tmp_path, name, expected):
    report = tmp_path / "report"
    data = made(tmp_path / "data", name)
    assert main(["report", str(data), "--out", str(report)]) == 0
    for (table, quantity), values in expected.items():
        assert column(report, table, quantity) == values, (table, quantity)
    for figure in FIGURES:
        for kind in ("svg", "png", "pdf"):
            assert (report / "figures" / f"{figure}.{kind}").stat().st_size > 500, figure
    page = (report / "report.html").read_text(encoding="utf-8")
    for invented in (">nan<", ">inf<", ">NaN<", "Infinity", "= nan", "= inf"):
        assert invented not in page.split("<script>")[0], invented
