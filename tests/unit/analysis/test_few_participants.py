"""What the report says first where there are few participants."""

import re
from dataclasses import replace
from itertools import product
from math import comb, factorial, prod
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from made_data import Made, make_folder
from made_designs import DESIGNS, make_design

from seethrough.analysis.cells import table_of
from seethrough.analysis.design import Design
from seethrough.analysis.page.markdown import as_markdown
from seethrough.analysis.report import Options, make_report, tables_of
from seethrough.analysis.sections.base.tables import SHARES, SKEWED, cell_table
from seethrough.analysis.stats.distributions import detectable, detectable_between
from seethrough.analysis.stats.paired import mean_interval


@pytest.fixture(scope="module")
def text_of(tmp_path_factory):
    def text(participants):
        folder = tmp_path_factory.mktemp(f"few{participants}")
        report = make_report(make_folder(folder, Made(participants=participants)), Options())
        return as_markdown(report)

    return text


def first_section(text):
    return text.split("\n## ")[1]


def test_one_participant_is_one_and_tests_nothing(text_of):
    text = text_of(1)
    assert "Only 1 participant: nothing can be tested." in first_section(text)
    assert not re.search(r"\b1 participants\b", text)


def test_three_are_said_to_be_few_before_anything_else(text_of):
    first = first_section(text_of(3)).removeprefix("In short").strip()
    assert first.startswith("> ⚠ Only 3 participants: a difference must be as large as")
    # with three differences of one sign a sign test has p = 2 / 2³
    assert "an exact sign test reaches p = .250 at best" in first


def test_groups_find_less_than_pairs():
    """R: the noncentral t of 14 df whose lower part is .20 (`uniroot` on `pt`)."""
    assert detectable_between(10, 6, 0.05, 0.80) == pytest.approx(1.55604514, abs=1e-8)
    # n pairs as two groups of n: more degrees of freedom, and √2 times the difference
    assert detectable_between(16, 16, 0.05, 0.80) < detectable(16, 0.05, 0.80) * 2**0.5


def test_a_study_of_groups_says_what_they_can_find(tmp_path):
    report = make_report(make_design(tmp_path / "data", DESIGNS["mixed"]), Options())
    (table,) = [t for t in tables_of(report) if t.key == "smallest_effect"]
    assert [r["n"] for r in table.rows] == [14, 14]
    assert table.rows[1]["dz"] == pytest.approx(detectable_between(9, 5, 0.05, 0.80))
    assert "Between groups (training, none − criterion) a difference must be" in as_markdown(report)


def test_of_sixteen_the_first_section_says_nothing(text_of):
    text = text_of(16)
    assert "Only 16" not in text and "at best" not in first_section(text)
    assert "With 16 participants a paired test finds" in text


@pytest.mark.parametrize(("n", "said"), [(8, ".71"), (16, ".91")])
def test_what_is_said_of_intervals_of_shares_is_so(n, said):
    """All ways in which n people can have 0 to 3 of three trials right, each .95, counted."""
    one = [comb(3, k) * 0.95**k * 0.05 ** (3 - k) for k in range(4)]
    held = 0.0
    for some in product(range(n + 1), repeat=3):
        if sum(some) > n:
            continue
        counts = [*some, n - sum(some)]
        low, high = mean_interval(np.repeat(np.arange(4) / 3, counts))
        if low <= 0.95 <= high:
            ways = factorial(n) // prod(factorial(c) for c in counts)
            held += ways * prod(p**c for p, c in zip(one, counts, strict=True))
    assert f"{held:.2f}"[1:] == said
    assert f" {said} " in SHARES


@pytest.mark.parametrize(
    ("values", "kind", "timed", "ends"),
    [
        ([1, 1, 1, 2 / 3], "bound", False, "An interval reaches above 1, where no value is"),
        ([0, 0, 1 / 3, 0.0], "bound", False, "An interval reaches below 0, where no value is"),
        ([0, 1, 0, 1.0], "bound", False, "An interval reaches below 0 or above 1"),
        ([2.0, 90.0, 3.0], "fixed", True, "An interval reaches below 0, where no value is"),
        ([20.0, 22.0, 21.0], "fixed", True, ""),
        ([1, 1, 1, 1.0], "bound", False, ""),
        ([-2.0, 3.0, 0.0], "fixed", False, ""),
    ],
)
def test_an_interval_that_leaves_what_can_be_is_named(values, kind, timed, ends):
    cells = table_of(np.array(values)[:, None], np.ones((len(values), 1), int),
                     [f"p{i}" for i in range(len(values))], {"view": ("a",)})  # fmt: skip
    context = SimpleNamespace(design=Design((), ()), study=SimpleNamespace(trials=pd.DataFrame()))
    table = cell_table("k", "k", cells, context, "First.", kind, cells if timed else None)
    assert table.note.startswith("First.")
    assert (SHARES in table.note, SKEWED in table.note) == (kind == "bound", timed)
    assert ends in table.note and ("reach" in table.note) == bool(ends)


def test_an_epsilon_that_three_people_cannot_estimate_is_not_shown(tmp_path):
    """Beside the words that they are too few to; of fourteen it is."""
    shown = {}
    for people in (3, 14):
        design = replace(DESIGNS["four"], people=(people,))
        report = make_report(make_design(tmp_path / f"{people}", design), Options())
        (table,) = [t for t in tables_of(report) if t.key == "anova_time_log"]
        assert ("too few to estimate ε" in table.note) == (people == 3)
        shown[people] = set(table.shown) & {"eps", "p_gg", "eps_hf", "p_hf", "p_lower"}
    assert shown == {3: {"p_lower"}, 14: {"eps", "p_gg", "eps_hf", "p_hf"}}
