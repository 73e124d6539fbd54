"""The tree as lists of files, for tests that hold all of it to a rule."""

from __future__ import annotations

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
ROOMS = ("analysis", "benchmarks", "configs", "experiment", "renderer", "tasks")
MADE_HERE = {"__pycache__", "build", "dist", "out"}


def _is_ours(path: Path) -> bool:
    """Whether a file belongs to the project: not made by a tool, not a participant's."""
    parts = path.relative_to(ROOT).parts
    if any(part in MADE_HERE or part.endswith(".egg-info") for part in parts[:-1]):
        return False
    if any(part.startswith(".") and part != ".ci" for part in parts[:-1]):
        return False
    if parts[0] == "data":
        return parts[1] in ("README.md", "published", "walks")
    return path.suffix not in {".nbi", ".nbc", ".pyc"}


@pytest.fixture(scope="session")
def root() -> Path:
    """The checkout."""
    return ROOT


@pytest.fixture(scope="session")
def tree() -> list[Path]:
    """Every file of the project, tests and documents included."""
    tops = [top for top in ROOT.iterdir() if not top.name.startswith(".") or top.name == ".ci"]
    files = [f for top in tops for f in ([top] if top.is_file() else top.rglob("*"))]
    return sorted(f for f in files if f.is_file() and _is_ours(f))


@pytest.fixture(scope="session")
def sources(tree: list[Path]) -> list[Path]:
    """The Python files of our package, whose rooms lie at the top of the checkout."""
    ours = {*ROOMS, "seethrough"}
    return [f for f in tree if f.suffix == ".py" and f.relative_to(ROOT).parts[0] in ours]


@pytest.fixture(scope="session")
def modules(sources: list[Path]) -> list[str]:
    """The names under which our files are imported; `__main__` is run, not imported."""
    paths = [f.relative_to(ROOT).with_suffix("") for f in sources if f.name != "__main__.py"]
    names = [".".join(p.parent.parts if p.name == "__init__" else p.parts) for p in paths]
    return [n if n.partition(".")[0] == "seethrough" else f"seethrough.{n}" for n in names]


@pytest.fixture(scope="session")
def linked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder in which `seethrough` lies whole, as in the wheel: for readers of folders."""
    folder = tmp_path_factory.mktemp("linked")
    (folder / "seethrough").mkdir()
    for source in (ROOT / "seethrough").glob("*.py"):
        (folder / "seethrough" / source.name).symlink_to(source)
    for room in ROOMS:
        (folder / "seethrough" / room).symlink_to(ROOT / room, target_is_directory=True)
    return folder
