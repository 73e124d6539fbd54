"""Groups: what people are assigned or bring along, and how many places each group has."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from seethrough.experiment.study.design.factors import MEASURED, WITHIN, Cell, Factor, Levels


@dataclass(frozen=True)
class Group:
    """A level of every between and measured factor: its cells, and how many people are wanted;
    `measured` are the levels that a person has to bring along."""

    levels: Levels
    measured: Levels
    cells: tuple[Cell, ...]
    people: int


def groups_of(factors: Sequence[Factor], cells: Sequence[Cell], people: int) -> tuple[Group, ...]:
    """The groups that have cells, in file order; one group of no levels where nobody is grouped."""
    which = [i for i, f in enumerate(factors) if f.kind != WITHIN]
    found: dict[Cell, list[Cell]] = {}
    for cell in cells:
        found.setdefault(tuple(cell[i] for i in which), []).append(cell)
    places = quotas([factors[i] for i in which], list(found), people)
    groups = []
    for key, own in found.items():
        named = [(factors[i], level) for i, level in zip(which, key, strict=True)]
        levels = {factor.name: level for factor, level in named}
        measured = {f.name: level for f, level in named if f.kind == MEASURED}
        groups.append(Group(levels, measured, tuple(own), places[key]))
    return tuple(groups)


def quotas(factors: Sequence[Factor], keys: Sequence[Cell], people: int) -> dict[Cell, int]:
    """People of each group: each level has the number that its factor says, or an equal share.

    Where groups cross completely the sums over each level are exact; each factor's levels are dealt
    evenly over the people sorted by the factors before it.
    """
    seats: list[tuple[int, ...]] = [()] * people
    for factor in factors:
        wanted = factor.people or _even(people, len(factor.levels))
        seats = sorted(
            ((*seat, level) for seat, level in zip(seats, _dealt(wanted, people), strict=True)),
        )
    names = [factor.names for factor in factors]
    counts = dict.fromkeys(keys, 0)
    for seat in seats:
        key = tuple(own[k] for own, k in zip(names, seat, strict=True))
        if key in counts:
            counts[key] += 1
    return counts


def _even(people: int, levels: int) -> tuple[int, ...]:
    return tuple(people // levels + (k < people % levels) for k in range(levels))


def _dealt(wanted: Sequence[int], people: int) -> list[int]:
    """A level for each seat: each level spread as evenly as its number allows."""
    places = sorted(
        ((2 * i + 1) / (2 * number), level)
        for level, number in enumerate(wanted)
        for i in range(number)
    )
    dealt = [level for _, level in places]
    return (dealt + [len(wanted) - 1] * people)[:people]
