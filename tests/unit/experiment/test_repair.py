"""A folder that two sessions wrote at once: what counts is chosen, nothing is lost, chains hold."""

import csv
import json
import os
import re

import pytest

from seethrough.analysis.errors import DataError
from seethrough.analysis.load.study import load_study
from seethrough.experiment import cli
from seethrough.experiment.record.chain import verify
from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.session.resume import starting_point
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import session_for
from seethrough.experiment.study.shown.described import design_entry
from seethrough.renderer.events import Tick
from seethrough.tasks.kit.base import Outcome

STUDY = load("demo")
TRIALS = [t for s in session_for(1, STUDY.plan) for t in s.trials]


def began(data):
    start = starting_point(STUDY, data, "human", "P01", 1)
    made = {"study_sha256": STUDY.digest()}
    who = Who(STUDY.general.name, "P01", "human", 1, made, start.session, design_entry(STUDY))
    return FileRecorder(data, who, attempts=start.attempts), start


def play(recorder, numbers):
    for number in numbers:
        begin(recorder, number)
        outcome = Outcome("1", "1", True, count_error=0)
        trial = TRIALS[number - 1]
        recorder.trial_ends(TrialRecord(trial, outcome, 1, 0, 2.0, 0, False, 9, 0, 0.1, 0.0, 0.0))


def begin(recorder, number):
    recorder.trial_begins(TRIALS[number - 1])
    recorder.event(Tick(1.0))


def ask(recorder, item):
    recorder.answers([{"item": item, "value": "1"}])


@pytest.fixture
def twice(tmp_path):
    """Session 1 is in its third trial as session 2 goes on; both play to the end."""
    data = tmp_path / "data"
    one, _ = began(data)
    ask(one, "consent")
    play(one, (1, 2))
    begin(one, 3)
    two, start = began(data)
    assert start.session == 2
    first = min({*range(1, 9)} - start.done)
    play(two, range(first, len(TRIALS) + 1))
    ask(one, "preference")
    play(one, range(4, len(TRIALS) + 1))
    ask(two, "preference")
    for recorder in (one, two):
        recorder.close("complete")
    return data


def files(folder):
    return {p.relative_to(folder): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def sessions(data):
    rows = []
    for table in sorted(data.glob("data/human/P01/*_trials_data.csv")):
        rows += [int(r["session"]) for r in csv.DictReader(table.read_text().splitlines())]
    return rows


def test_who_was_played_twice_is_named_with_what_there_is_to_choose(twice, capsys):
    assert verify(twice / "data/human/P01")
    assert cli.main(["repair", str(twice)]) == 1
    said = capsys.readouterr().out.splitlines()
    assert said[0] == "P01: played twice at once; which counts?"
    when = r"began 20\d\d-\S+Z"
    left = len(TRIALS) - 1
    assert re.fullmatch(rf"  --keep 1: session 1 \({when}, {left} trials\), complete", said[1])
    assert re.fullmatch(
        rf"  --keep 2: session 1 \({when}, 2 trials\), then session 2 \({when}, \d+ trials\), co.*",
        said[2],
    )


@pytest.mark.parametrize(("keep", "counts"), [(1, {1}), (2, {1, 2})])
def test_the_branch_that_counts_is_whole_and_the_folder_as_it_was_is_kept(
    twice, keep, counts, capsys
):
    home = twice / "data/human/P01"
    before = files(home)
    with pytest.raises(DataError):
        load_study(twice)
    assert cli.main(["repair", str(twice), "--participant", "P01", "--keep", str(keep)]) == 0
    assert files(twice / "aside/human/P01-1") == before
    assert verify(home) == [] and set(sessions(twice)) == counts
    study = load_study(twice)
    assert all(chain.state in ("verified", "open") for chain in study.chains)
    (line,) = study.repairs
    assert line.startswith("P01 was played twice at once: session 1 (")
    assert "all of it is kept in aside/human/P01-1 (repaired 20" in line
    assert sessions(twice).count(1) == (2 if keep == 2 else len(TRIALS) - 1)
    answers = [r for p in home.glob("*_questionnaire_data.csv") for r in
               csv.DictReader(p.read_text().splitlines())]  # fmt: skip
    assert [r["item"] for r in answers] == ["consent", "preference"]
    capsys.readouterr()
    out = twice.parent / "out"
    assert cli.main(["export", str(twice), "--format", "wide", "--out", str(out)]) == 0
    assert "P01: played twice at once, repaired" in capsys.readouterr().out
    assert cli.main(["repair", str(twice)]) == 0
    assert "nobody was played twice" in capsys.readouterr().out


@pytest.mark.parametrize("after", [0, 1, 2])
def test_a_repair_that_was_broken_off_at_any_renaming_is_done_again(
    after, twice, monkeypatch, capsys
):
    """Between the two the participant has no folder: the next `repair` gives them the new one."""
    home, rename, left = twice / "data/human/P01", os.rename, [after]

    def stops(old, new):
        if not left[0]:
            raise KeyboardInterrupt
        left[0] -= 1
        rename(old, new)

    words = ["repair", str(twice), "--participant", "P01", "--keep", "2"]
    with monkeypatch.context() as patch:
        patch.setattr(os, "rename", stops)
        cli.main(words)
    assert home.exists() == (after != 1)
    capsys.readouterr()
    cli.main(words)
    assert ("P01: a repair was broken off: it is done now" in capsys.readouterr().out) == (
        after == 1
    )
    assert verify(home) == [] and set(sessions(twice)) == {1, 2}
    assert {p.name for p in (twice / "aside/human").iterdir()} == {"P01-1"}


def test_what_was_set_aside_is_withdrawn_too(twice, capsys):
    from seethrough.experiment.ledger.ledger import Ledger
    from seethrough.experiment.ledger.ledger_plan import plan_of
    from seethrough.experiment.ledger.ledger_slots import moment

    now = moment("2026-01-02T03:04:05Z")
    with Ledger.open(twice, "", plan_of(STUDY), now) as ledger:
        ledger.reserve("P01", now)
    assert cli.main(["repair", str(twice), "--participant", "P01", "--keep", "1"]) == 0
    assert cli.main(["withdraw", str(twice), "--participant", "P01", "--yes"]) == 0
    assert not list((twice / "aside").rglob("*.csv")) and not list((twice / "data").rglob("*.csv"))


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["--participant", "P02"], "--participant = P02: no such participant"),
        (["--keep", "1"], "--keep = 1: expected --participant with it"),
        (["--participant", "P01", "--keep", "3"], "--keep = 3: expected one of 1, 2"),
    ],
)
def test_bad_words_change_nothing(twice, words, line, capsys):
    before = files(twice)
    assert cli.main(["repair", str(twice), *words]) == 2
    assert line in capsys.readouterr().err
    assert files(twice) == before


def test_a_file_that_was_changed_since_cannot_be_cut_and_nothing_happens(twice, capsys):
    (sidecar,) = twice.glob("data/human/P01/*session-2_trials_data.json")
    about = json.loads(sidecar.read_text())
    (name,) = [n for n in about["chain"]["holds"] if n.endswith("questionnaire_data.csv")]
    path = sidecar.parent / name
    path.write_text(path.read_text().replace("consent", "consemt"))
    before = files(twice)
    assert cli.main(["repair", str(twice), "--participant", "P01", "--keep", "2"]) == 2
    assert "was changed since the session that follows began" in capsys.readouterr().err
    assert {n: b for n, b in files(twice).items() if n.name != "locks.sqlite"} == before
