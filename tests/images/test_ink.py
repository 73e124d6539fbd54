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
