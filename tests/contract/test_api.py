"""What code outside may rely on: listed, light to import, and all that plug-ins need."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

from seethrough import api
from seethrough.experiment.suites.api_page import PAGE, page

ROOT = Path(__file__).parents[2]
SHOWN = [
    *ROOT.glob("tests/plugins/*/*.py"),
    *(p for p in ROOT.glob("experiment/suites/templates/*.txt") if p.name != "pyproject.txt"),
]


def test_the_page_lists_what_there_is():
    """`python -m seethrough.experiment.suites.api_page` makes it anew. Whoever changes what stands
    there decides whether `VERSION` grows."""
    assert PAGE.read_text("utf-8") == page()
    assert f"This is version {api.VERSION} " in page()


def test_every_name_is_there_and_says_what_it_is():
    for name in api.__all__:
        assert getattr(api, name) is not None
    assert set(api.__all__) <= set(dir(api))
    bare = [line for line in page().splitlines() if line.endswith((": .", ":."))]
    assert not bare


def test_a_plugin_s_import_needs_no_statistics_and_no_window():
    code = "import sys, seethrough.api; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    heavy = {"pandas", "statsmodels", "pyglet", "moderngl", "imgui_bundle", "sqlalchemy"}
    assert not heavy & set(done.stdout.split())


def _imports(path: Path) -> list[str]:
    """What it imports of ours."""
    found = []
    for node in ast.walk(ast.parse(path.read_text("utf-8").replace("NAME", "mine"))):
        if isinstance(node, ast.ImportFrom):
            found.append(str(node.module))
        elif isinstance(node, ast.Import):
            found += [alias.name for alias in node.names]
    return [name for name in found if name.startswith("seethrough")]


@pytest.mark.parametrize("path", SHOWN, ids=lambda path: path.name)
def test_what_strangers_are_shown_relies_on_nothing_else(path):
    assert _imports(path) == ["seethrough.api"]
