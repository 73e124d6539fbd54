"""Can whole-number answers have the printed mean and s.d.? GRIM and its kin, by enumeration.

GRIM (Brown & Heathers 2017) asks for the mean alone; here mean and s.d. are asked together.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

import numpy as np

from seethrough.analysis.published.numbers import Moments


def totals(moments: Moments, count: int, highest: int, halves: bool = True) -> list[int]:
    """Sums of `count` whole numbers in 0..highest whose mean prints as given (GRIM).

    `halves`: whether a mean that lies on a half may print so, rounded up or down.
    """
    return [t for t in range(count * highest + 1) if moments.mean.fits(t / count, halves)]


def mean_of_shares(moments: Moments, n: int, trials: tuple[int, ...]) -> Fraction | None:
    """A mean of n shares c/t, each t one of `trials`, that prints as given; None if none does.

    Such a mean is a multiple of 1 / (n·lcm(trials)); conversely every multiple is checked, so None
    is a proof, while a value found may still need a mixture of trial numbers that nobody ran.
    """
    step = n * int(np.lcm.reduce(trials))
    for k in range(step + 1):
        if moments.mean.fits(k / step):
            return Fraction(k, step)
    return None


def partitions(total: int, parts: int, largest: int) -> Iterator[tuple[int, ...]]:
    """Ways to write `total` as at most `parts` positive whole numbers, largest first."""
    if total == 0:
        yield ()
        return
    if parts == 0:
        return
    for first in range(min(total, largest), 0, -1):
        for rest in partitions(total - first, parts - 1, first):
            yield (first, *rest)


def fitting_scores(
    moments: Moments, n: int, trials: int, halves: bool = True
) -> list[tuple[int, ...]]:
    """Errors per participant (of `trials` each, zeros left out) with the printed mean and s.d."""
    found = []
    for right in totals(moments, n * trials, 1, halves):
        wrong = n * trials - right
        for errors in partitions(wrong, n, trials):
            shares = np.ones(n)
            shares[: len(errors)] -= np.array(errors) / trials
            if moments.sd.fits(float(np.std(shares, ddof=1))):
                found.append(errors)
    return found


def fitting_whole_numbers(
    moments: Moments, n: int, highest: int, per: int = 1
) -> tuple[int, ...] | None:
    """n whole numbers in 0..highest that, divided by `per`, have the printed mean and s.d.

    None is a proof that none exist: only the sum and the sum of squares matter, and all reachable
    pairs are enumerated. `per` > 1 is for means over `per` answers.
    """
    stages = _stages(n, highest)
    for total in totals(moments, n * per, highest):
        if total > n * highest:
            break
        for squares in _bits(stages[n][total]):
            variance = (squares - total * total / n) / (n - 1)
            if moments.sd.fits(float(np.sqrt(max(0.0, variance))) / per):
                return _rebuild(stages, highest, total, squares)
    return None


def _stages(n: int, highest: int) -> list[list[int]]:
    """For 0..n answers and each sum: the reachable sums of squares, as the bits of an integer."""
    stages = [[1]]
    for count in range(1, n + 1):
        before = stages[-1]
        reached = [0] * (count * highest + 1)
        for total, bits in enumerate(before):
            for value in range(highest + 1):
                reached[total + value] |= bits << (value * value)
        stages.append(reached)
    return stages


def _bits(number: int) -> list[int]:
    """Positions of the ones."""
    return [i for i, digit in enumerate(reversed(bin(number)[2:])) if digit == "1"]


def _rebuild(stages: list[list[int]], highest: int, total: int, squares: int) -> tuple[int, ...]:
    """Answers, largest first, with this sum and sum of squares."""
    answers = []
    for before in reversed(stages[:-1]):
        value = next(
            v
            for v in range(highest, -1, -1)
            if 0 <= total - v < len(before)
            and squares >= v * v
            and before[total - v] >> (squares - v * v) & 1
        )
        answers.append(value)
        total, squares = total - value, squares - value * value
    return tuple(sorted(answers, reverse=True))
