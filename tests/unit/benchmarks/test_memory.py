"""The most memory a process held is its own, not its parent's."""

import subprocess
import sys
from pathlib import Path

import pytest

from seethrough.benchmarks.memory import peak, used_by
from seethrough.benchmarks.rows import row

LARGE = 200  # MiB: far above an empty Python's 10 to 20
FILL = f"b = bytes([1]) * ({LARGE} << 20)"
TOLD = Path("/proc/self/status").exists()  # on Linux; elsewhere there is nothing to read


def more(peak, than):
    return peak > than if TOLD else peak is None


def less(peak, than):
    return peak < than if TOLD else peak is None


def test_a_child_does_not_start_with_its_parents_peak():
    held = bytes([1]) * (LARGE << 20)
    assert more(peak(), LARGE)
    assert less(used_by("pass").peak, LARGE / 2)
    assert len(held) == LARGE << 20


def test_what_was_let_go_counts_and_so_do_arguments_and_processor_time():
    code = f"import sys; assert sys.argv[1:] == ['a']; {FILL}; del b; print('x', end='')"
    used = used_by(code, "a")
    assert more(used.peak, LARGE)
    assert 0 < used.cpu < 60
    with pytest.raises(subprocess.CalledProcessError):
        used_by("raise SystemExit(2)")


WATCHING = """
import subprocess, sys
from seethrough.benchmarks.memory import Watch, peak
start = "import subprocess, sys; subprocess.run([sys.executable, '-c', sys.argv[1]], check=True)"
with Watch(0.05) as watch:
    subprocess.run([sys.executable, "-c", start, sys.argv[1]], check=True)
print(watch.peak, peak())
"""


def test_a_watch_sees_the_processes_of_its_processes():
    words = [sys.executable, "-c", WATCHING, f"import time; {FILL}; time.sleep(0.5)"]
    done = subprocess.run(words, check=True, capture_output=True, text=True)
    seen, own = (float(word) if TOLD else None for word in done.stdout.split())
    assert more(seen, LARGE) and less(own, LARGE / 2)


def test_a_row_without_a_goal_meets_none():
    assert row("a", "b", 1.0, "s")["met"] is None
    assert row("a", "b", 1.0, "s", aim=0.5)["met"] is None
    assert row("a", "b", 1.0, "s", 1)["met"] is True
    assert row("a", "b", 0.9, "s", 1, more=True)["met"] is False
    assert row("a", "b", 1.23456e-16, "")["value"] == 1.235e-16
