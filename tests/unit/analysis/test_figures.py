"""Figures' panels and texts, from values that are made by hand."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from seethrough.analysis.cells import Cells
from seethrough.analysis.comparison import Pair
from seethrough.analysis.design import Design, Factor, Task
from seethrough.analysis.figures.comparison import ratings_figure
from seethrough.analysis.figures.levels import _means, level_means
from seethrough.analysis.page.blocks import Column, Table

RATED = Pair("all", "overall", "", 2, np.array([2.0, 3, 4]), np.array([4.0, 5, 6]))
COLUMNS = tuple(Column(n, n) for n in
                ("key", "mean_baseline", "mean_level", "sd_baseline", "sd_level"))  # fmt: skip
ROW = {"key": "all", "mean_baseline": 3.0, "mean_level": 5.0, "sd_baseline": 1.0, "sd_level": 1.0}


@pytest.mark.parametrize(
    ("scale", "said"), [("1–7", "Bars of mean ratings, 1–7. "), ("", "Bars of mean ratings. ")]
)
def test_a_figure_of_ratings_says_their_scale_where_there_is_one(scale, said):
    tests = Table("tests", "Tests", COLUMNS, (ROW,))
    assert ratings_figure("ratings", [RATED], (), tests, scale).alt.startswith(said + "overall: ")


def test_a_group_of_whom_nobody_has_every_cell_has_no_panel():
    """Two of the four people, group b, lack a cell each: its means are of nobody."""
    values = np.array([[[1.0, 2]], [[3.0, 5]], [[np.nan, 1]], [[2.0, np.nan]]])
    cells = Cells(values, np.isfinite(values).astype(np.intp), ("P1", "P2", "P3", "P4"),
                  {"task": ("count",), "view": ("plain", "cut")})  # fmt: skip
    group = Factor("group", "between", ("a", "b"), "a")
    design = Design((Factor("view", "within", ("plain", "cut"), "plain"), group),
                    (Task("count", "T1", ()),))  # fmt: skip
    trials = pd.DataFrame({"participant": ["P1", "P2", "P3", "P4"], "group": list("aabb")})
    context = SimpleNamespace(design=design, study=SimpleNamespace(trials=trials))
    figure = level_means("means", "Means", "s", cells, context)
    panels = [
        panel for row in figure.spec.get("vconcat", [figure.spec]) for panel in row["hconcat"]
    ]
    assert [panel["title"] for panel in panels] == ["T1 count, a group"]
    assert (
        "plain: 2.00; T1 count, a group, cut: 3.50." in figure.alt and "b group" not in figure.alt
    )


def test_intervals_within_people_are_cousineau_and_moreys_about_the_mean():
    """Of two levels t·sd(difference) / √(2n): half the paired difference's interval, × √2."""
    values = np.random.default_rng(4).normal(3, 1, (6, 1, 2))
    cells = Cells(values, np.ones(values.shape, np.intp), tuple("abcdef"),
                  {"task": ("count",), "view": ("plain", "cut")})  # fmt: skip
    first, second = values[:, 0].T
    half = stats.t.ppf(0.975, 5) * (first - second).std(ddof=1) / np.sqrt(2 * 6)
    rows = _means(cells, np.ones(6, bool))
    assert [r.mean for r in rows] == pytest.approx([first.mean(), second.mean()])
    assert [r.mean - r.low for r in rows] == pytest.approx([half, half])
    assert [r.high - r.mean for r in rows] == pytest.approx([half, half])
