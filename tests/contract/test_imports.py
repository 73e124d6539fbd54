"""Who may import whom, and that importing does nothing (ARCHITECTURE.md, CONVENTIONS.md)."""

from __future__ import annotations

import ast
import json
import os
import subprocess
import sys
from functools import cache
from itertools import pairwise
from pathlib import Path

import pytest

ROOMS = ("analysis", "benchmarks", "configs", "experiment", "renderer", "tasks")

# Imports the modules named on standard input, without a display, and prints what each of them
# did besides reading Python files, as {module: [what, ...]}.
WATCHED_IMPORT = """
import importlib, json, os, sys

root = os.getcwd()
did = []

def watch(event, args):
    if event == "open" and not isinstance(args[0], int):  # a descriptor: opened by what is below
        name, mode, flags = args
        name = os.fsdecode(name)
        ours = os.path.abspath(name).startswith(root + os.sep) and "site-packages" not in name
        writes = bool(flags and flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT))
        known = name.endswith((".py", ".pyc")) or ".egg-info" in name  # what an editable one leaves
        if ours and not known and not os.path.isdir(name):
            did.append(f"opened {name}")
        elif writes and name != os.devnull and "__pycache__" not in name:  # numba tries its cache
            did.append(f"wrote {name}")
    elif event in ("subprocess.Popen", "socket.connect", "socket.bind"):
        if "ldconfig" not in str(args[0]):  # ctypes looks for a library
            did.append(f"{event} {args}")

def forbid(owner, name):
    def refuse(*args, **kwargs):
        did.append(f"called {owner.__name__}.{name}")
        raise RuntimeError(name)
    setattr(owner, name, refuse)

import matplotlib.pyplot, moderngl, numba, pandas, statsmodels.api  # theirs may read their files
forbid(moderngl, "create_context")
forbid(moderngl, "create_standalone_context")
sys.addaudithook(watch)
found = {}
for name in json.load(sys.stdin):
    did.clear()
    try:
        importlib.import_module(name)
    except BaseException as error:
        did.append(f"raised {type(error).__name__}: {error}")
    found[name] = list(did)
print("FOUND", json.dumps(found))
"""

# Library -> the files that may import it: the edges where GPU and window live (style: one file
# owns each toolkit). A trailing "/" is a folder.
OWNERS = {
    "moderngl": ("renderer/gpu/", "experiment/", "benchmarks/"),
    "pyglet": (
        "experiment/display/window.py",
        "experiment/display/system_window.py",
        "experiment/display/viewer_window.py",
    ),
    "imgui_bundle": ("experiment/",),
    "pandas": ("analysis/", "experiment/", "benchmarks/"),
    "statsmodels": ("analysis/", "experiment/", "benchmarks/"),
    "matplotlib": ("experiment/", "benchmarks/"),
    "vl_convert": ("analysis/page/charts.py",),
    "PIL": ("experiment/", "analysis/", "benchmarks/", "renderer/models/files/texture.py"),
    "seethrough.renderer.gpu": ("renderer/gpu/", "experiment/", "benchmarks/"),
}

# What must not be loaded once these modules are: the program's --help answers within 0.5 s, and
# a task or a scene is plain values.
HEAVY = ("numba", "scipy.stats", "statsmodels", "pandas", "matplotlib", "moderngl", "pyglet")
LIGHT = {
    "seethrough.experiment.cli": (*HEAVY, "numpy", "imgui_bundle", "rich", "pydantic"),
    "seethrough.experiment.record.columns": (*HEAVY, "numpy"),
    "seethrough.experiment.study.config": (*HEAVY, "imgui_bundle"),
    "seethrough.experiment.record.recorder": (*HEAVY, "imgui_bundle"),
    "seethrough.renderer.scene.scene": HEAVY,
    "seethrough.renderer.models": HEAVY,
    "seethrough.tasks.kit.base": (*HEAVY, "imgui_bundle"),
}


def _python(code: str, root: Path, given: str = "") -> str:
    """What a fresh interpreter prints for `code`, run without a display in the checkout."""
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    environment["PYTHONDONTWRITEBYTECODE"] = "1"
    run = subprocess.run(
        [sys.executable, "-c", code],
        cwd=root,
        env=environment,
        input=given,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    return run.stdout


@pytest.fixture(scope="session")
def what_imports_did(root: Path, modules: list[str]) -> dict[str, list[str]]:
    """{module: what its import did besides importing}."""
    printed = _python(WATCHED_IMPORT, root, json.dumps(modules))
    return json.loads(printed.partition("FOUND ")[2])


@cache
def _imported(source: Path) -> list[str]:
    """Every module a file imports, anywhere in it; `from a import b` counts as a and a.b."""
    names = []
    for node in ast.walk(ast.parse(source.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names += [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
    return names


def test_import_arrows_point_one_way(root: Path, linked: Path) -> None:
    """import-linter's contracts in pyproject.toml hold."""
    linter = Path(sys.executable).with_name("lint-imports")
    run = subprocess.run(
        [linter, "--no-cache", "--config", root / "pyproject.toml"],
        cwd=linked,
        env={**os.environ, "PYTHONPATH": str(linked)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stdout + run.stderr


def test_the_drawing_of_arrows_is_true(sources: list[Path], root: Path) -> None:
    """ARCHITECTURE.md draws each room that imports another, and no other."""
    text = (root / "ARCHITECTURE.md").read_text("utf-8")
    drawing = text.split("**Import arrows**")[1].split("```")[1]
    drawn = set()
    for line in drawing.strip().splitlines():
        steps = [step.split(", ") for step in line.split(" ─► ")]
        drawn |= {(a, b) for tails, heads in pairwise(steps) for a in tails for b in heads}
    found = set()
    for source in sources:
        room = source.relative_to(root).parts[0]
        for name in _imported(source):
            _, _, inner = name.partition("seethrough.")
            other = inner.partition(".")[0]
            if room in ROOMS and other in ROOMS and other != room:
                found.add((room, other))
    assert found == drawn


def test_rooms_are_imported_by_their_whole_name(tree: list[Path], root: Path) -> None:
    """`import renderer` works only where one stands in the checkout: it is seethrough.renderer."""
    bare = [
        f"{f.relative_to(root)}: {name}"
        for f in tree
        if f.suffix == ".py"
        for name in _imported(f)
        if name.partition(".")[0] in ROOMS
    ]
    assert not bare


@pytest.mark.parametrize("library", OWNERS)
def test_only_the_edges_import(library: str, sources: list[Path], root: Path) -> None:
    """A toolkit is imported by the files that own it and by no other."""
    wrong = []
    for source in sources:
        path = source.relative_to(root).as_posix()
        allowed = any(path == o or (o[-1] == "/" and path.startswith(o)) for o in OWNERS[library])
        uses = any(n == library or n.startswith(f"{library}.") for n in _imported(source))
        if uses and not allowed:
            wrong.append(path)
    assert not wrong, f"{library} is imported by {wrong}, expected only by {OWNERS[library]}"


def test_no_import_does_anything(what_imports_did: dict[str, list[str]]) -> None:
    """No module opens a GPU, a window or a file when it is imported, or needs a display."""
    assert len(what_imports_did) > 20
    busy = {module: did for module, did in what_imports_did.items() if did}
    assert not busy


@pytest.mark.parametrize("module", LIGHT)
def test_light_modules_stay_light(module: str, root: Path) -> None:
    """A module that every command loads does not load what only some need."""
    printed = _python(f"import sys, {module}; print('LOADED', *sys.modules)", root)
    loaded = set(printed.partition("LOADED ")[2].split())
    assert module in loaded
    assert not loaded & set(LIGHT[module])


def test_what_is_compared_with_older_commits_is_where_the_benchmark_looks() -> None:
    """Its modules are asked for by name, the latest place first: a move breaks it silently."""
    from importlib import import_module

    from seethrough.benchmarks.drawing import against
    from seethrough.benchmarks.sessions import since

    wanted = (
        (since.SIMULATE, "simulate"),
        (since.CONFIG, "load"),
        (since.BATCH, "play_files"),
        (since.DATA_RUN, "make_tables"),
        (against.DYNAMIC, "DynamicTransparency"),
        (against.STANDARD, "Standard"),
        (against.ABSTRACT, "abstract_scene"),
        (against.CONTROLS, "orbit"),
        (against.VIEWED, "SCENES"),
        (against.CONTEXT, "standalone"),
    )
    for modules, name in wanted:
        assert hasattr(import_module(f"seethrough.{modules[0]}"), name)
