"""What describes itself is named in its own folder: the rest asks for it."""

from __future__ import annotations

import re
from pathlib import Path

# The first study's two techniques: where one of them stands, a third has no place.
NAMED = re.compile(r"""(["'])(standard|dynamic)\1""")
WHERE_THEY_MAY = (
    "renderer/techniques/standard/",
    "renderer/techniques/dynamic/",
    "configs/",
    "benchmarks/",
    "docs/",
    "tests/",
    "analysis/published/",
    "analysis/before.py",  # what a study without a `design` varied: readers of old data
    "experiment/study/migrate.py",
    "experiment/study/migrate_file.py",
    "experiment/people/fitted/",  # the two levels whose times simulated people are fitted to
    # Feudal priority's two versions are called static and dynamic.
    "renderer/polygons/feudal/feudal.py",
    "renderer/polygons/methods.py",
)


def test_no_technique_is_named_elsewhere(root: Path, sources: list[Path]) -> None:
    """Standard and dynamic stand where they are at home, and where data or the paper say them."""
    found = []
    for path in sources:
        name = path.relative_to(root).as_posix()
        if not name.startswith(WHERE_THEY_MAY):
            lines = path.read_text("utf-8").splitlines()
            found += [f"{name}:{n}" for n, line in enumerate(lines, 1) if NAMED.search(line)]
    assert not found
