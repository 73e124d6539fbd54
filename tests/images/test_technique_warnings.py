"""What `check` says of a study's scenes: it finds the failures that the gallery shows, and only
where they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seethrough.experiment.commands.studies.check_difficulty import check_techniques
from seethrough.experiment.gallery.gallery_failures import CAMERA, failures
from seethrough.experiment.study.checked.technique_warnings import MOST_SCENES, Met, Warner, _spread
from seethrough.experiment.study.config import load
from seethrough.experiment.verdicts import Verdicts
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques import named


@pytest.fixture(scope="module")
def warner():
    return Warner(load("demo"), standalone())


@pytest.mark.parametrize("name", ["breakaway", "see_through"])
def test_a_target_that_stays_hidden_is_counted(warner, name):
    """Targets in line; no tag on what hides it. Without what is in front, nothing is hidden."""
    failure = failures()[name]
    assert warner.judged(failure.scene, [CAMERA], failure.parameters)[0] == 1
    free = Scene(tuple(o for o in failure.scene.objects if o.target)[-1:])
    assert warner.judged(free, [CAMERA], failure.parameters)[0] == 0


def test_where_another_view_shows_the_target_it_is_not_hidden(warner):
    """From the side the two balls are not in line."""
    failure = failures()["breakaway"]
    other = replace(CAMERA, eye=CAMERA.eye + np.array([3.0, 0.0, 0.0]))
    assert warner.judged(failure.scene, [CAMERA, other], failure.parameters)[0] == 0


def test_hands_on_the_target_uncover_it_where_they_can(warner):
    """With the pointer on it, the lens reaches as far as the wheel turns; without a wheel it ends
    before the wall."""
    failure = failures()["lens"]
    assert warner.judged(failure.scene, [CAMERA], failure.parameters)[0] == 0
    stuck = replace(failure.parameters, step=0.0)
    assert warner.judged(failure.scene, [CAMERA], stuck)[0] == 1
    elsewhere = failures()["fade"]
    assert warner.judged(elsewhere.scene, [CAMERA], elsewhere.parameters)[0] == 0


def test_what_vanishes_is_a_share_of_what_one_would_see(warner):
    """A wall that faces the viewer: gone under a wide cut, there under a narrow one."""
    failure = failures()["adaptive_cutaway"]
    wide = replace(failure.parameters, angle=84.0)
    assert warner.judged(failure.scene, [CAMERA], wide)[1] == 1.0
    assert warner.judged(failure.scene, [CAMERA], named("adaptive_cutaway"))[1] == 0.0


def test_what_a_technique_adds_is_no_thing_of_the_scene(warner):
    """A balloon's rods lead back to where things were; what is pushed aside is still there."""
    failure = failures()["balloon"]
    count = len(failure.scene.objects)
    moved = warner._seen(failure.scene, CAMERA, failure.parameters)
    assert [len(pixels) for pixels in moved] == [count, count]
    warner.judged(failure.scene, [CAMERA], failure.parameters)


def test_an_open_mesh_is_named_where_it_is_cut(warner):
    """And not where nothing is capped, or nothing stands before a target."""
    failure = failures()["cutaway"]
    assert warner.judged(failure.scene, [CAMERA], failure.parameters)[2] == {"thing"}
    bare = replace(failure.parameters, cap="none")
    assert warner.judged(failure.scene, [CAMERA], bare)[2] == set()
    assert warner.judged(failures()["breakaway"].scene, [CAMERA], named("breakaway"))[2] == set()


def test_the_lines_say_how_many_scenes():
    met = Met("breakaway", scenes=48, hidden=14, targets=20)
    assert list(met.warnings()) == [
        "in 14 of 48 scenes a target stays hidden under breakaway (20 targets)"
    ]
    assert list(Met("lens", scenes=48).warnings()) == []


def test_few_scenes_are_all_looked_at_and_many_evenly():
    assert _spread([*range(5)]) == [*range(5)]
    some = _spread([*range(1000)])
    assert len(some) == MOST_SCENES and some[0] == 0
    assert int(np.diff(some).max()) <= 21


def test_a_mesh_is_closed_where_every_edge_has_two_sides():
    """A box is; without one triangle, or with one turned over, it is not."""
    from seethrough.renderer.scene import geometry

    box = geometry.box(1, 2, 3)
    assert box.closed
    assert not replace(box, triangles=box.triangles[1:]).closed
    turned = box.triangles.copy()
    turned[0] = turned[0][::-1]
    assert not replace(box, triangles=turned).closed


def test_check_says_what_of_which_technique_fails_and_where_that_is_told(monkeypatch, capsys):
    """A line a warning, its words in their order; one for what was looked through without any."""
    found = {"breakaway": Met("breakaway", 3, hidden=1, targets=4), "lens": Met("lens", 3)}
    monkeypatch.setattr(Warner, "trials", lambda self, trials: dict.fromkeys(found, ()))
    monkeypatch.setattr(Warner, "met", lambda self, name, trials: found[name])
    said = Verdicts()
    check_techniques(load("demo"), [], standalone(), said)
    assert capsys.readouterr().out.splitlines() == [
        "technique   in 1 of 3 scenes a target stays hidden under breakaway (4 targets): WARNING, "
        "docs/techniques.md says how each fails",
        "technique   lens: all targets of 3 scenes come to show: ok",
    ]
    assert said.found == {"ok": 1, "WARNING": 1, "FAILS": 0}
