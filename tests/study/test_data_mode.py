"""Data mode against visual mode: the same session, played with the eyes open and from tables."""

import time

import pytest

from seethrough.experiment import cli
from seethrough.experiment.display.clock import SimulatedClock
from seethrough.experiment.display.offscreen import OffscreenDisplay
from seethrough.experiment.people.fitted.crowds import Crowds
from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.people.runs import batch
from seethrough.experiment.people.runs.data_mode import Played, play_session
from seethrough.experiment.people.runs.pool import LazyDraw, Pool
from seethrough.experiment.people.simulated_input import SimulatedInput
from seethrough.experiment.session.session import run_session
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import SIMULATED, generator
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.skills.profile import AVERAGE

LATTICE = frozenset({"motor_noise"})  # without it a participant stands on the lattice: exact tables


def with_open_eyes(context, study, slot, seed, without):
    """A whole session through the offscreen display, as `seethrough simulate` plays it."""
    clock = SimulatedClock()
    display = OffscreenDisplay(context, (study.display.width, study.display.height), clock)
    person = SimulatedParticipant(generator(seed, (SIMULATED, slot)), without=without)
    played = Played(study.general.name, f"S{slot:02d}", slot, keep=True)
    seat = SimulatedInput(person, display, clock)
    run_session(study, slot, Surroundings(display, seat, clock, played, TASKS))
    return played


def test_where_tables_are_exact_a_whole_session_is_the_same_event_for_event(context):
    """All four tasks at both levels, in the study's own scenes, drawn by the real renderer."""
    study = load("demo")
    eyes = with_open_eyes(context, study, 1, 5, LATTICE)
    tables = play_session(study, 1, 5, Pool(study, 0, LazyDraw(study)),
                          without=LATTICE, keep=True)  # fmt: skip
    assert eyes.status == tables.status == "complete"
    assert {(r.trial.task, r.trial.levels["transparency"]) for r in eyes.records} == {
        (task, level) for task in study.tasks() for level in ("standard", "dynamic")
    }
    for record, ours, theirs in zip(eyes.records, tables.events, eyes.events, strict=True):
        assert ours == theirs, record.trial.task
    assert tables.records == eyes.records
    assert tables.trials == eyes.trials and len(eyes.trials) == 8
    assert tables.questions == eyes.questions and len(eyes.questions) == 14


def test_a_study_of_sixteen_in_data_mode_is_the_same_on_two_workers(tmp_path, monkeypatch):
    """What CI plays: 16 participants, two processes against one, down to the last byte."""
    monkeypatch.setattr("seethrough.experiment.people.runs.batch_files.CHUNK", 4)
    tables = tmp_path / "tables.db"
    folders = []
    for workers in ("1", "2"):
        out = tmp_path / workers
        words = ["simulate", "demo", "--mode", "data", "--participants", "16", "--pool", "1",
                 "--tables", str(tables), "--out", str(out), "--workers", workers]  # fmt: skip
        assert cli.main(words) == 0
        folder = out / "data" / "simulated"
        folders.append({p.relative_to(folder): p.read_bytes() for p in folder.glob("*/*")})
    assert folders[0] == folders[1] and len(folders[0]) == 4 * 4


def test_a_crowd_is_the_same_on_two_workers(tmp_path, monkeypatch):
    """Row by row, whoever played whom; that workers played takes time of theirs."""
    monkeypatch.setattr("seethrough.experiment.people.fitted.crowds.CHUNK", 2)
    study, played = load("demo"), []
    for workers in (1, 2):
        with Crowds(study, 1, tmp_path / "tables.db", workers) as crowds:
            before = crowds.seconds() - time.process_time()
            played.append(crowds.crowd(3, 5).play(AVERAGE, ("count", "pattern")))
            assert (crowds.seconds() - time.process_time() - before > 0.05) == (workers == 2)
    assert played[0] == played[1] and {r["participant"] for r in played[0]} == {1, 2, 3, 4, 5}


@pytest.mark.parametrize(
    "words",
    [
        "simulate demo --out {t}/x --participants 1",
        "simulate demo --out {t}/x --participants 1 --mode data --pool 1",
        "calibrate demo --out {t}/c.toml --tables {t}/t.db --pool 1 --participants 3",
    ],
)
def test_without_opengl_a_command_that_draws_says_so_in_one_line(
    tmp_path, capsys, monkeypatch, words
):
    def none():
        raise RuntimeError("OpenGL 3.3: not available, expected a graphics driver")

    monkeypatch.setattr("seethrough.renderer.gpu.device.context.standalone", none)
    monkeypatch.setattr(batch, "_made", [])
    assert cli.main(words.format(t=tmp_path).split()) == 2
    told = [line for line in capsys.readouterr().err.splitlines() if " after " not in line]
    assert told == ["seethrough: OpenGL 3.3: not available, expected a graphics driver"]
