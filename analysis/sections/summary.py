"""The first page: the study's questions, answered in plain sentences."""

from __future__ import annotations

from analysis.comparison import apa_f
from analysis.page.blocks import Prose, Section, Table, say
from analysis.sections.context import Context
from analysis.stats.undefined import is_defined

PLANNING = " (simulated participants)"


def summary_section(
    context: Context, logs: Table | None, accuracy: Table | None, single: Table | None
) -> Section:
    """P1 faster, P2 not less accurate, P3 depth perception, by name."""
    note = PLANNING if context.study.source == "simulated" else ""
    blocks = [
        _faster(context, logs, note),
        _accurate(context, accuracy, note),
        _depth(single, note),
    ]
    return Section("summary", "In short", tuple(blocks))


def _faster(context: Context, logs: Table | None, note: str) -> Prose:
    start = f"P1, dynamic transparency is faster{note}: "
    if logs is None or not logs.rows:
        return say(f"{start}not answered, nobody has complete times.", kind="answer")
    key = str(logs.rows[0]["measure"])
    row = logs.row(key)
    if not is_defined(row["p"]):
        return say(f"{start}{{}}.", logs.cite(key, "p"), kind="answer")
    supported = row["p"] < context.plan.alpha
    verdict = (
        ("supported" if row["ratio"] < 1 else "contradicted: it is slower")
        if supported
        else "not shown"
    )
    return say(
        f"{start}{verdict}. Times with it are {{}} of those without, 95 % CI [{{}}, {{}}], {{}}.",
        logs.cite(key, "ratio"),
        logs.cite(key, "ratio_low"),
        logs.cite(key, "ratio_high"),
        apa_f(logs, key),
        kind="answer",
    )


def _accurate(context: Context, tests: Table | None, note: str) -> Prose:
    start = f"P2, dynamic transparency does not cost accuracy{note}: "
    rows = [r for r in tests.rows if is_defined(r["p"])] if tests else []
    if not rows:
        return say(f"{start}not answered, no accuracy measure can be tested.", kind="answer")
    alpha = context.plan.alpha
    worse = [r["label"] for r in rows if r["p"] < alpha and r["difference"] < 0]
    better = [r["label"] for r in rows if r["p"] < alpha and r["difference"] > 0]
    equal = [
        r["label"]
        for r in rows
        if r["p"] >= alpha and is_defined(r["tost_p"]) and r["tost_p"] < alpha
    ]
    open_ = [
        r["label"]
        for r in rows
        if r["p"] >= alpha and not (is_defined(r["tost_p"]) and r["tost_p"] < alpha)
    ]
    parts = [
        f"{words} in {', '.join(labels)}"
        for words, labels in (
            ("less accurate", worse),
            ("more accurate", better),
            ("equivalent within the margin", equal),
            ("neither different nor shown to be equivalent", open_),
        )
        if labels
    ]
    verdict = "contradicted" if worse else "supported" if not open_ else "not contradicted"
    return say(f"{start}{verdict}. It is {'; '.join(parts)}.", kind="answer")


def _depth(single: Table | None, note: str) -> Prose:
    start = f"P3, static depth perception does not suffer{note}: "
    rows = {str(r["item"]) for r in single.rows} if single else set()
    if single is None or "depth_test" not in rows:
        return say(f"{start}not asked.", kind="answer")
    return say(
        f"{start}{{}} of 3 right on average with the technique, from {{}} participants. Nobody "
        "takes the test without it, so this describes and does not compare.",
        single.cite("depth_test", "mean"),
        single.cite("depth_test", "n"),
        kind="answer",
    )
