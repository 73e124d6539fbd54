"""Fitting: a profile whose times and errors come near the published ones.

Every evaluation uses the same random streams, trial by trial, so that profiles differ and luck
does not. Means come first: times are nearly proportional to the pace.

A row is met or not (`calibration.ENOUGH`), and all of them are to be met: what is least are squares
of standard errors, which are steeper where a row comes near the end of what is met (`steep`).
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.special import ndtri
from scipy.stats.qmc import Halton

from seethrough.experiment.people.fitted.calibration import (
    FITTED,
    Key,
    Moments,
    TrialRow,
    gains,
    measured,
    misfit,
    published,
    residuals,
)
from seethrough.experiment.people.fitted.priors import FREE, moved, with_free
from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.people.persons.person import TRAITS
from seethrough.experiment.people.runs.data_mode import play_trial
from seethrough.experiment.people.runs.pool import Pool
from seethrough.experiment.study.design.design import SIMULATED, generator, session_for
from seethrough.tasks.kit.skills.profile import Profile

Play = Callable[[Profile], Iterable[TrialRow]]

STEP = 0.2  # of the logarithm, for derivatives: smaller ones drown in what chance does to paths
PACES = 1  # evaluations that correct the pace alone
STEPS = 6  # evaluations that go by the same derivatives, before these are taken again
LAST = 5  # evaluations of the larger crowd, which goes by the first one's derivatives
STEEP = 1.5  # standard errors off at which a row's square counts twice
LOOSE = 1.0  # logarithm of the factor by which a constant may move for one standard error


class Crowd:
    """The same people playing a study in data mode again and again, with one profile or another.

    They are spread evenly over what people are like (a scrambled Halton sequence), not drawn: a
    few very slow people more or less would move a standard deviation by a tenth. Scenes and tables
    are those of `pool`, which draws what it lacks.
    """

    def __init__(self, seed: int, count: int, pool: Pool) -> None:
        self.seed, self.slots = seed, range(1, count + 1)
        self.study, self.pool = pool.study, pool
        # Its first column alternates, as a Latin square does: it would be a trait of those who meet
        # one condition first. It is drawn and left out; the other columns' bases are odd primes.
        even = Halton(1 + TRAITS, seed=generator(seed, (SIMULATED,)))
        self.traits = ndtri(even.random(count)[:, 1:])

    def play(self, profile: Profile, tasks: Collection[str]) -> list[TrialRow]:
        """Who, which task and level, how long, how far off, for every trial of `tasks`.

        What is drawn on the way is kept person by person: an interrupted fit goes on with it.
        """
        rows: list[TrialRow] = []
        for slot in self.slots:
            person = SimulatedParticipant(
                generator(self.seed, (SIMULATED, slot)), profile, traits=self.traits[slot - 1]
            )
            for task_set in session_for(slot, self.study.plan):
                if task_set.trials[0].task not in tasks:
                    continue
                for trial in task_set.training:
                    play_trial(person, self.pool, trial)
                for trial in task_set.trials:
                    record = play_trial(person, self.pool, trial)[0]
                    of = record.outcome
                    assert of is not None  # it was played to its end
                    rows.append(
                        {"participant": slot, "task": trial.task, "time": record.time,
                         "transparency": trial.levels["transparency"], "truth": of.truth,
                         "count_error": of.count_error, "distance": of.distance,
                         "correct": of.correct}
                    )  # fmt: skip
            self.pool.looks.flush()
        return rows


class Evaluations:
    """Evaluations of one crowd: the best so far with its residuals `here` and its misfit; its
    squares, as `steep` as they are, are told to `say` after each evaluation."""

    def __init__(self, start: Profile, play: Play, say: Callable[[float], None]) -> None:
        self.start, self.play, self.say = start, play, say
        self.squares, self.misfit, self.best = np.inf, np.inf, start
        self.x, self.here = np.zeros(len(FREE)), np.empty(0)
        self.count = 0
        self._known: dict[bytes, NDArray[np.float64]] = {}  # x → its residuals

    def found(self, x: NDArray[np.float64]) -> dict[Key, Moments]:
        """What the crowd does with the constants at `x`."""
        return self._played(x)[0]

    def residuals(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Standard errors off, of rows and of differences; and how far constants have moved, so
        that none moves for nothing."""
        known = self._known.get(x.tobytes())
        return self._played(x)[1] if known is None else known

    def _played(self, x: NDArray[np.float64]) -> tuple[dict[Key, Moments], NDArray[np.float64]]:
        profile = with_free(self.start, x)
        simulated = measured(self.play(profile))
        here = np.concatenate([residuals(simulated), gains(simulated), x / LOOSE])
        squares = float(np.sum(steep(here) ** 2))
        self.count += 1
        self._known[x.tobytes()] = here
        if squares < self.squares:
            self.squares, self.misfit, self.best = squares, misfit(simulated), profile
            self.x, self.here = np.array(x), here
        self.say(self.squares)
        return simulated, here


def calibrate(
    start: Profile,
    play: Play,
    evaluations: int,
    say: Callable[[float], None] = lambda value: None,
    last: Play | None = None,
    at: Profile | None = None,
) -> tuple[Profile, float]:
    """The best profile found in about so many evaluations of `play`, and its misfit.

    The way begins at `start`, or at the free constants of `at`, which lie about `start` all the
    same: from one place only the nearest of several minima is found.

    First the pace is corrected by how far the fitted means are off; where there are evaluations
    for derivatives, scipy's least squares (trust region reflective) moves all of `FREE`, with
    derivatives over `STEP` that are taken again after `STEPS`, as long as there are evaluations.
    Then a larger crowd (`last`) corrects what was peculiar to the first one, with the last ones.
    """
    search = Evaluations(start, play, say)
    x = moved(start, at or start)
    if evaluations - PACES <= len(FREE):  # too few for derivatives: the pace alone
        for _ in range(evaluations):
            x[0] -= _too_slow(search.found(x))
        return search.best, float(search.misfit)
    for _ in range(PACES):
        x[0] -= _too_slow(search.found(x))
    here = search.residuals(x)
    while True:
        slopes = slopes_of(search.residuals, x, here)
        _least_squares(search.residuals, x, min(STEPS, evaluations - search.count), slopes)
        x, here = search.x, search.here
        if evaluations - search.count <= len(FREE):
            break
    if last is not None:
        search = Evaluations(start, last, say)
        _least_squares(search.residuals, x, LAST, slopes)
    return search.best, float(search.misfit)


def _too_slow(simulated: Mapping[Key, Moments]) -> float:
    """By how much the fitted means are too long: the mean logarithm of their ratios."""
    ratios = [
        ours / theirs
        for task in FITTED
        for ours, theirs in zip(
            simulated[task, "time"].means, published()[task, "time"].means, strict=True
        )
    ]
    return float(np.mean(np.log(ratios)))


def slopes_of(
    found: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    x: NDArray[np.float64],
    here: NDArray[np.float64] | None = None,
) -> NDArray[np.float64]:
    """(residuals, constants) forward differences of `found` at `x`, where it is `here`."""
    here = found(x) if here is None else here
    return np.stack([(found(x + step) - here) / STEP for step in STEP * np.eye(len(x))], axis=1)


def _least_squares(
    found: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    x: NDArray[np.float64],
    steps: int,
    slopes: NDArray[np.float64],
) -> None:
    """Go down from `x` in so many evaluations, with these derivatives of residuals."""
    bounds = np.log(list(FREE.values()))
    least_squares(
        lambda z: steep(found(z)),
        np.clip(x, -0.99 * bounds, 0.99 * bounds),
        jac=lambda z: steep_slopes(found(z), slopes),
        bounds=(-bounds, bounds),
        max_nfev=max(1, steps),
        xtol=0.01,
        ftol=0.01,
    )


def steep(here: NDArray[np.float64]) -> NDArray[np.float64]:
    """(residuals,) of rows and differences, then of constants, as their squares are to count: those
    of rows as they are while they are small, twice at `STEEP`, four times at `ENOUGH`."""
    rows, constants = here[: -len(FREE)], here[-len(FREE) :]
    return np.concatenate([rows * np.sqrt(1 + (rows / STEEP) ** 4), constants])


def steep_slopes(here: NDArray[np.float64], slopes: NDArray[np.float64]) -> NDArray[np.float64]:
    """(residuals, constants) derivatives of `steep` where residuals are `here`, with `slopes`."""
    power = (here[: -len(FREE)] / STEEP) ** 4
    steeper = np.concatenate([(1 + 3 * power) / np.sqrt(1 + power), np.ones(len(FREE))])
    found: NDArray[np.float64] = steeper[:, None] * slopes
    return found
