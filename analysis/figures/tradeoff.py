"""Each participant's step from standard to dynamic, on time × error."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analysis.figures.style import COLOURS, FAINT, LEVELS, picked
from analysis.load.schema import TASK_CODES
from analysis.page.blocks import Figure, Tips
from analysis.page.numbers import significant
from analysis.tradeoff import Change


def arrows(key: str, changes: Sequence[Change]) -> Figure:
    """A panel per task, an arrow per participant."""
    told = "; ".join(
        f"{c.task}: mean time {significant(float(c.time[:, 0].mean()))} to "
        f"{significant(float(c.time[:, 1].mean()))} s, mean {c.error_label} "
        f"{significant(float(c.error[:, 0].mean()))} to {significant(float(c.error[:, 1].mean()))}"
        for c in changes
    )
    alt = f"Time against error, an arrow per participant from standard to dynamic. {told}."
    size = (2.4 * len(changes) + 0.4, 2.9)
    draw = partial(_arrows, changes=tuple(changes))
    return Figure(key, "Time against error, from standard to dynamic", alt, draw, size)


def _arrows(canvas: Any, tips: Tips, changes: tuple[Change, ...]) -> None:
    panels = canvas.subplots(1, len(changes), squeeze=False)[0]
    for axes, c in zip(panels, changes, strict=True):
        _panel(axes, tips, c)
    marks = [panels[-1].plot([], [], "o", color=COLOURS[level])[0] for level in LEVELS]
    canvas.legend(marks, LEVELS, loc="outside upper right", ncols=2)


def _panel(axes: Any, tips: Tips, c: Change) -> None:
    shown = picked(len(c.time))
    # logarithms on a plain axis: arrows on a logarithmic one would miss their heads
    time, error = np.log10(c.time[shown]), c.error[shown]
    axes.quiver(
        time[:, 0],
        error[:, 0],
        time[:, 1] - time[:, 0],
        error[:, 1] - error[:, 0],
        angles="xy",
        scale_units="xy",
        scale=1,
        color=FAINT,
        width=0.005,
        headwidth=5.5,
        headlength=6,
        zorder=3,  # the heads lie on the dots they point at
    )
    for side, level in enumerate(LEVELS):
        (dots,) = axes.plot(time[:, side], error[:, side], "o", color=COLOURS[level], markersize=4)
        tips.mark_each(
            dots,
            [
                f"{c.participants[i]}, {level}: {significant(c.time[i, side])} s, "
                f"{c.error_label} {significant(c.error[i, side])}"
                for i in shown
            ],
        )
    axes.set_xlim(*_roomy(time))
    axes.set_ylim(*_roomy(error))
    _time_ticks(axes)
    axes.set_title(f"{TASK_CODES[c.task]} {c.task.replace('_', ' ')}")
    axes.set_xlabel("time (s)")
    axes.set_ylabel(c.error_label)


def _roomy(values: NDArray[np.float64]) -> tuple[float, float]:
    """Limits with a margin; quiver itself takes no part in automatic limits."""
    low, high = float(values.min()), float(values.max())
    pad = 0.06 * (high - low) or 0.05
    return low - pad, high + pad


def _time_ticks(axes: Any) -> None:
    """Plain seconds on an axis of log₁₀ seconds."""
    low, high = axes.get_xlim()
    nice = [a * 10.0**b for b in range(-2, 5) for a in (1, 2, 5)]
    ticks = [t for t in nice if low <= np.log10(t) <= high]
    axes.set_xticks(np.log10(ticks), [f"{t:g}" for t in ticks])
