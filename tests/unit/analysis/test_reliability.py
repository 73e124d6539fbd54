"""Whether items go together. References: psych 2.2.9 in R 4.2.2, `alpha(x)` with Feldt's interval,
and Σλ² / (Σλ² + Σψ) of `factanal(covmat = cov(x), factors = 1)` with loadings times s.d."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from made_designs import DESIGNS, make_design

from seethrough.analysis.report import Options, make_report, tables_of
from seethrough.analysis.stats.reliability import HEYWOOD, SUM, TOO_FEW, reliability
from seethrough.analysis.stats.undefined import Undefined
from seethrough.experiment.study.config import load
from seethrough.experiment.study.shown.described import design_entry

ANSWERS = np.array([
    [2, 2, 0, 1], [0, 1, 0, 1], [2, 2, 1, 2], [2, 1, 3, 1], [4, 3, 2, 3], [1, 2, 2, 1],
    [1, 1, 2, 1], [2, 1, 1, 1], [4, 3, 4, 3], [4, 4, 3, 3], [3, 2, 2, 2], [1, 1, 1, 2],
    [1, 1, 2, 1], [3, 2, 4, 3], [2, 1, 3, 1], [0, 1, 0, 1], [2, 2, 2, 3], [1, 0, 0, 1],
    [1, 2, 1, 1], [1, 1, 2, 1], [1, 3, 2, 1], [4, 3, 2, 3], [2, 2, 1, 1], [2, 2, 1, 2],
], dtype=float)  # fmt: skip


def test_alpha_and_omega_are_those_of_r() -> None:
    found = reliability(ANSWERS)
    assert found.alpha == pytest.approx(0.857142857143, abs=1e-10)
    assert found.interval == pytest.approx((0.7337608254, 0.9317466280), abs=1e-9)
    # two optimisers of one flat likelihood
    assert found.omega == pytest.approx(0.874672647028, abs=1e-7)


def test_an_offset_and_a_turned_item_change_nothing() -> None:
    moved = reliability(ANSWERS + np.array([0, 100, -7, 1e6]))
    assert moved.alpha == pytest.approx(reliability(ANSWERS).alpha, abs=1e-8)
    assert reliability(-ANSWERS).omega == pytest.approx(reliability(ANSWERS).omega, abs=1e-7)


@pytest.mark.parametrize(
    ("items", "why"),
    [
        (ANSWERS[:, :2], "fewer than three items"),
        (ANSWERS[:2], "fewer than three participants"),
        (ANSWERS * [1, 1, 1, 0], "everybody answers an item alike"),
        (np.column_stack([ANSWERS[:, 0], -ANSWERS[:, 0] / 2, -ANSWERS[:, 0] / 2]),
         "the items' sum does not vary"),
    ],
)  # fmt: skip
def test_it_says_why_there_is_none(items: np.ndarray, why: str) -> None:
    assert reliability(items).alpha == Undefined(why)


def test_an_item_without_a_variance_of_its_own_has_no_omega() -> None:
    own = np.random.default_rng(1).normal(size=len(ANSWERS))
    x = np.column_stack([ANSWERS[:, 0], ANSWERS[:, 0] + 0.001 * own, ANSWERS[:, 1]])
    assert reliability(x).omega == Undefined(HEYWOOD)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("factor", [1.0, 0.1 / 3, -1.0, 1e6])
@pytest.mark.parametrize("people", [4, 8, len(ANSWERS)])
def test_items_that_follow_from_others_have_no_omega_and_no_warning(people, factor) -> None:
    """Whatever rounding makes of a matrix that cannot be inverted: the likelihood has no bound."""
    x = np.column_stack([ANSWERS, factor * ANSWERS[:, 0], ANSWERS[:, :2].sum(axis=1)])[:people]
    found = reliability(x)
    why = TOO_FEW if people <= x.shape[1] else SUM
    assert found.omega == Undefined(why) and isinstance(found.alpha, float)
    alike = reliability(np.repeat(ANSWERS[:people, :1], 5, axis=1))
    assert alike.alpha == pytest.approx(1.0) and not isinstance(alike.omega, float)


def test_the_sidecar_says_which_items_a_sum_is_made_of() -> None:
    items = {i["name"]: i for i in design_entry(load("liao2023"))["items"]}
    assert items["sus"]["parts"] == [f"sus_{n}" for n in range(1, 11)]
    assert items["sus"]["reverse"] == [f"sus_{n}" for n in range(2, 11, 2)]
    assert not {"sus_1", "sus_2"} & items.keys()


def test_a_report_has_it_of_a_sum_and_turns_items(tmp_path: Path) -> None:
    """Answers to four items, one of them turned, in a made folder's questionnaires."""
    names = [f"q_{n}" for n in range(1, 5)]
    item = {"name": "scale", "label": "scale", "each": [], "group": "", "of": "", "parts": names,
            "reverse": ["q_2"]}  # fmt: skip

    def answers(slot: int) -> list[dict[str, Any]]:
        own = ANSWERS[slot - 1] * np.array([1, -1, 1, 1]) + np.array([0, 4, 0, 0])
        given = dict(zip(names, own.tolist(), strict=True)) | {"scale": float(own.sum())}
        return [{"item": name, "value": value, "text": ""} for name, value in given.items()]

    design = replace(DESIGNS["scenes"], more={"items": [item]}, answers=answers)
    folder = make_design(tmp_path / "data", design)
    (table,) = [t for t in tables_of(make_report(folder, Options())) if t.key == "reliability"]
    (row,) = table.rows
    expected = reliability(ANSWERS[:12])
    assert (row["items"], row["n"]) == (4, 12)
    assert row["alpha"] == pytest.approx(expected.alpha)
