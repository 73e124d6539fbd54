"""How numbers are written, at the edges of each rule."""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.analysis.page.numbers import bounded, fixed, p_value, show, significant


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1.0, "1"), (np.nextafter(1, 0), "> .999"), (0.9995, "> .999"), (0.99949, ".999"),
        (0.999, ".999"), (0.5, ".500"), (0.05, ".0500"), (0.0499, ".0499"), (0.0504, ".0504"),
        (0.04949, ".049"), (0.0506, ".051"), (0.001, ".001"), (np.nextafter(0.001, 0), "< .001"),
        (0.0, "< .001"),
    ],
)  # fmt: skip
def test_a_p_value_never_says_more_than_it_is(value, text):
    assert p_value(value) == text


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [(-0.0004, 3, "0.000"), (-0.0006, 3, "−0.001"), (1.25, 1, "1.2"), (-12.5, 0, "−12")],
)
def test_fixed_has_a_real_minus_and_no_negative_zero(value, digits, text):
    assert fixed(value, digits) == text


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [(0.5, 2, ".50"), (-0.5, 2, "−.50"), (0.999, 2, "1.00"), (1.0, 2, "1.00"), (-1.0, 2, "−1.00"),
     (10.04, 1, "10.0"), (0.0, 2, ".00")],
)  # fmt: skip
def test_bounded_loses_the_zero_only_before_the_point(value, digits, text):
    assert bounded(value, digits) == text


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [(0, 3, "0"), (1234.5, 3, "1234"), (99999, 3, "99999"), (100000, 3, "1.00 × 10⁵"),
     (-123456, 2, "−1.2 × 10⁵"), (0.001, 3, "0.00100"), (0.00099, 2, "9.9 × 10⁻⁴"),
     (12.345, 3, "12.3"), (1.0, 1, "1")],
)  # fmt: skip
def test_significant_figures(value, digits, text):
    assert significant(value, digits) == text


@pytest.mark.parametrize(
    ("value", "style", "text"),
    [(None, "p", ""), (True, "int", "yes"), (False, "text", "no"), ("x", "fixed2", "x"),
     (-3.0, "int", "−3"), (0.25, "fixed1", "0.2"), (0.25, "bound2", ".25"), (0.25, "p", ".250"),
     (0.25, "sig1", "0.2")],
)  # fmt: skip
def test_each_style(value, style, text):
    assert show(value, style) == text
