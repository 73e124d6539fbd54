"""What there is of each kind of plug-in: ours in a folder each, others' by entry points.

A plug-in is one object that describes itself (decisions/0012). Ours is the value CONSTANT of the
package KIND's folder holds for it: `TECHNIQUE` of `seethrough.renderer.techniques.dynamic`. A
stranger's package names its object in the entry points of a group, as in its pyproject.toml:

    [project.entry-points."seethrough.techniques"]
    my_lens = "my_package:TECHNIQUE"

Names are found without importing anything; an object is imported when it is asked for.
"""

from __future__ import annotations

import pkgutil
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from typing import Any


@dataclass(frozen=True)
class Kind:
    """Where plug-ins of a kind are: our `package`, whose packages hold a `constant` each, and the
    entry points' `group`. `others` are packages there that are no plug-ins."""

    package: str
    constant: str
    group: str
    others: frozenset[str] = frozenset()


KINDS = {
    "technique": Kind("seethrough.renderer.techniques", "TECHNIQUE", "seethrough.techniques"),
    "task": Kind("seethrough.tasks", "TASK", "seethrough.tasks", frozenset({"kit", "worlds"})),
    "world": Kind("seethrough.tasks.worlds", "WORLD", "seethrough.worlds"),
    "question": Kind("seethrough.experiment.questions", "QUESTION", "seethrough.questions"),
}


class PluginError(Exception):
    """A plug-in that cannot be used, in one line."""


@cache
def _places(kind: str) -> dict[str, EntryPoint | str]:
    """Name → our module, or another package's entry point; sorted by name, ours first.

    Raises PluginError if two plug-ins of a kind have one name.
    """
    where = KINDS[kind]
    found: dict[str, EntryPoint | str] = {
        module.name: f"{where.package}.{module.name}"
        for module in sorted(
            pkgutil.iter_modules(import_module(where.package).__path__), key=lambda m: m.name
        )
        if module.ispkg and module.name not in where.others
    }
    for point in sorted(entry_points(group=where.group), key=lambda p: (p.name, p.value)):
        if point.name in found:
            raise PluginError(
                f"{kind} {point.name}: {point.value} has the name of another {kind}, "
                f"expected a name of its own in [project.entry-points.{where.group!r}]"
            )
        found[point.name] = point
    return found


def known(kind: str) -> tuple[str, ...]:
    """The names of all plug-ins of a kind: ours sorted, then others' sorted."""
    return tuple(_places(kind))


@cache
def get(kind: str, name: str) -> Any:
    """The plug-in of this name.

    Raises KeyError if there is none, PluginError if it fails to load.
    """
    place = _places(kind)[name]
    if isinstance(place, str):
        found = getattr(import_module(place), KINDS[kind].constant)
    else:
        try:
            found = place.load()
        except Exception as error:  # a stranger's code may raise anything
            raise PluginError(
                f"{kind} {name}: cannot load {place.value} ({type(error).__name__}: {error})"
            ) from error
    if found.name != name:
        raise PluginError(
            f"{kind} {name}: its object calls itself {found.name!r}, expected {name!r}"
        )
    return found


def every(kind: str) -> dict[str, Any]:
    """Name → plug-in, of all of a kind, in the order of `known`."""
    return {name: get(kind, name) for name in known(kind)}
