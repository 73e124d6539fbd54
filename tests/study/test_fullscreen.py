"""A window that fills the screen has the screen's size, whatever the study's width and height."""

import subprocess
import sys

import pytest
from desktop import Desktop

OPEN = """
from seethrough.experiment.display.system_window import open_window
from seethrough.experiment.study.tables.study_tables import DisplayTable
window = open_window(DisplayTable(width=320, height=240, fullscreen={}), "a window")
print(*window.get_framebuffer_size())
"""


@pytest.mark.parametrize("fullscreen, size", [(True, "1300 700"), (False, "320 240")])
def test_a_window_is_as_large_as_the_study_says(fullscreen, size):
    with Desktop(1300, 700) as desktop:
        run = subprocess.run(
            [sys.executable, "-c", OPEN.format(fullscreen)], env=desktop.env,
            capture_output=True, text=True, timeout=120, check=False,
        )  # fmt: skip
    assert (run.returncode, run.stdout.strip()) == (0, size), run.stderr
