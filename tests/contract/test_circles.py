"""No two modules, and no two rooms, need each other: what one imports as it is imported counts.

A room is a folder with the files in it, without the folders. What only types need (TYPE_CHECKING)
or a function when it is called does not count, nor does what starts the program (`__main__`).
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

Graph = dict[str, set[str]]


def _imported(node: ast.AST, known: set[str]) -> Iterator[str]:
    """The modules of ours that a module imports as it is imported itself."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            continue
        if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.dump(child.test):
            continue
        if isinstance(child, ast.ImportFrom) and child.module:
            for alias in child.names:
                inner = f"{child.module}.{alias.name}"
                yield inner if inner in known else child.module
        elif isinstance(child, ast.Import):
            yield from (alias.name for alias in child.names)
        else:
            yield from _imported(child, known)


def _modules(root: Path, sources: list[Path]) -> dict[str, Path]:
    """Name → file; a package has its folder's name."""
    found = {}
    for path in sources:
        parts = path.relative_to(root).with_suffix("").parts
        name = ".".join(parts if parts[0] == "seethrough" else ("seethrough", *parts))
        if path.name != "__main__.py":
            found[name.removesuffix(".__init__")] = path
    return found


def _graph(files: Mapping[str, Path]) -> Graph:
    names = set(files)
    read = {name: ast.parse(path.read_text("utf-8")) for name, path in files.items()}
    return {n: {t for t in _imported(tree, names) if t in names} - {n} for n, tree in read.items()}


def _rooms(files: Mapping[str, Path], modules: Graph) -> Graph:
    room = {n: n if p.name == "__init__.py" else n.rpartition(".")[0] for n, p in files.items()}
    room["seethrough.api"] = "seethrough.api"  # the front of the house: nothing stands before it
    rooms: Graph = {name: set() for name in room.values()}
    for name, needed in modules.items():
        rooms[room[name]] |= {room[n] for n in needed} - {room[name]}
    return rooms


def _circle(graph: Graph) -> list[str]:
    """One circle; empty if there is none."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def test_no_circles(root: Path, sources: list[Path]) -> None:
    """Neither between modules nor between rooms."""
    files = _modules(root, sources)
    modules = _graph(files)
    assert sum(map(len, modules.values())) > 1000  # it finds what there is
    assert _circle(modules) == []
    assert _circle(_rooms(files, modules)) == []


def test_a_circle_is_found() -> None:
    assert _circle({"a": {"b"}, "b": {"c"}, "c": {"a"}})
    assert not _circle({"a": {"b", "c"}, "b": {"c"}, "c": set()})
