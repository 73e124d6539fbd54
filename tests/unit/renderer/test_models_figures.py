"""The shipped models are what they were when their figures were written down."""

import json

import pytest
from model_figures import FIGURES, figures, shipped

KNOWN = json.loads(FIGURES.read_text("utf-8"))


@pytest.fixture(scope="module")
def models():
    return shipped()


def test_every_model_has_its_figures(models):
    assert set(KNOWN) == set(models)


@pytest.mark.parametrize("name", sorted(KNOWN))
def test_a_model_looks_as_it_did(name, models):
    """python tests/support/model_figures.py writes them, where a model is changed on purpose."""
    found = figures(models[name])
    for key, value in KNOWN[name].items():
        # libraries of mathematics differ in the last digits; a millimetre would show here
        assert found[key] == pytest.approx(value, rel=1e-6, abs=1e-9), key
