"""P1 to P3 by name, and what “no effect” would need."""

from __future__ import annotations

import numpy as np

from analysis.comparison import apa_f
from analysis.page.blocks import Block, Cited, Column, Fold, Prose, Section, Table, say
from analysis.published.consistency import Finding
from analysis.published.numbers import Published
from analysis.sections.summary import places
from analysis.stats.distributions import t_upper

ALPHA = 0.05
MARGIN = 0.20


EQUIVALENCE = (
    Column("measure", "measure"),
    Column("label", "measure"),
    Column("margin", "margin", "sig3", "20 % of the standard mean"),
    Column("p", "p (TOST)", "p"),
    Column("shown", "equivalent?"),
    Column("how", "from"),
)


def equivalence_table(published: Published, tests: Table) -> Table:
    """TOST of every accuracy measure in which the paper finds no difference."""
    rows = [
        {
            "measure": name,
            "label": tests.row(name)["label"],
            "margin": tests.row(name)["tost_margin"],
            "p": tests.row(name)["tost_p"],
            "how": "data with the printed moments and F",
        }
        for name in ("error_T4", "distance_T3")
    ]
    margin, p = worst_tost(published)
    rows.append(
        {
            "measure": "correct_T2",
            "label": "T2 share correct",
            "margin": margin,
            "p": p,
            "how": "means and SD alone: the largest p that correlation and rounding allow",
        }
    )
    every = tuple({**row, "shown": "yes" if row["p"] < ALPHA else "not shown"} for row in rows)
    shown = ("label", "margin", "p", "shown", "how")
    return Table("equivalence", "Is “no difference” equality?", EQUIVALENCE, every, shown)


def worst_tost(published: Published) -> tuple[float, float]:
    """T2's margin, and the largest p of its TOST: no F was printed, so the correlation is unknown.

    The s.d. of a difference is at most the sum of the two s.d. (at r = −1).
    """
    first, second = published.correct
    n = published.participants
    margin = MARGIN * first.mean.value
    room = MARGIN * first.mean.low - max(
        abs(first.mean.high - second.mean.low), abs(second.mean.high - first.mean.low)
    )
    error = (first.sd.high + second.sd.high) / np.sqrt(n)
    return margin, t_upper(room / error, n - 1)


def equivalence_section(published: Published, tests: Table, table: Table) -> Section:
    """A test that shows no difference is not one that shows there is none."""
    key = "distance_T3"
    p = published.measure(key).p.text
    shown = tests.row(key)["tost_p"] < ALPHA
    verdict = "equivalence is shown" if shown else "equivalence is not shown"
    text = say(
        f"The paper reads T3's distances (p = {p}) as “not negatively affected”. The 95 % interval "
        "of the difference (standard − dynamic) runs from {} to {} units, from marks that much "
        "farther off with dynamic transparency to marks that much nearer; two one-sided tests "
        f"against ± {{}} units (20 % of the standard mean) give p = {{}}: {verdict}.",
        tests.cite(key, "difference_low", "fixed1"),
        tests.cite(key, "difference_high", "fixed1"),
        tests.cite(key, "tost_margin"),
        tests.cite(key, "tost_p", "bound2"),
    )
    return Section("equivalence", "Is “no effect on spatial understanding” shown?", (text, table))


def predictions_section(
    published: Published, tests: Table, findings: list[Finding], equal: Table
) -> Section:
    """P1 to P3 by name."""
    printed = _printed(published)
    answers = (
        _faster(published, tests, findings),
        _accurate(published, tests, printed, equal),
        _depth(published, printed),
    )
    fold = Fold("Printed numbers without an F", (printed,))
    every: tuple[Block, ...] = (*answers, *places(answers), fold)
    return Section("predictions", "The paper's predictions", every)


def _printed(published: Published) -> Table:
    """What the paper prints besides the nine measures, for the sentences to cite."""
    levels = ("standard", "dynamic")
    rows = [
        *(
            (f"correct_T2_{level}", f"T2 share correct, {level}", m)
            for level, m in zip(levels, published.correct, strict=True)
        ),
        *(
            (f"rating_{level}", f"overall rating, {level}", m)
            for level, m in zip(levels, published.rating, strict=True)
        ),
        *((s.name, s.label, s.moments) for s in published.single),
    ]
    columns = (
        Column("item", "item"),
        Column("label", "item"),
        Column("mean", "M", "text", "as printed"),
        Column("sd", "SD", "text", "as printed"),
    )
    return Table(
        "printed",
        "Printed numbers without an F",
        columns,
        tuple(
            {"item": key, "label": label, "mean": m.mean.text, "sd": m.sd.text}
            for key, label, m in rows
        ),
        ("label", "mean", "sd"),
    )


def _faster(published: Published, tests: Table, findings: list[Finding]) -> Prose:
    multiple = next(f for f in findings if f.key == "multiplicity").detail.split(":")[0]
    overall = tests.row("time_overall")
    supported = overall["difference"] > 0 and overall["p"] < ALPHA
    verdict = "not supported" if not supported else "supported"
    runs: list[str | Cited] = []
    for name in published.tasks:
        row, p = tests.row(name), tests.cite(name, "p_holm")
        words = "no difference shown"
        if row["p_holm"] < ALPHA:
            words = "faster" if row["difference"] > 0 else "slower"
        equals = "" if p.text.startswith("<") else "= "
        runs += ["; " if runs else "", f"{row['label']} {words}, p {equals}", p]
    return say(
        f"P1, dynamic transparency is faster: {verdict}. Overall {{}}. By task (Holm-corrected): "
        f"{{}}; {multiple}.",
        apa_f(tests, "time_overall"),
        runs,
        kind="answer",
    )


def _accurate(published: Published, tests: Table, printed: Table, equal: Table) -> Prose:
    parts: dict[str, list[str | Cited]] = {"less": [], "more": []}
    for name in ("error_T1_T4", "error_T1", "error_T4", "distance_T3"):
        row = tests.row(name)
        if row["p"] < ALPHA:
            runs = parts["more" if row["difference"] > 0 else "less"]
            runs += ["; " if runs else "", f"{row['label']}, ", *apa_f(tests, name)]
    said: list[str | Cited] = []
    for words, runs in parts.items():
        said += [f" It is {words} accurate in ", *runs, "."] if runs else []
    said.append(" No difference is shown in ")
    for i, row in enumerate(equal.rows):
        p = equal.cite(str(row["measure"]), "p")
        equals = " ≤ " if row["measure"] == "correct_T2" else " = "
        equals = " " if p.text.startswith("<") else equals
        words = "equivalence is shown" if row["shown"] == "yes" else "nor is equivalence"
        said += ["; " if i else "", f"{row['label']}, {words} (TOST p{equals}", p, ")"]
    open_ = any(row["shown"] != "yes" for row in equal.rows)
    verdict = "contradicted" if parts["less"] else "supported"
    if open_ and not parts["less"]:
        verdict = "not contradicted, and not shown everywhere"
    return say(
        f"P2, dynamic transparency does not cost accuracy: {verdict}.{{}}. T2's shares right are "
        f"{{}} and {{}}. Margin: {100 * MARGIN:g} % of the standard mean.",
        said,
        printed.cite("correct_T2_standard", "mean"),
        printed.cite("correct_T2_dynamic", "mean"),
        kind="answer",
    )


def _depth(published: Published, printed: Table) -> Prose:
    depth = next(s for s in published.single if s.name == "depth_test")
    own = next(s for s in published.single if s.name == "depth_self_report")
    return say(
        f"P3, static depth perception does not suffer: not tested. {{}} of {depth.highest} right "
        f"with dynamic transparency (SD = {{}}) and a self-report of {{}} on a scale to "
        f"{own.highest} are high, but nobody took the test without it: there is nothing to "
        "compare with.",
        printed.cite("depth_test", "mean"),
        printed.cite("depth_test", "sd"),
        printed.cite("depth_self_report", "mean"),
        kind="answer",
    )
