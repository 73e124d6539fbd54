"""Rows of a benchmark as Markdown, and the command's options."""

from __future__ import annotations

import pytest

from seethrough.benchmarks import tables
from seethrough.benchmarks.drawing.speed import row
from seethrough.experiment.cli import main

ROWS = [
    row("plan()", "200 objects", 1.25, "ms", 2, 0.4),
    row("masks", "40 targets", 0.5, "×", 0.1, None),
    row("error", "jeep: fast", 0.25, "%", 0.1, None),
    row("time / standard", "jeep: fast", 1.5, "×", None, None),
    row("error", "jeep: exact", 0.0, "%", None, None),
    row("time / standard", "jeep: exact", 3.0, "×", None, None),
]
TABLE = """| figure | scene | value | must | aim | met |
| --- | --- | --- | --- | --- | --- |
| plan() | 200 objects | 1.25 ms | 2 | 0.4 | yes |
| masks | 40 targets | 0.5 × | 0.1 |  | **no** |

| jeep | error | time / standard |
| --- | --- | --- |
| fast | 0.25 % (must 0.1: **not met**) | 1.5 × |
| exact | 0 % | 3 × |
"""


def test_rows_become_tables():
    """Lines of their own, or a table for each scene."""
    assert tables.markdown(ROWS) == TABLE


def test_a_table_is_put_between_its_marks(tmp_path, monkeypatch):
    """What stands around it stays; a second run replaces the first."""
    monkeypatch.setattr(tables, "machine", lambda: "a machine")
    page = tmp_path / "README.md"
    page.write_text("# A\n<!-- bench b -->\nold\n<!-- /bench b -->\nafter\n", "utf-8")
    for _ in range(2):
        tables.put(page, "b", ROWS)
        tables.put(page, "c", ROWS[:1])
    text = page.read_text("utf-8")
    assert text.startswith("# A\n<!-- bench b -->\nOn a machine:\n\n| figure")
    assert "old" not in text and text.count("| fast |") == 1 and "\nafter\n" in text
    assert text.count("<!-- bench c -->") == text.count("<!-- /bench c -->") == 1


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<!-- bench b -->\nold\nafter\n", "<!-- /bench b --> = missing: expected after"),
        ("old\n<!-- /bench b -->\nafter\n", "<!-- bench b --> = missing: expected before"),
        ("<!-- /bench b -->\n<!-- bench b -->\nafter\n", "<!-- /bench b --> = missing"),
    ],
)
def test_a_page_that_lost_a_mark_stays_whole(tmp_path, monkeypatch, text, message):
    """And the line names the page."""
    monkeypatch.setattr(tables, "machine", lambda: "a machine")
    page = tmp_path / "README.md"
    page.write_text(text, "utf-8")
    with pytest.raises(ValueError, match=f"README.md: {message}"):
        tables.put(page, "b", ROWS)
    assert page.read_text("utf-8") == text


def test_the_command_says_so_before_it_measures_in_one_line(tmp_path, capsys):
    page = tmp_path / "page.md"
    page.write_text("<!-- bench statistics -->\n", "utf-8")
    assert main(["bench", "statistics", "--markdown", str(page)]) == 2
    told = capsys.readouterr()
    assert "page.md: <!-- /bench statistics --> = missing" in told.err
    assert told.err.count("\n") == 1 and not told.out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--figure", "x.pdf"], "--figure = x.pdf: expected a name that ends in .svg or .png"),
        (["--figure", "x.svg"], "--figure = x.svg: bench speed draws none"),
        (["--markdown", "no/x.md"], "--markdown = no/x.md: expected an existing folder"),
        (["--json", "no/x.json"], "--json = no/x.json: expected an existing folder"),
    ],
)
def test_impossible_options_are_refused_before_anything_is_measured(words, message, capsys):
    """In one line."""
    assert main(["bench", "speed", *words]) == 2
    assert message in capsys.readouterr().err.replace("\\", "/")
