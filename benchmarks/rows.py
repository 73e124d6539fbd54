"""A line of a benchmark's table."""

from __future__ import annotations

from typing import Any

Row = dict[str, Any]


def row(
    figure: str, scene: str, value: float, unit: str, must: float | None = None,
    aim: float | None = None, more: bool = False,
) -> Row:  # fmt: skip
    """{figure, scene, value, unit, must, aim, met}; the value to four digits.

    `met`: whether the value is at most `must` (at least, with `more`), None without a `must`.
    """
    met = None if must is None else bool(value >= must if more else value <= must)
    return {
        "figure": figure, "scene": scene, "value": float(f"{value:.4g}"), "unit": unit,
        "must": must, "aim": aim, "met": met,
    }  # fmt: skip
