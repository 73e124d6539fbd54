"""The red–green plates: their digits as they are read, and colours that only hue tells apart."""

from __future__ import annotations

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from seethrough.experiment.pages import color_plates
from seethrough.experiment.pages.color_plates import DIGITS, Plate, _in_digit, plates

ART = """
.###.  ####.  #####  .###.  #####  .###.
#...#  ....#  #....  #....  ....#  #...#
....#  ....#  ####.  #....  ...#.  #...#
..##.  .###.  ....#  ####.  ..#..  .###.
.#...  ....#  ....#  #...#  .#...  #...#
#....  ....#  #...#  #...#  .#...  #...#
#####  ####.  .###.  .###.  .#...  .###.
"""
DRAWN = {
    digit: [row.split("  ")[n] for row in ART.strip().splitlines()]
    for n, digit in enumerate((2, 3, 5, 6, 7, 8))
}
LEFT, TOP, WIDE, HIGH = 0.27, 0.18, 0.46, 0.64  # of the unit square: five columns, seven rows


@pytest.mark.parametrize("digit", DIGITS)
def test_a_digit_is_where_it_is_drawn(digit):
    """At every point of a fine grid: what the drawing has there, and nothing about it."""
    y, x = (np.mgrid[0:1:200j, 0:1:200j] + 1e-4).reshape(2, -1)
    column, row = np.floor((x - LEFT) / WIDE * 5), np.floor((y - TOP) / HIGH * 7)
    inside = (column >= 0) & (column < 5) & (row >= 0) & (row < 7)
    right = np.zeros(len(x), bool)
    for k in np.flatnonzero(inside):
        right[k] = DRAWN[digit][int(row[k])][int(column[k])] == "#"
    assert np.array_equal(_in_digit(np.column_stack([x, y]), digit), right)


def linear(colors):
    colors = np.asarray(colors, float)
    return np.where(colors <= 0.04045, colors / 12.92, ((colors + 0.055) / 1.055) ** 2.4)


def lab(light):
    """CIELAB of linear sRGB under D65."""
    to_xyz = np.array(
        [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    )
    t = np.clip(light, 0, None) @ to_xyz.T / [0.9505, 1.0, 1.089]
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.stack(
        [116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], -1
    )


# Linear sRGB as a deuteranope and a protanope see it (Viénot, Brettel & Mollon 1999): projected on
# the plane of what both eyes agree on.
BLIND = {
    "deuteranope": [[0.29275, 0.70725, 0], [0.29275, 0.70725, 0], [-0.02234, 0.02234, 1]],
    "protanope": [[0.11238, 0.88762, 0], [0.11238, 0.88762, 0], [0.00401, -0.00401, 1]],
}


def apart(first, second):
    """How far the mean colours are apart, without their lightness and with it."""
    a, b = lab(linear(first)).mean(axis=0), lab(linear(second)).mean(axis=0)
    return np.linalg.norm((a - b)[1:]), np.linalg.norm(a - b)


@pytest.fixture(scope="module")
def three():
    """A plate that needs red–green vision, and which of its dots are the digit's."""
    plate = Plate(5, False, np.random.default_rng(4))
    return plate, _in_digit(plate.places, 5)


def test_hue_tells_the_digit_and_lightness_does_not(three):
    plate, on = three
    light = lab(linear(plate.colors))
    figure, ground = light[on], light[~on]
    # 20 is a difference that nobody overlooks; one in lightness that dots' own drown is none.
    assert apart(plate.colors[on], plate.colors[~on])[0] > 20
    spread = ground[:, 0].std()
    assert abs(figure[:, 0].mean() - ground[:, 0].mean()) < spread / 2
    assert 4 < spread < 12


@pytest.mark.parametrize("eye", BLIND)
def test_without_red_green_vision_the_digit_is_hardly_there(eye, three):
    plate, on = three
    seen = np.clip(linear(plate.colors) @ np.array(BLIND[eye]).T, 0, 1)
    figure, ground = (lab(seen[m]).mean(axis=0) for m in (on, ~on))
    normal = apart(plate.colors[on], plate.colors[~on])[1]
    # A protanope sees the red darker and less yellow; a deuteranope less than is just noticed.
    most = {"deuteranope": 2.3, "protanope": normal / 3}[eye]
    assert np.linalg.norm((figure - ground)[1:]) < most


def test_everybody_sees_the_first_plate():
    plate = plates(np.random.default_rng(2))[0]
    on = _in_digit(plate.places, plate.digit)
    light = lab(linear(plate.colors))[:, 0]
    assert plate.control
    assert light[~on].min() > light[on].max() + 20


def test_four_plates_show_four_digits_and_the_first_alone_is_for_everybody():
    shown = plates(np.random.default_rng(11))
    assert len({p.digit for p in shown}) == len(shown) == 4
    assert [p.control for p in shown] == [True, False, False, False]
    places = [p.places for p in shown]
    assert not any(len(a) == len(b) and (a == b).all() for a, b in pairwise(places))


def test_dots_fill_a_disc_and_none_lies_on_another(three):
    plate, on = three
    away = np.linalg.norm(plate.places[:, None] - plate.places, axis=2)
    np.fill_diagonal(away, np.inf)
    assert (away > plate.radii[:, None] + plate.radii).all()
    assert sorted(set(plate.radii), reverse=True) == list(
        plate.radii[np.r_[True, np.diff(plate.radii) != 0]]
    )
    assert np.linalg.norm(plate.places - 0.5, axis=1).max() <= 0.48
    covered = np.pi * (plate.radii**2).sum() / (np.pi * 0.48**2)
    assert 0.35 < covered < 0.75
    # In every quarter of the disc about as many, and enough on the digit to draw it.
    quarter = (plate.places > 0.5) @ [1, 2]
    assert np.bincount(quarter, minlength=4).min() > len(plate.places) / 6
    assert on.sum() > 40


def test_nothing_is_packed_until_somebody_looks(monkeypatch):
    monkeypatch.setattr(color_plates, "_packed", lambda rng: SimpleNamespace())
    assert [p.digit for p in plates(np.random.default_rng(3))]
