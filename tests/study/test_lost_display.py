"""The graphics context or the whole desktop is lost during a session: one line, nothing lost."""

import json
import sys

import pytest
from desktop import Desktop, wait_until
from player import START, answer, open_session

from seethrough.experiment.session.resume import starting_point
from seethrough.experiment.study.config import load

TITLE = "A session that breaks off"
STUDY = f"""
[study]
name = "lost"
title = "{TITLE}"
description = "A few trials."
participants = 1
seed = 5
[design]
tasks = ["count"]
trials = 9
[world.abstract]
objects = 60
target_share = [0.3, 0.4]
[session]
resume = "trial"
[technique]
use = "standard"
[world]
use = "abstract"
[practice]
trials = 0
[questions] # in this order
"""

# `seethrough`, whose driver fails in one of the ways that drivers have once the first file exists.
FAILING = """
import sys
from pathlib import Path
import moderngl, pyglet
from seethrough.experiment import cli

now, how = Path(sys.argv.pop(1)), sys.argv.pop(1)
flip, error = pyglet.window.Window.flip, moderngl.Context.error

def fails_to_flip(window):
    if now.exists():
        raise pyglet.gl.GLException("(0x1287): Unknown error")
    flip(window)

if how == "flip":
    pyglet.window.Window.flip = fails_to_flip
else:
    said = lambda context: "GL_UNKNOWN_ERROR" if now.exists() else error.fget(context)
    moderngl.Context.error = property(said)
sys.exit(cli.main(sys.argv[1:]))
"""


@pytest.fixture
def study_file(tmp_path):
    path = tmp_path / "lost.toml"
    path.write_text(STUDY, encoding="utf-8")
    return path


def goes_on_where_it_was(study_file, data, program):
    """What the program has told of is whole on disk, and the session can be gone on with."""
    start = starting_point(load(str(study_file)), data, "human", "P01", 1)
    return (start.session, start.done) == (2, frozenset(range(1, program.trials() + 1)))


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ("flip", r"(0x1287): Unknown error"),
        ("status", "GL_UNKNOWN_ERROR"),
    ],
)
def test_a_lost_context_is_one_line_and_the_session_can_go_on(study_file, tmp_path, how, words):
    data, now = tmp_path / "data", tmp_path / "now"
    start = (sys.executable, "-c", FAILING, now, how)
    with (
        Desktop() as desktop,
        open_session(desktop, study_file, data, TITLE, start=start) as program,
    ):
        answer(desktop, program, "count", 1)
        now.touch()
        wait_until(lambda: not program.running(), START, "the end")
        assert program.process.returncode == 2
        assert program.said().splitlines()[-1] == (
            f"seethrough: display: the graphics driver gave up ({words}); every completed trial is "
            "saved: go on with the same --participant"
        )
        assert "Traceback" not in program.said()
    (end,) = data.rglob("*_end.json")
    assert json.loads(end.read_text("utf-8"))["status"] == "display lost"
    assert goes_on_where_it_was(study_file, data, program)


def test_a_desktop_that_ends_is_one_line_and_the_session_goes_on_at_another(study_file, tmp_path):
    data = tmp_path / "data"
    with (
        Desktop() as desktop,
        open_session(desktop, study_file, data, TITLE) as program,
    ):
        answer(desktop, program, "count", 1)
        desktop.server.kill()
        wait_until(lambda: not program.running(), START, "the end")
        assert program.process.returncode == 2
        line = "seethrough: display: the desktop went away; every completed trial is saved"
        assert program.said().splitlines()[-1] == line
    assert goes_on_where_it_was(study_file, data, program)
    told = program.trials()
    with (
        Desktop() as desktop,
        open_session(desktop, study_file, data, TITLE) as program,
    ):
        assert "session 2 goes on at trial " in program.said()
        answer(desktop, program, "count", 9 - told)
        while program.running():
            desktop.keys("Return")
        assert program.process.returncode == 0, program.said()
