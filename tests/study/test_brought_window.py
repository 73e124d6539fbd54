"""What a study brings along, and what is clicked, in a window with real keys and a real mouse."""

from __future__ import annotations

import csv
import shutil
import subprocess
import time
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from desktop import Desktop, wait_until
from player import ARTEFACTS, START, TRIAL, open_session, trials_of
from toy_study import toy_study

from seethrough import registry
from seethrough.experiment import cli
from seethrough.experiment.files import trust
from seethrough.experiment.study.beside import plugin_files
from seethrough.experiment.study.config import load
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.renderer.scene.projection import to_camera, to_pixels
from seethrough.tasks.catalog import TASKS

ROOT = Path(__file__).parents[2]
POINTED = """
[study]
name = "pointed"
title = "Pointing"
description = "Things to click, few of them."
participants = 2
seed = 3
[factors.view]
levels.standard = { technique.use = "standard" }
levels.lens = { technique.use = "lens" }
[world]
use = "abstract"
[world.abstract]
objects = 12
target_share = [0.3, 0.4]
[design]
tasks = ["select"]
trials = 2
[practice]
trials = 0
[questions]
remarks = { when = "end" }
"""


@pytest.fixture
def desktop():
    with Desktop() as screen:
        yield screen


def rows(data: Path) -> list[dict[str, str]]:
    """The trials of P01."""
    (table,) = data.glob("data/human/P01/*trials_data.csv")
    with open(table, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_toys_of_every_kind_are_played_by_hand(desktop, tmp_path, monkeypatch):
    """A stranger's world, task, technique and question, to the end by keyboard; replayed after."""
    monkeypatch.setenv(trust.HOME, str(tmp_path / "home"))
    monkeypatch.setattr(registry, "_provided", {})  # nothing of it stays known
    desktop.env[trust.HOME] = str(tmp_path / "home")
    for kind in plugin_files.KINDS:
        shutil.copy(ROOT / f"tests/plugins/toy_{kind}/toy_{kind}.py", tmp_path)
    study, data = tmp_path / "toys.toml", tmp_path / "data"
    study.write_text(
        toy_study("near", "toy", brought=True).replace(
            "[display]\nwidth = 160\nheight = 120\n", ""
        ),
        "utf-8",
    )
    with open_session(desktop, study, data, "Toys", "--trust") as program:
        for number in range(60):  # of which each does a page or a trial, and most do nothing
            if not program.running():
                break
            if number == 8:
                desktop.screenshot(ARTEFACTS / "window-toys.png")
            desktop.keys("Return", "y", "a", "Down", "space", "Tab", "Return")
        wait_until(lambda: not program.running(), START, "the end")
        assert program.process.returncode == 0, program.said()
    played = rows(data)
    assert {r["task"] for r in played} == {"toy_task", "depth_order"}
    assert {r["answer"] for r in played if r["task"] == "toy_task"} == {"y"}
    assert {r["view"] for r in played} == {"plain", "near"}
    words = ("replay", str(data), "--participant", "P01", "--trial", "1", "--verify", "--trust")
    assert cli.main(words) == 0


def test_what_is_clicked_with_the_mouse_is_found(desktop, tmp_path):
    """Each marked thing at the pixel where it stands, under two techniques: no click of the mouse
    misses. The space bar goes on from pages, and where a trial has begun by then is a click; so is
    what was clicked again for a trial whose end showed late."""
    study, data = tmp_path / "pointed.toml", tmp_path / "data"
    study.write_text(POINTED, "utf-8")
    scenes, task = StudyScenes(load(str(study))), TASKS["select"]
    size = (800, 600)
    astray = [0]  # for each trial, spaces and clicks that may have met it and were not for it
    with open_session(desktop, study, data, "Pointing") as program:
        for trial in trials_of(study):
            state = scenes.begin(task, trial, size[0] / size[1])
            view = task.view(state)
            at = to_pixels(
                to_camera(view.scene.centers[state.made.thing], view.camera), view.camera, size
            )
            left, top = _window(desktop)
            astray.append(0)
            hit = partial(_clicked, desktop, program, astray, at + np.array([left, top]))
            wait_until(hit, TRIAL, "a hit")
        desktop.screenshot(ARTEFACTS / "window-pointed.png")
        for _ in range(20):
            if not program.running():
                break
            desktop.keys("Tab", "Return")
        wait_until(lambda: not program.running(), START, "the end")
        assert program.process.returncode == 0, program.said()
    played = rows(data)
    assert len(played) == 4
    misses = [int(float(r["misses"])) for r in played]
    assert all(m <= n for m, n in zip(misses, astray[:-1], strict=True)), (misses, astray)
    assert 0 in misses, (misses, astray)
    assert {r["correct"] for r in played} == {"true"}


def _clicked(desktop, program, astray: list[int], at: np.ndarray) -> bool:
    """Click, go on from a page, and say whether this trial's end was reported: that of the last but
    one for which `astray` counts."""
    asked = len(astray) - 1
    for again in range(2):  # the first may come before the trial's first frame: nobody's then
        astray[-1] += again
        desktop.do("mousemove", *np.round(at).astype(int).tolist())
        desktop.do("click", 1)
        until = time.monotonic() + 1  # a hit is reported with the frame that follows
        while program.trials() < asked and time.monotonic() < until:
            time.sleep(0.05)
        if program.trials() >= asked:
            return True
    astray[-2] += 1
    astray[-1] += 1
    desktop.keys("Tab", "space")
    return False


def _window(desktop) -> tuple[int, int]:
    """Where the window's picture begins on the screen."""
    found = subprocess.run(
        ["xdotool", "search", "--name", "Pointing", "getwindowgeometry", "--shell"],
        env=desktop.env, capture_output=True, text=True, check=True, timeout=20,
    ).stdout  # fmt: skip
    said = dict(line.split("=") for line in found.split())
    return int(said["X"]), int(said["Y"])
