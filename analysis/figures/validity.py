"""Learning over the trials of a task set."""

from __future__ import annotations

from functools import partial
from typing import Any

import pandas as pd

from analysis.figures.style import COLOURS, LEVELS
from analysis.page.blocks import Figure, Tips
from analysis.page.numbers import significant


def learning_figure(key: str, curve: pd.DataFrame) -> Figure:
    """Geometric mean time by position, a line per transparency level."""
    parts = dict(list(curve.groupby(curve["transparency"].astype("str"))))
    lines = {
        level: list(
            zip(parts[level]["trial_in_set"].astype(int), parts[level]["time"], strict=True)
        )
        for level in LEVELS
        if level in parts
    }
    told = "; ".join(
        f"{level}: " + ", ".join(f"trial {k} {significant(float(t))} s" for k, t in points[:12])
        for level, points in lines.items()
    )
    alt = f"Lines of geometric mean time by position in the task set. {told}."
    title = "Time by position in the task set"
    return Figure(key, title, alt, partial(_learning, lines=lines), (5.2, 2.8))


def _learning(canvas: Any, tips: Tips, lines: dict[str, list[tuple[int, float]]]) -> None:
    axes = canvas.subplots()
    for level, points in lines.items():
        places, times = zip(*points, strict=True)
        (line,) = axes.plot(places, times, "o-", color=COLOURS[level], markersize=5, label=level)
        tips.mark_each(
            line, [f"{level}, trial {k}: geometric mean {significant(t)} s" for k, t in points]
        )
        axes.set_xticks(places)
    axes.set_ylim(bottom=0)
    axes.set_xlabel("trial in its task set")
    axes.set_ylabel("geometric mean time (s)")
    axes.legend()
