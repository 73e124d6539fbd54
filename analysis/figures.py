"""The report's figures. Each function returns a Figure whose numbers are all in its tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from analysis.comparison import Measure
from analysis.page.blocks import Figure, Table, Tips
from analysis.page.numbers import significant
from analysis.page.pictures import COLOURS, FAINT, INK
from analysis.stats.paired import within_halfwidths
from analysis.stats.undefined import is_defined

MOST_DOTS = 200
LEVELS = ("standard", "dynamic")


def bars_and_differences(
    key: str, title: str, axis: str, measures: Sequence[Measure], tests: Table
) -> Figure:
    """Means with Cousineau–Morey intervals, and each participant's paired difference beside."""

    def draw(canvas: Any, tips: Tips) -> None:
        left, right = canvas.subplots(1, 2, width_ratios=[1.25, 1])
        for i, m in enumerate(measures):
            _pair_of_bars(left, tips, i, m)
            _differences(right, tips, i, m, tests)
        labels = [m.label.replace(" ", "\n", 1).replace("_", " ") for m in measures]
        left.set_xticks(range(len(measures)), labels)
        right.set_xticks(range(len(measures)), labels)
        left.set_ylabel(axis)
        left.set_title("means, 95 % within-participant intervals")
        right.set_title("standard − dynamic, per participant")
        right.axhline(0, color=FAINT, linewidth=0.8)
        handles = [left.bar(0, 0, color=COLOURS[level]) for level in LEVELS]
        left.legend(handles, LEVELS, loc="best")
        left.set_ylim(bottom=0)

    said = "; ".join(
        f"{m.label}: standard {significant(float(m.standard.mean()))}, "
        f"dynamic {significant(float(m.dynamic.mean()))} {m.unit}"
        for m in measures
    )
    alt = f"Bars of means with intervals, beside dots of paired differences. {said}."
    return Figure(key, title, alt, draw)


def _pair_of_bars(axes: Any, tips: Tips, i: int, m: Measure) -> None:
    halves = within_halfwidths(np.stack([m.standard, m.dynamic], axis=1))
    for side, level, values, half in zip(
        (-0.2, 0.2), LEVELS, (m.standard, m.dynamic), halves, strict=True
    ):
        mean = float(values.mean())
        (bar,) = axes.bar(i + side, mean, width=0.36, color=COLOURS[level])
        text = f"{m.label}, {level}: mean {significant(mean)} {m.unit}"
        if is_defined(half):
            axes.errorbar(i + side, mean, yerr=half, color=INK, capsize=3, linewidth=1)
            text += f", 95 % within-participant interval ± {significant(half)}"
        tips.mark(bar, text)


def _differences(axes: Any, tips: Tips, i: int, m: Measure, tests: Table) -> None:
    gaps = np.sort(m.standard - m.dynamic)
    if len(gaps) > MOST_DOTS:
        gaps = gaps[np.linspace(0, len(gaps) - 1, MOST_DOTS).round().astype(int)]
    spread = np.linspace(-0.16, 0.16, len(gaps)) if len(gaps) > 1 else np.zeros(1)
    # neighbours in size would line up in a slope: deal them out to both sides in turn
    spread = spread[np.argsort(np.argsort(np.arange(len(gaps)) * 7 % max(1, len(gaps))))]
    axes.plot(i + spread, gaps, "o", color=FAINT, markersize=3, alpha=0.8, markeredgewidth=0)
    row = tests.row(m.key)
    low, high = row["difference_low"], row["difference_high"]
    text = f"{m.label}: mean difference {significant(row['difference'])} {m.unit}"
    if is_defined(low) and is_defined(high):
        axes.plot([i + 0.28, i + 0.28], [low, high], color=INK, linewidth=1.4)
        text += f", 95 % interval {significant(low)} to {significant(high)}"
    (dot,) = axes.plot(i + 0.28, row["difference"], "D", color=INK, markersize=4.5)
    tips.mark(dot, text)


def ratings_figure(key: str, measures: Sequence[Measure], scenarios: Sequence[str]) -> Figure:
    """The paper's second figure: mean ratings with standard deviations, scenario by scenario."""

    def draw(canvas: Any, tips: Tips) -> None:
        panels = canvas.subplots(1, len(scenarios), sharey=True, squeeze=False)[0]
        for axes, scenario in zip(panels, scenarios, strict=True):
            own = [m for m in measures if m.key.endswith(scenario)]
            for i, m in enumerate(own):
                _rating_bars(axes, tips, i, m)
            axes.set_xticks(range(len(own)), [m.label.split(",")[0] for m in own])
            axes.set_title(scenario)
            axes.set_ylim(0, 4.6)
            axes.set_yticks(range(5))
        panels[0].set_ylabel("rating (0–4)")
        handles = [panels[-1].bar(0, 0, color=COLOURS[level]) for level in LEVELS]
        panels[-1].legend(handles, LEVELS, loc="upper right", ncols=2)

    said = "; ".join(
        f"{m.label}: standard {significant(float(m.standard.mean()))}, "
        f"dynamic {significant(float(m.dynamic.mean()))}"
        for m in measures
    )
    return Figure(key, "Ratings", f"Bars of mean ratings from 0 to 4. {said}.", draw)


def _rating_bars(axes: Any, tips: Tips, i: int, m: Measure) -> None:
    for side, level, values in zip((-0.2, 0.2), LEVELS, (m.standard, m.dynamic), strict=True):
        mean = float(values.mean())
        (bar,) = axes.bar(i + side, mean, width=0.36, color=COLOURS[level])
        text = f"{m.label}, {level}: mean {significant(mean)}"
        if len(values) > 1:
            sd = float(np.std(values, ddof=1))
            axes.errorbar(i + side, mean, yerr=sd, color=INK, capsize=3, linewidth=1)
            text += f", s.d. {significant(sd)}"
        tips.mark(bar, text)


def effect_sizes(key: str, title: str, tests: Table) -> Figure:
    """d_z of every measure with its interval, one line each."""
    rows = [r for r in tests.rows if is_defined(r["dz"])]

    def draw(canvas: Any, tips: Tips) -> None:
        axes = canvas.subplots()
        axes.axvline(0, color=FAINT, linewidth=0.8)
        for i, row in enumerate(rows):
            axes.plot([row["dz_low"], row["dz_high"]], [i, i], color=INK, linewidth=1.4)
            (dot,) = axes.plot(row["dz"], i, "o", color=COLOURS["dynamic"], markersize=6)
            ends = f"{significant(row['dz_low'])} to {significant(row['dz_high'])}"
            tips.mark(dot, f"{row['label']}: d_z = {significant(row['dz'])}, 95 % {ends}")
        axes.set_yticks(range(len(rows)), [r["label"] for r in rows])
        axes.invert_yaxis()
        axes.grid(axis="x")
        axes.grid(visible=False, axis="y")
        axes.set_xlabel("d_z, positive: less with dynamic transparency")

    said = "; ".join(
        f"{r['label']} {significant(r['dz'])} [{significant(r['dz_low'])}, "
        f"{significant(r['dz_high'])}]"
        for r in rows
    )
    return Figure(key, title, f"Dots with intervals. {said}.", draw, (7.2, 0.7 + 0.34 * len(rows)))
