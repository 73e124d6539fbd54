"""Power: how often the study's own decisions would fall as predicted with n participants.

Power is P(significant, and the predicted sign). Of what is significant, type S is the share with
the wrong sign, and type M how many times too large the estimates are (Gelman and Carlin 2014).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf

import numpy as np
from numpy.random import SeedSequence

from seethrough.analysis.stats.ranks import share_interval
from seethrough.analysis.stats.undefined import is_defined
from seethrough.experiment.power.closed import ENOUGH
from seethrough.experiment.power.decisions import Planned, Results, Test, decide, run
from seethrough.experiment.power.sources import Source

ANALYSIS = 3  # first word of the streams (CONVENTIONS.md)
AT_ONCE = 2_000_000  # scores drawn at a time: memory stays below 100 MB


@dataclass(frozen=True)
class Point:
    """A prediction with n people: share supported, its 95 % Clopper–Pearson interval, and the
    share in which something was significant against it."""

    name: str
    n: int
    power: float
    low: float
    high: float
    against: float


@dataclass(frozen=True)
class Sized:
    """A test with n people: signed power, type S and type M of what is significant; None where
    nothing was, or nothing can be wrong (one-sided tests)."""

    name: str
    n: int
    power: float
    wrong: float | None
    exaggerated: float | None


def implied_r(means: Sequence[float], sds: Sequence[float], f: float, n: int) -> float:
    """Correlation of the two conditions that F(1, n − 1) implies."""
    d = means[0] - means[1]
    return (sds[0] ** 2 + sds[1] ** 2 - n * d * d / f) / (2 * sds[0] * sds[1])


def curve(
    planned: Sequence[Planned],
    source: Source,
    sizes: Sequence[int],
    replications: int,
    alpha: float,
    seed: int,
    truth: Mapping[str, float],
) -> tuple[list[Point], list[Sized]]:
    """Every prediction and every test at each size; each size has a stream of its own.

    `truth`: the true estimate of each test by its name, for type M.
    """
    points: list[Point] = []
    tests: list[Sized] = []
    for n in sizes:
        rng = np.random.Generator(np.random.PCG64(SeedSequence(seed, spawn_key=(ANALYSIS, n))))
        drawn = _drawn(planned, source, n, replications, rng)
        for prediction in planned:
            results = [drawn[test.name] for test in prediction.tests]
            decided = decide(prediction, results, alpha)
            hits = int(decided.supported.sum())
            low, high = share_interval(hits, replications)
            assert is_defined(low) and is_defined(high)  # of one replication or more they are
            against = float(decided.against.mean())
            points.append(Point(prediction.name, n, hits / replications, low, high, against))
        for test in {t.name: t for p in planned for t in p.tests}.values():
            tests.append(_sized(test, n, drawn[test.name], alpha, truth.get(test.name, 0.0)))
    return points, tests


def _drawn(
    planned: Sequence[Planned], source: Source, n: int, replications: int, rng: np.random.Generator
) -> dict[str, Results]:
    """Results of every test over all replications, drawn in parts that memory holds."""
    tests = {t.name: t for p in planned for t in p.tests}
    columns = 1 + max(max([t.column, *(part.column for part in t.parts)]) for t in tests.values())
    step = max(1, AT_ONCE // (n * columns))
    parts: dict[str, list[Results]] = {name: [] for name in tests}
    for begin in range(0, replications, step):
        groups = source.draw(rng, min(step, replications - begin), n)
        for name, test in tests.items():
            parts[name].append(run(test, groups))
    return {name: _joined(found) for name, found in parts.items()}


def _joined(found: Sequence[Results]) -> Results:
    return Results(
        np.concatenate([r.p for r in found]),
        np.concatenate([r.estimate for r in found]),
        np.concatenate([r.fits for r in found]),
        np.concatenate([r.there for r in found]),
    )


def _sized(test: Test, n: int, found: Results, alpha: float, truth: float) -> Sized:
    shown = found.there & (found.p < alpha)
    right = float((shown & (found.fits > 0)).mean())
    if not test.directed or not shown.any():
        return Sized(test.name, n, right, None, None)
    wrong = float((found.fits[shown] < 0).mean())
    larger = float(np.abs(found.estimate[shown]).mean() / abs(truth)) if truth else inf
    return Sized(test.name, n, right, wrong, larger)


def enough(points: Sequence[Point]) -> Mapping[str, int | None]:
    """For each prediction the smallest n from which on power stays at 80 %; None if none does."""
    answer: dict[str, int | None] = {}
    for name in dict.fromkeys(p.name for p in points):
        least = None
        for point in sorted((p for p in points if p.name == name), key=lambda p: -p.n):
            if point.power < ENOUGH:
                break
            least = point.n
        answer[name] = least
    return answer
