"""What there is of each kind of plug-in: ours in a folder each, others' by entry points.

A plug-in is one object that describes itself (decisions/0012). Ours is the value CONSTANT of the
package KIND's folder holds for it: `TECHNIQUE` of `seethrough.renderer.techniques.dynamic`. A
stranger's package names its object in the entry points of a group, as in its pyproject.toml:

    [project.entry-points."seethrough.techniques"]
    my_lens = "my_package:TECHNIQUE"

Names are found without importing anything; an object is imported when it is asked for. A study may
bring one along in a file (experiment/study/beside/plugin_files.py): it is `provided` to this
process.
"""

from __future__ import annotations

import hashlib
import pkgutil
import sys
import traceback
from collections.abc import Collection
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
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


@dataclass(frozen=True)
class Origin:
    """Where a plug-in that is not ours is from: its code's files, and one hash of all of them. Of
    one that a study brings along, `beside` is the file's name there, and `content` what is in it.
    """

    files: tuple[Path, ...]
    sha256: str
    beside: str = ""
    content: bytes = b""


_provided: dict[tuple[str, str], tuple[object, Origin]] = {}


def provide(kind: str, name: str, plugin: object, origin: Origin) -> None:
    """A plug-in that a study brings along; one that had the name before is forgotten.

    Raises PluginError where an installed one has the name.
    """
    if name in _places(kind):
        raise PluginError(f"there is a {kind} {name} already, expected a name of its own")
    _provided[kind, name] = (plugin, origin)


def origin(kind: str, name: str) -> Origin | None:
    """Where a plug-in is from; None for ours. Raises KeyError if there is none."""
    if (kind, name) in _provided:
        return _provided[kind, name][1]
    place = _places(kind)[name]
    return None if isinstance(place, str) else _installed(place.module)


def at_fault(error: BaseException) -> tuple[str, str] | None:
    """(kind, name) of the plug-in of others whose code ran when an exception was raised; None
    where only ours did."""
    ran = {frame.f_code.co_filename for frame, _ in traceback.walk_tb(error.__traceback__)}
    places = {
        (kind, name): place
        for kind in KINDS
        for name, place in _places(kind).items()
        if not isinstance(place, str) and place.module in sys.modules
    }
    for kind, name in (*_provided, *places):
        found = origin(kind, name)
        if found is not None and ran & {str(path) for path in found.files}:
            return kind, name
    return None


def place_in(error: BaseException, files: Collection[str]) -> str:
    """ " (FILE, line N)": the innermost line of these files that an exception came from; "" where
    there is none."""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if f.filename in files]
    return f" ({Path(frames[-1].filename).name}, line {frames[-1].lineno})" if frames else ""


def place_of(error: BaseException) -> str:
    """The same, of the plug-in of others whose code ran."""
    found = at_fault(error)
    own = origin(*found) if found is not None else None
    return place_in(error, {str(path) for path in own.files}) if own is not None else ""


@cache
def _installed(module: str) -> Origin:
    """All Python files of the package that a module belongs to, or the module's own."""
    import_module(module)
    top = sys.modules[module.partition(".")[0]]
    main = Path(str(top.__file__))
    files = sorted(main.parent.rglob("*.py")) if main.stem == "__init__" else [main]
    whole = hashlib.sha256()
    for file in files:
        name = file.relative_to(main.parent).as_posix()
        whole.update(name.encode() + b"\0" + file.read_bytes())
    return Origin(tuple(files), whole.hexdigest())


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
    brought = (name for own, name in _provided if own == kind)
    return (*_places(kind), *brought)


def get(kind: str, name: str) -> Any:
    """The plug-in of this name.

    Raises KeyError if there is none, PluginError if it fails to load.
    """
    brought = _provided.get((kind, name))
    return brought[0] if brought else _loaded(kind, name)


@cache
def _loaded(kind: str, name: str) -> object:
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
