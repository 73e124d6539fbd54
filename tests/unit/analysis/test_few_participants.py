"""What the report says first where there are few participants."""

import re

import pytest
from made_data import Made, make_folder
from made_designs import DESIGNS, make_design

from seethrough.analysis.page.markdown import as_markdown
from seethrough.analysis.report import Options, make_report, tables_of
from seethrough.analysis.stats.distributions import detectable, detectable_between


@pytest.fixture(scope="module")
def text_of(tmp_path_factory):
    def text(participants):
        folder = tmp_path_factory.mktemp(f"few{participants}")
        report = make_report(make_folder(folder, Made(participants=participants)), Options())
        return as_markdown(report)

    return text


def first_section(text):
    return text.split("\n## ")[1]


def test_one_participant_is_one_and_tests_nothing(text_of):
    text = text_of(1)
    assert "Only 1 participant: nothing can be tested." in first_section(text)
    assert not re.search(r"\b1 participants\b", text)


def test_three_are_said_to_be_few_before_anything_else(text_of):
    first = first_section(text_of(3)).removeprefix("In short").strip()
    assert first.startswith("> ⚠ Only 3 participants: a difference must be as large as")
    # with three differences of one sign a sign test has p = 2 / 2³
    assert "an exact sign test reaches p = .250 at best" in first


def test_groups_find_less_than_pairs():
    """R: the noncentral t of 14 df whose lower part is .20 (`uniroot` on `pt`)."""
    assert detectable_between(10, 6, 0.05, 0.80) == pytest.approx(1.55604514, abs=1e-8)
    # n pairs as two groups of n: more degrees of freedom, and √2 times the difference
    assert detectable_between(16, 16, 0.05, 0.80) < detectable(16, 0.05, 0.80) * 2**0.5


def test_a_study_of_groups_says_what_they_can_find(tmp_path):
    report = make_report(make_design(tmp_path / "data", DESIGNS["mixed"]), Options())
    (table,) = [t for t in tables_of(report) if t.key == "smallest_effect"]
    assert [r["n"] for r in table.rows] == [14, 14]
    assert table.rows[1]["dz"] == pytest.approx(detectable_between(9, 5, 0.05, 0.80))
    assert "Between groups (training, none − criterion) a difference must be" in as_markdown(report)


def test_of_sixteen_the_first_section_says_nothing(text_of):
    text = text_of(16)
    assert "Only 16" not in text and "at best" not in first_section(text)
    assert "With 16 participants a paired test finds" in text
