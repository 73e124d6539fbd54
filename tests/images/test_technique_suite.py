"""Every technique, ours and a stranger's, keeps to what all must; and the suite notices."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path

import numpy as np
import pytest
from plugins import installed, seethrough

from seethrough import registry
from seethrough.experiment.suites import technique_hard as hard
from seethrough.experiment.suites.technique_suite import _Tried, check, check_all
from seethrough.renderer.events import KeyPress
from seethrough.renderer.techniques import removal
from seethrough.renderer.techniques.base import Gesture
from seethrough.renderer.techniques.cutaway.cutaway import Cutaway, CutawayParameters

TOY = Path(__file__).parents[1] / "plugins" / "toy_technique"
# Combinations of options that are compared here; test_every_option.py has all of dynamic's.
MOST = {"dynamic": 4}


@pytest.mark.parametrize("name", registry.known("technique"))
def test_a_technique_keeps_to_what_all_must(context, name):
    """As `seethrough technique check` says it."""
    found = list(check(registry.get("technique", name), context, MOST.get(name, 100)))
    assert [str(f) for f in found if not f.holds] == []
    assert len(found) == 12


@pytest.mark.parametrize("name", registry.known("technique"))
def test_a_part_of_all_scenes_is_exact(context, name):
    """Of those that `technique check NAME --all` draws; tests/hard has the hard ones."""
    every = check_all(registry.get("technique", name), context)
    assert [str(f) for f in islice(every, 0, 20, 5) if not f.holds] == []


def test_a_hard_scene_that_is_all_in_doubt_says_so(context):
    """One pixel is compared, and not left out."""
    (make, size), *_ = hard.SIZES
    tried = _Tried(registry.get("technique", "cutaway"), context)
    found = tried.compared("1 × 1", make(), CutawayParameters(), size, False, True)
    assert size == (1, 1) and found.holds and "0.00 % left out" in found.said


def test_a_stranger_s_technique_is_found_drawn_and_checked(tmp_path):
    """A package of at most 60 lines, installed, with no edit anywhere."""
    assert sum(len(f.read_text().splitlines()) for f in TOY.glob("*.*")) <= 60
    there = installed(TOY, tmp_path)
    listed = seethrough(there, "technique", "list")
    assert "toy (1): What is near you is not shown." in listed.stdout
    picture = tmp_path / "toy.png"
    words = ("render", "jeep", "--technique", "toy", "--set", "distance=3.5", "--size", "80x60")
    drawn = seethrough(there, *words, "--out", str(picture))
    assert drawn.returncode == 0 and picture.stat().st_size > 1000, drawn.stderr
    checked = seethrough(there, "technique", "check", "toy")
    assert checked.returncode == 0, checked.stdout + checked.stderr


def test_what_new_writes_passes(tmp_path):
    """Written, installed and checked without a change; what is there is not overwritten."""
    folder = tmp_path / "mine"
    written = seethrough(tmp_path, "new", "technique", "mine", str(folder))
    assert written.returncode == 0, written.stderr
    again = seethrough(tmp_path, "new", "technique", "mine", str(folder))
    assert again.returncode == 2 and again.stderr.count("\n") == 1
    there = installed(folder, tmp_path)
    checked = seethrough(there, "technique", "check", "mine")
    assert checked.returncode == 0, checked.stdout + checked.stderr


class _Broken(Cutaway):
    """A cut-away with a fault, made for each test."""

    def __init__(self, **faults):
        class Parameters(CutawayParameters):
            pass

        self.Parameters = Parameters
        for name, fault in faults.items():
            setattr(self, name, fault)
        removal.Removal.__init__(self)


FAULTS = {
    "described": {"instruction": "Two. Sentences."},
    "exact": {
        "removes": Cutaway.removes.replace("s.depth <", "s.depth * 1.02 <"),
    },
    "replay": {"on_event": lambda p, state, event, shot: (state, True)},
    "pure": {"known": lambda p, state, seen: (seen.depth.sort(), [])[1]},
}


@pytest.mark.parametrize("name", ["described", "exact", "replay", "pure"])
def test_the_suite_notices(context, name):
    """A technique with one fault fails where that fault is."""
    wrong = [f.name for f in check(_Broken(**FAULTS[name]), context, 3) if not f.holds]
    assert name in wrong


@pytest.mark.parametrize("name", registry.known("technique"))
def test_what_gives_nothing_to_test_is_no_verdict(context, name):
    """Hands that do nothing reach nothing, and that is not well done."""
    technique = registry.get("technique", name)
    found = {f.name: f for f in check(technique, context, 1)}
    assert not found["cost"].tested
    assert found["reaches"].tested == bool(technique.takes)
    assert str(found["reaches"]).startswith("ok  " if technique.takes else "note")
    assert found["refuses"].tested == (name != "standard")


@dataclass(frozen=True)
class Pressed:
    """How often keys were pressed."""

    times: int = 0


def _answers_to(*keys):
    """What makes a technique count presses of these keys."""

    def on_event(p, state, event, shot):
        heard = isinstance(event, KeyPress) and event.key in keys
        return (replace(state, times=state.times + 1), True) if heard else (state, False)

    return {"begin": lambda p: Pressed(), "on_event": on_event}


HANDS = {
    "a key that does nothing": (
        "replay", {"takes": frozenset({"key:q", "key:x"}), **_answers_to("q")},
        "says it takes key:x",
    ),
    "a key that the suite's own events lack": (
        "replay", {"takes": frozenset({"key:q"}), **_answers_to("q", "e")},
        "answers to key:e",
    ),
    "hands that change nothing, and not by default": (
        "reaches", {"takes": frozenset({"key:q"}), **_answers_to("q"),
                    "active": lambda p: p.planes == 1, "reach": lambda *_: (Gesture("key:q"),)},
        "nothing changes in any scene",
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", HANDS)
def test_the_suite_notices_hands(context, what):
    """Each of them passed while nothing brought the key, or the parameters, that it takes."""
    name, faults, words = HANDS[what]
    found = {f.name: f for f in check(_Broken(**faults), context, 1)}
    assert not found[name].holds
    assert words in found[name].said


def test_a_state_that_nothing_is_said_of_is_noticed(context):
    """It takes nothing, and counts keys all the same."""
    found = {f.name: f for f in check(_Broken(**_answers_to("up")), context, 1)}
    assert not found["replay"].holds and "answers to key:up" in found["replay"].said


def test_a_technique_that_paints_what_it_leaves_is_not_idle(context):
    """Its rule changes nothing of what is impenetrable, and its shader does."""

    class Paints(_Broken):
        def objects(self, p, scene):
            return np.ones(len(scene.objects))

        def touches(self, p, state, shot):
            return np.ones(len(shot.scene.objects), dtype=bool)

    broken = Paints()
    broken.glsl = "float opacity(Surface s) { tinted = vec4(1.0); return 1.0; }\n"
    broken.glsl += "bool opened(Surface s) { return false; }\n"
    wrong = [f.name for f in check(broken, context, 3) if not f.holds]
    assert {"idle", "exact"} <= {*wrong}


def test_state_between_frames_is_noticed(context):
    """A uniform that counts frames makes two frames of the same thing differ."""

    class Counts(_Broken):
        count = 0

        def pictures(self, p, state, shot, needed):
            self.count += 1
            found = super().pictures(p, state, shot, needed)
            return {n: picture * (1 + 0.1 * (self.count % 2)) for n, picture in found.items()}

    wrong = [f.name for f in check(Counts(), context, 3) if not f.holds]
    assert "no state between frames" in wrong
