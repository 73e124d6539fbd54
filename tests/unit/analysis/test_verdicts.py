"""What the report says of a prediction follows from its tables, in every case there is."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from seethrough.analysis.before import design_before
from seethrough.analysis.comparison import Pair, compare, compare_logs, decisive
from seethrough.analysis.equivalence import Margin, no_difference
from seethrough.analysis.page.blocks import Prose
from seethrough.analysis.sections.answers.answers_directed import by_task
from seethrough.analysis.sections.answers.answers_margin import accurate
from seethrough.analysis.sections.tests.ordinal import friedman_table

MARGINS = {"time": 1.2, "count_error": 2.0, "correct": 0.1}
DESIGN = design_before({"analysis": {"margins": MARGINS}})
CONTRAST = DESIGN.contrasts()[0]
TIME, ERROR = Margin(1.2, ratio=True), Margin(2.0)
RNG = np.random.default_rng(6)
BASE = RNG.normal(10.0, 1.0, 16)
NOISE = RNG.normal(0.0, 0.1, 16)
WIDE = RNG.normal(0.0, 9.0, 16)


def text(block: Prose | tuple | list) -> str:
    runs = block.runs if isinstance(block, Prose) else block
    return "".join(run if isinstance(run, str) else run.text for run in runs)


def errors(dynamic: np.ndarray, of: str = "count_error", label: str = "T1 count"):
    pair = Pair(f"{of}_count", label, "", 3, BASE, dynamic, margin=ERROR)
    return compare([replace(pair, contrast=CONTRAST, of=of, where="count")])


def judged(**tables) -> str:
    """What is said of the second prediction, from each measure's table."""
    context = SimpleNamespace(design=DESIGN, plan=SimpleNamespace(alpha=0.05))
    own = {
        name: {"ranks" if name == "correct" else "tests": table} for name, table in tables.items()
    }
    start = "P2, dynamic transparency does not cost accuracy: "
    return text(accurate(context, DESIGN.predictions[1], own, start).said)


@pytest.mark.parametrize(
    ("dynamic", "verdict", "words"),
    [
        (BASE + 3 + NOISE, "contradicted", "less accurate in relative error, T1 count"),
        (BASE - 3 + NOISE, "supported", "more accurate in relative error, T1 count"),
        (BASE + NOISE - NOISE.mean(), "supported", "no worse within the margin in"),
        (BASE + WIDE - WIDE.mean(), "not shown everywhere", "not shown to be no worse in"),
    ],
)
def test_accuracy_is_judged_by_difference_and_equivalence(dynamic, verdict, words):
    said = judged(count_error=errors(dynamic))
    assert f"accuracy: {verdict}" in said and words in said


def test_one_measure_that_suffers_contradicts_the_others():
    """Cancelling errors can look equal where absolute ones have doubled."""
    signed = errors(BASE + NOISE - NOISE.mean())
    absolute = errors(BASE + 3 + NOISE, "absolute_error")
    said = judged(count_error=signed, absolute_error=absolute)
    assert "accuracy: contradicted. It is less accurate in absolute relative error" in said
    assert "no worse within the margin in relative error, T1 count" in said


@pytest.mark.parametrize(("shift", "word"), [(-0.5, "less"), (0.4, "more")])
def test_shares_of_right_answers_are_better_when_larger(shift, word):
    """T2 goes by its exact p; every other task by how far off its answers are."""
    row = {"measure": "correct_pattern", "of": "correct", "where": "pattern",
           "level": CONTRAST.key, "label": "T2 pattern", "difference": -shift, "p": 0.5,
           "p_exact": 0.001, "p_holm": 0.004, "tost_p": 0.9,
           "tost_margin": 0.1, "noninferior_p": 0.9, "method": "exact"}  # fmt: skip
    other = {**row, "measure": "correct_count", "where": "count", "label": "T1 count",
             "difference": shift}  # fmt: skip
    table = friedman_table("friedman_correct", "", [row, other], [], True)
    said = judged(correct=table)
    assert f"{word} accurate in right answers, T2 pattern (Holm-corrected p = .004)" in said
    assert "T1" not in said


def test_holm_decides_within_a_family():
    """p = .03 for each of four tasks is no difference in any: Holm's p is .12."""
    rng = np.random.default_rng(1)
    gaps = rng.normal(size=16)
    gaps = (gaps - gaps.mean()) / gaps.std(ddof=1)
    logs = (gaps + 0.6, gaps * 0)
    times = [Pair(f"time_{i}", f"T{i}", "s", 2, BASE, BASE, "tasks", TIME, logs) for i in range(4)]
    logs = compare_logs(times)
    assert all(0.025 < r["p"] < 0.035 for r in logs.rows)
    assert [decisive(r)[0] for r in logs.rows] == ["p_holm"] * 4
    said = text(by_task(logs, list(logs.rows), 0.05))
    assert said.count("no difference shown") == 4 and "faster" not in said


def test_a_slower_task_is_named():
    quick, slow = ((np.log(BASE), np.log(BASE * by) + NOISE) for by in (0.5, 2.0))
    times = [
        Pair("time_a", "T1", "s", 2, BASE, BASE, "tasks", TIME, quick),
        Pair("time_b", "T2", "s", 2, BASE, BASE, "tasks", TIME, slow),
    ]
    logs = compare_logs(times)
    said = text(by_task(logs, list(logs.rows), 0.05))
    assert "T1 faster" in said and "T2 slower" in said


def test_no_difference_never_stands_alone():
    """Wherever it is said, equivalence follows: shown, not shown, or why it cannot be."""
    for dynamic, words in (
        (BASE + NOISE - NOISE.mean(), "so the two are equivalent within that margin"),
        (BASE + WIDE - WIDE.mean(), "so this is no evidence of equality either"),
    ):
        table = errors(dynamic)
        assert words in text(no_difference(table, "count_error_count", 0.05))
        assert "± 2.00, the declared margin" in text(
            no_difference(table, "count_error_count", 0.05)
        )
    zero = np.zeros(16)
    table = compare([Pair("m", "m", "", 2, zero, zero, margin=Margin(0.1))])
    assert "undefined: all differences are equal" in text(no_difference(table, "m", 0.05))
    table = compare([Pair("m", "m", "", 2, BASE, BASE + WIDE)])
    assert "no evidence of equality: no margin was declared" in text(
        no_difference(table, "m", 0.05)
    )
