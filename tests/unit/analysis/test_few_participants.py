"""What the report says first where there are few participants."""

import re

import pytest
from made_data import Made, make_folder

from seethrough.analysis.page.markdown import as_markdown
from seethrough.analysis.report import Options, make_report


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


def test_of_sixteen_the_first_section_says_nothing(text_of):
    text = text_of(16)
    assert "Only 16" not in text and "at best" not in first_section(text)
    assert "With 16 participants a paired test finds" in text
