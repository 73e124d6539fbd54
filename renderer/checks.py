"""Checks of parameters: one line that names the field, its value and what was expected."""

from __future__ import annotations

import math
from collections.abc import Sequence


def number(owner: str, name: str, value: float, low: float, high: float) -> None:
    """Raise ValueError unless low ≤ value ≤ high."""
    if not (isinstance(value, (int, float)) and math.isfinite(value) and low <= value <= high):
        raise ValueError(f"{owner}: {name} = {value!r}, expected a number from {low} to {high}")


def choice(owner: str, name: str, value: object, choices: Sequence[object]) -> None:
    """Raise ValueError unless `value` is one of `choices`."""
    if value not in choices:
        wanted = ", ".join(repr(c) for c in choices)
        raise ValueError(f"{owner}: {name} = {value!r}, expected one of {wanted}")


def whole(owner: str, name: str, value: int, low: int, high: int) -> None:
    """Raise ValueError unless `value` is a whole number with low ≤ value ≤ high."""
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise ValueError(f"{owner}: {name} = {value!r}, expected a whole number {low} to {high}")
