"""What the figures share: colours, and the pieces of a Vega-Lite specification."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

Spec = dict[str, object]

INK = "#1f2328"
RULE = "#d0d7de"
FAINT = "#8c959f"
PALETTE = (
    "#c2570c",
    "#0b69b7",
    "#00795a",
    "#b1408a",
    "#8a6d00",
    "#5a5a5a",
    "#2f87a8",
    "#7a3b00",
)
"""Told apart by every kind of colour vision (after Okabe and Ito), and by darkness in print; more
levels than colours are told apart by their places, too."""
LEVEL = PALETTE[1]
NO_DATA: Spec = {"values": []}
MOST_DOTS = 200


def level_colour(levels: Sequence[str], factor: str | None = None) -> Spec:
    """The channel that colours levels, the baseline first; `factor` names what they are of."""
    colours = [PALETTE[i % len(PALETTE)] for i in range(len(levels))]
    return {
        "field": "level",
        "type": "nominal",
        "title": factor,
        "scale": {"domain": list(levels), "range": colours},
        "legend": {"orient": "top"},
    }


def in_rows(panels: Sequence[Spec], wide: int) -> Spec:
    """Panels side by side, `wide` of them in a row."""
    if len(panels) <= wide:
        return {"hconcat": list(panels)}
    rows = [list(panels[i : i + wide]) for i in range(0, len(panels), wide)]
    return {"vconcat": [{"hconcat": row} for row in rows]}


def picked(n: int) -> NDArray[np.intp]:
    """Which of n participants are drawn: all, or an even choice of `MOST_DOTS`."""
    return np.unique(np.linspace(0, n - 1, min(n, MOST_DOTS)).round().astype(np.intp))


def number(field: str, title: str | None = None, **more: object) -> Spec:
    """A quantitative channel."""
    return {"field": field, "type": "quantitative", "title": title, **more}


def layer(
    mark: str,
    rows: Sequence[Mapping[str, object]],
    encoding: Mapping[str, object],
    **options: object,
) -> Spec:
    """A layer with data of its own; where rows have a `tip`, marks say it."""
    tipped = any("tip" in row for row in rows)
    said = {"field": "tip", "type": "nominal"}
    return {
        "data": {"values": list(rows)},
        # marks that say nothing are drawn for the eye alone
        "mark": {"type": mark, "aria": tipped, **options},
        "encoding": {**encoding, **({"tooltip": said, "description": said} if tipped else {})},
    }


def layers(*parts: Spec) -> list[Spec]:
    """Those that have something to draw: Vega warns of a scale without data."""
    return [part for part in parts if part["data"] != NO_DATA]


def zero_line(channel: str, title: str | None = None) -> Spec:
    """A line at 0 across the plot; `channel` is x or y."""
    return layer("rule", [{"zero": 0}], {channel: number("zero", title)}, color=FAINT)


def categories(labels: Sequence[str], channel: str = "x") -> Spec:
    """A quantitative axis with a label at each whole number, so that marks can stand beside it.

    A blank in a label of the x axis breaks the line.
    """
    named = [label.split(" ") if channel == "x" else label for label in labels]
    return {
        "type": "quantitative",
        "title": None,
        "scale": {"domain": [-0.5, len(labels) - 0.5], "nice": False, "reverse": channel == "y"},
        "axis": {
            "values": list(range(len(labels))),
            "labelExpr": f"{named!r}[datum.value]",
            "labelAngle": 0,
            "labelOverlap": False,
            "grid": False,
        },
    }
