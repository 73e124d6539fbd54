"""P1 to P3 by name, and what “no effect” would need."""

from __future__ import annotations

from analysis.comparison import apa_f
from analysis.page.blocks import Column, Fold, Prose, Section, Table, say
from analysis.published.consistency import Finding
from analysis.published.numbers import Published

ALPHA = 0.05


def equivalence_section(published: Published, tests: Table) -> Section:
    """T3's distance: a test that shows no difference is not one that shows there is none."""
    key = "distance_T3"
    p = published.measure(key).p.text
    shown = tests.row(key)["tost_p"] < ALPHA
    verdict = "equivalence is shown" if shown else "equivalence is not shown"
    text = say(
        f"The paper reads T3's distances (p = {p}) as “not negatively affected”. The 95 % interval "
        "of the difference, [{}, {}] units, allows a good deal in either direction; two one-sided "
        f"tests against ± {{}} units (20 % of the standard mean) give p = {{}}: {verdict}.",
        tests.cite(key, "difference_low", "fixed1"),
        tests.cite(key, "difference_high", "fixed1"),
        tests.cite(key, "tost_margin"),
        tests.cite(key, "tost_p", "bound2"),
    )
    return Section("equivalence", "Is “no effect on spatial understanding” shown?", (text,))


def predictions_section(published: Published, tests: Table, findings: list[Finding]) -> Section:
    """P1 to P3 by name."""
    printed = _printed(published)
    blocks = (
        _faster(published, tests, findings),
        _accurate(published, tests, printed),
        _depth(published, printed),
        Fold("Printed numbers without an F", (printed,)),
    )
    return Section("predictions", "The paper's predictions", blocks)


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
        Column("sd", "s.d.", "text", "as printed"),
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
    rows = [tests.row(name) for name in published.tasks]
    faster = [r for r in rows if r["difference"] > 0 and r["p"] < ALPHA]
    overall = tests.row("time_overall")
    supported = overall["difference"] > 0 and overall["p"] < ALPHA
    verdict = "not supported" if not supported else "supported"
    return say(
        f"P1, dynamic transparency is faster: {verdict}. Overall {{}}; it is significantly faster "
        f"in {len(faster)} of {len(rows)} tasks; {multiple}.",
        apa_f(tests, "time_overall"),
        kind="answer",
    )


def _accurate(published: Published, tests: Table, printed: Table) -> Prose:
    better: list[str] = []
    unclear: list[str] = []
    for name in ("error_T1", "error_T4", "distance_T3"):
        row = tests.row(name)
        (better if row["p"] < ALPHA and row["difference"] > 0 else unclear).append(row["label"])
    worse = [r["label"] for r in tests.rows if r["difference"] < 0 and r["p"] < ALPHA]
    a, b = (m.mean.text for m in published.correct)
    verdict = "contradicted" if worse else "not contradicted, and not shown everywhere"
    same = "the same share right to the last digit" if a == b else "different shares right"
    return say(
        f"P2, dynamic transparency does not cost accuracy: {verdict}. It is more accurate in "
        f"{', '.join(better) or 'nothing'} (T1: {{}}); no difference is shown in "
        f"{', '.join(unclear)} (T4: {{}}); T2 has {same} ({{}} and {{}}). For T3's distance "
        "equivalence within ± 20 % has p = {}, so “no effect” is not shown either.",
        apa_f(tests, "error_T1"),
        apa_f(tests, "error_T4"),
        printed.cite("correct_T2_standard", "mean"),
        printed.cite("correct_T2_dynamic", "mean"),
        tests.cite("distance_T3", "tost_p", "bound2"),
        kind="answer",
    )


def _depth(published: Published, printed: Table) -> Prose:
    depth = next(s for s in published.single if s.name == "depth_test")
    own = next(s for s in published.single if s.name == "depth_self_report")
    return say(
        f"P3, static depth perception does not suffer: not tested. {{}} of {depth.highest} right "
        f"with dynamic transparency (s.d. {{}}) and a self-report of {{}} of {own.highest} are "
        "high, but nobody took the test without it: there is nothing to compare with.",
        printed.cite("depth_test", "mean"),
        printed.cite("depth_test", "sd"),
        printed.cite("depth_self_report", "mean"),
        kind="answer",
    )
