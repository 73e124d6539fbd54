"""The columns are the interface between a session and its analysis."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import pytest

from seethrough.experiment.record.columns import TABLES, Column, versions
from seethrough.experiment.record.dictionary import BEGIN, END, dictionary, with_dictionary

EVERY = [(table, column) for table, columns in TABLES.items() for column in columns]


@pytest.mark.parametrize("table", TABLES)
def test_columns_are_unique(table: str) -> None:
    """No name stands twice in a table, and `row_id` opens it."""
    names = [column.name for column in TABLES[table]]
    assert sorted(set(names)) == sorted(names)
    assert names[0] == "row_id"


@pytest.mark.parametrize(("table", "column"), EVERY, ids=[f"{t}-{c.name}" for t, c in EVERY])
def test_columns_are_typed_and_described(table: str, column: Column) -> None:
    """A column has a name any program can use, a type, and a meaning; levels are distinct texts."""
    assert re.fullmatch(r"[a-z][a-z0-9_]*", column.name)
    assert column.type in {"text", "integer", "number", "boolean"}
    assert len(column.description) > 5
    assert not column.levels or column.type == "text"
    assert len(set(column.levels)) == len(column.levels)
    assert column.type == "number" or column.unit in {"", "objects", "frames"}


def test_a_name_means_one_thing() -> None:
    """Columns of the same name are the same in every table."""
    meanings: dict[str, set[Column]] = {}
    for _, column in EVERY:
        meanings.setdefault(column.name, set()).add(column)
    assert not [name for name, columns in meanings.items() if len(columns) > 1]


def test_the_dictionary_names_every_column() -> None:
    """Each table has its heading, and each column its line with type, unit and levels."""
    text = dictionary()
    for table, columns in TABLES.items():
        rows = text.partition(f"`…_{table}_data.csv`")[2].partition("## ")[0].splitlines()
        for column in columns:
            line = next(row for row in rows if row.startswith(f"| `{column.name}` "))
            assert f"| {column.type} | {column.unit} |" in line
            assert all(f"`{level}`" in line for level in column.levels)


def test_the_readme_holds_the_dictionary(root: Path) -> None:
    """data/README.md is what `python -m seethrough.experiment.record.dictionary` makes of it."""
    text = (root / "data" / "README.md").read_text("utf-8")
    assert text == with_dictionary(text)


def test_a_readme_without_marks_is_left_alone() -> None:
    """What is written by hand is never overwritten."""
    with pytest.raises(ValueError, match=r"data/README\.md: expected the marks"):
        with_dictionary(f"by hand {END} {BEGIN}")
    assert with_dictionary(f"a{BEGIN}old{END}b").startswith(f"a{BEGIN}")
    assert with_dictionary(f"a{BEGIN}old{END}b").endswith(f"{END}b")


CAME_LATER = {  # as earlier versions of the program wrote their tables: what each version brought
    "trials": [{"time_within", "early"}, {"world"}, set()],
    "questionnaire": [set(), set(), {"after_trial", "after_task"}],
}


@pytest.mark.parametrize("table", CAME_LATER)
def test_an_earlier_version_s_table_lacks_what_came_later_and_nothing_else(table: str) -> None:
    """A column's version is history: changing it makes data that are there unreadable."""
    names = [{column.name for column in columns} for columns in versions(TABLES[table])]
    brought = CAME_LATER[table][: len(names) - 1]
    assert not set().union(*CAME_LATER[table][len(names) - 1 :])
    assert [after - before for before, after in pairwise(names)] == brought
    assert all(before <= after for before, after in pairwise(names))
