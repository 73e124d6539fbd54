"""SIGKILL at random moments of a session: every completed trial and every answered page is on disk,
no half row, and the participant goes on with what is left.

`python tests/support/killed_sessions.py 200 1 FOLDER` does it two hundred times.
"""

import subprocess
import sys
from pathlib import Path

SCRIPT = Path(__file__).parents[1] / "support" / "killed_sessions.py"


def test_killed_sessions_lose_no_completed_trial_and_no_answer(tmp_path):
    words = [sys.executable, str(SCRIPT), "15", "1", str(tmp_path)]
    done = subprocess.run(words, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("15 sessions killed") and "none lost" in done.stdout
    # The moments really differ: sessions of many lengths were cut, some of them while answering.
    assert int(done.stdout.split()[-2]) > 5
    assert int(done.stdout.partition("lost; ")[2].split()[0]) > 0
