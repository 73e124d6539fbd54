"""Bars with paired differences, ratings, and effect sizes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from seethrough.analysis.comparison import Pair
from seethrough.analysis.design import Factor
from seethrough.analysis.page.blocks import Figure, Table
from seethrough.analysis.page.numbers import significant
from seethrough.analysis.page.style import (
    FAINT,
    INK,
    LEVEL,
    Spec,
    categories,
    in_rows,
    layer,
    layers,
    level_colour,
    number,
    picked,
    zero_line,
)
from seethrough.analysis.stats.undefined import Number, either_in, is_defined, number_in
from seethrough.analysis.words import capitalised

HEIGHT = 210


def _means(measures: Sequence[Pair]) -> str:
    return "; ".join(
        f"{m.label}: {m.names[0]} {significant(float(m.first.mean()))}, "
        f"{m.names[1]} {significant(float(m.second.mean()))} {m.unit}".rstrip()
        for m in measures
    )


def bars_and_differences(
    key: str, title: str, axis: str, measures: Sequence[Pair], tests: Table
) -> Figure:
    """Means with Cousineau–Morey intervals, and each participant's paired difference beside."""
    alt = f"Bars of means with intervals, beside dots of paired differences. {_means(measures)}."
    halves = [either_in(tests.row(m.key), "within_half") for m in measures]
    left = _bars(measures, halves, axis, "95 % within-participant interval ±")
    left["title"] = "Means, 95 % within-participant intervals"
    right = {
        "title": "{} − {}, per participant".format(*measures[0].names),
        "width": 280,
        "height": HEIGHT,
        "layer": _differences(measures, tests),
    }
    caption = (
        f"{title}: means with 95 % within-participant intervals; beside them each participant's "
        "difference, and their mean with its 95 % interval"
    )
    return Figure(key, caption, alt, {"hconcat": [left, right]})


def _bars(measures: Sequence[Pair], halves: Sequence[Number], axis: str, words: str) -> Spec:
    """A bar per measure and level with its error bar; `words` introduce the half in the tip."""
    bars, ends = [], []
    for i, (m, half) in enumerate(zip(measures, halves, strict=True)):
        for side, level, values in zip((-0.2, 0.2), m.names, (m.first, m.second), strict=True):
            mean = float(values.mean())
            tip = f"{m.label}, {level}: mean {significant(mean)} {m.unit}".rstrip()
            if is_defined(half):
                tip += f", {words} {significant(half)}"
                ends.append({"x": i + side, "low": mean - half, "high": mean + half})
            bar = {"from": i + side - 0.18, "to": i + side + 0.18, "mean": mean, "zero": 0}
            bars.append({**bar, "level": level, "tip": tip})
    x = categories([m.label for m in measures])
    box = {
        "x": {"field": "from", **x},
        "x2": {"field": "to"},
        "color": level_colour(measures[0].names),
    }
    return {
        "width": 60 + 66 * len(measures),
        "height": HEIGHT,
        "layer": layers(
            layer("rect", bars, {**box, "y": number("mean", axis), "y2": {"field": "zero"}}),
            layer("rule", ends, {"x": {"field": "x", **x}, **_span("y", axis)}, color=INK,
                  strokeWidth=2),
        ),
    }  # fmt: skip


def _span(channel: str, axis: str | None = None) -> Spec:
    return {channel: number("low", axis), f"{channel}2": {"field": "high"}}


def _differences(measures: Sequence[Pair], tests: Table) -> list[Spec]:
    dots, ends, means = [], [], []
    for i, m in enumerate(measures):
        gaps = np.sort(m.first - m.second)[picked(len(m.first))]
        # sorted values in a row would make a slope: deal them out to both sides in turn
        turn = np.arange(len(gaps)) * 7 % max(1, len(gaps))
        spread = -0.16 + 0.32 * turn / max(1, len(gaps) - 1)
        dots += [{"x": i + float(s), "y": float(g)} for s, g in zip(spread, gaps, strict=True)]
        row = tests.row(m.key)
        mean = number_in(row, "difference")
        low, high = row["difference_low"], row["difference_high"]
        tip = f"{m.label}: mean difference {significant(mean)} {m.unit}".rstrip()
        if is_defined(low) and is_defined(high):
            tip += f", 95 % interval {significant(low)} to {significant(high)}"
            ends.append({"x": i + 0.28, "low": low, "high": high})
        means.append({"x": i + 0.28, "y": mean, "tip": tip})
    x = {"x": {"field": "x", **categories([m.label for m in measures])}}
    y = {"y": number("y")}
    return layers(
        zero_line("y"),
        layer("point", dots, {**x, **y}, color=FAINT, filled=True, size=14),
        layer("rule", ends, {**x, **_span("y")}, color=INK, strokeWidth=2),
        layer(
            "point", means, {**x, **y}, color=INK, filled=True, shape="diamond", size=70, opacity=1
        ),
    )


def ratings_figure(
    key: str, measures: Sequence[Pair], others: Sequence[Factor], tests: Table, scale: str
) -> Figure:
    """Mean ratings with standard deviations, a panel for each level of the other factors."""
    panels = []
    wheres = dict.fromkeys(m.label.partition(", ")[2] for m in measures)
    for where in wheres:
        own = [m for m in measures if m.label.partition(", ")[2] == where]
        panels.append(_ratings(where or key, own, tests, scale))
    alt = f"Bars of mean ratings{f', {scale}' if scale else ''}. {_means(measures)}."
    title = f"{capitalised(key)}, means and standard deviations"
    return Figure(key, title, alt, in_rows(panels, 3))


def _ratings(where: str, measures: Sequence[Pair], tests: Table, points: str) -> Spec:
    bars, ends = [], []
    for i, m in enumerate(measures):
        row = tests.row(m.key)
        sides = zip((-0.2, 0.2), m.names, ("baseline", "level"), strict=True)
        for side, level, of in sides:
            mean, sd = number_in(row, f"mean_{of}"), row[f"sd_{of}"]
            tip = f"{m.label}, {level}: mean {significant(mean)}"
            if is_defined(sd):
                tip += f", SD {significant(sd)}"
                ends.append({"x": i + side, "low": mean - sd, "high": mean + sd})
            bar = {"from": i + side - 0.18, "to": i + side + 0.18, "mean": mean, "zero": 0}
            bars.append({**bar, "level": level, "tip": tip})
    x = categories([m.label.split(",")[0].replace("_", " ") for m in measures])
    scale, axis = {}, "rating"
    if points:
        top = int(points.rpartition("–")[2])
        domain = {"domain": [0, 1.15 * top], "nice": False}
        scale = {"scale": domain, "axis": {"values": list(range(top + 1))}}
        axis = f"rating ({points})"
    y = number("mean", axis, **scale)
    box = {
        "x": {"field": "from", **x},
        "x2": {"field": "to"},
        "color": level_colour(measures[0].names),
    }
    span = {"y": number("low", axis, **scale), "y2": {"field": "high"}}
    return {
        "title": where,
        "width": max(270, 66 * len(measures)),
        "height": HEIGHT,
        "layer": layers(
            layer("rect", bars, {**box, "y": y, "y2": {"field": "zero"}}),
            layer("rule", ends, {"x": {"field": "x", **x}, **span}, color=INK, clip=True),
        ),
    }


def effect_sizes(key: str, title: str, tests: Table) -> Figure:
    """d_z of every measure with its interval, one line each."""
    rows = [
        {
            "y": i,
            "dz": row["dz"],
            "low": row["dz_low"],
            "high": row["dz_high"],
            "tip": f"{row['label']}: d_z = {significant(number_in(row, 'dz'))}, 95 % interval "
            f"{significant(number_in(row, 'dz_low'))} to {significant(number_in(row, 'dz_high'))}",
        }
        for i, row in enumerate(r for r in tests.rows if is_defined(r["dz"]))
    ]
    labels = [str(r["label"]) for r in tests.rows if is_defined(r["dz"])]
    y = {"y": {"field": "y", **categories(labels, "y")}}
    lines = [{k: v for k, v in row.items() if k != "tip"} for row in rows]
    axis = "standardised difference d_z; positive: less than under the baseline"
    dz = number("dz", axis, axis={"tickCount": 8})
    spec = {
        "width": 520,
        "height": 26 * len(rows),
        "layer": layers(
            zero_line("x", axis),
            layer("rule", lines, {**y, **_span("x", axis)}, color=INK, strokeWidth=2),
            layer("point", rows, {**y, "x": dz}, color=LEVEL, filled=True, size=60, opacity=1),
        ),
    }
    said = "; ".join(str(row["tip"]) for row in rows)
    return Figure(key, title, f"Dots with intervals. {said}.", spec)
