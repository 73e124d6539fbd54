"""Pages and HUDs lie on the screen as they did when their figures were written down."""

import json

import pytest
from ink_figures import FIGURES, everything, forms, huds

KNOWN = json.loads(FIGURES.read_text("utf-8"))


@pytest.fixture(scope="module")
def drawn(context):
    return everything(context)


def test_every_page_and_hud_has_its_figures():
    assert set(KNOWN) == {f"hud {n}" for n in huds()} | {f"page {n}" for n in forms()}


@pytest.mark.parametrize("name", sorted(KNOWN))
def test_ink_lies_where_it_did(name, drawn):
    """python tests/support/ink_figures.py writes them, where a look is changed on purpose."""
    assert set(drawn[name]) == set(KNOWN[name])
    for color, numbers in KNOWN[name].items():
        # They are written to a hundredth of a pixel, and an area is a sum of hundreds of them.
        assert drawn[name][color][:1] == numbers[:1], color
        assert drawn[name][color][2:] == pytest.approx(numbers[2:], abs=0.02), color
        assert drawn[name][color][1] == pytest.approx(numbers[1], rel=1e-4, abs=0.02), color


def test_a_screen_of_four_times_the_pixels_has_four_times_the_ink(context):
    """Lines, too, are as wide for the eye: not the same number of pixels."""
    small, large = (everything(context, size) for size in ((1600, 1200), (3200, 2400)))
    assert set(small) == set(large)
    for name, colors in small.items():
        for color, (_, area, *bounds, _x, _y) in colors.items():
            if color.startswith("00") or color == "picture corners":
                continue  # soft borders' outer rims; a picture's corners as parts of it
            _, more, *wider, _x, _y = large[name][color]
            # A line's soft border is a pixel at any size: of one of 4 + 2 pixels, 8 + 2 remain.
            assert 0.8 * 4 < more / area < 1.1 * 4, (name, color)
            # Widths of letters are whole pixels, and so are the sizes of words that have to fit.
            assert wider == pytest.approx([2 * b for b in bounds], rel=0.03, abs=8), (name, color)
