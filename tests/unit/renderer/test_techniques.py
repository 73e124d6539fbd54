"""Parameters are checked where they are made: field, value, what was expected."""

from __future__ import annotations

import pytest

from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency


@pytest.mark.parametrize(
    ("field", "value", "expected"),
    [
        ("alpha_target", 1.5, "a number from 0 to 1"),
        ("alpha_edge", -0.1, "a number from 0 to 1"),
        ("alpha_edge", float("nan"), "a number from 0 to 1"),
        ("width", "wide", "a number from 0 to 1000"),
        ("mask", "square", 'one of "outline", "ring"'),
        ("granularity", "world", 'one of "pixel", "surface", "object", "region"'),
        ("mode", "lazy", 'one of "passive", "active"'),
        ("pointer", 3, r"\[x, y\], numbers from"),
        ("layers", 1.5, "a whole number from 0 to 10000"),
        ("layers", True, "a whole number from 0 to 10000"),
        ("min_transmittance", 1.0, "a number from 0 to 0.99"),
        ("combine", "max", 'one of "product", "min"'),
        ("model", "subtractive", 'one of "multiplicative", "additive"'),
        ("ring_size", 1, "a whole number from 2 to 4096"),
        ("order", "alphabet", 'one of "planes", "polygons", "centers"'),
        ("doubt", 2, "a number from 0 to 1"),
    ],
)
def test_a_bad_value_is_refused_by_name(field, value, expected):
    """One line each."""
    with pytest.raises(
        ValueError, match=f"dynamic transparency: {field} = .*, expected {expected}"
    ):
        DynamicTransparency(**{field: value})


def test_the_defaults_are_the_documented_ones():
    """study.md's start values: α_T .3, α_0 .1, n 10."""
    technique = DynamicTransparency()
    assert (technique.alpha_target, technique.alpha_edge, technique.width) == (0.3, 0.1, 10.0)
    assert not technique.per_pixel_only
