"""What people bring along: from the command line, or asked before a slot is taken."""

import io

import pytest

from seethrough.experiment.commands.sessions.run import _brought, _check_brought
from seethrough.experiment.errors import InputError
from seethrough.experiment.study.config import load

STUDY = load("expertise")


class Terminal(io.StringIO):
    """Standard input that somebody sits before."""

    def isatty(self):
        return True


def test_a_level_is_said_or_asked_for_or_missing(monkeypatch, capsys):
    assert _brought(STUDY, ["expertise=expert"], ask=True) == {"expertise": "expert"}
    monkeypatch.setattr("sys.stdin", Terminal("novice\n"))
    assert _brought(STUDY, [], ask=True) == {"expertise": "novice"}
    assert "Do you work with 3D models every week?" in capsys.readouterr().out
    monkeypatch.setattr("sys.stdin", Terminal("guru\n"))
    with pytest.raises(InputError, match="expertise = guru: expected one of novice, expert"):
        _brought(STUDY, [], ask=True)
    monkeypatch.setattr("sys.stdin", io.StringIO())
    with pytest.raises(InputError, match="--set: missing, expected expertise=LEVEL"):
        _brought(STUDY, [], ask=True)
    assert _brought(STUDY, [], ask=False) == {}


@pytest.mark.parametrize("said", ["expertise", "expertise=guru", "view=plain", "=expert"])
def test_what_is_no_measured_level_is_refused(said):
    with pytest.raises(InputError, match=r"--set = .*: expected one of expertise=novice, expert"):
        _brought(STUDY, [said], ask=True)
    with pytest.raises(InputError, match="expected none: the study has no measured factor"):
        _brought(load("published"), [said], ask=True)


def test_a_slot_of_another_group_is_refused():
    expert = next(s for s in range(1, 9) if STUDY.plan.groups[STUDY.plan.group_of(s)[0]].levels[
        "expertise"] == "expert")  # fmt: skip
    _check_brought(STUDY, expert, {"expertise": "expert"})
    _check_brought(STUDY, expert, {})
    with pytest.raises(InputError, match=f"slot {expert} is of expertise=expert"):
        _check_brought(STUDY, expert, {"expertise": "novice"})
