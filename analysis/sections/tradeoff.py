"""Speed and accuracy side by side: did anyone buy speed with errors?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from seethrough.analysis.cells import Missing, people
from seethrough.analysis.comparison import Pair, compare
from seethrough.analysis.design import Factor
from seethrough.analysis.figures.tradeoff import arrows
from seethrough.analysis.measures import groups_of
from seethrough.analysis.page.blocks import Block, Cited, Column, Prose, Section, Table, say
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.ranks import sign_test
from seethrough.analysis.stats.ties import difference_signs
from seethrough.analysis.stats.undefined import Undefined, is_defined, number_in
from seethrough.analysis.tradeoff import Change, accuracy_by_speed, changes, correlation, scores

CHANGES = (
    Column("task", "task"),
    Column("label", "task"),
    Column("error", "error measure", about="the measure that times are set against"),
    Column("n", "n", "int"),
    Column("faster_worse", "faster, more errors", "int"),
    Column("faster_better", "faster, fewer errors", "int"),
    Column("faster_same", "faster, same errors", "int"),
    Column("slower", "not faster", "int"),
    Column("p_errors", "p of the faster", "p", "more against fewer errors, sign test"),
    Column("r", "r of changes", "bound2", "95 % interval", "r_low", "r_high"),
    Column("r_low", "from", "bound2", "95 % interval"),
    Column("r_high", "to", "bound2", "95 % interval"),
    Column("p", "p", "p"),
)
WARNINGS = {
    "bis": "BIS weighs time and accuracy equally; it is the least sensitive to trade-offs, though "
    "not to those of a diffusion model.",
    "ies": "IES assumes that errors and time are exchangeable and misleads below 90 % correct.",
    "rcs": "RCS counts right answers per second and inherits the weights of IES.",
}
SCORES_SHOWN = ("label", "n", "mean_baseline", "mean_level", "F", "p", "pes", "dz", "bf10")


def tradeoff_section(context: Context) -> Section | None:
    """None unless somebody worked under both levels."""
    found = changes(context.trials, context.design)
    factor = context.design.main
    if not found or factor is None:
        return None
    context.missing["trade-off"] = _absent(found, context)
    table = Table(
        "tradeoff",
        f"From {factor.baseline} to {_others(factor)}: who became faster, and at what price",
        CHANGES,
        tuple(_row(c) for c in found),
        tuple(c.name for c in CHANGES[1:] if c.name not in ("r_low", "r_high")),
        "r: correlation of the changes in mean log time and in error; no p is corrected for being "
        "one of several. A positive r: those who gained "
        "more time also gained more accuracy. A negative one: those who gained more time lost more "
        "accuracy, as where people buy speed with errors.",
    )
    blocks: list[Block] = [
        _sentence(table, found, context.plan.alpha),
        arrows("tradeoff", found),
        table,
        *_conditional(context, factor),
        *_scores(context, factor),
    ]
    return Section("tradeoff", "What accuracy costs in time", tuple(blocks))


def _others(factor: Factor) -> str:
    """The levels that people step to from the baseline."""
    others = [level for level in factor.levels if level != factor.baseline]
    return others[0] if len(others) == 1 else "each other level"


def _absent(found: Sequence[Change], context: Context) -> tuple[Missing, ...]:
    """Who lacks time or error in a task that somebody of their group has, by name."""
    everybody = people(context.trials)
    own = [groups_of(context.study.trials, f, everybody) for f in context.design.groups]
    group = dict(zip(everybody, zip(*own, strict=True) if own else [()] * len(everybody),
                     strict=True))  # fmt: skip
    there = {c.key: set(c.participants) for c in found}
    met = {t: {group[name] for name in who} for t, who in there.items()}
    lacks = {
        name: tuple(t for t, who in there.items() if name not in who and group[name] in met[t])
        for name in everybody
    }
    return tuple(Missing(name, tasks) for name, tasks in lacks.items() if tasks)


def _row(c: Change) -> dict[str, object]:
    faster = difference_signs(c.log_time[:, 1], c.log_time[:, 0]) < 0
    worse = difference_signs(c.worse[:, 1], c.worse[:, 0])
    r = correlation(c.log_time[:, 1] - c.log_time[:, 0], np.diff(c.worse).ravel())
    counts = [int(np.sum(faster & (worse == sign))) for sign in (1, -1, 0)]
    return {
        "task": c.key,
        "label": c.said,
        "error": c.error_label,
        "n": len(faster),
        "faster_worse": counts[0],
        "faster_better": counts[1],
        "faster_same": counts[2],
        "slower": int(np.sum(~faster)),
        "p_errors": sign_test(counts[0], counts[1]),
        "r": r.r,
        "r_low": r.interval[0],
        "r_high": r.interval[1],
        "p": r.p,
    }


def _sentence(table: Table, found: Sequence[Change], alpha: float) -> Prose:
    """One sentence: whether anyone bought speed with errors."""
    runs: list[str | Cited] = []
    for c in found:
        runs += [
            ", " if runs else "",
            table.cite(c.key, "faster_worse"),
            " of ",
            table.cite(c.key, "n"),
            f" in {c.said}",
        ]
    rows = {c.said: table.row(c.key) for c in found}
    group = [
        name
        for name, row in rows.items()
        if number_in(row, "p_errors") < alpha
        and number_in(row, "faster_worse") > number_in(row, "faster_better")
    ]
    gained = [
        name
        for name, row in rows.items()
        if is_defined(row["p"]) and number_in(row, "p") < alpha and number_in(row, "r") < 0
    ]
    verdicts = []
    if group:
        verdicts.append(
            f"in {' and '.join(group)} most of those who became faster made more errors (the "
            "level's effect on both: it does not tell whether one was bought with the other)"
        )
    if gained:
        verdicts.append(
            f"in {' and '.join(gained)} those who gained more time lost more accuracy: a sign that "
            "there speed was bought with errors"
        )
    verdict = (
        ", and ".join(verdicts)
        if verdicts
        else "nowhere is it shown that more of the faster made more errors than fewer, nor that "
        "those who gained more time lost more accuracy"
    )
    said = say(f"Faster and with more errors under {_under(found)} were {{}}; {verdict}.", runs)
    return said if gained else Prose((*said.runs, *_allowed(table, found)))


def _under(found: Sequence[Change]) -> str:
    """The level that is stepped to, in words, where there is one."""
    said = {c.contrast.second for c in found if c.contrast is not None}
    return said.pop() if len(said) == 1 else "the level than under the baseline"


NO_PROOF = " That is no proof that nobody bought speed with errors"


def _allowed(table: Table, found: Sequence[Change]) -> list[str | Cited]:
    """No sign is no proof: how strong a trade-off the intervals leave possible."""
    known = {c.key: low for c in found if is_defined(low := table.row(c.key)["r_low"])}
    said = {c.key: c.said for c in found}
    if not known:
        return [f"{NO_PROOF}: no correlation has an interval here."]
    task = min(known, key=lambda name: known[name])
    return [
        f"{NO_PROOF}: in {said[task]} the interval still allows a correlation of ",
        table.cite(task, "r_low"),
        ".",
    ]


def _conditional(context: Context, factor: Factor) -> list[Block]:
    """Conditional accuracy, where answers are right or wrong."""
    found = accuracy_by_speed(context.trials, factor)
    names = ("fastest third", "middle third", "slowest third")
    rows = tuple(
        {
            "cell": f"{row.level}/{names[int(row.part)]}",
            factor.name: str(row.level),
            "third": names[int(row.part)],
            "share": float(row.share),
            "trials": int(row.trials),
        }
        for row in found.itertuples()
    )
    table = Table(
        "conditional_accuracy",
        "Conditional accuracy: right answers by speed",
        (
            Column("cell", "cell"),
            Column(factor.name, factor.name),
            Column("third", "trials"),
            Column("share", "share correct", "bound3"),
            Column("trials", "trials", "int"),
        ),
        rows,
        (factor.name, "third", "share", "trials"),
        f"Speed within participant × task × {factor.name}. If haste makes errors, the fastest "
        "third is the least accurate.",
    )
    return [table] if context.trials["correct"].notna().any() else []


def _scores(context: Context, factor: Factor) -> list[Block]:
    """The combined scores as ordinary measures, each with its warning."""
    if not context.trials["correct"].notna().any():
        return []
    found = scores(context.trials, factor)
    if found is None:
        return []
    blocks: list[Block] = []
    measures = []
    for key, label, digits, values in (
        ("bis", "balanced integration score", 2, found.bis),
        ("ies", "inverse efficiency score (s)", 2, found.ies),
        ("rcs", "rate-correct score (1/s)", 4, found.rcs),
    ):
        if isinstance(values, Undefined):
            blocks.append(say(f"{label[0].upper()}{label[1:]}: {values}.", kind="note"))
        else:
            measures += _score_pairs(key, label, digits, values, factor)
    if measures:
        note = " ".join(words for key, words in WARNINGS.items()
            if any(m.key.partition("/")[0] == key for m in measures))  # fmt: skip
        table = replace(
            compare(measures),
            key="tests_combined",
            title="Combined scores over all tasks (secondary)",
            shown=SCORES_SHOWN,
            note=f"Secondary: read time and error above first. {note}",
        )
        blocks.insert(0, table)
    return blocks


def _score_pairs(key: str, label: str, digits: int, values: Array, factor: Factor) -> list[Pair]:
    """A score's contrasts: each level against the baseline."""
    contrasts, at = factor.contrasts(), factor.levels.index
    return [
        Pair(
            f"{key}/{c.key}" if len(contrasts) > 1 else key,
            f"{label}: {c.baseline} → {c.level}" if len(contrasts) > 1 else label,
            "", digits, values[:, at(c.baseline)], values[:, at(c.level)],
            ratio_scale=key != "bis", contrast=c,
        )
        for c in contrasts
    ]  # fmt: skip
