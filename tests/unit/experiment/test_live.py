"""A session in a window, with a window that shows nothing: what its sidecar says, and when."""

import json
from dataclasses import asdict, replace
from types import SimpleNamespace

import pytest

from seethrough.experiment.commands.sessions import simulate
from seethrough.experiment.display.clock import RealClock
from seethrough.experiment.errors import InputError
from seethrough.experiment.people.persons.profile_file import find
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.session import live
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import Trial
from seethrough.tasks.kit.base import Outcome

STUDY = load("demo")


class NoWindow:
    """What `play_in_window` asks of a window."""

    def __init__(self, *_):
        self.stage, self.context, self.aspect = SimpleNamespace(), None, 4 / 3
        self.declared, self.measured, self.period = 60.0, 75.0, 1 / 75

    def describe(self):
        return {"window": "no"}

    def waiting(self, work):
        return work()

    def close(self):
        pass


@pytest.fixture(autouse=True)
def no_window(monkeypatch):
    monkeypatch.setattr(live, "Window", NoWindow)
    monkeypatch.setattr(live, "_simulated", lambda *_: None)
    monkeypatch.setattr(live, "run_session", lambda *_: "complete")


def test_a_model_that_cannot_be_kept_begins_no_session(tmp_path, monkeypatch):
    def full(*_):
        raise InputError("models/x.npz: cannot be written: No space left on device")

    monkeypatch.setattr(live, "keep", full)
    with pytest.raises(InputError, match="No space left"):
        live.play_in_window(STUDY, "P01", 1, "human", tmp_path, RealClock())
    assert not list(tmp_path.rglob("*_trials_data.*"))


def test_a_watched_simulation_says_what_it_takes_to_simulate_it_again(tmp_path):
    profile, without = find("hasty"), frozenset({"slips", "crowding"})
    assert simulate._watch(STUDY, 1, 7, tmp_path, profile, without) == 0
    (sidecar,) = tmp_path.glob("data/simulated/S01/*_trials_data.json")
    told = json.loads(sidecar.read_text("utf-8"))["provenance"]
    assert told["simulation_seed"] == 7 and told["without"] == ["crowding", "slips"]
    assert told["profile"] == asdict(profile) and len(told["code"]) == 12
    assert told["display"] == {"window": "no"} and told["speed"] == 1.0


def test_a_person_s_session_says_nothing_of_a_simulation(tmp_path):
    live.play_in_window(STUDY, "P01", 1, "human", tmp_path, RealClock())
    (sidecar,) = tmp_path.glob("data/human/P01/*_trials_data.json")
    assert not {"profile", "without"} & set(json.loads(sidecar.read_text("utf-8"))["provenance"])


def test_the_measured_period_counts_and_a_rate_that_was_not_declared_is_said(
    tmp_path, monkeypatch, capsys
):
    worlds = []
    monkeypatch.setattr(live, "run_session", lambda *words: worlds.append(words[2]) or "complete")
    live.play_in_window(STUDY, "P01", 1, "human", tmp_path, RealClock())
    assert worlds[0].period == 1 / 75
    said = "display: 75.0 Hz measured, 60 declared: NOT AS DECLARED"
    assert said in capsys.readouterr().err


@pytest.mark.parametrize(("source", "pilot"), [("human", False), ("pilot", True)])
def test_a_pilot_runs_line_has_its_own_colour(tmp_path, monkeypatch, source, pilot):
    worlds = []
    monkeypatch.setattr(live, "run_session", lambda *words: worlds.append(words[2]) or "complete")
    live.play_in_window(STUDY, "P01", 1, source, tmp_path, RealClock())
    assert worlds[0].display.stage.pilot is pilot


def test_the_terminal_shows_trial_answer_time_and_missed_frames(capsys):
    trial = Trial(7, 1, 2, 1, {"view": "dynamic"}, "count", "s", (1, 1))
    outcome = Outcome("12", "14", False, count_error=-2)
    record = TrialRecord(trial, outcome, 14, 10.0, 52.25, 0.0, False, 2500, 3, 0.05, 1.0, 1.0)
    live.say(record)
    live.say(replace(record, outcome=None, timed_out=True))
    first, second = capsys.readouterr().err.splitlines()
    assert first.split() == ("trial 7 dynamic count 12 42.2 s, 3/2500 frames missed".split())
    assert "timed out" in second


def test_a_session_that_goes_on_says_and_records_what_of_the_program_changed(
    tmp_path, monkeypatch, capsys
):
    def version(made, **other):
        versions = {**made["versions"], "numpy": "1.2.3"}
        return {**made, "versions": versions, "program_sha256": "f" * 64}

    monkeypatch.setattr(live, "run_session", lambda *_: "left")
    real = live.provenance
    monkeypatch.setattr(live, "provenance", lambda *a, **k: version(real(*a, **k)))
    live.play_in_window(STUDY, "P01", 1, "human", tmp_path, RealClock())
    monkeypatch.setattr(live, "provenance", real)
    capsys.readouterr()
    for _ in range(2):
        live.play_in_window(STUDY, "P01", 1, "human", tmp_path, RealClock())
    said = capsys.readouterr().err.splitlines()
    now = real(STUDY, {})
    changed = [
        f"program: {'f' * 12}, now {now['program_sha256'][:12]}",
        f"numpy: 1.2.3, now {now['versions']['numpy']}",
    ]
    found = [x for x in said if x.startswith("since the session before: ")]
    assert found == [f"since the session before: {line}" for line in changed]  # once, not twice
    home = tmp_path / "data/human/P01"
    recorded = [
        json.loads(path.read_text("utf-8"))["provenance"].get("changed_since")
        for path in sorted(home.glob("*_trials_data.json"))
    ]
    assert recorded == [None, changed, []]
