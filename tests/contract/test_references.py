"""Papers are cited by keys, and every key is in REFERENCES.md."""

from __future__ import annotations

import ast
import re
from pathlib import Path

from seethrough import registry

KEY = re.compile(r"\b(?:[A-Z][a-z]+)+[A-Za-z]*(?:19|20)\d\d\b|\bWebSorting\b")


def _texts(source: Path) -> list[str]:
    """Docstrings and comments of a file."""
    text = source.read_text("utf-8")
    kinds = ast.Module | ast.ClassDef | ast.FunctionDef
    found = [ast.get_docstring(n) or "" for n in ast.walk(ast.parse(text)) if isinstance(n, kinds)]
    return [*found, *re.findall(r"#[^\n]*", text)]


def test_every_key_is_listed(sources: list[Path], root: Path) -> None:
    """A key of a docstring or comment, first author and year, has its row."""
    listed = set(re.findall(r"(?m)^\| ([A-Z]\w+) \|", (root / "REFERENCES.md").read_text("utf-8")))
    cited = {key for source in sources for text in _texts(source) for key in KEY.findall(text)}
    assert {"Elmqvist2009", "Kang2008", "LabBSP2010", "Chen1996", "WebSorting"} <= cited
    assert not cited - listed


def test_no_paper_is_cited_by_a_number(sources: list[Path], root: Path) -> None:
    """Numbers of a folder that readers do not have say nothing."""
    numbered = [
        f"{source.relative_to(root)}: {text.strip()[:80]}"
        for source in sources
        for text in _texts(source)
        if re.search(r"\b[Pp]apers? 00\d\b|\(00[0-4]\b|\b00[0-4] §", text)
    ]
    assert not numbered


def test_the_sources_of_what_is_registered_are_listed(root: Path) -> None:
    """A technique, task, world or kind of question whose source is a key has its row, and none
    cites the published study by another year."""
    listed = set(re.findall(r"(?m)^\| ([A-Z]\w+) \|", (root / "REFERENCES.md").read_text("utf-8")))
    found = [thing.source for kind in registry.KINDS for thing in registry.every(kind).values()]
    cited = {key for source in found for key in KEY.findall(source)}
    assert "Elmqvist2009" in cited
    assert not cited - listed
    assert not [source for source in found if "Elmqvist," in source]
