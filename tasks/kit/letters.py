"""The five letters of the pattern task on the 5 × 7 grid (Elmqvist2009 §VI, figure 5).

The scan lost the paper's drawing; these are ours. Rows run from the letter's top to its foot.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

COLUMNS, ROWS = 5, 7

LETTERS = {
    "C": (".###.", "#...#", "#....", "#....", "#....", "#...#", ".###."),
    "K": ("#...#", "#..#.", "#.#..", "##...", "#.#..", "#..#.", "#...#"),
    "R": ("####.", "#...#", "#...#", "####.", "#.#..", "#..#.", "#...#"),
    "X": ("#...#", "#...#", ".#.#.", "..#..", ".#.#.", "#...#", "#...#"),
    "Y": ("#...#", "#...#", ".#.#.", "..#..", "..#..", "..#..", "..#.."),
}


def letter_points(letter: str, spacing: float, angle: float) -> NDArray[np.float64]:
    """(n, 3) places of the letter's cells in the plane y = 0, turned by `angle` about +y.

    Seen from above with −z up the page at angle 0, the letter reads the right way round.
    """
    rows, columns = np.nonzero(np.array([list(row) for row in LETTERS[letter]]) == "#")
    x = (columns - (COLUMNS - 1) / 2) * spacing
    z = (rows - (ROWS - 1) / 2) * spacing
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack([x * cos + z * sin, np.zeros(len(x)), z * cos - x * sin], axis=1)


def grid_reach() -> float:
    """Distance from the grid's middle to its corner cells, in spacings."""
    return float(np.hypot((COLUMNS - 1) / 2, (ROWS - 1) / 2))
