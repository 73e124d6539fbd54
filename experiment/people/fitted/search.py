"""Which published rows can these people reach at all? A search over constants in their intervals.

Constants are spread evenly over all intervals at once (a scrambled Halton sequence) and played.
Then more is proposed and played: for each row that nothing reached what lies between two tries on
either side of it, else what a linear model of all tries expects to reach it; and what the model
expects to meet most rows together. A row that one or two tries reached counts only if other people
reach it with the same constants, too: of many tries by few people one is near anything by luck.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from scipy.stats.qmc import Halton

from seethrough.experiment.people.fitted.calibration import (
    ENOUGH,
    Line,
    TrialRow,
    lines,
    measured,
)
from seethrough.experiment.people.fitted.priors import Interval, at, intervals
from seethrough.tasks.kit.skills.profile import Profile

Array = NDArray[np.float64]
Play = Callable[[Profile], Sequence[TrialRow]]

RIDGE = 0.1  # of the linear model, on constants from −1 to 1: few tries say little of many
CANDIDATES = 4096  # constants among which the model looks
ALONE = 4  # rounds that propose for each row that nothing reached
TOGETHER = 6  # rounds that propose what meets most rows together
FAR = 8.0  # standard errors beyond which a row says no more about where to look


@dataclass
class Search:
    """What was tried: `u` of each, its rows, and what other people made of the best of each row.

    `held` row → standard errors off with other people, of rows that something reached.
    """

    start: Profile
    within: dict[str, Interval]
    names: list[str] = field(default_factory=list)
    published: list[float] = field(default_factory=list)
    u: list[Array] = field(default_factory=list)
    off: list[Array] = field(default_factory=list)
    held: dict[str, float] = field(default_factory=dict)

    def profile(self, number: int) -> Profile:
        """The constants of a try."""
        return at(self.start, self.within, self.u[number])

    @property
    def table(self) -> Array:
        """(tries, rows) standard errors off."""
        return np.array(self.off)

    @property
    def most(self) -> int:
        """The try that meets most rows, the nearest of them."""
        off = np.abs(self.table)
        near = np.minimum(off, FAR).sum(axis=1) / (1 + FAR * off.shape[1])
        return int(np.argmax((off <= ENOUGH).sum(axis=1) - near))


def search(
    start: Profile,
    play: Play,
    others: Play,
    count: int,
    rng: Generator,
    say: Callable[[str], None] = lambda line: None,
) -> Search:
    """Try `count` sets of constants spread evenly, then what these propose; `others` play again
    what reached a row."""
    found = Search(start, intervals(start))
    even = Halton(len(found.within), seed=rng).random(count)
    for u in even:
        _try(found, play, u, say)
    for u in _proposed(found, rng, play, say):
        _try(found, play, u, say)
    for k, name in enumerate(found.names):
        off = np.abs(found.table[:, k])
        if off.min() <= ENOUGH and (off <= ENOUGH).sum() <= 2:
            again = _fitted(others(found.profile(int(off.argmin()))))
            found.held[name] = next(line.off for line in again if line.name == name)
            say(f"{name} again")
    return found


def _fitted(rows: Sequence[TrialRow]) -> list[Line]:
    return [line for line in lines(measured(rows)) if line.fitted]


def _try(found: Search, play: Play, u: Array, say: Callable[[str], None]) -> None:
    rows = _fitted(play(at(found.start, found.within, u)))
    found.names = [line.name for line in rows]
    found.published = [line.published for line in rows]
    found.u.append(np.asarray(u))
    found.off.append(np.array([line.off for line in rows]))
    say(f"{int((np.abs(found.table) <= ENOUGH).sum(axis=1).max())} rows met at most")


def _proposed(
    found: Search, rng: Generator, play: Play, say: Callable[[str], None]
) -> Iterator[Array]:
    """What the model expects to reach a row that nothing reached; then to meet most together."""
    for k in list(range(len(found.names))) * ALONE:
        if np.abs(found.table[:, k]).min() > ENOUGH:
            yield _alone(found, k, rng)
    for _ in range(TOGETHER):
        there, expected = _expected(found, rng)
        over = np.maximum(np.abs(expected) - np.arcsinh(ENOUGH / 2), 0)
        yield there[int((over**2).sum(axis=1).argmin())]


def _alone(found: Search, k: int, rng: Generator) -> Array:
    """What should reach a row: between two tries on either side of it, if there are such (by the
    rule of false position), else where the model expects to come nearest."""
    off = found.table[:, k]
    if (off > 0).all() or (off < 0).all():
        there, expected = _expected(found, rng)
        nearest: Array = there[int(np.abs(expected[:, k]).argmin())]
        return nearest
    low = int(np.where(off < 0, off, -np.inf).argmax())
    high = int(np.where(off >= 0, off, np.inf).argmin())
    below, above = np.arcsinh(off[[low, high]])
    part = float(below / (below - above))
    between: Array = found.u[low] + part * (found.u[high] - found.u[low])
    return between


def _expected(found: Search, rng: Generator) -> tuple[Array, Array]:
    """(candidates, constants) and what a ridge regression on all tries expects there (…, rows): the
    inverse hyperbolic sine of what is off, which is even where that grows by factors."""
    u = 2 * np.array(found.u) - 1
    off = np.arcsinh(found.table)
    mean = off.mean(axis=0)
    normal = u.T @ u + RIDGE * len(u) * np.eye(u.shape[1])
    slopes = np.linalg.solve(normal, u.T @ (off - mean))
    there = rng.random((CANDIDATES, u.shape[1]))
    # Corners and the neighbourhood of the best so far as well: most of a box lies in its middle.
    there[::4] = np.round(there[::4])
    near = found.u[found.most] + 0.15 * rng.standard_normal((CANDIDATES // 2, u.shape[1]))
    there[: CANDIDATES // 2] = np.clip(near, 0, 1)
    return there, mean + (2 * there - 1) @ slopes


def report(found: Search, seconds: float) -> list[str]:
    """Row by row how many tries reached it and how near the nearest came; then all together."""
    off = np.abs(found.table)
    tries = len(off)
    said = [
        f"{tries} sets of {len(found.within)} constants within their intervals, "
        f"{seconds:.0f} s of processor time",
        f"{'measure':32s}{'published':>10s}{'nearest':>9s}{'reached by':>12s}",
    ]
    for k, name in enumerate(found.names):
        digits = 3 if abs(found.published[k]) < 2 else 2
        count = int((off[:, k] <= ENOUGH).sum())
        verdict = "within reach" if count else "out of reach"
        if name in found.held:
            again = found.held[name]
            verdict = "within reach" if abs(again) <= ENOUGH else "out of reach"
            verdict += f": {again:+.1f} by other people"
        nearest = found.table[int(off[:, k].argmin()), k]
        said.append(
            f"{name:32s}{found.published[k]:10.{digits}f}{nearest:+9.1f}"
            f"{f'{count} of {tries}':>12s}  {verdict}"
        )
    best = off[found.most]
    lacks = [n for n, o in zip(found.names, best, strict=True) if o > ENOUGH]
    said.append(
        f"together: at most {int((best <= ENOUGH).sum())} of {len(found.names)} rows by one set of "
        f"constants; it lacks {', '.join(lacks) or 'none'}"
    )
    return said
