"""What becomes of each kind of model file is what it was when its figures were written down."""

import json

import pytest
from alike import differences
from read_figures import CASES, FIGURES, read

KNOWN = json.loads(FIGURES.read_text("utf-8"))


def test_every_kind_of_file_has_its_figures():
    assert set(KNOWN) == set(CASES)


@pytest.mark.parametrize("name", sorted(KNOWN))
def test_a_model_becomes_what_it_did(name, tmp_path):
    """python tests/support/read_figures.py writes them, where reading is changed on purpose."""
    found, known = read(CASES[name], tmp_path), json.loads(json.dumps(KNOWN[name]))
    carried, right = found["facts"].pop("carried"), known["facts"].pop("carried")
    if carried is not None:
        # Of triangles that are equally wrong, the last digit says which is cut first.
        for key in ("triangles", "color", "spread", "center", "normal"):
            assert found["mesh"].pop(key) == pytest.approx(
                known["mesh"].pop(key), rel=0.01, abs=0.01
            )
        assert carried.pop("limited") == right.pop("limited")
        assert carried == pytest.approx(right, rel=0.01)
    assert differences(found, known) == []
