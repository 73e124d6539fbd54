"""Red–green plates of our own: a digit of dots that differ from the ground in hue alone.

A screening aid, no diagnosis: what was answered is recorded, the experimenter decides. Each dot's
lightness varies at random, so that lightness gives the digit away to nobody; the first plate
differs in lightness, for everybody to see.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

# 5 × 7 digits, rows from the top, one bit a column from the left.
DIGITS = {
    2: (0b01110, 0b10001, 0b00001, 0b00110, 0b01000, 0b10000, 0b11111),
    3: (0b11110, 0b00001, 0b00001, 0b01110, 0b00001, 0b00001, 0b11110),
    5: (0b11111, 0b10000, 0b11110, 0b00001, 0b00001, 0b10001, 0b01110),
    6: (0b01110, 0b10000, 0b10000, 0b11110, 0b10001, 0b10001, 0b01110),
    7: (0b11111, 0b00001, 0b00010, 0b00100, 0b01000, 0b01000, 0b01000),
    8: (0b01110, 0b10001, 0b10001, 0b01110, 0b10001, 0b10001, 0b01110),
}
FIGURE, GROUND = (0.78, 0.45, 0.33), (0.55, 0.58, 0.30)  # a red and a green of like lightness
DARK, LIGHT = (0.25, 0.25, 0.35), (0.75, 0.75, 0.70)
DOTS = 6000  # tried; about one in twenty finds room


class Plate:
    """Dots in the unit square, origin upper left: (n, 2) places, (n,) radii, (n, 3) colours.

    They are packed when somebody asks for them: a simulated participant reads the digit.
    """

    def __init__(self, digit: int, control: bool, rng: Generator) -> None:
        self.digit, self.control = digit, control
        self._rng = rng

    @property
    def places(self) -> NDArray[np.float64]:
        """(n, 2) middles of the dots."""
        return self._dots[0]

    @property
    def radii(self) -> NDArray[np.float64]:
        """(n,) radii of the dots."""
        return self._dots[1]

    @property
    def colors(self) -> NDArray[np.float64]:
        """(n, 3) colours of the dots."""
        return self._dots[2]

    @cached_property
    def _dots(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        places, radii = _packed(self._rng)
        inside = _in_digit(places, self.digit)
        figure, ground = (DARK, LIGHT) if self.control else (FIGURE, GROUND)
        colors = np.where(inside[:, None], figure, ground)
        lightness = self._rng.uniform(0.75, 1.2, len(places))
        return places, radii, np.clip(colors * lightness[:, None], 0, 1)


def plates(rng: Generator) -> tuple[Plate, ...]:
    """One plate that everybody can read, then three that need red–green vision."""
    digits = rng.permutation(sorted(DIGITS))[:4]
    own = rng.spawn(len(digits))
    return tuple(Plate(int(d), i == 0, own[i]) for i, d in enumerate(digits))


def _packed(rng: Generator) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Dots of different sizes in a disc, none on another: the largest first."""
    angle = rng.uniform(0, 2 * np.pi, DOTS)
    distance = 0.48 * np.sqrt(rng.uniform(size=DOTS))
    candidates = 0.5 + np.stack([distance * np.cos(angle), distance * np.sin(angle)], axis=1)
    sizes = np.repeat([0.026, 0.020, 0.014], DOTS // 3)
    places, radii, kept = np.zeros((DOTS, 2)), np.zeros(DOTS), 0
    for place, radius in zip(candidates, sizes, strict=True):
        apart = places[:kept] - place
        if (np.hypot(apart[:, 0], apart[:, 1]) > radii[:kept] + radius).all():
            places[kept], radii[kept] = place, radius
            kept += 1
    return places[:kept], radii[:kept]


def _in_digit(places: NDArray[np.float64], digit: int) -> NDArray[np.bool_]:
    """(n,) which places lie on the digit, drawn 5 × 7 in the middle of the square."""
    column = np.floor((places[:, 0] - 0.27) / 0.46 * 5).astype(int)
    row = np.floor((places[:, 1] - 0.18) / 0.64 * 7).astype(int)
    on = (column >= 0) & (column < 5) & (row >= 0) & (row < 7)
    bits = np.array(DIGITS[digit])[np.clip(row, 0, 6)]
    dark: NDArray[np.bool_] = bits >> (4 - np.clip(column, 0, 4)) & 1 == 1
    return on & dark
