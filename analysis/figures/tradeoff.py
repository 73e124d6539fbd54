"""Each participant's step from the baseline to a level, on time × error, and the mean's."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from seethrough.analysis.page.blocks import Figure
from seethrough.analysis.page.numbers import significant
from seethrough.analysis.page.style import (
    FAINT,
    INK,
    Spec,
    in_rows,
    layer,
    layers,
    level_colour,
    number,
    picked,
)
from seethrough.analysis.tradeoff import Change

SIDE = 150
"""Width and height of a panel in pixels."""


def arrows(key: str, changes: Sequence[Change]) -> Figure:
    """A panel per task and level, an arrow per participant and a dark one for the mean."""
    told = "; ".join(
        f"{c.said}: mean time {significant(float(c.time[:, 0].mean()))} to "
        f"{significant(float(c.time[:, 1].mean()))} s, mean {c.error_label} "
        f"{significant(float(c.error[:, 0].mean()))} to {significant(float(c.error[:, 1].mean()))}"
        for c in changes
    )
    alt = (
        "Time against error, an arrow per participant from baseline to level, a dark one for the "
        f"means. {told}."
    )
    # one list for all panels: they share a scale of colours
    known = tuple(dict.fromkeys(name for c in changes for name in c.names))
    spec = in_rows([_panel(c, known) for c in changes], 4)
    levels = {c.names for c in changes}
    first, second = levels.pop() if len(levels) == 1 else ("the baseline", "each level")
    return Figure(key, f"Time against error, from {first} to {second}", alt, spec)


def _panel(c: Change, known: tuple[str, ...]) -> Spec:
    shown = picked(len(c.time))
    time, error = c.time[shown], c.error[shown]
    xs, ys = _roomy(np.log10(time)), _roomy(error)
    # an arrow head turns with its arrow as drawn, in pixels
    right = np.diff(np.log10(time)).ravel() / (xs[1] - xs[0])
    up = np.diff(error).ravel() / (ys[1] - ys[0])
    angles = np.degrees(np.arctan2(-up, right))
    starts, heads, lines = [], [], []
    for i, t, e, angle in zip(shown, time.tolist(), error.tolist(), angles.tolist(), strict=True):
        tips = [
            f"{c.participants[i]}, {level}: {significant(t[side])} s, "
            f"{c.error_label} {significant(e[side])}"
            for side, level in enumerate(c.names)
        ]
        starts.append({"x": t[0], "y": e[0], "level": c.names[0], "tip": tips[0]})
        heads.append({"x": t[1], "y": e[1], "level": c.names[1], "angle": angle, "tip": tips[1]})
        lines.append({"x": t[0], "y": e[0], "x2": t[1], "y2": e[1]})
    mean, head = _mean(c, xs, ys)
    domain = [10.0 ** xs[0], 10.0 ** xs[1]]
    scale = {"type": "log", "domain": domain, "nice": False}
    place = {
        "x": number("x", "time (s)", scale=scale, axis={"values": _ticks(*xs), "format": "~g"}),
        "y": number("y", c.error_label, scale={"domain": list(ys), "nice": False}),
    }
    turned = {"angle": {"field": "angle", "type": "quantitative", "scale": None}}
    colour = {"color": level_colour(known)}
    return {
        "title": c.said,
        "width": SIDE,
        "height": SIDE,
        "layer": layers(
            layer("rule", lines, {**place, "x2": {"field": "x2"}, "y2": {"field": "y2"}},
                  color=FAINT),
            layer("point", starts, {**place, **colour}, filled=True, size=24, opacity=1),
            layer("point", heads, {**place, **colour, **turned}, filled=True, size=60,
                  shape="triangle-right", opacity=1),
            layer("rule", [mean], {**place, "x2": {"field": "x2"}, "y2": {"field": "y2"}},
                  color=INK, strokeWidth=3),
            layer("point", [head], {**place, **turned}, filled=True, size=140,
                  shape="triangle-right", color=INK, opacity=1),
        ),
    }  # fmt: skip


def _mean(
    c: Change, xs: tuple[float, float], ys: tuple[float, float]
) -> tuple[Spec, Spec]:  # fmt: skip
    """The step of geometric mean times and mean errors, of everybody: its line, and its head."""
    log, error = c.log_time.mean(axis=0) / np.log(10), c.error.mean(axis=0)
    right, up = (log[1] - log[0]) / (xs[1] - xs[0]), (error[1] - error[0]) / (ys[1] - ys[0])
    x, y = [float(10.0**v) for v in log], [float(v) for v in error]
    tip = (
        f"means: {significant(x[0])} to {significant(x[1])} s (geometric), {c.error_label} "
        f"{significant(y[0])} to {significant(y[1])}"
    )
    line: Spec = {"x": x[0], "y": y[0], "x2": x[1], "y2": y[1]}
    return line, {"x": x[1], "y": y[1], "angle": float(np.degrees(np.arctan2(-up, right))),
                  "tip": tip}  # fmt: skip


def _roomy(values: NDArray[np.float64]) -> tuple[float, float]:
    """Limits with a margin."""
    low, high = float(values.min()), float(values.max())
    pad = 0.06 * (high - low) or 0.05
    return low - pad, high + pad


def _ticks(low: float, high: float) -> list[float]:
    """Plain seconds within limits given as log₁₀ seconds; a log axis has more."""
    nice = [a * 10.0**b for b in range(-2, 5) for a in (1, 2, 5)]
    return [t for t in nice if low <= np.log10(t) <= high]
