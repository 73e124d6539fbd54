"""Recorded data that were changed after the session: found, and the file and row named."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from pathlib import Path

import pytest
from data_folders import ANSWERS, TRIALS, edit, refused
from disks import nobody
from made_chains import chain, enter
from made_data import Made, make_folder

from seethrough.analysis.errors import DataError
from seethrough.analysis.load.chain import start_of
from seethrough.analysis.load.study import load_study
from seethrough.analysis.page.markdown import as_markdown
from seethrough.analysis.report import Options, make_report


@pytest.fixture(scope="module")
def made(tmp_path_factory) -> Path:
    return make_folder(tmp_path_factory.mktemp("made") / "data", Made(participants=3, trials=2))


@pytest.fixture
def folder(made, tmp_path) -> Path:
    return Path(shutil.copytree(made, tmp_path / "data"))


def test_a_good_chain_is_verified(folder):
    end = chain(folder)
    states = {c.file: c.state for c in load_study(folder).chains}
    assert states[TRIALS] == "verified"
    assert list(states.values()) == ["verified"] * 3
    end.unlink()
    assert {c.file: c.state for c in load_study(folder).chains}[TRIALS] == "open"


def test_one_changed_byte_is_found_and_named(folder):
    chain(folder)
    path = folder / TRIALS
    lines = path.read_text().split("\n")
    lines[9] = lines[9].replace("false", "true", 1)
    path.write_text("\n".join(lines))
    refused(folder, r"P01.*: row 10: changed, or a row before it removed")


def test_rows_cut_off_at_the_end_are_found(folder):
    chain(folder)
    path = folder / TRIALS
    path.write_text("\n".join(path.read_text().split("\n")[:-3]) + "\n")
    refused(folder, r"P01.*: rows at its end were removed or added")


def test_a_changed_sidecar_is_found(folder):
    chain(folder)
    sidecar = (folder / TRIALS).with_suffix(".json")
    sidecar.write_text(sidecar.read_text().replace("0.1.0", "0.1.1"))
    refused(folder, r"P01.*: row 1: this header, or its sidecar, was changed")


def test_a_changed_questionnaire_is_found(folder):
    chain(folder)
    edit(folder / ANSWERS, 4, "value", "4")
    refused(folder, r"P01.*questionnaire_data.csv: changed after the session")


def test_a_forged_questionnaire_is_no_part_of_a_closed_session(folder):
    """Its own answers were listed as it closed: those that lie there without were added later."""
    answers = (folder / ANSWERS).read_bytes()
    (folder / ANSWERS).unlink()
    chain(folder)
    states = {c.file: c.state for c in load_study(folder).chains}
    assert states[TRIALS] == "verified"
    (folder / ANSWERS).write_bytes(answers)
    refused(folder, r"P01.*session-1_questionnaire_data\.csv: added after the session")
    (folder / ANSWERS).unlink()
    later = folder / ANSWERS.replace("session-1", "session-2")
    later.write_bytes(answers)
    refused(folder, r"P01.*session-2_questionnaire_data\.csv: expected its session's trial table")


def test_a_trace_added_to_a_closed_session_is_named(folder):
    chain(folder)
    (folder / TRIALS).with_name("traces").joinpath("session-1_trial-999_events.csv").write_text("")
    refused(folder, r"P01/traces/session-1_trial-999_events\.csv: added after the session")
    (folder / TRIALS).with_name("traces").joinpath("session-1_trial-999_events.csv").unlink()
    (folder / TRIALS).with_name("traces").joinpath("session-10_trial-1_events.csv").write_text("")
    load_study(folder)  # another session's, not this one's


def test_a_changed_byte_in_any_recorded_file_is_found_and_named(folder):
    """Each file of a session in turn: tables, sidecar, traces of trials and of training."""
    chain(folder)
    load_study(folder)
    for path in sorted((folder / TRIALS).parent.rglob("*")):
        if not path.is_file():
            continue
        whole = path.read_bytes()
        # the last letter or digit: still a table, still JSON, and no longer what was written
        at = max(i for i, byte in enumerate(whole) if chr(byte).isalnum())
        path.write_bytes(
            whole[:at] + (b"1" if whole[at : at + 1] != b"1" else b"2") + whole[at + 1 :]
        )
        named = path.with_suffix(".csv") if path.name.endswith("_data.json") else path
        refused(folder, f"{named.relative_to(folder)}: .*changed")
        path.write_bytes(whole)
    load_study(folder)


def test_a_trace_names_its_trial(folder):
    chain(folder)
    (folder / TRIALS).parent.joinpath("traces/session-1_trial-003_camera.csv").write_text("")
    refused(folder, r"trial-003_camera.csv: changed after .*the trial in row 4 of .*P01")


def test_a_removed_trace_is_found_and_data_without_any_say_so(folder):
    chain(folder)
    traces = (folder / TRIALS).parent / "traces"
    (traces / "session-1_trial-002_events.csv").unlink()
    refused(folder, "trial-002_events.csv: removed after the session")
    shutil.rmtree(traces)
    text = as_markdown(make_report(folder, Options()))
    assert "1 without their traces, which are not in this folder" in text


def test_the_report_prints_what_the_chains_say(folder):
    chain(folder)
    text = as_markdown(make_report(folder, Options()))
    rows = (folder / TRIALS).read_text().count("\n") - 1
    assert "of 3 trial tables 3 verified to the end of the session" in text
    assert f"{3 * (2 * rows + 1)} traces as they were recorded" in text


def test_a_session_that_does_not_follow_the_one_before_is_found(folder):
    """Session 2's chain goes on from session 1's end: exchanging or dropping a session shows."""
    chain(folder)
    first = folder / TRIALS
    second = Path(str(first).replace("session-1", "session-2"))
    header = first.read_text().split("\n")[0]
    for follows, pattern in (("", "does not follow the session before"), (None, "")):
        last = first.read_text().rstrip("\n").rpartition(",")[2] if follows is None else follows
        about = {"chain": {"follows": last}}
        start = start_of(about, header)
        second.with_suffix(".json").write_text(
            json.dumps({"chain": {**about["chain"], "start": start}})
        )
        second.write_text(header + "\n")
        if pattern:
            refused(folder, f"session-2.*: {pattern}")
        else:
            load_study(folder)


@pytest.mark.parametrize("how", ["crlf", "bom", "quoted", "no end", "utf-16", "semicolons"])
def test_a_table_saved_again_is_told_from_one_that_was_changed(folder, how):
    """The original is still what it was: one line says so, and a changed cell is named anyway."""
    chain(folder)
    path = folder / TRIALS
    whole = path.read_text()

    def save(text):
        if how == "crlf":
            return text.replace("\n", "\r\n").encode()
        if how in ("bom", "utf-16"):
            return text.encode("utf-8-sig" if how == "bom" else "utf-16")
        if how == "no end":
            return text.removesuffix("\n").encode()
        if how == "semicolons":
            return text.replace(",", ";").encode()
        return text.replace(",dynamic,", ',"dynamic",').encode()

    path.write_bytes(save(whole))
    refused(folder, r"P01.*_trials_data\.csv: saved again by another program; put the original")
    lines = whole.split("\n")
    times = lines[0].split(",").index("time")
    for row in range(1, len(lines) - 1):  # every dynamic time divided by three, as was tried
        cells = lines[row].split(",")
        if "dynamic" in cells:
            cells[times] = repr(float(cells[times]) / 3)
            lines[row] = ",".join(cells)
    path.write_bytes(save("\n".join(lines)))
    refused(folder, r"P01.*_trials_data\.csv: row \d+: changed, or a row before it removed and ")


def test_a_questionnaire_saved_again_is_told_from_one_that_was_changed(folder):
    chain(folder)
    path = folder / ANSWERS
    path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    refused(folder, r"P01.*questionnaire_data.csv: saved again by another program")


def test_an_end_file_that_the_next_session_found_cannot_go(folder):
    """What goes on after a killed session holds its files: without that it had been closed."""
    end = chain(folder)
    first = folder / TRIALS
    second = Path(str(first).replace("session-1", "session-2"))
    header, *rows = first.read_text().rstrip("\n").split("\n")
    chained = {"follows": rows[-1].rpartition(",")[2]}
    start = start_of({"chain": chained}, header)
    second.with_suffix(".json").write_text(json.dumps({"chain": {**chained, "start": start}}))
    second.write_text(header + "\n")
    load_study(folder)
    end.unlink()
    refused(folder, r"P01/.*session-1_end\.json: removed after the session")


def test_a_table_loses_its_chain_only_where_nobody_has_one(folder):
    chain(folder)
    path = folder / TRIALS
    lines = path.read_text().split("\n")
    plain = "\n".join(line.rpartition(",")[0] for line in lines)
    path.write_text(plain)
    refused(folder, "P01.*column = chain: missing, though its sidecar begins a chain")
    path.with_suffix(".json").unlink()
    refused(folder, "P01.*: no chain in table and sidecar, though Seethrough recorded")


def test_ledger_and_folders_are_compared_both_ways(folder):
    chain(folder)
    enter(folder, P01="complete", P02="surplus", P03="live", P04="void", P05="live")
    load_study(folder)  # P03 was completed, and the ledger not yet told; the others left no files
    (folder / "ledger.sqlite").unlink()
    enter(folder, P01="complete", P02="complete", P06="complete")
    refused(folder, "P06: complete in the ledger, but without files: the folder was removed")
    refused(folder, "P03: not in the ledger: the folder was added, or the ledger lost")
    (folder / TRIALS.replace("_trials_data.csv", "_end.json")).unlink()
    refused(folder, r"P01: complete in the ledger, but no end file says so")


@pytest.mark.parametrize("name", ["data/human", "data/human/P01", "data/human/P01/traces", TRIALS])
def test_what_may_not_be_read_is_not_taken_for_absent(made, name):
    """As somebody whom permissions stop, where this is run by root, whom none does."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(shutil.copytree(made, Path(place) / "data"))
        chain(folder)
        for path in (Path(place), *Path(place).rglob("*")):
            path.chmod(0o755)
        (folder / name).chmod(0)
        user, error = nobody(), None
        try:
            if user:
                os.seteuid(user)
            load_study(folder)
        except DataError as caught:
            error = caught
        finally:
            if user:
                os.seteuid(0)
            (folder / name).chmod(0o755)
        assert error is not None and error.lines[0] == f"{name}: cannot be read: Permission denied"


@pytest.mark.parametrize("where", ["P02", "traces/P02", "traces/session-9_trial-001_events.csv"])
def test_what_was_dragged_into_a_participants_folder_is_named(where, folder):
    """Somebody else's folder would be counted no more, where no ledger misses them."""
    chain(folder)
    (folder / "data/human/P02").mkdir(exist_ok=True)
    other = folder / "data/human/P01" / where
    if other.suffix:
        other.write_text("t,event\n")
    else:
        shutil.move(folder / "data/human/P02", other)
    refused(folder, f"data/human/P01/{where}: (a folder: expected files and traces alone|expected a"
                    " trace of a session that is here)")  # fmt: skip
