"""Means with intervals for any number of levels: a panel for each task and group."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from seethrough.analysis.cells import Cells
from seethrough.analysis.measures import TASK
from seethrough.analysis.page.blocks import Figure
from seethrough.analysis.page.numbers import significant
from seethrough.analysis.page.style import (
    Spec,
    categories,
    in_rows,
    layer,
    layers,
    level_colour,
    number,
)
from seethrough.analysis.stats.paired import mean_interval, within_halfwidths
from seethrough.analysis.stats.undefined import is_defined

if TYPE_CHECKING:
    from seethrough.analysis.sections.base.context import Context

HEIGHT = 190
WIDE = 3


def level_means(key: str, title: str, axis: str, cells: Cells, context: Context) -> Figure:
    """Means of every cell, with 95 % intervals: within participants where levels are (Cousineau and
    Morey's), of the mean between groups. A panel for each task and group."""
    from seethrough.analysis.sections.base.tables import groups_in

    design = context.design
    groups = groups_in(context, cells.participants)
    panels, told = [], []
    for task in cells.factors[TASK]:
        own = cells.pick(task=task)
        for where, members in groups or [({}, np.ones(len(own.participants), bool))]:
            said = [design.factor(f).label(level) for f, level in where.items()]
            name = ", ".join([design.task_said(task), *said])
            rows = _means(own, members)
            if rows:
                panels.append((name, rows))
                told += [f"{name}, {r.at}: {significant(r.mean)}" for r in rows]
    top = max((r.high for _, rows in panels for r in rows), default=1.0)
    low = min((r.low for _, rows in panels for r in rows), default=0.0)
    domain = [min(0.0, low), top]
    names = _colours(cells)
    factors = [f for f in cells.factors if f != TASK]
    drawn = [_panel(name, rows, axis, domain, names, factors) for name, rows in panels]
    within = any(len(known) > 1 for f, known in cells.factors.items() if f != TASK)
    words = "within-participant intervals" if within else "intervals of the mean"
    if within and groups:
        words += ", which compare levels and not groups"
    alt = f"Points with 95 % {words}. {'; '.join(told)}."
    wide = len(groups) if 1 < len(groups) <= WIDE else WIDE  # a task's groups side by side
    return Figure(key, f"{title} (95 % {words})", alt, in_rows(drawn, wide))


def _colours(cells: Cells) -> tuple[str, ...]:
    """The factor that is told apart by colour: the second, or the only one."""
    factors = [known for name, known in cells.factors.items() if name != TASK]
    return factors[-1] if factors else ("all",)


@dataclass(frozen=True)
class _Mean:
    """A cell's mean with its interval: `at` its levels in words, of the `first` factor and the
    last (`level`)."""

    at: str
    first: str
    level: str
    mean: float
    low: float
    high: float


def _means(cells: Cells, members: np.ndarray) -> list[_Mean]:
    """Each cell's mean, interval and places, of who has every cell that anybody has."""
    index = list(np.ndindex(*cells.values.shape[1:]))
    flat = cells.values.reshape(len(cells.values), -1)[members]
    there = np.isfinite(flat).any(axis=0)
    whole = flat[:, there]
    whole = whole[np.isfinite(whole).all(axis=1)]
    if not len(whole):
        return []
    halves = within_halfwidths(whole) if whole.shape[1] > 1 else []
    rows = []
    for column, at in enumerate(i for i, has in zip(index, there, strict=True) if has):
        levels = [known[j] for known, j in zip(cells.factors.values(), at, strict=True)]
        values = whole[:, column]
        mean = float(values.mean())
        low, high = mean_interval(values)
        if halves:
            half = halves[column]
            low, high = (mean - half, mean + half) if is_defined(half) else (half, half)
        ends = (low, high) if is_defined(low) and is_defined(high) else (mean, mean)
        levels = levels or ["all"]
        rows.append(_Mean(" ".join(levels), levels[0], levels[-1], mean, *ends))
    return rows


def _panel(
    name: str,
    rows: list[_Mean],
    axis: str,
    domain: list[float],
    levels: tuple[str, ...],
    factors: list[str],
) -> Spec:
    """Levels of the first factor along x, those of the last in colour and side by side; `factors`
    are their names."""
    firsts = list(dict.fromkeys(r.first for r in rows))
    several = len({r.level for r in rows}) > 1 and any(r.first != r.level for r in rows)
    shown = list(levels) if several else firsts
    points, ends = [], []
    for r in rows:
        step = (levels.index(r.level) - (len(levels) - 1) / 2) * 0.5 / len(levels)
        x = firsts.index(r.first) + (step if several else 0.0)
        level = r.level if several else r.first
        tip = (
            f"{name}, {r.at}: mean {significant(r.mean)}, 95 % interval "
            f"{significant(r.low)} to {significant(r.high)}"
        )
        points.append({"x": x, "y": r.mean, "level": level, "tip": tip})
        ends.append({"x": x, "low": r.low, "high": r.high, "level": level})
    along = {"field": "x", **categories(firsts), "title": factors[0] if factors else None}
    scale = {"domain": domain, "nice": True, "zero": False}
    colour = {"color": level_colour(shown, factors[-1] if several else None)}
    low = number("low", axis, scale=scale)
    lines = {"x": along, "y": low, "y2": {"field": "high"}, **colour}
    dots = {"x": along, "y": number("y", axis, scale=scale), **colour}
    return {
        "title": name,
        "width": max(120, 34 * len(firsts) * (2 if several else 1)),
        "height": HEIGHT,
        "layer": layers(
            layer("rule", ends, lines, strokeWidth=2),
            layer("point", points, dots, filled=True, size=60, opacity=1),
        ),
    }
