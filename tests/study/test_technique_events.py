"""Techniques that follow the pointer, in a session: what reaches them, and the same again."""

from __future__ import annotations

from dataclasses import replace

import pytest
from recorded_session import FACTORS, STUDY, Handling, play_recorded

from seethrough.experiment import cli
from seethrough.experiment.commands.sessions.replay import _verify as verify
from seethrough.experiment.replay.replayer import find_trial, replay
from seethrough.experiment.session.hand import Hand
from seethrough.renderer.events import KeyPress, PointerMove, Tick, Wheel
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques import named
from seethrough.tasks.kit.base import View

LENS = replace(named("lens"), depth=60.0, radius=0.3)
LEVELS = {"lens": {"technique": {"use": "lens"}}, "plain": {"technique": {"use": "standard"}}}
OF_LENSES = {
    **STUDY,
    "factors": {**FACTORS, "transparency": {"levels": LEVELS}},
    "technique": {"lens": {"depth": 60.0, "radius": 0.3}},
}


def kinds(recorded):
    return [row.split(",")[1] for row in recorded.events.read_text().splitlines()[1:]]


@pytest.fixture(scope="module")
def lens_data(tmp_path_factory):
    """A session half of whose trials are drawn with a lens."""
    folder = tmp_path_factory.mktemp("lens") / "data"
    play_recorded(folder, OF_LENSES, Handling)
    return folder


def of_lens(recorded):
    return recorded.trial.levels["transparency"] == "lens"


def in_the_open(recorded):
    return recorded.trial.levels["scenario"] == "abstract"


@pytest.mark.parametrize("number", range(1, 9))
def test_a_lens_is_replayed_to_the_pixel(lens_data, number, capsys):
    """Pointer, wheel and keys, in the abstract world and where the pointer turns the viewer."""
    words = ["replay", str(lens_data), "--participant", "P01", "--trial", str(number), "--verify"]
    assert cli.main(words) == 0
    assert capsys.readouterr().out.endswith(" 0 different\n")
    recorded = find_trial(lens_data, "P01", number)
    # The second button is none of what a lens takes, and reaches nobody.
    assert ("Wheel" in kinds(recorded)) == of_lens(recorded)
    assert "SecondPress" not in kinds(recorded)
    if not of_lens(recorded):
        return
    states = [frame.view.drawn for frame in replay(recorded)]
    assert states[-1].depth == pytest.approx(60.0 * 1.1**3)  # three steps; q and e undo each other
    if not any(frame.view.captured for frame in replay(recorded)):
        assert len({state.pointer for state in states}) > 5


def test_without_its_wheel_the_lens_is_elsewhere(lens_data, capsys):
    """The pictures notice that an event is missing."""
    trials = [find_trial(lens_data, "P01", number) for number in range(1, 9)]
    recorded = next(r for r in trials if of_lens(r) and in_the_open(r))
    rows = recorded.events.read_text().splitlines(keepends=True)
    fewer = recorded.events.parent / "fewer.csv"
    fewer.write_text("".join(row for row in rows if ",Wheel," not in row))
    assert verify(replace(recorded, events=fewer)) == 1
    assert "another picture than was shown" in capsys.readouterr().out


def test_the_searchlight_of_active_mode_follows_the_pointer(tmp_path, capsys):
    """Said in [technique.dynamic]; its trials are replayed to the pixel, and no wheel is taken."""
    active = {"mode": "active", "radius": 0.3}
    folder = tmp_path / "data"
    play_recorded(folder, {**STUDY, "technique": {"dynamic": active}}, Handling)
    drawn = 0
    for number in range(1, 9):
        recorded = find_trial(folder, "P01", number)
        words = ["replay", str(folder), "--participant", "P01", "--trial", str(number), "--verify"]
        assert cli.main(words) == 0
        assert "Wheel" not in kinds(recorded)
        if recorded.trial.levels["transparency"] == "dynamic" and in_the_open(recorded):
            drawn += len({frame.view.drawn for frame in replay(recorded)}) > 5
    assert drawn == 2
    capsys.readouterr()


def hand_and_view(captured):
    view = View(Scene(()), Camera.__new__(Camera), captured=captured)
    return Hand(LENS, 4 / 3), view


def test_a_used_event_goes_no_further_and_a_captured_pointer_stays_in_the_middle():
    """The lens takes wheel and keys; its moves are left to the task, which orbits by them."""
    hand, view = hand_and_view(captured=False)
    assert not hand.on_event(PointerMove(0, 0.9, 0.2, 0.1, 0), view)
    assert hand.state.pointer == (0.9, 0.2)
    assert hand.on_event(Wheel(0, 0.9, 0.2, -1.0), view)
    assert hand.on_event(KeyPress(0, "e"), view)
    assert not hand.on_event(KeyPress(0, "up"), view)
    assert not hand.on_event(Tick(0), view)
    hand, view = hand_and_view(captured=True)
    hand.on_event(PointerMove(0, 0.9, 0.2, 0.1, 0), view)
    assert hand.state.pointer == pytest.approx((2 / 3, 0.5), abs=1e-3)
