"""Bars with paired differences, ratings, and effect sizes."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from analysis.comparison import Measure
from analysis.figures.style import COLOURS, FAINT, INK, LEVELS, SIDES, legend, picked
from analysis.page.blocks import Figure, Table, Tips
from analysis.page.numbers import significant
from analysis.stats.paired import within_halfwidths
from analysis.stats.undefined import Number, is_defined


def bars_and_differences(
    key: str, title: str, axis: str, measures: Sequence[Measure], tests: Table
) -> Figure:
    """Means with Cousineau–Morey intervals, and each participant's paired difference beside."""
    said = "; ".join(
        f"{m.label}: standard {significant(float(m.standard.mean()))}, "
        f"dynamic {significant(float(m.dynamic.mean()))} {m.unit}".rstrip()
        for m in measures
    )
    alt = f"Bars of means with intervals, beside dots of paired differences. {said}."
    ends = [
        (row["difference_low"], row["difference_high"])
        for row in (tests.row(m.key) for m in measures)
    ]
    draw = partial(_bars_and_differences, axis=axis, measures=tuple(measures), ends=ends)
    return Figure(key, title, alt, draw)


def _bars_and_differences(
    canvas: Any,
    tips: Tips,
    axis: str,
    measures: tuple[Measure, ...],
    ends: list[tuple[Number, Number]],
) -> None:
    left, right = canvas.subplots(1, 2, width_ratios=[1.25, 1])
    for i, (m, interval) in enumerate(zip(measures, ends, strict=True)):
        halves = within_halfwidths(np.stack([m.standard, m.dynamic], axis=1))
        for side, level, values, half in zip(
            SIDES, LEVELS, (m.standard, m.dynamic), halves, strict=True
        ):
            text = ", 95 % within-participant interval ± "
            _bar(left, tips, (i + side, m.label, level), values, half, text, m.unit)
        _differences(right, tips, i, m, interval)
    labels = [m.label.replace(" ", "\n", 1) for m in measures]
    for axes in (left, right):
        axes.set_xticks(range(len(measures)), labels, fontsize=8)
    left.set_ylabel(axis)
    left.set_title("means, 95 % within-participant intervals")
    right.set_title("standard − dynamic, per participant")
    right.axhline(0, color=FAINT, linewidth=0.8)
    legend(left, loc="best")
    left.set_ylim(bottom=0)


def _bar(
    axes: Any,
    tips: Tips,
    place: tuple[float, str, str],
    values: Any,
    half: Number,
    words: str,
    unit: str,
) -> None:
    """A bar with its error bar; `words` introduce the half-width in the bar's tip."""
    x, label, level = place
    mean = float(values.mean())
    (bar,) = axes.bar(x, mean, width=0.36, color=COLOURS[level])
    text = f"{label}, {level}: mean {significant(mean)} {unit}".rstrip()
    if is_defined(half):
        axes.errorbar(x, mean, yerr=half, color=INK, capsize=3, linewidth=1)
        text += f"{words}{significant(half)}"
    tips.mark(bar, text)


def _differences(
    axes: Any, tips: Tips, i: int, m: Measure, interval: tuple[Number, Number]
) -> None:
    gaps = np.sort(m.standard - m.dynamic)[picked(len(m.standard))]
    # sorted values in a row would make a slope: deal them out to both sides in turn
    turn = np.arange(len(gaps)) * 7 % max(1, len(gaps))
    spread = -0.16 + 0.32 * turn / max(1, len(gaps) - 1)
    axes.plot(i + spread, gaps, "o", color=FAINT, markersize=3, alpha=0.8, markeredgewidth=0)
    mean = float(np.mean(m.standard - m.dynamic))
    text = f"{m.label}: mean difference {significant(mean)} {m.unit}".rstrip()
    low, high = interval
    if is_defined(low) and is_defined(high):
        axes.plot([i + 0.28, i + 0.28], [low, high], color=INK, linewidth=1.4)
        text += f", 95 % interval {significant(low)} to {significant(high)}"
    (dot,) = axes.plot(i + 0.28, mean, "D", color=INK, markersize=4.5)
    tips.mark(dot, text)


def ratings_figure(key: str, measures: Sequence[Measure], scenarios: Sequence[str]) -> Figure:
    """The paper's second figure: mean ratings with standard deviations, scenario by scenario."""
    said = "; ".join(
        f"{m.label}: standard {significant(float(m.standard.mean()))}, "
        f"dynamic {significant(float(m.dynamic.mean()))}"
        for m in measures
    )
    draw = partial(_ratings, measures=tuple(measures), scenarios=tuple(scenarios))
    return Figure(key, "Ratings", f"Bars of mean ratings from 0 to 4. {said}.", draw)


def _ratings(
    canvas: Any, tips: Tips, measures: tuple[Measure, ...], scenarios: tuple[str, ...]
) -> None:
    panels = canvas.subplots(1, len(scenarios), sharey=True, squeeze=False)[0]
    for axes, scenario in zip(panels, scenarios, strict=True):
        own = [m for m in measures if m.key.endswith(scenario)]
        for i, m in enumerate(own):
            for side, level, values in zip(SIDES, LEVELS, (m.standard, m.dynamic), strict=True):
                half = (
                    [float(np.std(values, ddof=1))]
                    if len(values) > 1
                    else within_halfwidths(values[:, None])
                )
                _bar(axes, tips, (i + side, m.label, level), values, half[0], ", s.d. ", "")
        axes.set_xticks(range(len(own)), [m.label.split(",")[0] for m in own])
        axes.set_title(scenario)
        axes.set_ylim(0, 4.6)
        axes.set_yticks(range(5))
    panels[0].set_ylabel("rating (0–4), mean and s.d.")
    legend(panels[-1], loc="upper right", ncols=2)


def effect_sizes(key: str, title: str, tests: Table) -> Figure:
    """d_z of every measure with its interval, one line each."""
    rows = [
        (r["label"], r["dz"], r["dz_low"], r["dz_high"]) for r in tests.rows if is_defined(r["dz"])
    ]
    said = "; ".join(
        f"{label} {significant(dz)} [{significant(low)}, {significant(high)}]"
        for label, dz, low, high in rows
    )
    size = (7.2, 0.7 + 0.34 * len(rows))
    return Figure(key, title, f"Dots with intervals. {said}.", partial(_sizes, rows=rows), size)


def _sizes(canvas: Any, tips: Tips, rows: list[tuple[str, float, float, float]]) -> None:
    axes = canvas.subplots()
    axes.axvline(0, color=FAINT, linewidth=0.8)
    for i, (label, dz, low, high) in enumerate(rows):
        axes.plot([low, high], [i, i], color=INK, linewidth=1.4)
        (dot,) = axes.plot(dz, i, "o", color=COLOURS["dynamic"], markersize=6)
        ends = f"{significant(low)} to {significant(high)}"
        tips.mark(dot, f"{label}: d_z = {significant(dz)}, 95 % interval {ends}")
    axes.set_yticks(range(len(rows)), [label for label, *_ in rows])
    axes.invert_yaxis()
    axes.grid(axis="x")
    axes.grid(visible=False, axis="y")
    axes.set_xlabel("standardised difference, positive: less with dynamic transparency")
