"""A linear mixed model of single trials, as a sensitivity analysis beside the contrast scores.

Participants differ in level and in the technique's effect, and both differ between their tasks.
With fewer random effects the trials of one person would count as independent evidence, so the
fullest model that the data can hold is fitted, and the report names it. t has n − 1 degrees of
freedom, the participants'.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from seethrough.analysis.load.schema import TRANSPARENCY
from seethrough.analysis.measures import design
from seethrough.analysis.stats import reml
from seethrough.analysis.stats.distributions import t_quantile, t_two_sided
from seethrough.analysis.stats.ties import is_constant
from seethrough.analysis.stats.undefined import Interval, Number, Undefined, no_interval

MOST_PARTICIPANTS = 400
SLOPES = "(1 + transparency | participant)"
TASK_SLOPES = "(1 + transparency | participant:task)"
TASK_LEVELS = "(1 | participant:task)"
LEVELS = "(1 | participant)"
MODELS = ((SLOPES, TASK_SLOPES), (SLOPES, TASK_LEVELS), (SLOPES,), (LEVELS,))
"""Random terms in lme4's words, fullest first."""


@dataclass(frozen=True, slots=True)
class MixedEffect:
    """The technique's effect on log time, averaged over tasks; `ratio` is dynamic / standard.

    `n`: participants who met both levels; `model`: the random terms that were fitted, `singular`
    whether one of their variances is estimated as 0 or a correlation as ±1. `sd_slope`: s.d. of
    the effect between participants; `sd_task_slope`: between the tasks of one participant.
    """

    n: int
    trials: int
    estimate: Number
    error: Number
    t: Number
    p: Number
    ratio: Number
    interval: Interval
    sd_slope: Number
    sd_task_slope: Number
    model: str
    singular: bool | None


def _none(n: int, trials: int, why: str) -> MixedEffect:
    gone = Undefined(why)
    return MixedEffect(
        n, trials, gone, gone, gone, gone, gone, no_interval(why), gone, gone, "", None
    )


def mixed_model(trials: pd.DataFrame) -> MixedEffect:
    """log time ~ transparency × task with the fullest random terms of `MODELS`, by REML."""
    levels = design(trials)
    met = trials.groupby("participant", observed=True)["transparency"].nunique()
    n, count = int((met == 2).sum()), len(trials)
    if levels["transparency"] != TRANSPARENCY:
        return _none(n, count, "there is only one transparency level")
    if n < 3:
        return _none(n, count, "fewer than three participants with both levels")
    if len(met) > MOST_PARTICIPANTS:
        return _none(
            n,
            count,
            f"left out for more than {MOST_PARTICIPANTS} participants, where it takes minutes and "
            "agrees with the contrast scores",
        )
    technique = np.where(trials["transparency"] == "dynamic", 0.5, -0.5)
    fixed = _fixed(trials, technique, levels["task"])
    if np.linalg.matrix_rank(fixed) < fixed.shape[1]:
        return _none(n, count, "not every task was met under both levels")
    y = np.log(trials["time"].to_numpy())
    if is_constant(y):
        return _none(n, count, "all times are equal")
    # no offset and a spread of one: sums of squares of logs near 20.7 that differ by 10⁻⁸ cancel
    apart = y - y[0]
    unit = float(np.std(apart))
    return _fullest(trials, apart / unit, fixed, technique, levels["task"], n, unit)


def _fixed(
    trials: pd.DataFrame, technique: NDArray[np.float64], tasks: tuple[str, ...]
) -> NDArray[np.float64]:
    """Sum coding: the technique's coefficient is its mean effect over the tasks."""
    last = (trials["task"] == tasks[-1]).to_numpy(float)
    task = [(trials["task"] == t).to_numpy(float) - last for t in tasks[:-1]]
    return np.column_stack([np.ones(len(trials)), technique, *task, *(technique * t for t in task)])


def _fullest(
    trials: pd.DataFrame,
    y: NDArray[np.float64],
    fixed: NDArray[np.float64],
    technique: NDArray[np.float64],
    tasks: tuple[str, ...],
    n: int,
    unit: float,
) -> MixedEffect:
    """The first of `MODELS` that has fewer random effects than there are rows, and converges.

    `y` is in units of `unit`.
    """
    _, person = np.unique(trials["participant"].astype("str"), return_inverse=True)
    _, task = np.unique(trials["task"].astype("str"), return_inverse=True)
    groups = {
        "participant": int(person.max()) + 1,
        "task": len(np.unique(person * len(tasks) + task)),
    }
    one = np.ones((len(y), 1))
    both = np.column_stack([one, technique])
    whole = np.zeros(len(y), dtype=np.intp)
    terms = {
        SLOPES: (reml.Term(both, whole, 1), groups["participant"]),
        TASK_SLOPES: (reml.Term(both, task, len(tasks)), groups["task"]),
        TASK_LEVELS: (reml.Term(one, task, len(tasks)), groups["task"]),
        LEVELS: (reml.Term(one, whole, 1), groups["participant"]),
    }
    for names in MODELS:
        chosen = [terms[name] for name in names]
        if any(count * term.size >= len(y) for term, count in chosen):
            continue
        if len(tasks) == 1 and len(names) > 1:  # the same groups twice
            continue
        try:
            found = reml.fit(y, fixed, person, [term for term, _ in chosen])
        except np.linalg.LinAlgError:
            continue
        if found.converged and found.errors[1] > 0:
            return _effect(found, names, n, len(y), unit)
    return _none(n, len(y), "no model of these trials can be fitted")


def _effect(
    found: reml.Fit, names: tuple[str, ...], n: int, count: int, unit: float
) -> MixedEffect:
    estimate, error = unit * float(found.beta[1]), unit * float(found.errors[1])
    half = t_quantile(0.975, n - 1) * error
    slopes = {
        name: unit * float(np.sqrt(max(0.0, cov[1, 1])))
        for name, cov in zip(names, found.covariances, strict=True)
        if len(cov) == 2
    }
    gone = Undefined("not in the model")
    return MixedEffect(
        n,
        count,
        estimate,
        error,
        estimate / error,
        t_two_sided(estimate / error, n - 1),
        float(np.exp(estimate)),
        (float(np.exp(estimate - half)), float(np.exp(estimate + half))),
        slopes.get(SLOPES, gone),
        slopes.get(TASK_SLOPES, gone),
        " + ".join(names),
        found.singular,
    )
