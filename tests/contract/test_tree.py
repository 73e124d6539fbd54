"""What no file of the project may be or hold."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

LONGEST_FILE = 400  # lines: a file holds one thing, and its reader can hold it too
MOST_PARAMETERS = 10  # of a function: what belongs together travels as a record
LARGEST_FILE = 2**20  # bytes: what is larger is made by a command, not kept
CODE = {".py", ".vert", ".frag", ".geom", ".comp", ".glsl", ".css", ".js"}
TEXT = {*CODE, ".md", ".toml", ".txt", ".cff", ".csv", ".json", ".html", ".yml", ".svg", ""}

# Written in pieces, so that this file does not hold what it looks for.
HOSTS = ("pypi" + r"\.org", "python" + "hosted", r"registry\.npm" + "js", "deb" + r"\.debian")
HOMES = ("wo" + "rk", "ro" + "ot", "ho" + "me", "Us" + "ers")
FORBIDDEN = {
    "a registry's host": re.compile("|".join(HOSTS)),
    "a path of somebody's machine": re.compile(rf"(?<![\w.<])/(?:{'|'.join(HOMES)})/\w"),
    "a folder outside the project": re.compile(r"\.\./sha" + "red"),
    "a postponement": re.compile(r"\b(?:TO" + "DO|FIX" + r"ME)\b"),
}
UNFINISHED = re.compile("NotImplemented" + "Error")
LEFT_OUT = re.compile(r"\bpytest\." + r"(?:mark\.)?(?:skip|skipif|xfail|importorskip)\b")
# Reproducible streams come from a SeedSequence that is an argument, time from a clock.
STRAY = {
    "a stream made by adding to a seed": re.compile(r"\bseed\s*\+(?!=)\s*\w"),
    "a stream that nobody seeded": re.compile(r"default_rng\(\s*\)"),
    "the wall clock": re.compile(r"\btime\.time\(|\bdatetime\.now\(\)|\butcnow\("),
    "Python's global random numbers": re.compile(r"^\s*(?:import random\b|from random\b)", re.M),
}


def _text(path: Path) -> str:
    return path.read_text("utf-8") if path.suffix in TEXT else ""


def _holding(pattern: re.Pattern[str], files: list[Path], root: Path) -> list[str]:
    """`file:line: text` for each match."""
    found = []
    for file in files:
        for number, line in enumerate(_text(file).splitlines(), 1):
            if pattern.search(line):
                found.append(f"{file.relative_to(root)}:{number}: {line.strip()[:80]}")
    return found


@pytest.mark.parametrize("words", [["check"], ["format", "--check"]], ids=["check", "format"])
def test_ruff_agrees(words: list[str], root: Path) -> None:
    """The linter and the formatter have nothing to say."""
    ruff = Path(sys.executable).with_name("ruff")
    command = [ruff, *words, "--no-cache", "--quiet", "."]
    run = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr


def test_files_hold_one_thing(tree: list[Path], root: Path) -> None:
    """No file of code is longer than 400 lines."""
    lengths = {f.relative_to(root): len(_text(f).splitlines()) for f in tree if f.suffix in CODE}
    assert len(lengths) > 20
    assert not {str(path): n for path, n in lengths.items() if n > LONGEST_FILE}


def test_no_function_takes_more_than_ten_parameters(tree: list[Path], root: Path) -> None:
    """Kernels take named tuples, which cost compiled code nothing."""
    found = {}
    for file in (f for f in tree if f.suffix == ".py"):
        for node in ast.walk(ast.parse(_text(file))):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                names = [a.arg for a in (*node.args.posonlyargs, *node.args.args,
                                         *node.args.kwonlyargs)]  # fmt: skip
                where = f"{file.relative_to(root)}:{node.lineno} {node.name}"
                found[where] = len(names) - (names[:1] in (["self"], ["cls"]))
    assert len(found) > 5000  # it finds what there is
    assert {where: n for where, n in found.items() if n > MOST_PARAMETERS} == {}


def test_files_are_small(tree: list[Path], root: Path) -> None:
    """No file is larger than 1 MiB."""
    sizes = {str(f.relative_to(root)): f.stat().st_size for f in tree}
    assert not {path: size for path, size in sizes.items() if size > LARGEST_FILE}


@pytest.mark.parametrize("what", FORBIDDEN)
def test_no_file_names(what: str, tree: list[Path], root: Path) -> None:
    """Nothing in the tree ties it to one machine, one registry or a later day."""
    assert not _holding(FORBIDDEN[what], tree, root)


@pytest.mark.parametrize("what", STRAY)
def test_sources_have_no(what: str, sources: list[Path], root: Path) -> None:
    """Randomness and time are arguments (CONVENTIONS.md)."""
    assert not _holding(STRAY[what], sources, root)


def test_no_stub_is_called_done(sources: list[Path], root: Path) -> None:
    """No function only says that it is missing."""
    assert not _holding(UNFINISHED, sources, root)


def test_no_test_is_left_out(tree: list[Path], root: Path) -> None:
    """Every test runs everywhere."""
    tests = [f for f in tree if f.relative_to(root).parts[0] == "tests"]
    assert tests
    assert not _holding(LEFT_OUT, [f for f in tests if f.suffix == ".py"], root)
    assert not [str(f.relative_to(root)) for f in tests if f.name == "__init__.py"], (
        "a package under tests/ would shadow ours"
    )


def test_public_names_are_documented(sources: list[Path], root: Path) -> None:
    """Every module, public class and public function says what it is."""
    silent = []
    for source in sources:
        module = ast.parse(source.read_text("utf-8"))
        nodes = [node for node in module.body if isinstance(node, ast.FunctionDef | ast.ClassDef)]
        public = [node for node in nodes if not node.name.startswith("_")]
        for node in [module, *public]:
            if not ast.get_docstring(node):
                name = getattr(node, "name", "the module")
                silent.append(f"{source.relative_to(root)}: {name}")
    assert not silent


MADE = {"parquet/"}  # in a study's data folder
NAMED = re.compile(r"`([\w./-]+(?:/|\.(?:py|md|toml|txt|R|frag|rst|csv|json)))`")


@pytest.mark.parametrize("page", ["ARCHITECTURE.md", "CONTRIBUTING.md", "CONVENTIONS.md"])
def test_pages_name_files_that_there_are(page: str, tree: list[Path], root: Path) -> None:
    """Each file and folder between backquotes, by its path or by the end of one."""
    files = [f"/{f.relative_to(root).as_posix()}" for f in tree]
    there = [*files, *{f[: i + 1] for f in files for i, c in enumerate(f) if c == "/"}]
    named = {n for n in NAMED.findall((root / page).read_text("utf-8")) if n not in MADE}
    assert len(named) > 2
    assert [n for n in sorted(named) if not any(f.endswith(f"/{n}") for f in there)] == []


def test_shaders_say_what_they_provide(tree: list[Path], root: Path) -> None:
    """A shader file begins with a comment, after its #version line if it has one."""
    shaders = [f for f in tree if f.suffix in {".vert", ".frag", ".glsl"}]
    silent = []
    for shader in shaders:
        lines = [line for line in _text(shader).splitlines() if line.strip()]
        first = next((line for line in lines if not line.startswith("#version")), "")
        if not first.lstrip().startswith(("//", "/*")):
            silent.append(str(shader.relative_to(root)))
    assert not silent


def test_a_folder_can_be_taken_in_at_a_glance(root: Path) -> None:
    """At most 20 modules of ours side by side, the package's own file not counted."""
    found = {}
    for room in ("analysis", "benchmarks", "experiment", "renderer", "seethrough", "tasks"):
        for folder in [root / room, *(p for p in (root / room).rglob("*") if p.is_dir())]:
            found[folder] = sum(p.name != "__init__.py" for p in folder.glob("*.py"))
    assert sum(found.values()) > 500  # it finds what there is
    assert {folder: count for folder, count in found.items() if count > 20} == {}
