"""What questions call their items, and what others wait for: a slip in a study file is said, and is
not a column that another one overwrites, or a question that nobody is ever asked."""

from __future__ import annotations

import pytest
from small_study import SMALL

from seethrough.experiment.cli import main

ENDS = 'points = 5, ends = ["a", "b"]'
LIKERT = f'use = "likert", text = "T", {ENDS}'
CHOICE = 'use = "choice", text = "T", options = ["left", "right"]'
NAMED = "expected a name of 1 to 64 letters (a–z), digits, _, . and -, a letter first"
WRONG = [
    # names of columns
    (f'"=cmd()" = {{ {LIKERT} }}', f'questions.=cmd() = "=cmd()": {NAMED}'),
    (f'"a b" = {{ {LIKERT} }}', f'questions.a b = "a b": {NAMED}'),
    (f'"" = {{ {LIKERT} }}', f'questions. = "": {NAMED}'),
    (
        f"participant = {{ {LIKERT} }}",
        'questions.participant = "participant": expected another name: every table has a column of',
    ),
    (
        f"transparency = {{ {LIKERT} }}",
        'questions.transparency = "transparency": expected another name: the factor has a column',
    ),
    (
        f'q = {{ use = "likert", items = ["A", "B"], names = ["slot", "b,c"], {ENDS} }}',
        'questions.q.names = "slot": expected another name: every table has a column of that name',
    ),
    (
        f'q = {{ use = "likert", items = ["A", "B"], names = ["n", "n"], {ENDS} }}',
        'questions.q.names = ["n", "n"]: expected each once',
    ),
    (
        f'q = {{ use = "likert", items = ["A", "B"], {ENDS} }}\nq_2 = {{ {CHOICE} }}',
        'questions.q_2 = "q_2": expected another name: questions.q has a column of that name',
    ),
    (
        f'q = {{ {CHOICE[:-1]}], names = ["n", "n"] }}',
        'questions.q.names = ["n", "n"]: expected each once',
    ),
    # what does not do what it says
    (
        f'q = {{ use = "likert", items = ["A", "B"], reverse = ["q_3"], {ENDS} }}',
        'questions.q.reverse = "q_3": expected some of q_1, q_2',
    ),
    (
        'q = { use = "choice", text = "T" }',
        "questions.q.options: missing, expected options, or `of` with a factor's name",
    ),
    (
        'q = { use = "ranking", text = "T" }',
        "questions.q.options: missing, expected options, or `of` with a factor's name",
    ),
    (
        'q = { use = "number", text = "T", low = 0.5, high = 0.7 }',
        "questions.q.high = 0.7: expected a whole number from `low` (0.5) on, or whole = false",
    ),
    # what no answer can be
    *(
        (
            f"b = {{ {asked} }}\nq = {{ {LIKERT}, given = {{ b = {wanted} }} }}",
            f"questions.q.given.b = {shown}: expected an answer that there can be: {there}",
        )
        for asked, wanted, shown, there in (
            (CHOICE, '"up"', '"up"', "a number from 1 to 2 or one of left, right"),
            (CHOICE, '["left", "up"]', '"up"', "a number from 1 to 2 or one of left, right"),
            (CHOICE, "0", "0", "a number from 1 to 2 or one of left, right"),
            (CHOICE + ", numbered = false", "1", "1", "one of left, right"),
            (CHOICE + ', right = "left"', "2", "2", "a number from 0 to 1 or one of left, right"),
            (LIKERT, "6", "6", "a number from 1 to 5"),
            (LIKERT + ", first = 0", "5", "5", "a number from 0 to 4"),
            (LIKERT, "{ least = 6 }", '{"least": 6}', "a number from 1 to 5"),
            (LIKERT, "{ least = 4, most = 2 }", '{"least": 4, "most": 2}', "a number from 1 to 5"),
            ('use = "slider", text = "T"', "101", "101", "a number from 0 to 100"),
            ('use = "number", text = "T", high = 9', '"10"', '"10"', "a number from 0 to 9"),
        )
    ),
]
RIGHT = [
    f"b = {{ {CHOICE} }}\nq = {{ {LIKERT}, given = {{ b = {wanted} }} }}"
    for wanted in ('"left"', "2", '"2"', '["left", "right"]', "{ least = 2 }")
] + [
    f"b = {{ {LIKERT} }}\nq = {{ {LIKERT}, given = {{ b = {{ least = 5, most = 9 }} }} }}",
    f'b = {{ use = "text", text = "T" }}\nq = {{ {LIKERT}, given = {{ b = "anything" }} }}',
    f'q = {{ use = "likert", items = ["A", "B"], reverse = ["q_2"], {ENDS} }}',
    'q = { use = "choice", text = "T", of = "transparency" }',
    'q = { use = "number", text = "T", low = 0.5, high = 0.7, whole = false }',
]


def said(folder, capsys, questions, text=SMALL):
    study = folder / "small.toml"
    study.write_text(text.partition("[questions]")[0] + f"[questions]\n{questions}\n", "utf-8")
    status = main(["check", str(study), "--config-only"])
    return status, capsys.readouterr().err.replace(f"seethrough: {study}: ", "").splitlines()


@pytest.mark.parametrize(("questions", "message"), WRONG)
def test_a_slip_is_said(tmp_path, capsys, questions, message):
    status, lines = said(tmp_path, capsys, questions)
    assert status == 2
    assert lines[0].startswith(message)
    assert all("b,c" in line for line in lines[1:])  # the second fault of one case


@pytest.mark.parametrize("questions", RIGHT)
def test_what_can_be_is_taken(tmp_path, capsys, questions):
    assert said(tmp_path, capsys, questions) == (0, [])


@pytest.mark.parametrize(
    ("labels", "message"),
    [
        ('standard = "A", dynamic = "A"', '.dynamic = "A": expected another text than that of st'),
        ('standard = "dynamic"', '.standard = "dynamic": expected another text than that of dyna'),
        ('standard = ""', '.standard = "": expected text of 1 to 100 printable characters'),
        ('standard = "a\\nb"', '.standard = "a\\nb": expected text of 1 to 100 printable charact'),
        (f'standard = "{"x" * 101}"', ".standard = "),
    ],
)
def test_levels_can_be_told_apart_by_what_people_read(tmp_path, capsys, labels, message):
    """Two equal buttons, an empty one, and one that fills the page."""
    own = SMALL.replace("[world.abstract]", f"labels = {{ {labels} }}\n[world.abstract]")
    status, lines = said(tmp_path, capsys, "", own)
    assert status == 2 and len(lines) == 1
    assert lines[0].startswith(f"factors.transparency.labels{message}")
