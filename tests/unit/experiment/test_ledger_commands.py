"""run, status and withdraw with a ledger: what the experimenter sees and what is left."""

import json
import re
import shutil
from datetime import UTC, datetime

import pytest

from seethrough.analysis.errors import DataError
from seethrough.analysis.load.whole import verified
from seethrough.experiment import cli
from seethrough.experiment.commands.sessions import withdraw as withdraw_module
from seethrough.experiment.errors import InputError
from seethrough.experiment.ledger import ledger_lock
from seethrough.experiment.ledger.ledger import Ledger
from seethrough.experiment.ledger.ledger_files import withdrawn
from seethrough.experiment.ledger.ledger_plan import plan_of
from seethrough.experiment.record.chain import seal_of
from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.study.config import find, load

STUDY = load("demo")
NOW = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)


@pytest.fixture
def sessions(monkeypatch, tmp_path):
    """Runs `seethrough run` with sessions that end as they are told to, and record who came."""
    came = []

    def session(study, participant, slot, source, data, clock, guard):
        how = ends.pop(0) if ends else "complete"
        if how == "no display":
            raise InputError("display: no window can be opened")
        came.append((participant, slot, source))
        number = sum(c[0] == participant for c in came)
        made = {"study_sha256": study.digest()}
        who = Who(study.general.name, participant, source, slot, made, number)
        FileRecorder(data, who).close(how)
        return how

    ends = []
    monkeypatch.setattr("seethrough.experiment.session.live.play_in_window", session)

    def run(*words, how="complete"):
        ends[:] = [how]
        return cli.main(["run", "demo", "--data", str(tmp_path), *words])

    run.came = came
    return run


def entries(folder):
    with Ledger.existing(folder) as ledger:
        return [(e.participant, e.slot, e.status) for e in ledger.entries()]


def test_slots_come_from_the_ledger_and_drop_outs_are_given_out_again(sessions, tmp_path, capsys):
    assert sessions("--next") == 0
    assert sessions("--next", how="left") == 1
    assert sessions("--next") == 0
    assert sessions.came == [("P01", 1, "human"), ("P02", 2, "human"), ("P03", 3, "human")]
    assert entries(tmp_path) == [("P01", 1, "complete"), ("P02", 2, "live"), ("P03", 3, "complete")]
    assert sessions("--participant", "P02") == 0  # comes back, in their own slot
    assert sessions.came[-1] == ("P02", 2, "human")
    assert cli.main(["withdraw", str(tmp_path), "--participant", "P02", "--yes"]) == 0
    assert not (tmp_path / "data" / "human" / "P02").exists()
    assert sessions("--next") == 0
    assert sessions.came[-1] == ("P04", 2, "human")  # a withdrawn id is never used again
    capsys.readouterr()
    assert sessions("--participant", "P01") == 2
    assert "P01: complete since" in (said := capsys.readouterr().err) and "one is P05" in said


def test_a_session_that_never_began_takes_no_slot(sessions, tmp_path, capsys):
    assert sessions("--next", how="no display") == 2
    assert entries(tmp_path) == []
    assert sessions("--next") == 0
    assert sessions.came == [("P01", 1, "human")]


def test_a_pilot_takes_no_slot(sessions, tmp_path):
    assert sessions("--next", "--pilot") == 0
    assert sessions.came == [("P01", 1, "pilot")]
    assert not (tmp_path / "ledger.sqlite").exists()


def test_a_changed_study_is_refused_and_nothing_is_written(sessions, tmp_path, capsys):
    sessions("--next")
    changed = tmp_path / "changed.toml"
    text = find("demo")
    changed.write_text(text.read_text("utf-8").replace("objects = 60", "objects = 61"), "utf-8")
    capsys.readouterr()
    assert cli.main(["run", str(changed), "--data", str(tmp_path), "--next"]) == 2
    said = capsys.readouterr().err
    assert "abstract.objects = 61: expected 60, as in the study that this ledger began" in said
    assert said.count("\n") == 1 and len(sessions.came) == 1


def test_a_lost_ledger_is_made_again_from_the_files(sessions, tmp_path, capsys):
    for how in ("complete", "left", "complete"):
        sessions("--next", how=how)
    before = entries(tmp_path)
    (tmp_path / "ledger.sqlite").unlink()
    assert sessions("--next") == 0
    assert entries(tmp_path) == [*before, ("P04", 4, "complete")]
    assert "P02: not in the ledger: entered as live, slot 2" in capsys.readouterr().err


def test_a_session_whose_end_the_ledger_missed_is_completed(sessions, tmp_path, capsys):
    sessions("--next", how="left")
    (end,) = (tmp_path / "data" / "human" / "P01").glob("*_end.json")
    said = json.loads(end.read_text("utf-8"))
    said["status"] = "complete"
    end.write_text(json.dumps({**said, "seal": seal_of(said)}), "utf-8")  # a crash right after this
    assert cli.main(["status", str(tmp_path)]) == 0
    assert "P01: complete on disk, live in the ledger" in capsys.readouterr().out
    assert entries(tmp_path) == [("P01", 1, "complete")]


def test_free_slots_are_those_that_nobody_holds(tmp_path, capsys):
    with Ledger.open(tmp_path, "", plan_of(STUDY), NOW) as ledger:
        ledger.reserve("A", NOW)
    assert cli.main(["status", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert re.search(r"slots     0 complete, 1 open( \(1 stale\))?, 3 free, 0 void entries", said)


def test_status_says_who_has_what_and_what_is_next(tmp_path, capsys):
    with Ledger.open(tmp_path, "", plan_of(STUDY), NOW) as ledger:
        for name in ("A", "B", "C"):
            ledger.reserve(name, NOW)
        ledger.complete("A", NOW)
        ledger.void("B", "felt ill\x1b[2J", NOW)
    assert cli.main(["status", str(tmp_path)]) == 1
    said = capsys.readouterr().out
    assert "files     A: complete in the ledger, but without files" in said
    assert "files     C: open, no files: never begun, or they were removed" in said
    assert "study     demo: 4 participants wanted, 4 rows of the design" in said
    assert "slots     1 complete, 1 open (1 stale), 2 free, 1 void entries" in said
    assert "balance   completed rows differ by 1\n          row 1: 1 complete, 0 open" in said
    assert "open      C, slot 3, since 2026-01-02T03:04:05.000Z (stale: its slot may" in said
    assert "void      B, slot 2, since 2026-01-02T03:04:05.000Z: felt ill\\x1b[2J" in said
    assert "next      seethrough run demo --next: slot 2, row 2\n" in said


def test_withdrawing_asks_and_removes_only_when_told(sessions, tmp_path, capsys, monkeypatch):
    sessions("--next")
    folder = tmp_path / "data" / "human" / "P01"
    words = ["withdraw", str(tmp_path), "--participant", "P01"]
    assert cli.main(words) == 2  # nobody to ask
    assert "--yes: expected, where nobody can be asked" in capsys.readouterr().err
    monkeypatch.setattr("sys.stdin.isatty", lambda: True, raising=False)
    for answer, status in (("no", 1), ("p01", 1), ("P01", 0)):
        assert folder.exists()
        monkeypatch.setattr("builtins.input", lambda question, answer=answer: answer)
        assert cli.main([*words, "--why", "by mail"]) == status
    assert not folder.exists() and (tmp_path / "data" / "human").exists()
    with Ledger.existing(tmp_path) as ledger:
        (entry,) = ledger.entries()
    assert (entry.status, entry.why) == ("void", "withdrawn: by mail")
    assert entry.changed.startswith(datetime.now(UTC).strftime("%Y-"))
    assert cli.main(["withdraw", str(tmp_path), "--participant", "P09", "--yes"]) == 2
    assert "participant = P09: not in the ledger" in capsys.readouterr().err
    assert cli.main(["withdraw", str(tmp_path), "--participant", "../..", "--yes"]) == 2


def test_keeping_the_files_frees_the_slot_all_the_same(sessions, tmp_path):
    sessions("--next")
    words = ["withdraw", str(tmp_path), "--participant", "P01", "--yes", "--keep-files"]
    assert cli.main(words) == 0
    assert (tmp_path / "data" / "human" / "P01").exists()
    assert entries(tmp_path) == [("P01", 1, "void")]
    assert [p.name for p in verified(tmp_path).people] == ["P01"]  # nobody took data back


@pytest.mark.parametrize("how", ["from a copy", "half removed", "the ledger lost"])
def test_data_of_who_was_withdrawn_are_never_counted(how, sessions, tmp_path, capsys, monkeypatch):
    """A backup that is put back, or a removal that failed: report, seal, export, status refuse."""
    sessions("--next")
    sessions("--next")
    own, copy = tmp_path / "data" / "human" / "P01", tmp_path.with_name(f"{tmp_path.name}-copy")
    shutil.copytree(own, copy)
    words = ["withdraw", str(tmp_path), "--participant", "P01", "--yes"]
    if how == "half removed":

        def fails(folder):
            raise OSError(5, "Input/output error", str(folder))

        with monkeypatch.context() as patch:
            patch.setattr(withdraw_module.shutil, "rmtree", fails)
            assert cli.main(words) == 2
        assert "expected to be withdrawn again" in capsys.readouterr().err
    else:
        assert cli.main(words) == 0
        assert [p.name for p in verified(tmp_path).people] == ["P02"]
        shutil.copytree(copy, own)
    if how == "the ledger lost":
        (tmp_path / "ledger.sqlite").unlink()
    with pytest.raises(DataError, match=r"P01: withdrawn \(20..-..-..\), but with files: expected"):
        verified(tmp_path)
    assert cli.main(["seal", str(tmp_path)]) == 2
    assert cli.main(["status", str(tmp_path)]) == (2 if how == "the ledger lost" else 1)
    if how != "the ledger lost":
        assert cli.main(words) == 0
        assert [p.name for p in verified(tmp_path).people] == ["P02"]


def test_a_list_of_who_was_withdrawn_that_cannot_be_read_is_no_empty_one(sessions, tmp_path):
    sessions("--next")
    path = tmp_path / "withdrawn.csv"
    for broken in (b"participant,slot,withdrawn\nP01\n", b"\xff\xfe\n"):
        path.write_bytes(broken)
        with pytest.raises(DataError, match=r"withdrawn\.csv"):
            verified(tmp_path)
        with pytest.raises(InputError, match=r"withdrawn\.csv"):
            withdrawn(tmp_path)
    path.unlink()
    path.symlink_to(tmp_path / "gone")
    with pytest.raises(DataError, match=r"withdrawn\.csv: a link that leads nowhere"):
        verified(tmp_path)
    with pytest.raises(InputError, match=r"withdrawn\.csv"):
        withdrawn(tmp_path)


def test_status_names_what_was_changed_in_the_files(sessions, tmp_path, capsys):
    sessions("--next")
    sessions("--next")
    assert cli.main(["status", str(tmp_path)]) == 0
    assert "files     as they were written: chains hold" in capsys.readouterr().out
    (table,) = (tmp_path / "data" / "human" / "P02").glob("*_trials_data.csv")
    table.write_text(table.read_text("utf-8").replace("row_id", "row_ld", 1), "utf-8")
    assert cli.main(["status", str(tmp_path)]) == 1
    said = capsys.readouterr().out
    changed = f"{table.relative_to(tmp_path)}: row 1: this header, or its sidecar, was changed"
    assert f"files     {changed}" in said


def test_status_names_the_study_as_run_takes_it(sessions, tmp_path, capsys):
    """A shipped one by its name, one's own by its path, quoted for a shell; gone: by its name."""
    own = tmp_path / "my studies" / "mine.toml"
    own.parent.mkdir()
    own.write_bytes(find("demo").read_bytes().replace(b'name = "demo"', b'name = "mine"'))
    data = tmp_path / "data"
    assert cli.main(["run", str(own), "--next", "--data", str(data)]) == 0
    capsys.readouterr()
    for said in (f"seethrough run '{own}' --next: slot 2", "[the file of the study mine] --next"):
        assert cli.main(["status", str(data)]) == 0
        assert said in capsys.readouterr().out.splitlines()[-1]
        own.unlink(missing_ok=True)


def left_by(data, source, participant):
    """The files of a session without a slot."""
    who = Who(STUDY.general.name, participant, source, 1, {"study_sha256": STUDY.digest()}, 1)
    FileRecorder(data, who).close("complete")
    return data / "data" / source / participant


def test_who_has_no_slot_is_withdrawn_without_a_ledger(tmp_path, capsys):
    simulated, other = (left_by(tmp_path, "simulated", name) for name in ("S01", "S02"))
    pilot = left_by(tmp_path, "pilot", "P01")
    withdraw = ["withdraw", str(tmp_path), "--participant"]
    with pytest.raises(InputError, match="--yes: expected"):
        withdraw_module.run(cli._parser(withdraw).parse_args([*withdraw, "S01"]))
    assert cli.main([*withdraw, "S01", "--yes"]) == 0
    assert "S01: 3 files of a simulated participant removed" in capsys.readouterr().out
    assert not simulated.exists() and other.exists() and pilot.exists()
    assert cli.main([*withdraw, "P01", "--yes"]) == 0 and not pilot.exists()
    assert cli.main([*withdraw, "P07", "--source", "simulated", "--yes"]) == 2
    assert cli.main([*withdraw, "P07", "--yes"]) == 2  # a person's slot: in the ledger alone
    said = capsys.readouterr().err.splitlines()
    assert "no such simulated participant" in said[0] and "no ledger" in said[1]
    left_by(tmp_path, "pilot", "S02")
    assert cli.main([*withdraw, "S02", "--yes"]) == 2 and other.exists()
    assert "--source: expected one of pilot, simulated" in capsys.readouterr().err


def test_a_removed_folder_is_missed(sessions, tmp_path, capsys):
    for _ in range(3):
        sessions("--next")
    shutil.rmtree(tmp_path / "data" / "human" / "P02")
    capsys.readouterr()
    assert cli.main(["status", str(tmp_path)]) == 1
    said = capsys.readouterr().out
    assert (
        "files     P02: complete in the ledger, but without files: the folder was removed" in said
    )
    assert "P01" not in said and "P03" not in said


def test_a_ledger_that_says_complete_is_held_against_the_end_on_disk(sessions, tmp_path, capsys):
    sessions("--next", how="left")
    with Ledger.existing(tmp_path) as ledger:
        ledger.complete("P01", NOW)
    assert cli.main(["status", str(tmp_path)]) == 1
    assert "files     P01: complete in the ledger, but no end file says so" in (
        capsys.readouterr().out
    )


def test_a_withdrawn_id_stays_withdrawn_also_where_the_ledger_was_lost(sessions, tmp_path, capsys):
    sessions("--next", how="left")
    assert cli.main(["withdraw", str(tmp_path), "--participant", "P01", "--yes"]) == 0
    for lost in tmp_path.glob("ledger.sqlite*"):
        lost.unlink()
    capsys.readouterr()
    assert sessions("--participant", "P01") == 2
    said = capsys.readouterr().err
    assert "P01: withdrawn, not in the ledger: entered as void" in said
    assert re.search(r"--participant = P01: void since 20\S+Z \(withdrawn\); the next free", said)
    assert sessions("--next") == 0
    assert sessions.came[-1] == ("P02", 1, "human")


def test_what_is_no_list_of_the_withdrawn_is_one_line(sessions, tmp_path, capsys):
    (tmp_path / "withdrawn.csv").write_text("participant,slot,withdrawn\nP01,one,today\n")
    assert sessions("--next") == 2
    said = capsys.readouterr().err
    assert "withdrawn.csv: expected participant, slot and date in each row" in said
    assert said.count("\n") == 1


def test_who_is_being_played_is_not_withdrawn(sessions, tmp_path, capsys, monkeypatch):
    sessions("--next", how="left")
    monkeypatch.setattr(ledger_lock, "POLL", 0.05)
    monkeypatch.setattr(ledger_lock, "BEAT", 0.05)
    with Ledger.existing(tmp_path) as ledger, ledger_lock.playing(ledger.locks(), "P01"):
        assert cli.main(["withdraw", str(tmp_path), "--participant", "P01", "--yes"]) == 2
    assert "--participant = P01: being played at" in capsys.readouterr().err
    assert entries(tmp_path) == [("P01", 1, "live")]
    assert (tmp_path / "data" / "human" / "P01").exists()
