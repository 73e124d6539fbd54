"""The report of a whole data folder: its tables against numbers computed another way."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from made_data import Made, make_folder
from scipy import stats

from seethrough.analysis.load.study import load_study
from seethrough.analysis.page.blocks import Table, walk
from seethrough.analysis.page.html import as_html
from seethrough.analysis.page.markdown import as_markdown
from seethrough.analysis.report import Options, figures_of, make_report
from seethrough.experiment.cli import main


@pytest.fixture(scope="module")
def report(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("study")
    make_folder(folder / "data", Made())
    assert main(["report", str(folder / "data"), "--out", str(folder / "report")]) == 0
    return folder / "report"


def table(report: Path, name: str) -> list[dict[str, str]]:
    with open(report / "tables" / f"{name}.csv", newline="") as file:
        return list(csv.DictReader(file))


def raw_times(report: Path) -> dict[tuple[str, str], list[float]]:
    """Per participant and cell, straight from the files, with nothing but csv."""
    cells: dict[tuple[str, str], dict[str, list[float]]] = {}
    for path in sorted((report.parent / "data").glob("data/human/*/*_trials_data.csv")):
        with open(path, newline="") as file:
            for row in csv.DictReader(file):
                cell = cells.setdefault((row["task"], row["transparency"]), {})
                cell.setdefault(row["participant"], []).append(float(row["time"]))
    return {k: [float(np.mean(v)) for v in people.values()] for k, people in cells.items()}


def test_it_counts_every_trial(report):
    counts = {r["what"]: r["count"] for r in table(report, "totals")}
    assert (counts["participants"], counts["trials recorded"]) == ("16", "384")


def test_times_by_task_are_those_of_the_files(report):
    raw = raw_times(report)
    for row in table(report, "tests_time"):
        task = row["measure"].removeprefix("time_")
        if task == "overall":
            first, second = (
                np.mean([v for (_, level), v in raw.items() if level == wanted], axis=0)
                for wanted in ("standard", "dynamic")
            )
        else:
            first, second = np.array(raw[task, "standard"]), np.array(raw[task, "dynamic"])
        test = stats.ttest_rel(first, second)
        assert float(row["mean_baseline"]) == pytest.approx(first.mean(), rel=1e-12)
        assert float(row["sd_level"]) == pytest.approx(second.std(ddof=1), rel=1e-12)
        assert float(row["F"]) == pytest.approx(test.statistic**2, rel=1e-10)
        assert float(row["p"]) == pytest.approx(test.pvalue, rel=1e-9)


def test_its_files_are_there(report):
    for figure in ("time", "ratings"):
        for kind in ("svg", "png", "pdf"):
            assert (report / "figures" / f"{figure}.{kind}").stat().st_size > 1000
    assert "participants were faster" in (report / "report.md").read_text()


def test_the_page_is_one_small_file_without_network(report):
    page = (report / "report.html").read_text()
    assert len(page.encode()) < 3 * 2**20
    # xmlns and xlink names look like addresses but are never fetched
    for mark in (' src="http', ' href="http', "@import", "url(http"):
        assert mark not in page


def test_one_participant_gets_a_report_that_says_undefined(tmp_path):
    make_folder(tmp_path / "data", Made(participants=1, trials=1))
    assert main(["report", str(tmp_path / "data"), "--out", str(tmp_path / "out")]) == 0
    rows = table(tmp_path / "out", "tests_time")
    assert {r["p"] for r in rows} == {"undefined: fewer than two participants"}
    assert (tmp_path / "out" / "figures" / "time.png").is_file()


def test_simulated_data_carry_the_banner(tmp_path):
    made = make_report(make_folder(tmp_path / "data", Made(2, source="simulated")), Options())
    pictures = {figure.key: "" for figure in figures_of(made.sections)}
    for text in (as_markdown(made), as_html(made, pictures, "0")):
        assert "Simulated participants: for planning only, never evidence" in text


def test_two_sources_are_never_mixed(tmp_path, capsys):
    make_folder(tmp_path / "data", Made(participants=2))
    make_folder(tmp_path / "data", Made(participants=2, source="simulated"))
    assert main(["report", str(tmp_path / "data"), "--out", str(tmp_path / "out")]) == 2
    assert "sources are never mixed: choose with --source" in capsys.readouterr().err
    human = load_study(tmp_path / "data", "human")
    assert set(human.trials["source"]) == {"human"}
    assert human.other_sources == ("simulated",)


def test_a_frozen_plan_is_followed_and_deviations_are_listed(tmp_path):
    config = {
        "study": {"participants": 6},
        "design": {"trials": 3, "tasks": ["count"] * 4, "transparency": ["standard", "dynamic"]},
        "analysis": {"alpha": 0.01, "exclude": ["timed_out"], "tests": ["time"]},
    }
    folder = make_folder(tmp_path / "data", Made(participants=4, config=config))
    path = next(folder.glob("data/human/P03/*_trials_data.csv"))
    path.write_text("\n".join(path.read_text().split("\n")[:-2]) + "\n")
    made = make_report(folder, Options(alpha=0.05))
    text = as_markdown(made)
    for deviation in (
        "alpha is 0.05, planned was 0.01",
        "4 participants have data, planned were 6",
        "Of 24 planned trials each, other numbers were recorded for P03 (23)",
    ):
        assert deviation in text
    # the frozen tests run, and no others
    assert [s.key for s in made.sections] == [
        "summary",
        "participants",
        "methods",
        "time",
        "provenance",
    ]
    with_other_rules = as_markdown(make_report(folder, Options(exclude=["focus_lost"])))
    assert "Exclusion rules are: focus\\_lost; planned were: timed\\_out" in with_other_rules


def test_excluded_trials_are_named_by_rule_and_row(tmp_path):
    folder = make_folder(tmp_path / "data", Made(participants=3))
    made = make_report(folder, Options(exclude=["participant:P02"]))
    tables = {b.key: b for s in made.sections for b in walk(s.blocks) if isinstance(b, Table)}
    rows = tables["excluded"].rows
    assert {(r["rule"], r["participant"]) for r in rows} == {("participant:P02", "P02")}
    assert [r["row"] for r in rows] == list(range(2, 26))
    assert tables["totals"].row("trials counted")["count"] == 48


def test_an_unrelated_folder_is_not_written_to(tmp_path, capsys):
    make_folder(tmp_path / "data", Made(participants=2))
    before = sorted(tmp_path.rglob("*"))
    assert main(["report", str(tmp_path / "data"), "--out", str(tmp_path / "data")]) == 2
    assert "expected a new folder" in capsys.readouterr().err
    assert sorted(tmp_path.rglob("*")) == before


def test_no_data_and_no_published_is_bad_input(tmp_path, capsys):
    assert main(["report", "--out", str(tmp_path / "out")]) == 2
    assert "expected either DATA or --published" in capsys.readouterr().err


def contents(folder):
    return {p.relative_to(folder): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def test_a_report_takes_the_place_of_another_only_when_told(tmp_path, capsys):
    """And of nothing else, ever: refused with a line, and nothing is touched."""
    out = tmp_path / "out"
    many = {"analysis": {"tests": ["time", "accuracy"]}, "study": {"title": "How far one sees"}}
    make_folder(tmp_path / "a", Made(participants=3, trials=1, config=many))
    few = {"analysis": {"tests": ["time"]}, "study": {"title": "How far one sees"}}
    make_folder(tmp_path / "b", Made(participants=3, trials=1, config=few))
    first, second = (["report", str(tmp_path / n), "--out", str(out)] for n in "ab")
    assert main(first) == 0
    before = contents(out)
    assert b"<h1>How far one sees: report</h1>" in before[Path("report.html")]
    assert main(second) == 2 and contents(out) == before
    assert f"--out = {out}: holds a report already: expected another folder, or --replace" in (
        capsys.readouterr().err
    )
    for name in ("notes.txt", "tables/mine.csv", "figures/mine.svg", "tables/x.txt"):
        mine = out / name
        mine.write_text("mine", encoding="utf-8")
        assert main([*second, "--replace"]) == 2 and contents(out) == {
            **before,
            Path(name): b"mine",
        }
        assert f"holds {name}, which is no part of a report" in capsys.readouterr().err
        mine.unlink()
    assert main(["report", str(tmp_path / "none"), "--out", str(out), "--replace"]) == 2
    assert contents(out) == before  # what cannot be made replaces nothing
    assert main([*second, "--replace"]) == 0
    after = contents(out)
    assert after[Path("report.html")] != before[Path("report.html")]
    assert main(["report", str(tmp_path / "b"), "--out", str(tmp_path / "new")]) == 0
    assert set(after) == set(contents(tmp_path / "new"))  # no table of the earlier one is left
