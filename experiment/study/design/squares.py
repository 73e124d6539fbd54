"""Orders of k things from numbers alone: whole squares, of which each slot takes a row.

Every row is a permutation of 0 … k − 1. What each square promises over all its rows:

    williams  each thing equally often at each position, and after each other (Williams 1949)
    latin     each thing equally often at each position
    fixed     nothing: one row, the order of the file
    random    nothing: each slot has an order of its own (experiment/study/design/design.py)
"""

from __future__ import annotations

from functools import cache

Rows = tuple[tuple[int, ...], ...]

SQUARES = ("williams", "latin", "fixed", "random")
MIXED = "mixed"  # not a square: trial by trial within a block


def williams_rows(k: int) -> Rows:
    """Orders of k conditions: a Williams square for even k, two squares for odd k.

    Raises ValueError for k < 1.
    """
    if k < 1:
        raise ValueError(f"conditions = {k}, expected at least 1")
    first = [(i + 1) // 2 if i % 2 else (k - i // 2) % k for i in range(k)]
    square = [tuple((c + row) % k for c in first) for row in range(k)]
    if k % 2 and k > 1:
        square += [tuple(reversed(row)) for row in square]
    return tuple(square)


def latin_rows(k: int) -> Rows:
    """The cyclic square: row r begins at r. Raises ValueError for k < 1."""
    if k < 1:
        raise ValueError(f"conditions = {k}, expected at least 1")
    return tuple(tuple((row + i) % k for i in range(k)) for row in range(k))


@cache
def square(kind: str, k: int) -> Rows:
    """The rows of a kind of order; one for `fixed`, and for `random`, whose rows are drawn."""
    if kind == "williams":
        return williams_rows(k)
    if kind == "latin":
        return latin_rows(k)
    if kind in ("fixed", "random"):
        return (tuple(range(k)),)
    raise ValueError(f"order = {kind!r}, expected one of {', '.join(SQUARES)}")


def positions_promised(kind: str) -> bool:
    """Whether each thing stands equally often at each position."""
    return kind in ("williams", "latin")


def successors_promised(kind: str) -> bool:
    """Whether each thing follows each other equally often."""
    return kind == "williams"
