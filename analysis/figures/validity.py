"""Learning over the trials of a task set."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from seethrough.analysis.page.blocks import Figure
from seethrough.analysis.page.numbers import significant
from seethrough.analysis.page.style import layer, layers, level_colour, number


def learning_figure(key: str, curve: pd.DataFrame, levels: Sequence[str]) -> Figure:
    """Geometric mean time by position, a line per level."""
    places = [int(trial) for trial in curve["trial_in_set"]]
    names, times = [str(level) for level in curve["level"]], [float(t) for t in curve["time"]]
    points = list(zip(names, places, times, strict=True))
    rows = [
        {
            "level": level,
            "trial": trial,
            "time": time,
            "tip": f"{level}, trial {trial}: geometric mean {significant(time)} s",
        }
        for level, trial, time in points
    ]
    told = "; ".join(
        f"{level}: " + ", ".join(f"trial {n} {significant(time)} s" for n, time in own[:12])
        for level in levels
        if (own := [(n, time) for name, n, time in points if name == level])
    )
    alt = f"Lines of geometric mean time by position in the task set. {told}."
    places = sorted(set(places))
    encoding = {
        "x": number("trial", "trial in its task set", axis={"values": places, "format": "d"},
                    scale={"domain": [places[0] - 0.2, places[-1] + 0.2], "nice": False}),
        "y": number("time", "geometric mean time (s)", scale={"zero": True}),
        "color": level_colour(levels),
    }  # fmt: skip
    lines = [{k: v for k, v in r.items() if k != "tip"} for r in rows]
    spec = {
        "width": 320,
        "height": 170,
        "layer": layers(
            layer("line", lines, encoding, strokeWidth=1.5),
            layer("point", rows, encoding, filled=True, size=50, opacity=1),
        ),
    }
    return Figure(key, "Time by position in the task set", alt, spec)
