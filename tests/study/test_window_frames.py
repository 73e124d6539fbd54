"""What measures frames in a window has a session in it that moves."""

import json
import subprocess
import sys

from desktop import Desktop

MODULE = "seethrough.benchmarks.sessions.window_frames"


def test_the_scene_is_dragged_in_nearly_every_frame_that_is_measured():
    with Desktop() as desktop:
        run = subprocess.run(
            [sys.executable, "-m", MODULE, "standard", "1"],
            env=desktop.env, capture_output=True, text=True, timeout=120, check=False,
        )  # fmt: skip
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout)
    assert found["frames"] > 3 and found["moved"] > 0.6  # the first two and the last stand still
    assert found["drawing"] > 0
