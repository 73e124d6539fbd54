"""constraints.txt pins what the project needs, all of it and nothing else."""

from __future__ import annotations

import re
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

EXTRAS = ("test", "bench")


@pytest.fixture(scope="module")
def pins(root: Path) -> dict[str, list[Requirement]]:
    """{package: its lines}; a package has several where Python versions need different ones."""
    found: dict[str, list[Requirement]] = {}
    for line in (root / "constraints.txt").read_text("utf-8").splitlines():
        requirement = Requirement(line)
        found.setdefault(canonicalize_name(requirement.name), []).append(requirement)
    return found


@pytest.fixture(scope="module")
def closure() -> dict[str, str]:
    """{package: installed version} of all that the project and its extras need on this machine."""
    found: dict[str, str] = {}
    todo = [("seethrough", extra) for extra in ("", *EXTRAS)]
    seen = set(todo)
    while todo:
        name, extra = todo.pop()
        try:
            package = distribution(name)
        except PackageNotFoundError:
            pytest.fail(f"{name} is not installed: run `python3 start.py test`")
        found[name] = package.version
        for line in package.requires or []:
            needed = Requirement(line)
            if needed.marker is None or needed.marker.evaluate({"extra": extra}):
                key = canonicalize_name(needed.name)
                new = {(key, e) for e in ("", *needed.extras)} - seen
                seen |= new
                todo += new
    return {name: version for name, version in found.items() if name != "seethrough"}


def test_every_line_pins_a_version_and_nothing_else(root: Path) -> None:
    """`name==version`, perhaps for some Pythons or systems only: no addresses, no options."""
    for line in (root / "constraints.txt").read_text("utf-8").splitlines():
        assert re.fullmatch(
            r"[A-Za-z0-9._-]+==[0-9][A-Za-z0-9.]*( ; [a-z_]+ [<>=!]+ '[^']+')?", line
        )


def test_the_pins_cover_what_is_needed(
    pins: dict[str, list[Requirement]], closure: dict[str, str]
) -> None:
    """Every package of the closure is pinned, for this machine, to the version installed here."""
    unpinned, different = [], []
    for name, version in closure.items():
        here = [p for p in pins.get(name, []) if p.marker is None or p.marker.evaluate()]
        if len(here) != 1:
            unpinned.append(name)
        elif not here[0].specifier.contains(version, prereleases=True):
            different.append(f"{name} {version}, expected {here[0].specifier}")
    assert not unpinned
    assert not different


def test_nothing_else_is_pinned(
    pins: dict[str, list[Requirement]], closure: dict[str, str]
) -> None:
    """A pin that applies to this machine belongs to the closure."""
    here = {
        n for n, lines in pins.items() if any(not p.marker or p.marker.evaluate() for p in lines)
    }
    assert not here - set(closure)
