"""What the tool of tests/support/mutations.py changes, and which tests it finds near."""

from pathlib import Path

import pytest
from mutation_sites import listed, sites
from nearest_tests import Imports

CODE = '''
"""Ä: positions are characters, not bytes."""
LIMIT: float = 2.0


def far(a: int, b: int, more: bool = False) -> bool:
    if more and not a:
        tell(a, b)
    return abs(a - b) < LIMIT


@dataclass(frozen=True)
class Kind(Base, total=False):
    name: str


@njit(cache=True)
def half(x):
    return x / 2
'''


@pytest.fixture
def root(tmp_path):
    files = {
        "renderer/far.py": CODE,
        "renderer/__init__.py": "",
        "renderer/user.py": "from seethrough.renderer.far import far\n",
        "tests/unit/renderer/test_far.py": "from seethrough.renderer.far import far\n",
        "tests/unit/renderer/test_user.py": "from seethrough.renderer import user\n",
        "tests/study/test_all.py": "from seethrough.renderer.far import far\n",
        "tests/unit/renderer/test_other.py": "import seethrough.renderer\n",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, "utf-8")
    return tmp_path


def test_each_operator_changes_its_place_and_nothing_else(root):
    found = {(s.line, CODE[s.start : s.end], s.text) for s in sites(root / "renderer/far.py", root)}
    assert found == {
        (3, "2.0", "(2.0 * 1.5)"),
        (6, "False", "True"),
        (7, "more and not a", "True"),
        (7, "more and not a", "(not (more and not a))"),
        (7, "more and not a", "(more or not a)"),
        (7, "not a", "(a)"),
        (8, "tell(a, b)", "pass"),
        (8, "tell(a, b)", "tell(b, a)"),
        (9, "return abs(a - b) < LIMIT", "return None"),
        (9, "abs(a - b) < LIMIT", "(abs(a - b) <= LIMIT)"),
        (9, "abs(a - b) < LIMIT", "(abs(a - b) >= LIMIT)"),
        (9, "a - b", "(a + b)"),
        (19, "return x / 2", "return None"),
        (19, "x / 2", "(x * 2)"),
        (19, "2", "(2 + 1)"),
    }


def test_a_kernel_may_hold_what_is_in_it_or_in_no_function(root):
    found = {s.line for s in sites(root / "renderer/far.py", root) if s.compiled}
    assert found == {3, 19}


def test_every_change_is_still_python(root):
    for site in sites(root / "renderer/far.py", root):
        compile(site.applied(CODE), "far.py", "exec")


def test_nearest_is_who_imports_it_then_who_imports_that_and_nobody_else(root):
    found = Imports(root).nearest("renderer/far.py")
    names = [Path(path).name for path in found]
    assert names == ["test_far.py", "test_user.py", "test_all.py"]


def test_a_change_by_hand_has_one_place(root):
    file = root / "changes"
    file.write_text("renderer/far.py\nabs(a - b)\nabs(a)⏎\n", "utf-8")
    (site,) = listed(file, root)
    assert (site.line, site.text) == (9, "abs(a)\n")
    file.write_text("renderer/far.py\nreturn\npass\n", "utf-8")
    with pytest.raises(ValueError, match="there 2 times, expected once"):
        listed(file, root)
