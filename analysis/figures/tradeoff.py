"""Each participant's step from standard to dynamic, on time × error."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from seethrough.analysis.page.blocks import Figure
from seethrough.analysis.page.numbers import significant
from seethrough.analysis.page.style import (
    FAINT,
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
    """A panel per task, an arrow per participant."""
    told = "; ".join(
        f"{c.said}: mean time {significant(float(c.time[:, 0].mean()))} to "
        f"{significant(float(c.time[:, 1].mean()))} s, mean {c.error_label} "
        f"{significant(float(c.error[:, 0].mean()))} to {significant(float(c.error[:, 1].mean()))}"
        for c in changes
    )
    alt = f"Time against error, an arrow per participant from baseline to level. {told}."
    spec = in_rows([_panel(c) for c in changes], 4)
    levels = {c.names for c in changes}
    first, second = levels.pop() if len(levels) == 1 else ("the baseline", "each level")
    return Figure(key, f"Time against error, from {first} to {second}", alt, spec)


def _panel(c: Change) -> Spec:
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
    domain = [10.0 ** xs[0], 10.0 ** xs[1]]
    scale = {"type": "log", "domain": domain, "nice": False}
    place = {
        "x": number("x", "time (s)", scale=scale, axis={"values": _ticks(*xs), "format": "~g"}),
        "y": number("y", c.error_label, scale={"domain": list(ys), "nice": False}),
    }
    turned = {"angle": {"field": "angle", "type": "quantitative", "scale": None}}
    colour = {"color": level_colour(c.names)}
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
        ),
    }  # fmt: skip


def _roomy(values: NDArray[np.float64]) -> tuple[float, float]:
    """Limits with a margin."""
    low, high = float(values.min()), float(values.max())
    pad = 0.06 * (high - low) or 0.05
    return low - pad, high + pad


def _ticks(low: float, high: float) -> list[float]:
    """Plain seconds within limits given as log₁₀ seconds; a log axis has more."""
    nice = [a * 10.0**b for b in range(-2, 5) for a in (1, 2, 5)]
    return [t for t in nice if low <= np.log10(t) <= high]
