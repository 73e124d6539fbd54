"""Changes to a data folder, and whether its loading refuses them."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path

import pytest

from seethrough.analysis.errors import DataError
from seethrough.analysis.load.study import load_study

TRIALS = "data/human/P01/study-made_subject-P01_session-1_trials_data.csv"
ANSWERS = "data/human/P01/study-made_subject-P01_session-1_questionnaire_data.csv"


def edit(path: Path, row: int, column: str, value: str) -> None:
    """Change one cell; rows are counted as a spreadsheet does, the header is row 1."""
    lines = path.read_text().split("\n")
    names, cells = lines[0].split(","), lines[row - 1].split(",")
    cells[names.index(column)] = value
    lines[row - 1] = ",".join(cells)
    path.write_text("\n".join(lines))


def snapshot(folder: Path) -> dict[str, str]:
    return {
        str(p): hashlib.sha256(p.read_bytes()).hexdigest() for p in folder.rglob("*") if p.is_file()
    }


def refused(folder: Path, pattern: str) -> None:
    """Loading says `pattern` in one of its lines, and touches nothing."""
    before = snapshot(folder)
    with pytest.raises(DataError) as caught:
        load_study(folder)
    assert all("\n" not in line for line in caught.value.lines)
    assert any(re.search(pattern, line) for line in caught.value.lines), caught.value.lines
    assert snapshot(folder) == before
