"""The first page of a report: each number stands in a CSV, and comes from the raw files."""

from __future__ import annotations

import csv
import re
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from made_data import Made, make_folder
from scipy import stats
from statsmodels.stats.multitest import multipletests

from seethrough.experiment.cli import main

TASKS = ("count", "pattern", "unique", "count_in_building")
# Names and levels, which are no results: tasks, predictions, confidence levels, the margin, the
# number of questions of the depth test, and the two sides of a ratio.
NO_RESULT = (
    r"T[1-4]|P[1-3]|9[05] % CI|Margins \(ours\): [^.]*(?:\.\d[^.]*)*\.|"
    r"of 3 right|on a scale to 4|1 / "
)


class FirstPage(HTMLParser):
    """The first section's cited numbers, and its text without them."""

    def __init__(self) -> None:
        super().__init__()
        self.cited: list[tuple[str, str, str, str, str]] = []
        self.text = ""
        self._section, self._inside, self._data, self._skip = 0, False, None, 0

    def handle_starttag(self, tag, attrs):
        own = dict(attrs)
        if tag == "section":
            self._section += 1
            self._inside = self._section == 1
        if tag in ("details", "table") or (tag == "p" and own.get("class") == "note"):
            self._skip += 1  # the note says where the numbers are; a table is one; folds come later
        if tag == "data" and self._inside:
            self._data = own

    def handle_endtag(self, tag):
        if tag in ("details", "table", "p") and self._skip:
            self._skip -= 1
        if tag == "data":
            self._data = None

    def handle_data(self, data):
        if not self._inside or self._skip:
            return
        if self._data is None:
            self.text += data
            return
        own = self._data
        self.cited.append(
            (own["data-from"], own["data-row"], own["data-column"], own["value"], data)
        )


def read(report: Path) -> FirstPage:
    page = FirstPage()
    page.feed((report / "report.html").read_text(encoding="utf-8"))
    return page


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("first")
    make_folder(folder / "data", Made(seed=3))
    assert main(["report", str(folder / "data"), "--out", str(folder / "study")]) == 0
    assert main(["report", "--published", "--out", str(folder / "published")]) == 0
    return folder


@pytest.mark.parametrize("name", ["study", "published"])
def test_every_number_of_the_first_page_is_in_a_row_of_a_csv(folder, name):
    page = read(folder / name)
    assert len(page.cited) >= 8
    for file, row, column, value, _ in page.cited:
        with open(folder / name / "tables" / file, newline="") as handle:
            rows = list(csv.DictReader(handle))
        key = next(iter(rows[0]))
        assert [r[column] for r in rows if r[key] == row] == [value], (file, row, column)


@pytest.mark.parametrize("name", ["study", "published"])
def test_no_number_of_the_first_page_is_typed_in(folder, name):
    left = re.sub(NO_RESULT, "", re.sub(r"\s+", " ", read(folder / name).text))
    assert re.findall(r"[^.;:]*\d[^.;:]*", left) == []


def raw(folder: Path) -> list[dict[str, str]]:
    rows = []
    for path in sorted(folder.glob("data/data/human/*/*_trials_data.csv")):
        with open(path, newline="") as file:
            rows += list(csv.DictReader(file))
    return rows


def by_person(rows, task: str, level: str, value) -> np.ndarray:
    """`value` of each participant's trials of a cell, (n,)."""
    cells: dict[str, list[dict[str, str]]] = {}
    for row in rows:
        if row["task"] == task and row["transparency"] == level:
            cells.setdefault(row["participant"], []).append(row)
    return np.array([value(trials) for _, trials in sorted(cells.items())])


def mean_of(column: str):
    return lambda trials: np.mean([float(t[column]) for t in trials])


def mean_log_time(trials) -> float:
    return np.mean([np.log(float(t["time"])) for t in trials])


def error(trials) -> float:
    return abs(sum(int(t["count_error"]) for t in trials)) / sum(int(t["truth"]) for t in trials)


def absolute_error(trials) -> float:
    return sum(abs(int(t["count_error"])) for t in trials) / sum(int(t["truth"]) for t in trials)


def share(trials) -> float:
    return np.mean([t["correct"] == "true" for t in trials])


def pairs(rows) -> dict[tuple[str, str], tuple[np.ndarray, np.ndarray]]:
    """What the first page rests on, from the files with csv and numpy alone."""

    def both(task, value):
        return tuple(by_person(rows, task, level, value) for level in ("standard", "dynamic"))

    found = {}
    logs = []
    for task in TASKS:
        pair = both(task, mean_log_time)
        logs.append(pair)
        found["tests_log_time.csv", f"time_{task}"] = pair
    found["tests_log_time.csv", "time_overall"] = tuple(
        np.mean(x, axis=0) for x in zip(*logs, strict=True)
    )
    for file, prefix, value in (
        ("tests_count_error.csv", "count_error", error),
        ("tests_absolute_error.csv", "absolute_error", absolute_error),
    ):
        own = [both(task, value) for task in ("count", "count_in_building")]
        found[file, f"{prefix}_count"], found[file, f"{prefix}_count_in_building"] = own
        found[file, f"{prefix}_overall"] = tuple(np.mean(x, axis=0) for x in zip(*own, strict=True))
    found["tests_distance.csv", "distance_unique"] = both("unique", mean_of("distance"))
    for task in TASKS:
        found["friedman_correct.csv", f"correct_{task}"] = both(task, share)
    return found


def holm(own, prefix: str, names) -> dict[str, float]:
    test = sign_p if prefix == "friedman_correct.csv" else paired_p
    p = [test(*own[prefix, n]) for n in names]
    return dict(zip(names, multipletests(p, method="holm")[1], strict=True))


def paired_p(first, second) -> float:
    return stats.ttest_rel(first, second).pvalue


def sign_p(first, second) -> float:
    gaps = np.sign(np.round(first - second, 12))  # shares of three: no rounding is a difference
    return stats.binomtest(int((gaps > 0).sum()), int((gaps != 0).sum())).pvalue


def expected(own, file: str, row: str, column: str) -> float:
    """The number from scipy and statsmodels, from the raw files."""
    first, second = own[file, row]
    gaps = first - second
    test = stats.ttest_rel(first, second)
    ends = test.confidence_interval()
    families = {
        "tests_log_time.csv": [f"time_{t}" for t in TASKS],
        "tests_count_error.csv": ["count_error_count", "count_error_count_in_building"],
        "tests_absolute_error.csv": ["absolute_error_count", "absolute_error_count_in_building"],
        "friedman_correct.csv": [f"correct_{t}" for t in TASKS],
    }
    f, n = test.statistic**2, len(gaps)
    quantities = {
        "ratio": lambda: np.exp(-gaps.mean()),
        "ratio_low": lambda: np.exp(-ends.high),
        "ratio_high": lambda: np.exp(-ends.low),
        "df1": lambda: 1,
        "df2": lambda: n - 1,
        "F": lambda: f,
        "p": lambda: test.pvalue,
        "p_holm": lambda: holm(own, file, families[file])[row],
        "pes": lambda: f / (f + n - 1),
        "pes_low": lambda: noncentral(f, n - 1, 0.95),
        "pes_high": lambda: noncentral(f, n - 1, 0.05),
        "p_exact": lambda: sign_p(first, second),
    }
    return float(quantities[column]())


def noncentral(f: float, df2: int, level: float) -> float:
    """λ / (λ + df₂) at which F lies at `level` of its noncentral distribution."""
    from scipy.optimize import brentq

    def gap(nc: float) -> float:
        return stats.ncf.cdf(f, 1, df2, nc) - level

    if stats.f.cdf(f, 1, df2) <= level:
        return 0.0
    nc = brentq(gap, 1e-12, 50 * f + 50)
    return nc / (nc + df2)


def test_every_number_of_the_first_page_follows_from_the_raw_files(folder):
    own = pairs(raw(folder))
    checked = 0
    for file, row, column, value, _ in read(folder / "study").cited:
        if file == "single_items.csv":
            continue  # the questionnaire's, below
        # noncentral F by root finding in scipy: its own error is about 1e-7
        assert float(value) == pytest.approx(
            expected(own, file, row, column), rel=1e-6, abs=1e-9
        ), (file, row, column)
        checked += 1
    assert checked >= 25


def test_the_depth_test_on_the_first_page_is_the_questionnaires_mean(folder):
    scores = []
    for path in folder.glob("data/data/human/*/*_questionnaire_data.csv"):
        with open(path, newline="") as file:
            scores += [float(r["value"]) for r in csv.DictReader(file) if r["item"] == "depth_test"]
    cited = {
        c: v for file, _, c, v, _ in read(folder / "study").cited if file == "single_items.csv"
    }
    assert float(cited["mean"]) == pytest.approx(np.mean(scores), rel=1e-12)
    assert int(cited["n"]) == len(scores)
