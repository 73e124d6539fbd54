"""A recorded trial, again: the same frames from the log alone."""

import csv
import shutil
from dataclasses import replace

import numpy as np
import pytest
from recorded_session import DrawnDisplay, play_recorded

from seethrough.experiment import cli
from seethrough.experiment.commands.sessions.replay import _verify as verify
from seethrough.experiment.errors import InputError
from seethrough.experiment.replay.replayer import find_trial, replay


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    folder = tmp_path_factory.mktemp("replay") / "data"
    play_recorded(folder)
    return folder


@pytest.mark.parametrize("number", [1, 2, 3, 4])
def test_replay_draws_the_frames_that_were_shown(data, number, capsys):
    words = ["replay", str(data), "--participant", "P01", "--trial", str(number), "--verify"]
    assert cli.main(words) == 0
    said = capsys.readouterr().out
    assert said.endswith(" 0 different\n")
    assert int(said.split()[0]) >= 3  # the first, the last, and about one a second


def test_a_changed_event_is_found(data, tmp_path, capsys):
    changed = tmp_path / "data"
    shutil.copytree(data, changed)
    recorded = find_trial(changed, "P01", 1)
    rows = recorded.events.read_text().splitlines()
    at = next(i for i, row in enumerate(rows) if ",PointerMove," in row)
    cells = rows[at].split(",")
    cells[4] = repr(float(cells[4]) + 0.05)
    rows[at] = ",".join(cells)
    recorded.events.write_text("\n".join(rows) + "\n")
    words = ["replay", str(changed), "--participant", "P01", "--trial", "1", "--verify"]
    assert cli.main(words) == 2  # the chain refuses it before anything is drawn
    assert "trial-001_events.csv: changed after the session" in capsys.readouterr().err
    assert verify(recorded) == 1  # and so do the pictures, and the camera's way
    said = capsys.readouterr().out
    assert "another picture than was shown" in said and "another camera than was recorded" in said


def test_a_session_without_a_window_is_compared_in_what_it_kept(data, tmp_path, capsys):
    """Simulated participants are shown nothing: camera and answer are there all the same."""
    recorded = find_trial(data, "P01", 1)
    plain = tmp_path / "camera.csv"
    rows = recorded.camera.read_text().splitlines()
    bare = [rows[0], *(f"{row.rpartition(',')[0]}," for row in rows[1:])]
    plain.write_text("\n".join(bare) + "\n")
    simulated = replace(recorded, camera=plain)
    assert verify(simulated) == 0
    said = capsys.readouterr().out
    assert "no picture was kept" in said and f"the camera of {len(rows) - 1} frames" in said
    other = replace(simulated, row={**recorded.row, "answer": "999", "correct": "maybe"})
    assert verify(other) == 1
    assert "answer = '999': the replay makes" in capsys.readouterr().out


def test_a_short_trial_has_enough_pictures_to_compare(data):
    """Twelve frames of a quarter second: the first, the last, and more than one a second."""
    for number in (1, 2, 3, 4):
        recorded = find_trial(data, "P01", number)
        with open(recorded.camera, encoding="utf-8", newline="") as file:
            kept = [bool(row["digest"]) for row in csv.DictReader(file)]
        assert kept[0] and kept[-1] and sum(kept) >= 6


@pytest.mark.parametrize("name", ["../../x", "../human/P01", "P0*", "*", "/", ".", "a/b"])
def test_a_participant_is_no_path(data, name):
    with pytest.raises(InputError, match=r"--participant = .*: expected 1 to 32 letters"):
        find_trial(data, name, 1)


def test_the_camera_path_of_the_replay_is_the_recorded_one(data):
    recorded = find_trial(data, "P01", 1)
    with open(recorded.camera, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    frames = list(replay(recorded))
    assert len(frames) == len(rows)
    moved = [(f, r) for f, r in zip(frames, rows, strict=True) if r["eye_x"]]
    assert len(moved) > 3
    for frame, row in moved:
        eye = [float(row[f"eye_{axis}"]) for axis in "xyz"]
        np.testing.assert_array_equal(frame.view.camera.eye, eye)


def test_the_visibility_table_covers_every_target(data, tmp_path):
    out = tmp_path / "visibility.csv"
    words = ["replay", str(data), "--participant", "P01", "--trial", "1"]
    assert cli.main([*words, "--visibility", str(out)]) == 0
    with open(out, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    scene = next(replay(find_trial(data, "P01", 1))).view.scene
    times = {r["time"] for r in rows}
    assert len(rows) == len(times) * int(scene.targets.sum())
    assert sum(int(r["pixels"]) > 0 for r in rows) > 0
    before = out.read_bytes()
    assert cli.main([*words, "--visibility", str(out)]) == 2
    assert out.read_bytes() == before


def test_a_video_has_the_trial_s_length_and_size(data, tmp_path):
    import imageio_ffmpeg

    out = tmp_path / "trial.mp4"
    words = ["replay", str(data), "--participant", "P01", "--trial", "1", "--video", str(out)]
    assert cli.main(words) == 0
    reader = imageio_ffmpeg.read_frames(str(out))
    about = next(reader)
    reader.close()
    frames = list(replay(find_trial(data, "P01", 1)))
    assert about["size"] == DrawnDisplay.SIZE
    # One frame of 1/30 s at each end is rounding.
    assert about["duration"] == pytest.approx(frames[-1].time - frames[0].time, abs=2 / 30)


def test_a_video_that_cannot_be_written_is_one_line(data, capfd):
    """Before the encoder says it in many; no file can be made in /proc."""
    words = ["replay", str(data), "--participant", "P01", "--trial", "1"]
    assert cli.main([*words, "--video", "/proc/a.mp4"]) == 2
    said = "seethrough: --video = /proc/a.mp4: cannot be written: No such file or directory\n"
    assert capfd.readouterr().err == said


def test_replay_changes_nothing(data):
    before = {p: p.read_bytes() for p in data.rglob("*") if p.is_file()}
    words = ["replay", str(data), "--participant", "P01", "--trial", "2", "--verify"]
    cli.main(words)
    assert {p: p.read_bytes() for p in data.rglob("*") if p.is_file()} == before


@pytest.mark.parametrize(
    ("participant", "trial", "message"),
    [("P02", 1, "P02: no such participant"), ("P01", 77, "--trial = 77: no such trial recorded")],
)
def test_what_is_not_there_is_named(data, participant, trial, message):
    with pytest.raises(InputError, match=message):
        find_trial(data, participant, trial)
