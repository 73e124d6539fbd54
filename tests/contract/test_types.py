"""Types are a gate: mypy over the package as it is installed, and ceilings for ways around it."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
import tokenize
import tomllib
from pathlib import Path

# What is reached. Lower them with what you mend, never raise one.
MOST_PRAGMAS = 9  # `type: ignore`, other checkers' comments, `cast`; at most 15 ever
MOST_ANY = 38  # uses of `Any` beside its imports; 40 is not to be reached
MOST_UNCHECKED = 0  # modules that are not checked yet

PRAGMA = re.compile(r"#\s*(type:\s*ignore|pyright:|mypy:|ty:)")


def _config(root: Path) -> dict:
    return tomllib.loads((root / "pyproject.toml").read_text("utf-8"))["tool"]["mypy"]


def _unchecked(root: Path) -> list[str]:
    """The modules of which mypy's errors are ignored."""
    overrides = _config(root)["overrides"]
    return [m for o in overrides if o.get("ignore_errors") for m in o["module"]]


def test_mypy_finds_nothing(root: Path, linked: Path, tmp_path: Path) -> None:
    """Strict, in all modules but those listed as not checked yet."""
    config, cache = root / "pyproject.toml", tmp_path / "cache"
    command = [sys.executable, "-m", "mypy", "--config-file", config, "--cache-dir", cache]
    run = subprocess.run(
        [*command, "-p", "seethrough"], cwd=linked, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stdout[-5000:] + run.stderr
    found = re.fullmatch(r"Success: no issues found in (\d+) source files\n", run.stdout)
    assert found is not None
    files = [f for room in (linked / "seethrough").iterdir() for f in _python_files(room)]
    assert int(found[1]) >= len(files)  # folders without an __init__.py count as well


def _python_files(path: Path) -> list[Path]:
    return [path] if path.suffix == ".py" else list(path.rglob("*.py"))


def test_strictness_is_given_up_by_name_only(root: Path, modules: list[str]) -> None:
    """Nothing is loosened for all; what is not checked yet is there and grows less."""
    config = _config(root)
    assert config["strict"] is True
    assert set(config) == {"strict", "untyped_calls_exclude", "overrides"}
    loose = {key for o in config["overrides"] for key in o} - {"module"}
    assert loose <= {"warn_return_any", "ignore_missing_imports", "ignore_errors"}
    unchecked = _unchecked(root)
    assert not set(unchecked) - set(modules)
    assert len(unchecked) <= MOST_UNCHECKED


def test_ways_around_the_checker_are_few(sources: list[Path]) -> None:
    """Comments that silence it, and casts."""
    found = []
    for path in sources:
        with open(path, "rb") as file:
            tokens = list(tokenize.tokenize(file.readline))
        found += [
            f"{path.name}:{t.start[0]}"
            for t in tokens
            if t.type == tokenize.COMMENT and PRAGMA.match(t.string)
        ]
        found += [f"{path.name}:{n.lineno}" for n in ast.walk(_tree(path)) if _is_cast(n)]
    assert len(found) <= MOST_PRAGMAS, found


def test_any_is_seldom_said(sources: list[Path]) -> None:
    """Each use counts but the import: as a name, or as an attribute of a module."""
    found = []
    for path in sources:
        for node in ast.walk(_tree(path)):
            name = getattr(node, "id", None) or getattr(node, "attr", None)
            if isinstance(node, ast.Name | ast.Attribute) and name == "Any":
                found.append(f"{path.name}:{node.lineno}")
    assert len(found) <= MOST_ANY, len(found)


def _tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text("utf-8"))


def _is_cast(node: ast.AST) -> bool:
    """`cast(…)` or `typing.cast(…)`; SQL has a cast of its own."""
    if not isinstance(node, ast.Call):
        return False
    called = node.func
    if isinstance(called, ast.Attribute):
        return called.attr == "cast" and getattr(called.value, "id", "") == "typing"
    return isinstance(called, ast.Name) and called.id == "cast"
