"""What a study may say of the things of a scene: tags, from the file, from the study's table."""

from __future__ import annotations

import glob
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from fnmatch import fnmatchcase

from seethrough.renderer.declared import check, key
from seethrough.renderer.scene.scene import Scene

NAMED = "text, a name with * for any part of it"


@dataclass(frozen=True)
class Tag:
    """Tags of all things of some names. What is not said stays as the file, or an earlier table,
    has it."""

    name: str = key(..., "which things: their name, with * for any part of it", said=NAMED)
    target: bool | None = key(None, "whether it may be asked for")
    occluder: bool | None = key(None, "whether it only hides: it is never asked for")
    wall: bool | None = key(None, "whether it is a wall: its kind is `wall`")
    impenetrable: bool | None = key(None, "whether it never turns transparent")
    importance: float | None = key(
        None, "how much it matters, for techniques of your own that ask: ours go by targets",
        low=0, high=1,
    )  # fmt: skip
    kind: str = key("", "what kind of thing it is, for techniques that go by kinds")
    group: str = key(
        "", "things of one group are drawn in their order in the file where nothing separates them"
    )
    label: str = key("", "what participants read instead of its name")

    def __post_init__(self) -> None:
        check(self)
        for name in ("name", "kind", "group", "label"):
            value = getattr(self, name)
            if not value.isprintable() or len(value) > 100 or (name == "name" and not value):
                raise ValueError(f"{name} = {value[:40]!r}, expected 1 to 100 printable characters")
        if self.target and self.occluder:
            raise ValueError("occluder = True, expected no occluder that is a target")

    def said(self) -> dict[str, object]:
        """Tag → value, of those that are said."""
        values = {f.name: getattr(self, f.name) for f in fields(self) if f.name != "name"}
        return {name: value for name, value in values.items() if value not in (None, "")}


TAGS = tuple(f.name for f in fields(Tag) if f.name != "name")
KINDS_OF = {
    **dict.fromkeys(("target", "occluder", "wall", "impenetrable"), (bool, "true or false")),
    **dict.fromkeys(("kind", "group", "label"), (str, "text of at most 100 characters")),
}


OPPOSITE = {"target": "occluder", "occluder": "target"}
"""Of these two, what is said last holds."""


def fits(name: str, pattern: str) -> bool:
    """Whether a thing's name is of the pattern: * is any part of it, all else is itself, for names
    have brackets and question marks of their own."""
    return fnmatchcase(name, "*".join(glob.escape(part) for part in pattern.split("*")))


def tagged(name: str, extras: Mapping[str, object], tags: Iterable[Tag]) -> dict[str, object]:
    """What holds for a thing: what its file says, in its order, then each entry of the table that
    fits its name.

    Raises ValueError, naming tag and value, for what a file says that a tag cannot be.
    """
    found: dict[str, object] = {}
    for tag, value in extras.items():
        if tag in TAGS:
            _say(found, tag, _checked(name, tag, value))
    for entry in tags:
        if fits(name, entry.name):
            for tag, value in entry.said().items():
                _say(found, tag, value)
    return found


def _say(found: dict[str, object], tag: str, value: object) -> None:
    found[tag] = value
    if tag in OPPOSITE and value:
        found.pop(OPPOSITE[tag], None)


def with_kind_tags(scene: Scene, tags: Sequence[KindTag]) -> Scene:
    """The scene with what a study says of its kinds; itself where nothing is said."""
    if not tags:
        return scene
    groups = {name: k for k, name in enumerate(dict.fromkeys(t.group for t in tags if t.group))}
    taken = max((o.group for o in scene.objects if o.group is not None), default=-1) + 1
    things = []
    for thing in scene.objects:
        for tag in tags:
            if fits(thing.kind, tag.name):
                hard = thing.impenetrable if tag.impenetrable is None else tag.impenetrable
                group = taken + groups[tag.group] if tag.group else thing.group
                thing = replace(thing, impenetrable=hard, group=group)
        things.append(thing)
    return Scene(tuple(things), scene.background)


def _checked(name: str, tag: str, value: object) -> object:
    """A tag's value as an editor may have written it: 1 and 0 are true and false."""
    kind, expected = KINDS_OF.get(tag, (float, "a number from 0 to 1"))
    if kind is bool and value in (0, 1) and isinstance(value, int | float):
        return bool(value)
    if kind is float and isinstance(value, int | float) and not isinstance(value, bool):
        if 0 <= value <= 1:
            return float(value)
    if kind is str and isinstance(value, str) and value.isprintable() and len(value) <= 100:
        return value
    raise ValueError(f"{name}: extras.{tag} = {str(value)[:40]!r}: expected {expected}")


@dataclass(frozen=True)
class KindTag:
    """Tags of all things of some kinds, of a world that is made from a stream."""

    name: str = key(..., "which things: their kind, with * for any part of it", said=NAMED)
    impenetrable: bool | None = key(None, "whether they never turn transparent")
    group: str = key(
        "", "things of one group are drawn in their order in the scene where nothing separates them"
    )

    def __post_init__(self) -> None:
        check(self)
        for name in ("name", "group"):
            value = getattr(self, name)
            if not value.isprintable() or len(value) > 100 or (name == "name" and not value):
                raise ValueError(f"{name} = {value[:40]!r}, expected 1 to 100 printable characters")
