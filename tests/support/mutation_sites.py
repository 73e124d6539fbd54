"""Places in the code where it can be changed a little, and what may stand there instead."""

from __future__ import annotations

import ast
import re
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOMS = ("analysis", "experiment", "renderer", "tasks")

COMPARISONS: dict[type[ast.cmpop], tuple[str, ...]] = {
    ast.Lt: ("<=", ">="),
    ast.LtE: ("<", ">"),
    ast.Gt: (">=", "<="),
    ast.GtE: (">", "<"),
    ast.Eq: ("!=",),
    ast.NotEq: ("==",),
    ast.Is: ("is not",),
    ast.IsNot: ("is",),
    ast.In: ("not in",),
    ast.NotIn: ("in",),
}
ARITHMETIC: dict[type[ast.operator], str] = {
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
# calls that mean the same, or cannot run, with their first two arguments exchanged
EITHER_WAY = {"min", "max", "minimum", "maximum", "isinstance", "issubclass", "getattr", "hypot"}


@dataclass(frozen=True)
class Site:
    """A place in a file (characters start to end), what to put there, and its line; `compiled`:
    kernels may hold it, for it is in one, or in no function."""

    path: str
    line: int
    start: int
    end: int
    text: str
    compiled: bool

    @property
    def room(self) -> str:
        """The package it is in."""
        return self.path.partition("/")[0]

    def applied(self, source: str) -> str:
        """The file with the change."""
        return source[: self.start] + self.text + source[self.end :]

    def told(self, root: Path) -> str:
        """Where, what stands there and what would, in one line."""
        was = (root / self.path).read_text("utf-8")[self.start : self.end]
        before, after = (" ".join(text.split()) for text in (was, self.text))
        return f"{self.path}:{self.line}: {before[:70]} -> {after[:70]}"


def sites(path: Path, root: Path) -> Iterator[Site]:
    """Every change of a file that an operator makes."""
    source = path.read_text("utf-8")
    lines = source.splitlines(keepends=True)
    starts = np.cumsum([0, *(len(line) for line in lines)])

    def at(line: int, column: int) -> int:
        """Position in characters: ast counts bytes of UTF-8."""
        return int(starts[line - 1]) + len(lines[line - 1].encode()[:column].decode())

    def ends(node: ast.expr | ast.stmt) -> tuple[int, int]:
        last = at(node.end_lineno or node.lineno, node.end_col_offset or 0)
        return at(node.lineno, node.col_offset), last

    def text_of(node: ast.expr) -> str:
        first, last = ends(node)
        return source[first:last]

    def made(node: ast.expr | ast.stmt, text: str, compiled: bool) -> Site:
        return Site(str(path.relative_to(root)), node.lineno, *ends(node), text, compiled)

    def visit(node: ast.AST, compiled: bool) -> Iterator[Site]:
        if isinstance(node, ast.FunctionDef):
            compiled = any("njit" in ast.unparse(d) for d in node.decorator_list)
        for place, text in _changed(node, text_of):
            yield made(place, text, compiled)
        for child in _run(node):
            yield from visit(child, compiled)

    yield from visit(ast.parse(source), True)


def _run(node: ast.AST) -> list[ast.AST]:
    """The parts of a node that are run: annotations are not."""
    match node:
        case ast.AnnAssign(target=target, value=value):
            return [target, *([] if value is None else [value])]
        case ast.FunctionDef(body=body, args=args):
            return [*body, args]
        case ast.ClassDef(body=body):  # what stands above and beside a class's name is its kind
            return list(body)
        case ast.arguments(defaults=defaults, kw_defaults=named):
            return [*defaults, *(d for d in named if d is not None)]
        case ast.If(test=ast.Name(id="TYPE_CHECKING")):
            return []
    return list(ast.iter_child_nodes(node))


def _changed(
    node: ast.AST, text: Callable[[ast.expr], str]
) -> Iterator[tuple[ast.expr | ast.stmt, str]]:
    """What may be put where, as source; `text` gives an expression's."""
    match node:
        case ast.Compare(left=left, ops=[op], comparators=[right]):
            for other in COMPARISONS[type(op)]:
                yield node, f"({text(left)} {other} {text(right)})"
        case ast.BinOp(left=left, op=op, right=right) if type(op) in ARITHMETIC:
            if not any(isinstance(s, ast.JoinedStr) or _is_text(s) for s in (left, right)):
                yield node, f"({text(left)} {ARITHMETIC[type(op)]} {text(right)})"
        case ast.UnaryOp(op=ast.Not() | ast.USub(), operand=operand):
            yield node, f"({text(operand)})"
        case ast.BoolOp(op=op, values=[first, second]):
            other = "or" if isinstance(op, ast.And) else "and"
            yield node, f"({text(first)} {other} {text(second)})"
        case ast.Constant(value=bool(value)):
            yield node, str(not value)
        case ast.Constant(value=int(value)):
            yield node, f"({value} + 1)"
        case ast.Constant(value=float(value)) if value != 0:
            yield node, f"({value!r} * 1.5)"
        case ast.Call(func=ast.Name(id="min" | "max" as name)):
            yield node, ("max" if name == "min" else "min") + text(node)[3:]
        case ast.Call(func=func, args=[ast.expr() as first, ast.expr() as second, *_]):
            starred = isinstance(first, ast.Starred) or isinstance(second, ast.Starred)
            if text(func).rpartition(".")[2] not in EITHER_WAY and not starred:
                whole, size = text(node), len(text(func))
                inner = whole[size:].replace(text(first), "\0", 1).replace(text(second), "\1", 1)
                turned = inner.replace("\0", text(second)).replace("\1", text(first))
                if turned != whole[size:]:
                    yield node, text(func) + turned
        case ast.Expr(value=ast.Call()):
            yield node, "pass"
        case ast.Return(value=ast.expr() as value) if not (
            isinstance(value, ast.Constant) and value.value is None
        ):
            yield node, "return None"
        case ast.If(test=test) | ast.IfExp(test=test):
            yield test, "True"
            yield test, f"(not ({text(test)}))"
        case ast.While(test=test) if not isinstance(test, ast.Constant):
            yield test, f"(not ({text(test)}))"
        case ast.comprehension(ifs=[test]):
            yield test, "True"


def _is_text(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def drawn(number: int, seed: int, root: Path, since: str = "") -> list[Site]:
    """Sites of all rooms: as many of each room, a file's as likely as its number of changes; in the
    order in which they were drawn, so that the first of them are a sample as well. `since`: only of
    lines that are newer than that commit."""
    newer = _newer(root, since) if since else None
    rng = np.random.default_rng(seed)
    chosen = []
    for room in ROOMS:
        every = [
            site
            for path in sorted((root / room).rglob("*.py"))
            if newer is None or path.relative_to(root).as_posix() in newer
            for site in sites(path, root)
            if newer is None or site.line in newer[site.path]
        ]
        share = min(-(-number // len(ROOMS)), len(every))
        picked = rng.choice(len(every), share, replace=False)
        print(f"{room}: {len(every)} possible changes, {share} drawn", flush=True)
        chosen += [every[k] for k in picked]
    return [chosen[k] for k in rng.permutation(len(chosen))][:number]


def _newer(root: Path, since: str) -> dict[str, set[int]]:
    """Lines of each file that came after a commit."""
    command = ["git", "diff", "--unified=0", since, "--", *ROOMS]
    told = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True).stdout
    found: dict[str, set[int]] = {}
    path = ""
    for line in told.splitlines():
        if line.startswith("+++ "):
            path = line.removeprefix("+++ b/")
        elif match := re.match(r"@@ -\S+ \+(\d+)(?:,(\d+))? @@", line):
            first, count = int(match[1]), int(match[2] or 1)
            found.setdefault(path, set()).update(range(first, first + count))
    return found


def listed(file: Path, root: Path) -> list[Site]:
    """Changes made by hand: three lines each, `path`, what stands there (once) and what shall,
    then an empty line; `⏎` breaks a line.

    Raises ValueError for text that is not in its file just once."""
    found = []
    for block in file.read_text("utf-8").strip().split("\n\n"):
        path, was, text = (part.replace("⏎", "\n") for part in block.splitlines())
        source = (root / path).read_text("utf-8")
        if source.count(was) != 1:
            raise ValueError(f"{path}: {was!r}: there {source.count(was)} times, expected once")
        start = source.index(was)
        line = source.count("\n", 0, start) + 1
        around = [
            node
            for node in ast.walk(ast.parse(source))
            if isinstance(node, ast.FunctionDef) and node.lineno <= line <= (node.end_lineno or 0)
        ]
        compiled = all(any("njit" in ast.unparse(d) for d in f.decorator_list) for f in around)
        found.append(Site(path, line, start, start + len(was), text, compiled))
    return found
