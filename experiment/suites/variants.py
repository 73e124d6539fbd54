"""Values of parameters worth trying, from what they declare: every value beside every other."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from itertools import combinations, product
from typing import TypeVar, get_args, get_origin, get_type_hints

import numpy as np

from seethrough.renderer.declared import Declares, Key, Of, declared

Made = TypeVar("Made", bound=Declares)


def values(parameters: Declares, name: str, said: Key) -> list[object]:
    """The default first, then choices, or the ends of what is allowed, of one parameter."""
    default = getattr(parameters, name)
    hint = get_type_hints(type(parameters))[name]
    kinds = [h for h in (get_args(hint) or (hint,)) if h is not type(None)]
    if tuple in (get_origin(hint), get_origin(kinds[0])):
        found: list[object] = []
    elif kinds[0] is bool:
        found = [not default]
    elif said.choices:
        found = [c for c in said.choices if c != default]
    elif said.low is not None and said.high is not None and not isinstance(said.high, Of):
        # The ends of a wide range say little: half and twice the default do as well.
        ends = [said.low, said.high]
        if isinstance(default, int | float) and said.high > 10 * max(abs(default), 1e-9):
            ends = [max(said.low, default / 2), min(said.high, default * 2)]
        found = [kinds[0](e) for e in ends]
    else:
        found = []
    return [default, *(v for v in dict.fromkeys(found) if v != default)]


def pairwise(parameters: Made, rng: np.random.Generator) -> list[Made]:
    """Parameters in which every two values of two parameters meet at least once: greedily, each
    time the best of some drawn at random."""
    named = {n: values(parameters, n, s) for n, s in declared(type(parameters)).items()}
    wanted = {
        ((a, i), (b, j))
        for a, b in combinations(named, 2)
        for i, j in product(range(len(named[a])), range(len(named[b])))
    }
    found: list[Made] = [parameters]
    chosen = [dict.fromkeys(named, 0)]
    wanted -= _pairs(chosen[0])
    while wanted:
        (a, i), (b, j) = min(wanted)
        drawn = [
            {n: int(rng.integers(len(v))) for n, v in named.items()} | {a: i, b: j}
            for _ in range(20)
        ]
        best = max(drawn, key=lambda d: len(wanted & _pairs(d)))
        wanted -= _pairs(best)
        try:
            new = dataclasses.replace(parameters, **{n: named[n][k] for n, k in best.items()})
        except ValueError:  # values that do not go together
            continue
        found.append(new)
    if len(named) == 1:
        ((name, options),) = named.items()
        found = [dataclasses.replace(parameters, **{name: v}) for v in options]
    return found


def _pairs(chosen: dict[str, int]) -> set[tuple[tuple[str, int], tuple[str, int]]]:
    return set(combinations(chosen.items(), 2))


def refused(parameters: Declares) -> Iterator[tuple[str, object]]:
    """(name, value) that must be refused: beyond each end, and of no choice."""
    for name, said in declared(type(parameters)).items():
        if said.choices:
            yield name, "no such choice"
        elif said.low is not None and said.high is not None and not isinstance(said.high, Of):
            hint = get_type_hints(type(parameters))[name]
            kinds = get_args(hint) or (hint,)
            if tuple not in (get_origin(hint), get_origin(kinds[0])):
                step = 1 if int in kinds else 1e-3 * max(1, abs(said.high))
                yield name, said.low - step
                yield name, said.high + step
                yield name, float("nan")
