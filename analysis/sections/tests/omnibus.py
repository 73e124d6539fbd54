"""Omnibus tests of a measure: every factor that varies in it, within people and between."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from seethrough.analysis.cells import Cells
from seethrough.analysis.comparison import sd_of
from seethrough.analysis.design import Design, Measured
from seethrough.analysis.measures import TASK, by_nesting, groups_of
from seethrough.analysis.page.blocks import Block, Fold, Prose, Table, say
from seethrough.analysis.page.numbers import significant
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.sections.base.tables import (
    BAYES_NOTE,
    EFFECTS,
    EFFECTS_SHOWN,
    design_at,
    effect_row,
    effect_sentence,
)
from seethrough.analysis.stats.split_plot import split_plot
from seethrough.analysis.stats.undefined import is_defined
from seethrough.analysis.words import capitalised

UNLIKE = 2.0
"""Ratio of the groups' s.d. from which a pooled error is warned of."""
MOST_CHOICES = 4096
"""Ways of leaving levels out that are tried for the largest complete sub-table."""


def omnibus(
    context: Context, measure: Measured, cells: Cells, logs: Cells | None
) -> tuple[list[Block], dict[str, Table]]:
    """The tables with their sentences; and those that decide, by `anova` and `anova_…`."""
    blocks: list[Block] = []
    found: dict[str, Table] = {}
    for name, title, own, own_logs, note in _variants(context, measure, cells, logs):
        raw = _table(context, f"anova_{measure.name}{name}", title, own, note)
        if raw is None:
            continue
        if own_logs is None:
            decides: Table | None = raw
            tables: list[Block] = [raw]
        else:
            raw = replace(raw, title=f"{title}, {measure.unit or 'raw'}")
            words = f"{note} Logarithms of trials' values.".strip()
            decides = _table(context, f"anova_{measure.name}{name}_log", f"{title}, logarithms",
                             own_logs, words)  # fmt: skip
            tables = [*(t for t in (decides,) if t is not None), Fold("On the raw scale", (raw,))]
        if decides is not None:
            found[f"anova{name}"] = decides
            blocks += _sentences(context, measure, decides, name)
        blocks += tables
    return blocks, found


Variant = tuple[str, str, Cells, Cells | None, str]


def _variants(
    context: Context, measure: Measured, cells: Cells, logs: Cells | None
) -> list[Variant]:
    """(name, title, cells, logs, note) of each table: with the tasks, with what they are nested in,
    or task by task where they do not pool."""
    tasks, design = cells.factors[TASK], context.design
    said = [f.name for f in (*design.groups, *design.crossed)]
    found: list[Variant] = []
    if len(tasks) > 1 and measure.pool:
        nested = (
            " Tasks are nested in "
            + " and ".join(f.name for f in design.nesting)
            + (", so task is one factor.")
        )
        title = _title([*said, TASK], measure)
        found.append((f"_{TASK}", title, cells, logs, nested.strip() if design.nesting else ""))
        for factor in design.nesting:
            inner = by_nesting(cells, factor, context.trials)
            inner_logs = by_nesting(logs, factor, context.trials) if logs else None
            note = f"Means of the tasks nested in each {factor.name}."
            title = _title([*said, factor.name], measure)
            found.append((f"_{factor.name}", title, inner, inner_logs, note))
        return found
    for task in tasks:
        own, own_logs = cells.pick(task=task), logs.pick(task=task) if logs else None
        sizes = [len(f.levels) for f in design_at(context, own).groups]
        sizes += [len(levels) for levels in own.factors.values() if len(levels) > 1]
        if len(sizes) < 2 and max([0, *sizes]) < 3:
            continue  # one contrast alone: it has its own row
        name = f"_in_{task}" if len(tasks) > 1 else ""
        title = f"{_title(said, measure)} in {design.task_said(task)}"
        found.append((name, title, own, own_logs, ""))
    return found


def _title(factors: Sequence[str], measure: Measured) -> str:
    words = " × ".join(factors)
    return f"{capitalised(words)}, {measure.said}"


UNCORRECTED = "The p of these effects are not corrected for one another."


def _table(context: Context, key: str, title: str, cells: Cells, note: str) -> Table | None:
    """The ANOVA of who has every cell; None where there is nothing to compare."""
    kept, gone = complete(context.design, cells)
    design = design_at(context, kept)
    kept = kept.lone() if design.groups else kept
    if min([2, *kept.values.shape[1:]]) < 2 or (kept.values.ndim == 1 and not design.groups):
        return None
    whole = kept.whole()
    if not len(whole.values):
        return None
    factors = design.groups
    codes, spread = _groups(context, design, whole)
    if codes is None:
        return None
    measured = [f.name for f in factors if f.kind == "measured"]
    effects = split_plot(
        whole.values, tuple(whole.factors), codes, tuple(f.name for f in factors), measured
    )
    if not effects:
        return None
    few = any(e.few for e in effects.values())
    notes = [note, gone, spread, UNCORRECTED, "" if factors else BAYES_NOTE]
    if few:
        notes.insert(0, "Participants are too few to estimate ε: the lower bound decides.")
    shown = tuple(c for c in EFFECTS_SHOWN if not (factors and c == "bf10"))
    if few:  # an ε that cannot be estimated is not shown beside these words
        shown = tuple("p_lower" if c == "p_hf" else c for c in shown
                      if c not in ("eps", "p_gg", "eps_hf"))  # fmt: skip
    rows = tuple(effect_row(e) for e in effects.values())
    return Table(key, title, EFFECTS, rows, shown, " ".join(n for n in notes if n))


def _groups(context: Context, design: Design, cells: Cells) -> tuple[np.ndarray | None, str]:
    """Each person's level codes, (n, b); None where a group has nobody. And what is to be said of
    the groups' sizes and spreads, on which a pooled error rests."""
    factors = design.groups
    if not factors:
        return np.zeros((len(cells.values), 0), dtype=np.intp), ""
    own = [groups_of(context.study.trials, f, cells.participants) for f in factors]
    codes = np.array([[f.levels.index(x) for x in g] for f, g in zip(factors, own, strict=True)])
    codes = codes.T.astype(np.intp)
    level = cells.values.reshape(len(cells.values), -1).mean(axis=1)
    sizes, spreads = [], []
    for cell in design.cells(factors):
        members = np.all(codes == [f.levels.index(cell[f.name]) for f in factors], axis=1)
        if not members.any():
            return None, ""
        sizes.append(f"{' '.join(cell.values())} {members.sum()}")
        spread = sd_of(level[members])
        if is_defined(spread):
            spreads.append(spread)
    note = f"Type III sums of squares. Groups: {', '.join(sizes)} people"
    if len(spreads) > 1 and min(spreads) > 0:
        note += f"; the largest of their s.d. is {significant(max(spreads) / min(spreads))} times "
        note += "the smallest"
    note += ". The pooled error takes them to be equal; the contrasts do not."
    if len(spreads) > 1 and max(spreads) > UNLIKE * min(spreads):
        note += (
            " Where the smaller group spreads three times as much (12 and 5 people), F rejects in "
            ".19 to .22 of studies without a difference, for .05: read the contrasts."
        )
    return codes, note


def complete(design: Design, cells: Cells) -> tuple[Cells, str]:
    """The largest sub-table without a cell that the study leaves out; what it lacks, in words."""
    factors = [f for f in design.crossed if f.name in cells.factors]
    names = {f.name for f in factors}
    gone = [cell for cell in design.excluded if set(cell) <= names]
    levels = {f.name: cells.factors[f.name] for f in factors}
    gone = [c for c in gone if all(level in levels[k] for k, level in c.items())]
    if not gone:
        return cells, ""
    best: tuple[int, Mapping[str, tuple[str, ...]]] = (-1, levels)
    choices = itertools.product(*(list(cell.items()) for cell in gone))
    for choice in itertools.islice(choices, MOST_CHOICES):
        left = {
            name: tuple(level for level in known if (name, level) not in choice)
            for name, known in levels.items()
        }
        # a factor of one level is compared no longer: two levels are worth more than many cells
        size = int(np.prod([len(known) if len(known) > 1 else 0 for known in left.values()]))
        if size > best[0]:
            best = (size, left)
    out = [
        f"{name} {level}" for name, known in levels.items() for level in known
        if level not in best[1][name]
    ]  # fmt: skip
    said = ", ".join(" × ".join(cell.values()) for cell in gone)
    note = f"The study leaves out {said}: this is the largest complete table, without "
    return cells.take(best[1]), f"{note}{' and '.join(out)}."


def _sentences(
    context: Context, measure: Measured, table: Table, name: str
) -> list[Prose]:  # fmt: skip
    """What the omnibus shows: whether effects differ between tasks; or every effect in turn."""
    alpha = context.plan.alpha
    scale = f" (a ratio of {measure.said}s)" if measure.log else ""
    measured = [f.name for f in context.design.groups if f.kind == "measured"]
    if name == f"_{TASK}":
        return [
            effect_sentence(table, str(row["effect"]), (
                f"{_subject(row, measured)}{scale} differs between tasks",
                f"{_subject(row, measured)}{scale} does not demonstrably differ between tasks",
            ), alpha)
            for row in table.rows
            if TASK in str(row["effect"]).split(" × ") and len(str(row["effect"]).split(" × ")) == 2
        ]  # fmt: skip
    if name in {f"_{f.name}" for f in context.design.nesting}:
        return []
    found = [r for r in table.rows if is_defined(r["p_decisive"]) and r["p_decisive"] < alpha]
    inside = [_parts(r) for r in found]
    # an effect that depends on another factor is read with it, and so comes after it
    ordered = sorted(found, key=lambda r: -len(_parts(r)))
    said = []
    for r in ordered:
        over = [" × ".join(sorted(x)) for x in inside if _parts(r) < x]
        words = _shown(r, measured) + (
            f" (but not alike: it depends, see {over[0]})" if over else ""
        )
        said.append(effect_sentence(table, str(r["effect"]), (words, words), alpha))
    none = [str(r["effect"]) for r in table.rows if r not in found and is_defined(r["F"])]
    if none:
        said.append(say(f"{measure.title}, not shown: "
                        f"{', '.join(none)}."))  # fmt: skip
    return said


def _parts(row: Mapping[str, object]) -> frozenset[str]:
    return frozenset(str(row["effect"]).split(" × "))


def _factor(row: Mapping[str, object]) -> str:
    return " × ".join(part for part in str(row["effect"]).split(" × ") if part != TASK)


def _subject(row: Mapping[str, object], measured: Sequence[str]) -> str:
    """What may differ between tasks: an effect; a difference, where nobody assigned the factor."""
    of = _factor(row)
    return f"The difference over {of}" if of in measured else f"The effect of {of}"


def _shown(row: Mapping[str, object], measured: Sequence[str]) -> str:
    """An effect in words, none of them causal where one of its factors was not assigned."""
    effect = str(row["effect"])
    *first, last = effect.split(" × ")
    if len(first) > 1:
        return f"The interaction of {' and '.join(first)} depends on {last}"
    if first:
        what = "difference over" if {*first, last} & set(measured) else "effect of"
        return f"The {what} {first[0]} depends on {last}"
    return f"Means differ over {effect}"
