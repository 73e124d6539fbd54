r"""Changes the code in one place at a time and asks whether a test notices.

    python tests/support/mutations.py --sites 120 --seed 1 --coverage FILE [--out FILE]

Sites are drawn evenly from all places in the rooms where an operator applies (a comparison turned
or made strict, a sign, a constant, a condition, a call left out). FILE is the database of a run of
the whole suite in which coverage.py noted which test passes each line:

    python -m pytest -n2 --dist loadscope -p forgetful --cov-context=test --cov-report= \
      --cov=analysis --cov=experiment --cov=renderer --cov=tasks && mv .coverage FILE

A site is tried in a copy of the checkout, on the tests that pass its line, then on the others of
their files, which may look at what the first of them made. Kernels are compiled, so
coverage.py cannot see their lines, and what is run while a module is imported belongs to no test:
for those, on all tests that pass any line of the files that use them, first of all those in files
that name the module. A test that fails catches nothing unless it passes in an unchanged copy.
Prints a line a site, then the share caught; exit status 0.
"""

from __future__ import annotations

import argparse
import ast
import json
import os
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from queue import Queue

import numpy as np
from coverage.numbits import numbits_to_nums

ROOT = Path(__file__).resolve().parents[2]
ROOMS = ("analysis", "experiment", "renderer", "tasks")
MOST_TESTS = 400  # tried for a site of a kind; more only repeat each other
LIMIT = 900  # s for the tests of a site: a change that never ends is caught

COMPARISONS = {
    ast.Lt: "<=",
    ast.LtE: "<",
    ast.Gt: ">=",
    ast.GtE: ">",
    ast.Eq: "!=",
    ast.NotEq: "==",
    ast.Is: "is not",
    ast.IsNot: "is",
    ast.In: "not in",
    ast.NotIn: "in",
}
ARITHMETIC = {
    ast.Add: "-",
    ast.Sub: "+",
    ast.Mult: "/",
    ast.Div: "*",
    ast.FloorDiv: "/",
    ast.Mod: "*",
    ast.Pow: "*",
    ast.BitAnd: "|",
    ast.BitOr: "&",
    ast.LShift: ">>",
    ast.RShift: "<<",
}


@dataclass(frozen=True)
class Site:
    """A place in a file (characters start to end), what to put there, and its line."""

    path: str
    line: int
    start: int
    end: int
    text: str
    compiled: bool

    def applied(self, source: str) -> str:
        """The file with the change."""
        return source[: self.start] + self.text + source[self.end :]


def sites(path: Path, root: Path) -> Iterator[Site]:
    """Every place of a file where an operator applies."""
    source = path.read_text("utf-8")
    starts = np.cumsum([0, *(len(line) for line in source.splitlines(keepends=True))])
    lines = source.splitlines(keepends=True)

    def at(line: int, column: int) -> int:
        """Position in characters: ast counts bytes of UTF-8."""
        return int(starts[line - 1]) + len(lines[line - 1].encode()[:column].decode())

    def made(node: ast.AST, text: str, compiled: bool) -> Site:
        start, end = at(node.lineno, node.col_offset), at(node.end_lineno, node.end_col_offset)
        return Site(str(path.relative_to(root)), node.lineno, start, end, text, compiled)

    def visit(node: ast.AST, compiled: bool) -> Iterator[Site]:
        if isinstance(node, ast.FunctionDef):
            compiled |= any("njit" in ast.unparse(d) for d in node.decorator_list)
        if isinstance(node, ast.AnnAssign):  # annotations are not run
            children = [child for child in (node.target, node.value) if child is not None]
        elif isinstance(node, ast.FunctionDef | ast.arguments):
            parts = [*getattr(node, "body", []), getattr(node, "args", None)]
            children = [p for p in parts if isinstance(p, ast.AST)]
            if isinstance(node, ast.arguments):
                children = [d for d in (*node.defaults, *node.kw_defaults) if d is not None]
        else:
            children = list(ast.iter_child_nodes(node))
        yield from ((made(node, text, compiled)) for text in _changed(node, source))
        for child in children:
            yield from visit(child, compiled)

    yield from visit(ast.parse(source), False)


def _changed(node: ast.AST, source: str) -> list[str]:
    """What may stand in a node's place, as source."""

    def text(part: ast.AST) -> str:
        return ast.get_source_segment(source, part) or ""

    match node:
        case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in COMPARISONS:
            return [f"({text(left)} {COMPARISONS[type(op)]} {text(right)})"]
        case ast.BinOp(left=left, op=op, right=right) if type(op) in ARITHMETIC:
            if isinstance(left, ast.Constant) and isinstance(left.value, str):
                return []
            return [f"({text(left)} {ARITHMETIC[type(op)]} {text(right)})"]
        case ast.UnaryOp(op=ast.Not() | ast.USub(), operand=operand):
            return [f"({text(operand)})"]
        case ast.BoolOp(op=op, values=[first, second]):
            return [f"({text(first)} {'or' if isinstance(op, ast.And) else 'and'} {text(second)})"]
        case ast.Constant(value=bool(value)):
            return [str(not value)]
        case ast.Constant(value=int(value)):
            return [f"({value} + 1)"]
        case ast.Constant(value=float(value)) if value != 0:
            return [f"({value!r} * 1.5)"]
        case ast.Call(func=ast.Name(id="min" | "max" as name)):
            return [("max" if name == "min" else "min") + text(node)[3:]]
        case ast.Expr(value=ast.Call()):
            return ["pass"]
    return []


def drawn(number: int, seed: int, root: Path = ROOT) -> list[Site]:
    """Sites of all rooms, each file's as likely as its number of them; in the order in which they
    were drawn, so that the first of them are a sample as well."""
    every = [
        site
        for room in ROOMS
        for path in sorted((root / room).rglob("*.py"))
        for site in sites(path, root)
    ]
    chosen = np.random.default_rng(seed).choice(len(every), min(number, len(every)), replace=False)
    print(f"{len(every)} sites, {len(chosen)} drawn with seed {seed}", flush=True)
    return [every[k] for k in chosen]


class Passed:
    """Which tests pass which lines, from coverage.py's database."""

    def __init__(self, database: Path, root: Path = ROOT) -> None:
        self.root = root
        self.known: dict[str, dict[int, set[str]]] = {}
        self.size: dict[str, int] = {}  # lines that a test passes: those of few are quick
        rows = sqlite3.connect(f"file:{database}?mode=ro", uri=True).execute(
            "SELECT f.path, c.context, l.numbits FROM line_bits l "
            "JOIN file f ON f.id = l.file_id JOIN context c ON c.id = l.context_id"
        )
        for path, context, bits in rows:
            if not context:  # passed while a module was imported
                continue
            lines = self.known.setdefault(Path(path).relative_to(root).as_posix(), {})
            test, numbers = context.partition("|")[0], numbits_to_nums(bits)
            self.size[test] = self.size.get(test, 0) + len(numbers)
            for line in numbers:
                lines.setdefault(line, set()).add(test)

    def tests(self, site: Site) -> list[str]:
        """The tests to try, quick kinds first."""
        found = set(self.known.get(site.path, {}).get(site.line, ()))
        first = found
        if not found or site.compiled:
            module = Path(site.path).with_suffix("").as_posix().replace("/", ".")
            for user in (site.path, *self._users(module)):
                found |= set().union(*self.known.get(user, {}).values(), set())
            first = {test for test in found if self._names(test.partition("::")[0], module)}
        else:  # what one test made for all of its file, the others look at
            files = {test.partition("::")[0] for test in found}
            found = found | {test for test in self.size if test.partition("::")[0] in files}
        kinds = ("tests/unit", "tests/hard", "tests/images", "tests/contract", "tests/study")
        rank = {kind: k for k, kind in enumerate(kinds)}
        ordered = sorted(
            found,
            key=lambda t: (t not in first, rank["/".join(t.split("/")[:2])], self.size[t], t),
        )
        return _fewer(ordered[: len(first)]) + _fewer(ordered[len(first) :])

    def in_kernels(self, site: Site) -> bool:
        """Whether compiled code may hold the place: its own file's, or a constant's users'."""
        if site.compiled or site.line in self.known.get(site.path, {}):
            return site.compiled
        module = Path(site.path).with_suffix("").as_posix().replace("/", ".")
        users = (site.path, *self._users(module))
        return any("njit" in (self.root / user).read_text("utf-8") for user in users)

    def _names(self, test: str, module: str) -> bool:
        """Whether a file of tests imports the module."""
        package, _, name = module.rpartition(".")
        words = rf"{re.escape(module)}\b|{re.escape(package)} import [^\n]*\b{re.escape(name)}\b"
        return bool(re.search(words, (self.root / test).read_text("utf-8")))

    def _users(self, module: str) -> list[str]:
        """Files that import the module."""
        package, _, name = module.rpartition(".")
        words = (module, f"{package} import")
        return [
            path
            for path in self.known
            if any(w in (text := (self.root / path).read_text("utf-8")) for w in words)
            and (module in text or name in text)
        ]


def _fewer(tests: list[str]) -> list[str]:
    """At most MOST_TESTS of them, spread evenly."""
    step = max(1.0, len(tests) / MOST_TESTS)
    return [tests[int(k * step)] for k in range(min(len(tests), MOST_TESTS))]


def caught(site: Site, tests: list[str], copy: Path, fresh: bool) -> tuple[bool | None, str]:
    """Whether a test fails with the change, and which; None if there is no test to try. `fresh`:
    kernels are compiled anew, for the change may be in them."""
    if not tests:
        return None, ""
    file = copy / site.path
    source = file.read_text("utf-8")
    file.write_text(site.applied(source), "utf-8")
    cache = tempfile.mkdtemp(prefix="numba-") if fresh else None
    try:
        status, failed = _run(tests, copy, ["-x"], {"NUMBA_CACHE_DIR": cache} if cache else {})
        return status != 0, failed[0] if failed else ""
    finally:
        file.write_text(source, "utf-8")
        if cache:
            shutil.rmtree(cache)


def _run(
    tests: list[str], copy: Path, options: list[str], more: dict[str, str]
) -> tuple[int, list[str]]:
    """pytest's exit status in a copy, and which failed: of `tests`, or files that are no more
    imported."""
    (copy / "chosen.txt").write_text("\n".join(tests), "utf-8")
    options = [*options, "-q", "-n0", "-p", "no:cacheprovider", "--no-header", "--tb=no"]
    command = [sys.executable, "-m", "pytest", *options, f"@{copy / 'chosen.txt'}"]
    environment = {**_environment(copy), **more}
    try:
        run = subprocess.run(
            command, cwd=copy, env=environment, capture_output=True, timeout=LIMIT, check=False
        )
    except subprocess.TimeoutExpired:
        return 1, []
    told = re.findall(r"^(?:FAILED|ERROR) (.+)$", run.stdout.decode(errors="replace"), re.M)
    names = {*tests, *(test.partition("::")[0] for test in tests)}
    found = [[n for n in names if t == n or t.startswith(f"{n} - ")] for t in told]
    return run.returncode, [max(each, key=len) for each in found if each]


def _environment(copy: Path) -> dict[str, str]:
    """In which Python imports the copy's code: the folder it is started in comes in no case first,
    for its `seethrough` has no rooms, and those of the checkout would be taken."""
    more = {"PYTHONPATH": _path(copy), "PYTHONSAFEPATH": "1", "PYTHONDONTWRITEBYTECODE": "1"}
    return {**os.environ, **more}


def _is_imported(copy: Path) -> bool:
    """Whether the copy's code is what its tests test."""
    command = [sys.executable, "-c", "import seethrough.renderer as r; print(r.__file__)"]
    run = subprocess.run(
        command, cwd=copy, env=_environment(copy), capture_output=True, text=True, check=True
    )
    return Path(run.stdout.strip()).resolve().is_relative_to(copy.resolve())


def _path(copy: Path) -> str:
    """Where Python finds the copy's code: its rooms lie in `seethrough` if it has that folder."""
    if not (copy / "seethrough").is_dir():
        return str(copy)
    linked = copy / "linked" / "seethrough"
    if not linked.exists():
        linked.mkdir(parents=True)
        for source in (copy / "seethrough").glob("*.py"):
            (linked / source.name).symlink_to(source)
        for room in (p for p in copy.iterdir() if (p / "__init__.py").exists()):
            if room.name not in ("seethrough", "tests"):
                (linked / room.name).symlink_to(room, target_is_directory=True)
    return str(linked.parent)


def _copies(number: int, folder: Path) -> Queue[Path]:
    copies: Queue[Path] = Queue()
    leave = shutil.ignore_patterns(".git", ".venv", "out", ".hypothesis", "*.egg-info", "linked")
    for k in range(number):
        shutil.copytree(ROOT, folder / str(k), ignore=leave)
        assert _is_imported(folder / str(k))
        copies.put(folder / str(k))
    return copies


def main() -> None:
    """The command of the module's text."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sites", type=int, default=120)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--coverage", type=Path, required=True)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--out", type=Path)
    args = parser.parse_args()
    passed, chosen = Passed(args.coverage), drawn(args.sites, args.seed)
    with tempfile.TemporaryDirectory() as folder:
        copies = _copies(args.workers, Path(folder))

        def one(site: Site, useless: frozenset[str] = frozenset()) -> dict[str, object]:
            tests = [test for test in passed.tests(site) if test not in useless]
            copy = copies.get()
            try:
                found, by = caught(site, tests, copy, passed.in_kernels(site))
            finally:
                copies.put(copy)
            source = (ROOT / site.path).read_text("utf-8")
            was = " ".join(source[site.start : site.end].split())
            verdict = {True: "caught", False: "SURVIVED", None: "NO TEST"}[found]
            row = {
                "site": f"{site.path}:{site.line}",
                "was": was,
                "is": " ".join(site.text.split()),
            }
            print(f"{verdict:9}{row['site']}: {was[:60]} -> {row['is'][:60]}", flush=True)
            return {**row, "verdict": verdict, "tests": len(tests), "by": by}

        with ThreadPoolExecutor(args.workers) as pool:
            rows = list(pool.map(one, chosen))
        useless: frozenset[str] = frozenset()
        while True:  # what catches a change passes without it
            by = sorted({str(row["by"]) for row in rows if "::" in str(row["by"])})
            copy = copies.get()
            failed = {
                t for k in range(0, len(by), 20) for t in _run(by[k : k + 20], copy, [], {})[1]
            }
            copies.put(copy)
            if not failed:
                break
            useless |= failed
            print("fail unchanged, too:", *sorted(failed), sep="\n  ", flush=True)
            again = [k for k, row in enumerate(rows) if row["by"] in failed]
            for k in again:
                rows[k] = one(chosen[k], useless)
    number = sum(row["verdict"] == "caught" for row in rows)
    print(f"{number} of {len(rows)} caught: {number / len(rows):.1%}")
    if args.out:
        args.out.write_text(json.dumps(rows, indent=1), "utf-8")


if __name__ == "__main__":
    main()
