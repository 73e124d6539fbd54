"""The paper's two Friedman results, on data that have the printed means and s.d."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.random import Generator

from seethrough.analysis.published.grim import fitting_scores, fitting_whole_numbers
from seethrough.analysis.published.numbers import Claim, Published
from seethrough.analysis.stats.ranks import Friedman, friedman
from seethrough.analysis.stats.undefined import is_defined

Case = tuple[str, Friedman, bool]
"""What was arranged, its test, and whether its p prints as the paper's."""


def correct_cases(published: Published, trials: int, rng: Generator) -> list[Case]:
    """Every way, up to names, to give T2's errors to participants."""
    n = published.participants
    cases = []
    for first in fitting_scores(published.correct[0], n, trials):
        for second in fitting_scores(published.correct[1], n, trials):
            for places in _overlaps(len(first), len(second)):
                shares = np.ones((n, 2))
                shares[: len(first), 0] -= np.array(first) / trials
                shares[list(places), 1] -= np.array(second) / trials
                who = _who(places, first, second, trials)
                result = friedman(shares, rng)
                cases.append((who, result, _prints(published.correct_p, result)))
    return cases


def _overlaps(first: int, second: int) -> Iterator[tuple[int, ...]]:
    """Which participants err under dynamic: 0..first − 1 also err under standard, later ones not.

    Fresh participants are alike, so only how many there are matters.
    """

    def place(left: int, used: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
        if left == 0:
            yield used
            return
        fresh = max([first - 1, *used]) + 1
        for spot in [i for i in range(first) if i not in used] + [fresh]:
            yield from place(left - 1, (*used, spot))

    return place(second, ())


def _who(
    places: tuple[int, ...], first: tuple[int, ...], second: tuple[int, ...], trials: int
) -> str:
    said = []
    for place, errors in zip(places, second, strict=True):
        other = (
            f"one with {first[place]}/{trials} wrong in standard"
            if place < len(first)
            else "one without errors in standard"
        )
        said.append(f"{errors}/{trials} wrong in dynamic: {other}")
    return "; ".join(said)


def rating_cases(published: Published, rng: Generator) -> list[Case]:
    """Ratings with the printed moments, paired alike and paired crosswise."""
    per, top = published.rating_items, published.rating_highest
    fits = [
        fitting_whole_numbers(m, published.participants, per * top, per) for m in published.rating
    ]
    if fits[0] is None or fits[1] is None:
        return []
    standard, dynamic = (np.array(f) / per for f in fits)
    cases = []
    for who, other in (("high with high", dynamic), ("high with low", dynamic[::-1])):
        result = friedman(np.stack([standard, other], axis=1), rng)
        cases.append((f"paired {who}", result, _prints(published.rating_p, result)))
    return cases


def _prints(claim: Claim, result: Friedman) -> bool:
    return is_defined(result.p) and claim.allows(result.p, result.p)
