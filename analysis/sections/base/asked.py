"""What was asked, and which questions are asked alike."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from seethrough.analysis.design import Factor, Item
from seethrough.analysis.sections.base.context import Context


def items_of(context: Context) -> tuple[Item, ...]:
    """What was asked: as the design has it, else as the answers look."""
    asked = context.study.questionnaire
    names = list(dict.fromkeys(asked["item"].astype("str")))
    stated = context.design.items
    if stated is not None:
        return tuple(item for item in stated if item.name in names)
    found = []
    for name in names:
        own = asked[(asked["item"] == name) & asked["value"].notna()]
        each = tuple(f.name for f in context.design.factors
                     if f.within and len(own) and own[f.name].nunique() > 1)  # fmt: skip
        if len(own):
            found.append(Item(name, name.replace("_", " "), each))
    return tuple(found)


@dataclass(frozen=True)
class Alike:
    """Items that are asked alike: for each level of the same factors. What is compared stands last
    in `each`."""

    name: str
    each: tuple[Factor, ...]
    items: tuple[Item, ...]

    @property
    def stem(self) -> str:
        """What keys of the items' mean begin with."""
        return "rating" if self.name == "ratings" else self.name

    @property
    def both_ways(self) -> bool:
        """Whether some items count the other way round, and others do not: then their plain mean
        means nothing."""
        turned = {r for i in self.items for r in i.reverse if not i.parts}
        return 0 < len(turned) < len(self.items)


def asked_alike(context: Context) -> list[Alike]:
    """The items that are asked for levels of factors, in groups."""
    groups: dict[tuple[str, tuple[str, ...]], list[Item]] = {}
    for item in items_of(context):
        if item.each:
            groups.setdefault((item.group or item.name, item.each), []).append(item)
    main = context.design.main
    found = []
    for (name, each), items in groups.items():
        factors = sorted((context.design.factor(f) for f in each), key=lambda f: f is main)
        found.append(Alike(name, tuple(factors), tuple(items)))
    return found


def scales(context: Context) -> list[tuple[str, Sequence[Item]]]:
    """Groups of items that have the same points, by name."""
    once: dict[str, list[Item]] = {}
    for item in items_of(context):
        if not item.each:
            once.setdefault(item.group or item.name, []).append(item)
    found = [*((a.name, a.items) for a in asked_alike(context)), *once.items()]
    return [(name, own) for name, own in found if one_scale(own)]


def one_scale(items: Sequence[Item]) -> bool:
    """Whether items have the same points."""
    return len({(i.points, i.low) for i in items}) == 1
