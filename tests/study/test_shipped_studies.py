"""Three shipped studies from their file to their report, as `bench studies` plays all ten."""

from __future__ import annotations

from pathlib import Path

import pytest

from seethrough.benchmarks.sessions import studies
from seethrough.experiment.study.config import load, shipped


@pytest.mark.parametrize("name", ["opacity", "expertise", "livingston2003"])
def test_a_study_goes_from_its_file_to_its_report(name: str, tmp_path: Path) -> None:
    """One scene a task and two people: that it goes through, not what comes out."""
    rows = {r["figure"]: r for r in studies.through(name, tmp_path, people=2, pool=1)}
    assert rows["steps that went through"]["value"] == 4
    assert rows["people in the report"]["value"] == 2
    assert rows["tables of the report"]["value"] > 20


def test_a_step_that_fails_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A study that its file makes impossible has no later step."""
    (tmp_path / "data").write_text("in the way")
    rows = list(studies.through("opacity", tmp_path, people=1, pool=1))
    assert rows[0]["value"] == 2
    assert not rows[0]["met"]
    assert "opacity: simulate ended with" in capsys.readouterr().out


def test_ten_studies_ship() -> None:
    assert len(studies.PARTS) >= 10
    assert set(studies.PARTS) == set(shipped()) - {"demo"}


def test_what_is_worked_by_hand_is_drawn() -> None:
    assert studies.by_hand(load("elmqvist2006"))
    assert not studies.by_hand(load("published"))
