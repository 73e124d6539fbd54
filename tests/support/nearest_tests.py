"""Which files of tests concern a module: those nearest to it by who imports whom."""

from __future__ import annotations

import ast
import heapq
import re
from pathlib import Path

from mutation_sites import ROOMS

KINDS = ("tests/unit", "tests/hard", "tests/images", "tests/study", "tests/contract")
BY_NAME = {  # who imports modules whose names it makes at run time: from where
    "experiment/cli.py": ("experiment/commands/",),
    "seethrough/registry.py": ("renderer/techniques/", "tasks/", "experiment/questions/"),
}


class Imports:
    """Who imports whom in a checkout, functions' own imports included."""

    def __init__(self, root: Path) -> None:
        self.root = root
        folders = (*ROOMS, "seethrough", "benchmarks", "tests")
        self.text = {
            path.relative_to(root).as_posix(): path.read_text("utf-8")
            for folder in folders
            for path in sorted((root / folder).rglob("*.py"))
        }
        self.users: dict[str, set[str]] = {}
        for path, text in self.text.items():
            for used in self._used(path, text):
                self.users.setdefault(used, set()).add(path)

    def _used(self, path: str, text: str) -> set[str]:
        found = set()
        for node in ast.walk(ast.parse(text)):
            names: list[str] = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and node.module:
                names = [f"{node.module}.{alias.name}" for alias in node.names]
            elif isinstance(node, ast.Constant) and isinstance(node.value, str):
                if re.fullmatch(r"seethrough(\.\w+)+", node.value):  # `python -m`
                    names = [node.value]
            found |= {self._file(name) for name in names}
        for start in BY_NAME.get(path, ()):
            found |= {
                other
                for other in self.text
                if other.startswith(start) and ("commands" in start or "__init__" in other)
            }
        return found - {"", path}

    def _file(self, name: str) -> str:
        """The file of a module, or of the module that a name is in; empty if it is none of ours."""
        for _ in range(2):
            inner = name.removeprefix("seethrough.").replace(".", "/")
            for path in (f"{inner}.py", f"{inner}/__init__.py"):
                for place in ("", "seethrough/", "tests/support/"):
                    if place + path in self.text:
                        return place + path
            name = name.rpartition(".")[0]
        return ""

    def nearest(self, path: str) -> list[str]:
        """Files of tests, nearest first: by the number of imports between (a package that passes a
        name on counts half), whether they name the module, the kind of test, and length."""
        far = {path: 0.0}
        heap = [(0.0, path)]
        while heap:
            distance, place = heapq.heappop(heap)
            if distance > far[place] or Path(place).name.startswith("test_"):
                continue
            for user in self.users.get(place, ()):
                step = 2.0 if user in BY_NAME else 0.5 if user.endswith("__init__.py") else 1.0
                there = distance + step
                if there < far.get(user, 99.0):
                    far[user] = there
                    heapq.heappush(heap, (there, user))
        folder, stem = Path(path).parent.name, Path(path).stem.strip("_")
        words = set((folder if stem == "init" else stem).split("_"))
        said = rf"""["'/ .]({re.escape(folder)}|{re.escape(stem)})["' .(]"""
        found = [p for p in far if Path(p).name.startswith("test_")]

        def rank(test: str) -> tuple[float, int, int]:
            named = bool(words & set(Path(test).stem.split("_")))
            named += bool(re.search(said, self.text[test]))
            kind = KINDS.index("/".join(test.split("/")[:2]))
            dear = {3: 1.0, 4: 0.5}.get(kind, 0.0)  # whole sessions, whole trees
            return far[test] - 0.75 * named + dear, kind, len(self.text[test])

        return sorted(found, key=rank)
