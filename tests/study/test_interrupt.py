"""Ctrl-C while a session starts: one line, and nothing is held by who never began."""

import signal
import subprocess
import sys
import time

import pytest
from desktop import Desktop

from seethrough.experiment.display import interrupt
from seethrough.experiment.ledger.ledger import Ledger

LINE = "seethrough: interrupted; every completed trial is saved"


@pytest.mark.parametrize("seconds", [0.7, 2.0, 4.0])  # imports, ledger, window: as they come
def test_an_interrupted_start_ends_in_one_line_and_holds_no_slot(tmp_path, seconds):
    data = tmp_path / "data"
    words = [sys.executable, "-m", "seethrough", "run", "demo", "--next", "--data", data]
    with Desktop() as desktop:
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
        program = subprocess.Popen(list(map(str, words)), env=desktop.env, **pipes)
        time.sleep(seconds)
        program.send_signal(signal.SIGINT)
        _, said = program.communicate(timeout=60)
    assert program.returncode == 130, said
    assert said.splitlines()[-1] == LINE and "Traceback" not in said
    if (data / "ledger.sqlite").exists():
        with Ledger.existing(data) as ledger:
            begun = (data / "data" / "human" / "P01").exists()
            assert [e.participant for e in ledger.entries()] == (["P01"] if begun else [])


def test_an_interrupt_waits_for_a_moment_at_which_it_can_be_obeyed():
    done = []
    with pytest.raises(KeyboardInterrupt), interrupt.deferred():
        signal.raise_signal(signal.SIGINT)
        done.append("in a library's callback")
        interrupt.check()
        done.append("never")
    assert done == ["in a library's callback"]
    with pytest.raises(KeyboardInterrupt), interrupt.deferred():
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)  # whoever presses twice means it
        done.append("never")
    with pytest.raises(KeyboardInterrupt), interrupt.deferred():
        signal.raise_signal(signal.SIGINT)
    interrupt.check()
    assert done == ["in a library's callback"]
