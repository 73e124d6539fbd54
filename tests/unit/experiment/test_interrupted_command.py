"""Ctrl-C ends a command with one line, wherever it comes."""

import pytest

from seethrough.experiment import cli
from seethrough.experiment.commands.sessions import status


def from_compiled_code(_):
    """What the interpreter makes of an interrupt inside a compiled function, twice over."""
    try:
        try:
            raise KeyboardInterrupt
        except KeyboardInterrupt as inner:
            raise SystemError("returned a result with an exception set") from inner
    except SystemError as outer:
        raise SystemError("returned a result with an exception set") from outer


def plainly(_):
    raise KeyboardInterrupt


@pytest.mark.parametrize("run", [plainly, from_compiled_code])
def test_an_interrupt_is_one_line(run, monkeypatch, capsys):
    monkeypatch.setattr(status, "run", run)
    assert cli.main(["status", "somewhere"]) == 130
    assert capsys.readouterr().err == "seethrough: interrupted\n"


def test_another_fault_of_compiled_code_is_not_taken_for_one(monkeypatch):
    def broken(_):
        raise SystemError("something else")

    monkeypatch.setattr(status, "run", broken)
    with pytest.raises(SystemError, match="something else"):
        cli.main(["status", "somewhere"])
