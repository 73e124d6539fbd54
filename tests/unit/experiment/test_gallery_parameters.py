"""Small multiples of techniques: which values are shown of each parameter."""

from __future__ import annotations

import pytest

from seethrough import registry
from seethrough.experiment.gallery.gallery_parameters import plates, varied
from seethrough.experiment.gallery.gallery_scenes import stage
from seethrough.renderer.declared import declared
from seethrough.renderer.techniques import named


def test_choices_are_all_shown_and_numbers_about_their_default():
    shown = varied(named("breakaway"))
    assert shown["cap"] == ("none", "inside", "flat")
    assert shown["margin"] == (4.8, 12.0, 30.0)  # .4, 1 and 2.5 times
    assert shown["jagged"] == (0.0, 0.5, 1.0)  # nothing is the default: of what is allowed
    assert shown["teeth"] == (4, 11, 27)
    assert varied(named("constant"))["layers"] == (1, 2, 4, None)


def test_values_keep_to_what_is_allowed():
    assert varied(named("view_dependent"))["most"] == (0.36, 0.9, 1.0)
    assert "depth" not in varied(named("lens"))  # where hands are, not how it looks
    assert not varied(named("standard"))


@pytest.mark.parametrize("name", registry.known("technique"))
def test_every_plate_differs_from_the_first_in_one_parameter(name):
    scene, camera = stage()
    p = named(name)
    made = list(plates(name, "stage", scene, camera, p, None))
    assert len({plate.name for plate in made}) == len(made)
    for plate in made:
        changed = {k for k in declared(type(p)) if getattr(plate.technique, k) != getattr(p, k)}
        assert len(changed) <= 1 and all(plate.caption.startswith(f"{k} = ") for k in changed)
