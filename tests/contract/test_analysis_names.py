"""The analysis knows no study by name: levels, tasks, worlds and measures come from the data.

Only `published/` (the paper's own numbers) and `before.py` (data that were recorded before sidecars
held a design) may name them.
"""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

from seethrough import registry

EXEMPT = ("published", "before.py")
NAMES = frozenset(
    "transparency scenario standard dynamic abstract walkthrough building pattern unique "
    "count_in_building count_error absolute_error distance depth_test depth_self_report preference "
    "efficiency enjoy T1 T2 T3 T4".split()
)
"""The published study's factors, levels, tasks, measures and items. `count` and `ease` are words of
other things, too, and are looked for as whole constants below."""
ALONE = frozenset({"count", "ease"})
TERMS = re.compile(r"standard deviation|inverse efficiency|unique\(|a unique one")
"""The field's terms, and a function of R's, that hold such a word."""
NO_NAME = {
    ("sections/participants.py", "count"): "a column of the table of totals",
    ("stats/ties.py", "count"): "no name at all",
    ("design.py", "count"): "a scale",
    ("load/schema.py", "count"): "a scale",
    ("page/r_script.py", "count"): "a scale",
}
"""(file, constant) that is another thing of the same name."""


def constants(path: Path) -> list[str]:
    """Every text in a module but its docstrings and the comments."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    said = set()
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list):
            said |= {
                id(s.value)
                for s in body
                if isinstance(s, ast.Expr) and isinstance(s.value, ast.Constant)
            }
    return [
        node.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in said
    ]


def _words(text: str) -> set[str]:
    return set(re.findall(r"[A-Za-z_0-9]+", TERMS.sub("", text)))


def modules(root: Path) -> list[Path]:
    base = root / "analysis"
    return [p for p in sorted(base.rglob("*.py")) if p.relative_to(base).parts[0] not in EXEMPT]


def test_no_constant_of_the_analysis_names_a_level_task_or_measure(root: Path) -> None:
    base = root / "analysis"
    found = []
    for path in modules(root):
        where = path.relative_to(base).as_posix()
        for text in constants(path):
            words = _words(text) & NAMES
            if text in ALONE and (where, text) not in NO_NAME:
                words.add(text)
            found += [f"{where}: {word!r} in {text!r}" for word in sorted(words)]
    assert found == []


def test_no_template_names_one(root: Path) -> None:
    found = []
    for path in sorted((root / "analysis" / "page" / "templates").iterdir()):
        words = _words(path.read_text(encoding="utf-8")) & NAMES
        found += [f"{path.name}: {word}" for word in sorted(words)]
    assert found == []


# Names of plug-ins that mean something else there: columns, kinds of arguments, statistics.
OTHER_WORDS = {"count", "constant", "fixed", "text", "number", "choice", "scene"}


@pytest.mark.parametrize("kind", ["technique", "task", "world", "question"])
def test_no_constant_is_the_name_of_a_plug_in(root: Path, kind: str) -> None:
    """Nor of any that comes later: `registry` says what there is."""
    names = set(registry.known(kind)) - OTHER_WORDS
    base = root / "analysis"
    found = [
        f"{path.relative_to(base).as_posix()}: {text!r}"
        for path in modules(root)
        for text in constants(path)
        if text in names
    ]
    assert found == []
