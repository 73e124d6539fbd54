"""Commands that open a window, where there is none to be had: one line, exit status 2."""

import os
import subprocess
import sys

import pytest
from desktop import Desktop

COMMANDS = [
    "run demo --next --data {t}/data",
    "run demo --next --pilot --data {t}/data",
    "simulate demo --watch --participants 1 --out {t}/data",
    "view fence",
]
# As on a machine whose window has no OpenGL 3.3: glcontext raises bare exceptions of many lines.
NO_OPENGL = """
import moderngl

def none(*_, **__):
    raise Exception("requested OpenGL 3.3, got version 2.1\\nand more\\nof it")

moderngl.create_context = none
"""


def said(env, words, folder):
    """The one line of a command that must fail; nothing of a session is there after it."""
    command = [sys.executable, "-m", "seethrough", *words.format(t=folder).split()]
    done = subprocess.run(command, env=env, capture_output=True, text=True, timeout=120)
    lines = [line for line in done.stderr.splitlines() if "participant P01, slot 1" not in line]
    assert done.returncode == 2 and len(lines) == 1, done.stderr
    assert not list(folder.rglob("*_data.*"))
    return lines[0]


@pytest.mark.parametrize("words", COMMANDS)
def test_without_a_desktop(words, tmp_path):
    env = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
    line = said(env, words, tmp_path)
    instead = "`seethrough simulate` plays a study, `seethrough render` draws"
    if words.startswith("view"):
        instead = "--picture FILE writes the first picture"
    assert line == (
        "seethrough: display: no window can be opened (DISPLAY is not set); expected to be started "
        f"from a terminal on a desktop; without one, {instead}"
    )


def test_without_opengl_in_the_window(tmp_path):
    site = tmp_path / "site"
    site.mkdir()
    (site / "sitecustomize.py").write_text(NO_OPENGL, encoding="utf-8")
    with Desktop() as desktop:
        for words in COMMANDS:
            assert said({**desktop.env, "PYTHONPATH": str(site)}, words, tmp_path) == (
                "seethrough: display: OpenGL 3.3 is not available in a window "
                "(requested OpenGL 3.3, got version 2.1), expected a graphics driver"
            )


def test_a_slot_whose_session_could_not_begin_is_given_out_again(tmp_path):
    env = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
    for _ in range(2):
        said(env, "run demo --next --data {t}/data", tmp_path)
    words = [sys.executable, "-m", "seethrough", "status", str(tmp_path / "data")]
    done = subprocess.run(words, env=env, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert "slots     0 complete, 0 open, 4 free, 0 void entries" in done.stdout
    assert "next      seethrough run demo --next: slot 1, row 1" in done.stdout
