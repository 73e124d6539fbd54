"""What a report has only where it was asked for: all pairs, and aligned ranks with their warning.

That their numbers are R's is held by tests/study/test_designs_against_r.py.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from made_designs import DESIGNS, make_design

from seethrough.analysis.errors import DataError
from seethrough.analysis.page.blocks import Prose, Report, Table, walk
from seethrough.analysis.report import Options, make_report
from seethrough.analysis.stats.aligned import aligned_ranks
from seethrough.analysis.stats.anova import repeated_measures

RANKED = DESIGNS["two_by_three_ranked"]


def _tables(report: Report) -> dict[str, Table]:
    return {b.key: b for s in report.sections for b in walk(s.blocks) if isinstance(b, Table)}


def _said(report: Report, kind: str) -> str:
    blocks = [b for s in report.sections for b in walk(s.blocks)]
    return " ".join(
        str(run) for b in blocks if isinstance(b, Prose) and b.kind == kind for run in b.runs
    )


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a study that asked for nothing."""
    return make_design(tmp_path_factory.mktemp("plain") / "data", replace(RANKED, plan={}))


def test_nothing_is_there_unless_it_was_asked_for(plain: Path) -> None:
    report = make_report(plain, Options())
    assert not [key for key in _tables(report) if key.startswith(("pairwise", "aligned"))]
    assert "ligned ranks" not in _said(report, "warning")


def test_what_was_asked_for_later_is_a_deviation(plain: Path, tmp_path: Path) -> None:
    frozen = replace(RANKED, plan={"alpha": 0.05})
    folder = make_design(tmp_path / "data", frozen)
    report = make_report(folder, Options(pairwise=("clutter",), aligned_ranks=True))
    tables = _tables(report)
    assert len(tables["pairwise_off"].rows) == len(tables["pairwise_ease"].rows) == 3
    said = _said(report, "warning")
    assert "All pairs of clutter were not planned; they were asked for." in said
    assert "Aligned ranks were not planned; they were asked for." in said
    assert "They reject far too often where values are discrete or skewed" in said
    planned = _said(make_report(make_design(tmp_path / "planned", RANKED), Options()), "warning")
    assert "not planned" not in planned


def test_a_factor_that_is_none_is_one_line(plain: Path) -> None:
    with pytest.raises(DataError, match="pairwise = 'size': expected among view, clutter"):
        make_report(plain, Options(pairwise=("size",)))


def test_holm_goes_over_all_pairs(tmp_path: Path) -> None:
    folder = make_design(tmp_path / "data", DESIGNS["four_ranked"])
    rows = _tables(make_report(folder, Options()))["pairwise_log_time"].rows
    p = np.array([r["p"] for r in rows])
    assert len(p) == 6
    order = np.argsort(p)
    step = np.maximum.accumulate(np.minimum(1, p[order] * np.arange(6, 0, -1)))
    assert np.array([r["p_holm"] for r in rows])[order] == pytest.approx(step)


def test_groups_get_the_warning_and_no_table(tmp_path: Path) -> None:
    folder = make_design(tmp_path / "data", DESIGNS["mixed_ordinal"])
    report = make_report(folder, Options(aligned_ranks=True))
    assert not [key for key in _tables(report) if key.startswith("aligned")]
    assert "never validated" in _said(report, "warning")


def test_alignment_takes_the_other_effects_out() -> None:
    """Of data with two main effects and no interaction, what is aligned for the interaction is the
    residuals alone: whatever is added to a level changes nothing."""
    rng = np.random.default_rng(4)
    y = rng.normal(size=(9, 2, 3))
    moved = y + 50.0 * np.arange(2)[:, None] + 7.0 * np.arange(3)
    one, other = (aligned_ranks(v, ("a", "b"))["a × b"].f for v in (y, moved))
    assert one == pytest.approx(other)
    # ranks of one factor's effect keep what is added to it
    assert aligned_ranks(moved, ("a", "b"))["a"].f > aligned_ranks(y, ("a", "b"))["a"].f
    assert repeated_measures(moved, ("a", "b"))["a"].df1 == 1
