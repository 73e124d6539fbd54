"""What techniques cost and what they show, from the table of `bench techniques`: a picture."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from seethrough.benchmarks.orderings.ordering_figures import INK, PAPER, plain, save
from seethrough.benchmarks.rows import Row

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LEAST = 0.05  # of 255: less is drawn here, as no error; a logarithm has no zero
COLORS = {"abstract": "#2f81d6", "walkthrough": "#c2750a", "jeep": "#2e9e4f"}
MARKS = {"abstract": "o", "walkthrough": "s", "jeep": "^"}
PANELS = (
    ("uncovered, mean", "hidden targets'\narea uncovered:\nmean (least: faint), %"),
    ("contrast", "their contrast,\n%"),
    ("context left", "context that\nstays, %"),
    ("changed pixels", "changed\npixels, %"),
    ("pops", "pops, worst\nstep, % of picture"),
)
FAINT = {"uncovered, mean": "uncovered, least"}

Table = dict[str, dict[str, dict[str, float]]]  # figure → way → scene → value


def draw(rows: list[Row], path: Path) -> None:
    """Write the picture."""
    save(picture(rows), path, "Error against time, and what is shown, for every technique")


def picture(rows: list[Row]) -> Figure:
    """Above, error against time, a panel a scene; below, what each technique shows. Ways have the
    numbers that they have below."""
    from matplotlib.figure import Figure

    table = _table(rows)
    ways = list(table["time"])
    ways.remove("idle")
    scenes = [s for s in COLORS if any(s in found for found in table["time"].values())]
    tall = 1.7 + 0.2 * len(ways)  # inches: headings and legend, then a line a way
    figure = Figure(figsize=(9.6, 2.6 + tall), layout="constrained", facecolor=PAPER)
    parts = figure.subfigures(2, 1, height_ratios=[2.6, tall], squeeze=False)
    upper, lower = parts.ravel()
    panels = upper.subplots(1, len(scenes), sharey=True, squeeze=False).ravel()
    for axes, scene in zip(panels, scenes, strict=True):
        _scatter(axes, scene, table, ways)
    panels[0].set_ylabel("error (RMSE, in 1/255)", color=INK, fontsize=8)
    columns = lower.subplots(1, len(PANELS), sharey=True, squeeze=False).ravel()
    for axes, (name, label) in zip(columns, PANELS, strict=True):
        _dots(axes, name, label, table, ways, scenes)
    columns[0].set_yticks(range(len(ways)), [f"{way}  {k}" for k, way in enumerate(ways, 1)])
    columns[0].invert_yaxis()
    handles, labels = columns[0].get_legend_handles_labels()
    lower.legend(
        handles, labels, loc="outside lower center", ncols=len(scenes), fontsize=8,
        labelcolor=INK, frameon=False,
    )  # fmt: skip
    return figure


def _table(rows: list[Row]) -> Table:
    found: Table = {}
    for row in rows:
        scene, colon, way = row["scene"].partition(": ")
        if colon:
            found.setdefault(row["figure"], {}).setdefault(way, {})[scene] = row["value"]
    return found


def _scatter(axes: Axes, scene: str, table: Table, ways: list[str]) -> None:
    """Numbers of ways at their time and error; those of one place stand above one another."""
    plain(axes)
    taken: list[tuple[float, float]] = []
    for number, way in enumerate(ways, 1):
        if scene not in table["time"][way]:
            continue
        x, error = table["time"][way][scene], max(table["error"][way][scene], LEAST)
        axes.plot(x, error, MARKS[scene], color=COLORS[scene], ms=3)
        at, up = (np.log(x), np.log(error)), 0
        while any(abs(at[0] - a) < 0.16 and abs(at[1] + 0.5 * up - b) < 0.45 for a, b in taken):
            up += 1
        taken.append((at[0], at[1] + 0.5 * up))
        axes.annotate(
            str(number), (x, error), (0, 3 + 8 * up), textcoords="offset points",
            fontsize=6.5, color=INK, ha="center",
            arrowprops={"arrowstyle": "-", "color": INK, "lw": 0.25} if up else None,
        )  # fmt: skip
    every = [value for way in ways for value in table["time"][way].values()]
    worst = max(value for way in ways for value in table["error"][way].values())
    axes.set(xscale="log", yscale="log", ylim=(LEAST / 1.5, max(200, 4 * worst)),
             xlim=(min(0.7, 0.8 * min(every)), max(60, 1.2 * max(every))))  # fmt: skip
    axes.set_xticks([1, 2, 5, 10, 20, 50], ["1", "2", "5", "10", "20", "50"])
    axes.set_xticks([], minor=True)
    axes.set_yticks([LEAST, 1, 10, 100], ["none", "1", "10", "100"])
    axes.set_yticks([], minor=True)
    axes.set_title(scene, color=INK, fontsize=9)
    axes.set_xlabel("time, standard frames", color=INK, fontsize=8)


def _dots(
    axes: Axes, name: str, label: str, table: Table, ways: list[str], scenes: list[str]
) -> None:
    plain(axes)
    for scene in scenes:
        for which, alpha in ((FAINT.get(name), 0.35), (name, 1.0)):
            if which is None:
                continue
            values = [table[which].get(way, {}).get(scene, np.nan) for way in ways]
            axes.plot(
                values, range(len(ways)), MARKS[scene], color=COLORS[scene], ms=4, alpha=alpha,
                label=scene if which == name else None,
            )  # fmt: skip
    axes.set_title(label, color=INK, fontsize=8)
    axes.tick_params(labelsize=7)
    if name == "pops":
        axes.set_xlim(left=0)
    else:
        most = max([100.0, *(v for found in table[name].values() for v in found.values())])
        axes.set_xlim(-4, most + 4)
