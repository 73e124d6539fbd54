"""A session that is stopped again and again while keys are typed: each answers what it was for."""

import subprocess
import sys
from pathlib import Path

STALLED = Path(__file__).parents[1] / "support" / "stalled_sessions.py"


def test_no_key_from_before_a_trial_answers_it_and_no_time_is_too_late(tmp_path):
    """One of the sessions that are played by hand a hundred times (CONTRIBUTING.md)."""
    command = [sys.executable, STALLED, "1", "7", tmp_path / "stalled"]
    run = subprocess.run(command, capture_output=True, text=True, timeout=400, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    assert run.stdout.startswith("1 sessions, 6 stalls"), run.stdout
