"""Difficulty balance: the certificate's measures by condition, against planted scenes and scipy."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from made_data import Made, make_folder
from scipy import stats

from seethrough.analysis.before import design_before
from seethrough.analysis.errors import DataError
from seethrough.analysis.load.matching import balance, with_certificate
from seethrough.analysis.load.schema import certificate_columns
from seethrough.analysis.load.study import load_study
from seethrough.analysis.page.blocks import Table, walk
from seethrough.analysis.page.markdown import as_markdown
from seethrough.analysis.report import Options, make_report

COLUMNS = certificate_columns(design_before({}))


def scenes(
    trials: pd.DataFrame, harder: float, rng: np.random.Generator
) -> list[dict[str, object]]:
    """A certificate row for every trial; dynamic scenes have `harder` more occluders."""
    return [
        {
            "scene": row.scene,
            "task": row.task,
            "transparency": row.transparency,
            "targets": row.targets,
            "visible": 0.5,
            "hidden": int(rng.integers(0, 3)),
            "occluders": rng.normal(20, 2) + harder * (row.transparency == "dynamic"),
            "clutter": rng.normal(100, 5),
            "path": 0.0 if row.scenario == "abstract" else rng.normal(50, 5),
        }
        for row in trials.itertuples()
    ]


def write(folder: Path, rows: list[dict[str, object]]) -> None:
    with open(folder / "certificate.csv", "w", newline="") as file:
        table = csv.DictWriter(file, list(COLUMNS), lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


@pytest.fixture
def folder(tmp_path) -> Path:
    """Every trial has a scene of its own."""
    folder = make_folder(tmp_path / "data", Made(participants=8))
    for path in folder.glob("data/human/*/*_trials_data.csv"):
        lines = path.read_text().split("\n")
        for i, line in enumerate(lines[1:-1], start=1):
            lines[i] = line.replace(",set", f",own-{path.parent.name}-{i}-", 1)
        path.write_text("\n".join(lines))
    return folder


def test_a_planted_difference_is_found_and_a_fair_one_is_not(folder):
    trials = load_study(folder).trials
    write(folder, scenes(trials, 3.0, np.random.default_rng(1)))
    study = load_study(folder)
    table = with_certificate(study.trials, study.certificate)
    found = {(b.task, b.quantity): b for b in balance(table, study.design)}
    assert len(found) == 4 * 6 - 2  # nobody walks in the abstract world
    for task in ("count", "pattern", "unique", "count_in_building"):
        # 3 occluders at a spread of 2; 24 scenes a level leave a standard error of 0.3
        assert found[task, "occluders"].smd == pytest.approx(1.5, abs=1.0)
        assert str(found[task, "visible"].smd) == "undefined: the scenes do not differ"


def test_means_and_intervals_are_those_of_scipy(folder):
    rows = scenes(load_study(folder).trials, 1.0, np.random.default_rng(2))
    write(folder, rows)
    report = make_report(folder, Options())
    section = next(s for s in report.sections if s.key == "validity")
    table = next(b for b in walk(section.blocks) if isinstance(b, Table) and b.key == "difficulty")
    row = table.row("occluders_unique")
    person = {r["scene"]: r["scene"].split("-")[1] for r in rows}
    values: dict[tuple[str, str], list[float]] = {}
    for r in rows:
        if r["task"] == "unique":
            values.setdefault((person[r["scene"]], r["transparency"]), []).append(r["occluders"])
    people = sorted({name for name, _ in values})
    pair = [[np.mean(values[name, level]) for name in people] for level in ("standard", "dynamic")]
    test = stats.ttest_rel(*pair)
    ends = test.confidence_interval()
    got = (row["mean_baseline"], row["mean_level"], row["low"], row["high"], row["p"])
    assert got == pytest.approx((*map(np.mean, pair), *ends, test.pvalue), rel=1e-9)
    both = [[v for (_, at), own in values.items() if at == level for v in own]
            for level in ("standard", "dynamic")]  # fmt: skip
    pooled = np.sqrt((np.var(both[0], ddof=1) + np.var(both[1], ddof=1)) / 2)
    assert row["smd"] == pytest.approx((np.mean(both[1]) - np.mean(both[0])) / pooled, rel=1e-9)


def test_without_a_certificate_the_report_says_so(folder):
    text = as_markdown(make_report(folder, Options()))
    assert "The data hold no difficulty certificate" in text
    assert "seethrough check STUDY --certificate DATA/certificate.csv" in text


@pytest.mark.parametrize(
    ("column", "value", "pattern"),
    [
        ("visible", "half", r"certificate.csv: row 2: visible = 'half': expected a finite number"),
        ("task", "juggle", r"certificate.csv: row 2: task = 'juggle': expected count, pattern"),
    ],
)
def test_a_bad_certificate_is_named_by_row(folder, column, value, pattern):
    rows = scenes(load_study(folder).trials, 0.0, np.random.default_rng(3))
    rows[0][column] = value
    write(folder, rows)
    with pytest.raises(DataError, match=pattern):
        load_study(folder)
