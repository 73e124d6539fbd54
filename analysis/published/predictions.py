"""P1 to P3 by name, and what “no effect” would need."""

from __future__ import annotations

import numpy as np

from seethrough.analysis.before import RATIOS
from seethrough.analysis.comparison import apa_f
from seethrough.analysis.page.blocks import Block, Cited, Column, Fold, Prose, Section, Table, say
from seethrough.analysis.page.numbers import equals
from seethrough.analysis.published.consistency import Finding
from seethrough.analysis.published.numbers import Published
from seethrough.analysis.sections.summary import places
from seethrough.analysis.stats.distributions import t_upper
from seethrough.analysis.stats.undefined import number_in

ALPHA = 0.05

EQUIVALENCE = (
    Column("measure", "measure"),
    Column("label", "measure"),
    Column("margin", "margin", "sig3", "ours, in the measure's unit"),
    Column("p", "p (TOST)", "p"),
    Column("shown", "equivalent?"),
    Column("noninferior_p", "p (no worse)", "p", "that dynamic is not worse by the margin"),
    Column("no_worse", "no worse?"),
    Column("how", "from"),
)


def equivalence_table(published: Published, tests: Table) -> Table:
    """Both tests of every accuracy measure in which the paper finds no difference."""
    rows = [
        {
            "measure": name,
            "label": tests.row(name)["label"],
            "margin": tests.row(name)["tost_margin"],
            "p": tests.row(name)["tost_p"],
            "noninferior_p": tests.row(name)["noninferior_p"],
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
            # the larger of the two one-sided p bounds each of them
            "noninferior_p": p,
            "how": "means and SD alone: the largest p that correlation and rounding allow; but "
            "no answers in the stated trials have them, so this is no evidence",
        }
    )
    every = tuple(
        {
            **row,
            "shown": _shown(number_in(row, "p"), row["measure"]),
            "no_worse": _shown(number_in(row, "noninferior_p"), row["measure"]),
        }
        for row in rows
    )
    shown = ("label", "margin", "p", "shown", "noninferior_p", "no_worse", "how")
    return Table("equivalence", "Is “no difference” equality?", EQUIVALENCE, every, shown)


IMPOSSIBLE = "not to be told: the numbers are impossible"


def _shown(p: float, name: object) -> str:
    """Whether a test shows it; numbers that no answers have show nothing."""
    if name == "correct_T2":
        return IMPOSSIBLE
    return "yes" if p < ALPHA else "not shown"


def worst_tost(published: Published) -> tuple[float, float]:
    """T2's margin, and the largest p of its TOST: no F was printed, so the correlation is unknown.

    The s.d. of a difference is at most the sum of the two s.d. (at r = −1).
    """
    first, second = published.correct
    margin = published.margins["correct"]
    gap = max(abs(first.mean.high - second.mean.low), abs(second.mean.high - first.mean.low))
    error = (first.sd.high + second.sd.high) / np.sqrt(published.participants)
    return margin, t_upper((margin - gap) / error, published.participants - 1)


def equivalence_section(published: Published, tests: Table, table: Table) -> Section:
    """A test that shows no difference is not one that shows there is none."""
    key = "distance_T3"
    p = published.measure(key).p.text
    row = table.row(key)
    no_worse = "it is shown" if row["no_worse"] == "yes" else "it is not shown"
    verdict = "is shown" if row["shown"] == "yes" else "is not shown"
    text = say(
        f"The paper reads T3's distances (p = {p}) as “not negatively affected”. The 95 % interval "
        "of the difference (standard − dynamic) runs from {} to {} units, from marks that much "
        "farther off with dynamic transparency to marks that much nearer. That they are not "
        "farther off by the margin of {} units (ours: the paper declares none): p = {}, "
        f"{no_worse}. Equivalence within ± the margin: p = {{}}, it {verdict}.",
        tests.cite(key, "difference_low", "fixed1"),
        tests.cite(key, "difference_high", "fixed1"),
        tests.cite(key, "tost_margin"),
        tests.cite(key, "noninferior_p", "bound2"),
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
    supported = number_in(overall, "difference") > 0 and number_in(overall, "p") < ALPHA
    verdict = "not supported" if not supported else "supported"
    runs: list[str | Cited] = []
    for name in published.tasks:
        row, p = tests.row(name), tests.cite(name, "p_holm")
        words = "no difference shown"
        if number_in(row, "p_holm") < ALPHA:
            words = "faster" if number_in(row, "difference") > 0 else "slower"
        runs += ["; " if runs else "", f"{row['label']} {words}, p {equals(p.text)}", p]
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
        if number_in(row, "p") < ALPHA:
            runs = parts["more" if number_in(row, "difference") > 0 else "less"]
            runs += ["; " if runs else "", f"{row['label']}, ", *apa_f(tests, name)]
    said: list[str | Cited] = []
    for words, runs in parts.items():
        said += [f" It is {words} accurate in ", *runs, "."] if runs else []
    said.append(" No difference is shown in ")
    for i, row in enumerate(equal.rows):
        p = equal.cite(str(row["measure"]), "noninferior_p")
        sign = equals(p.text)
        if sign and row["measure"] == "correct_T2":
            sign = "≤ "
        words = {
            "yes": "and that it is no worse is shown",
            "not shown": "and that it is no worse is not shown either",
        }.get(str(row["no_worse"]), "whose numbers are impossible, so that nothing follows")
        said += ["; " if i else "", f"{row['label']}, {words} (one-sided p {sign}", p, ")"]
    verdict = "contradicted" if parts["less"] else "supported"
    if any(row["no_worse"] != "yes" for row in equal.rows) and not parts["less"]:
        verdict = "not contradicted, and not shown everywhere"
    margins = ", ".join(
        f"{k.replace('_', ' ')} {v:g}" for k, v in published.margins.items() if k not in RATIOS
    )
    return say(
        f"P2, dynamic transparency does not cost accuracy: {verdict}.{{}}. T2's shares right are "
        f"{{}} and {{}}. Margins (ours): {margins}.",
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
