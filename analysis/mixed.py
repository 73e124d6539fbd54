"""A linear mixed model of single trials, as a sensitivity analysis beside the contrast scores.

Participants differ in level and in the effect of the main factor, and both differ between their
tasks. With fewer random effects the trials of one person would count as independent evidence, so
the fullest model that the data can hold is fitted; the report names it, and what was given up on
the way. t has n − g degrees of freedom: the participants' less the groups'.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from seethrough.analysis.design import Design, Factor
from seethrough.analysis.measures import levels_of
from seethrough.analysis.stats import reml
from seethrough.analysis.stats.distributions import t_quantile, t_two_sided
from seethrough.analysis.stats.split_plot import sum_coding
from seethrough.analysis.stats.ties import is_constant
from seethrough.analysis.stats.undefined import Interval, Number, Undefined, no_interval

MOST_PARTICIPANTS = 400
MOST_PARAMETERS = 30
"""Variances and covariances that are searched for at most: more take minutes."""
SLOPES = "(1 + {} | participant)"
TASK_SLOPES = "(1 + {} | participant:task)"
TASK_LEVELS = "(1 | participant:task)"
LEVELS = "(1 | participant)"
MODELS = ((SLOPES, TASK_SLOPES), (SLOPES, TASK_LEVELS), (SLOPES,), (LEVELS,))
"""Random terms in lme4's words, fullest first; `{}` is the main factor."""


@dataclass(frozen=True, slots=True)
class MixedEffect:
    """A level's effect on log time against the baseline, averaged over tasks and other factors.

    `ratio`: level / baseline. `n`: participants who met every level of the factor; `df`: n less the
    groups; `model`: the random terms that were fitted, `singular` whether one of their variances is
    estimated as 0 or a correlation as ±1; `crossed`: whether all else is crossed with the factor.
    `sd_slope`: s.d. of the effect between participants; `sd_task_slope`: between the tasks of one
    participant. `given_up`: fuller models, and why not.
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
    level: str = ""
    df: int = 0
    terms: tuple[str, ...] = ()
    crossed: bool = True
    given_up: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Layout:
    """The fixed columns, the factor's columns among them, and who and where each row is."""

    fixed: NDArray[np.float64]
    level: NDArray[np.float64]
    person: NDArray[np.intp]
    task: NDArray[np.intp]
    tasks: int
    n: int
    df: int
    crossed: bool


def _none(n: int, trials: int, why: str, level: str) -> MixedEffect:
    gone = Undefined(why)
    return MixedEffect(
        n,
        trials,
        gone,
        gone,
        gone,
        gone,
        gone,
        no_interval(why),
        gone,
        gone,
        "",
        None,
        level,
        n - 1,
    )


@dataclass(frozen=True, slots=True)
class Rows:
    """Log times in units of `unit` (n,), less the first; what they are fitted on, and the levels of
    the main factor that are set against its baseline."""

    y: NDArray[np.float64]
    unit: float
    layout: Layout
    factor: Factor
    others: tuple[str, ...]


def rows_of(trials: pd.DataFrame, design: Design, factor: Factor) -> Rows | str:
    """The trials as a model takes them, or why there is nothing to fit."""
    met = trials.groupby("participant", observed=True)[factor.name].nunique()
    n = int((met == len(factor.levels)).sum())
    if levels_of(trials, [factor])[factor.name] != factor.levels:
        return f"not every level of {factor.name} was met"
    if n < 3:
        return "fewer than three participants with every level"
    if len(met) > MOST_PARTICIPANTS:
        return (
            f"left out for more than {MOST_PARTICIPANTS} participants, where it takes minutes and "
            "agrees with the contrast scores"
        )
    others = tuple(level for level in factor.levels if level != factor.baseline)
    layout = _layout(trials, design, factor, others, n, crossed=True)
    if not _independent(layout.fixed).all():
        layout = _layout(trials, design, factor, others, n, crossed=False)
        kept = _independent(layout.fixed)
        if not kept[: len(others) + 1].all():
            return "the levels' effects cannot be told apart"
        layout = replace(layout, fixed=layout.fixed[:, kept])
    y = np.log(trials["time"].to_numpy())
    if is_constant(y):
        return "all times are equal"
    # no offset and a spread of one: sums of squares of logs near 20.7 that differ by 10⁻⁸ cancel
    apart = y - y[0]
    unit = float(np.std(apart))
    return Rows(apart / unit, unit, layout, factor, others)


def mixed_model(trials: pd.DataFrame, design: Design) -> list[MixedEffect]:
    """log time ~ main factor × task × the other factors with the fullest random terms, by REML.

    One effect for each level but the baseline; none where no factor varies within people.
    """
    factor = design.main
    if factor is None:
        return []
    rows = rows_of(trials, design, factor)
    if isinstance(rows, Rows):
        return _fullest(rows)
    met = trials.groupby("participant", observed=True)[factor.name].nunique()
    n = int((met == len(factor.levels)).sum())
    return [_none(n, len(trials), rows, c.level) for c in factor.contrasts()]


def _layout(
    trials: pd.DataFrame, design: Design, factor: Factor, others: Sequence[str], n: int,
    crossed: bool,
) -> Layout:  # fmt: skip
    """Each level's column is its indicator less 1/k, so that its coefficient is level − baseline at
    the mean of all else, which is sum-coded and crossed with it.

    Where some cells have no trials (a study leaves them out, or gives groups tasks of their own)
    nothing is crossed: not every interaction can be estimated.
    """
    levels = levels_of(trials, (*design.crossed, *design.groups), design.task_names)
    own = trials[factor.name].astype("str").to_numpy()
    shares = len(factor.levels)
    level = np.column_stack([(own == name) - 1 / shares for name in others])
    rest = np.ones((len(trials), 1))
    for name, known in levels.items():
        if name != factor.name and len(known) > 1:
            codes = pd.Categorical(trials[name].astype("str"), categories=list(known)).codes
            coded = np.column_stack([np.ones(len(trials)), sum_coding(len(known))[codes]])
            if crossed:
                rest = np.einsum("ni,nj->nji", rest, coded).reshape(len(trials), -1)
            else:
                rest = np.column_stack([rest, coded[:, 1:]])
    if not crossed:
        fixed = np.column_stack([rest[:, :1], level, rest[:, 1:]])
        return Layout(fixed, *_who(trials, level), len(levels["task"]), n,
                      n - _groups(trials, design), crossed)  # fmt: skip
    both = np.einsum("ni,nj->nij", level, rest).reshape(len(trials), -1)
    slots = np.arange(len(others)) * rest.shape[1]
    left = np.setdiff1d(np.arange(both.shape[1]), slots)
    fixed = np.column_stack([rest[:, :1], both[:, slots], rest[:, 1:], both[:, left]])
    return Layout(fixed, *_who(trials, level), len(levels["task"]), n, n - _groups(trials, design),
                  crossed)  # fmt: skip


def _independent(columns: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which columns are no sum of those before them."""
    kept: list[int] = []
    small = np.linalg.qr(columns).R  # of the same ranks, and no taller than wide
    for k in range(columns.shape[1]):
        if np.linalg.matrix_rank(small[:, [*kept, k]]) > len(kept):
            kept.append(k)
    found = np.zeros(columns.shape[1], bool)
    found[kept] = True
    return found


def _who(
    trials: pd.DataFrame, level: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.intp], NDArray[np.intp]]:
    """The factor's columns, and whose and which task each row is."""
    _, person = np.unique(trials["participant"].astype("str"), return_inverse=True)
    _, task = np.unique(trials["task"].astype("str"), return_inverse=True)
    return level, person, task


def _groups(trials: pd.DataFrame, design: Design) -> int:
    """How many groups of people there are, 1 where all are one."""
    if not design.groups:
        return 1
    return len(trials[[f.name for f in design.groups]].astype("str").drop_duplicates())


def person_terms(layout: Layout) -> dict[str, tuple[reml.Term, int]]:
    """Each random term of a person with how many groups it has."""
    one = np.ones((len(layout.level), 1))
    both = np.column_stack([one, layout.level])
    whole = np.zeros(len(one), dtype=np.intp)
    people = int(layout.person.max()) + 1
    pairs = len(np.unique(layout.person * layout.tasks + layout.task))
    return {
        SLOPES: (reml.Term(both, whole, 1), people),
        TASK_SLOPES: (reml.Term(both, layout.task, layout.tasks), pairs),
        TASK_LEVELS: (reml.Term(one, layout.task, layout.tasks), pairs),
        LEVELS: (reml.Term(one, whole, 1), people),
    }


def _fullest(rows: Rows) -> list[MixedEffect]:
    """The first of `MODELS` that has fewer random effects than there are rows, and converges."""
    y, layout, factor = rows.y, rows.layout, rows.factor
    terms, given_up = person_terms(layout), []
    for names in MODELS:
        chosen = [terms[name] for name in names]
        said = said_of(names, factor)
        if layout.tasks == 1 and len(names) > 1:  # the same groups twice
            continue
        if any(count * term.size >= len(y) for term, count in chosen):
            given_up.append(f"{said}: as many random effects as trials")
            continue
        if sum(t.size * (t.size + 1) // 2 for t, _ in chosen) > MOST_PARAMETERS:
            given_up.append(f"{said}: more than {MOST_PARAMETERS} variances and covariances")
            continue
        try:
            found = reml.fit(y, layout.fixed, layout.person, [term for term, _ in chosen])
        except np.linalg.LinAlgError:
            given_up.append(f"{said}: cannot be fitted")
            continue
        if found.converged and np.all(found.errors[1 : len(rows.others) + 1] > 0):
            return [
                _effect(found, names, rows, level, i, tuple(given_up))
                for i, level in enumerate(rows.others, start=1)
            ]
        given_up.append(f"{said}: did not converge")
    why = "no model of these trials can be fitted"
    return [_none(layout.n, len(y), why, level) for level in rows.others]


def said_of(names: Sequence[str], factor: Factor) -> str:
    """Random terms in lme4's words."""
    return " + ".join(names).replace("{}", factor.name)


def _effect(
    found: reml.Fit, names: tuple[str, ...], rows: Rows, level: str, at: int,
    given_up: tuple[str, ...],
) -> MixedEffect:  # fmt: skip
    unit, layout = rows.unit, rows.layout
    estimate, error = unit * float(found.beta[at]), unit * float(found.errors[at])
    half = t_quantile(0.975, layout.df) * error
    slopes = {
        name: unit * float(np.sqrt(max(0.0, cov[at, at])))
        for name, cov in zip(names, found.covariances, strict=True)
        if len(cov) > 1
    }
    gone = Undefined("not in the model")
    return MixedEffect(
        layout.n,
        len(rows.y),
        estimate,
        error,
        estimate / error,
        t_two_sided(estimate / error, layout.df),
        float(np.exp(estimate)),
        (float(np.exp(estimate - half)), float(np.exp(estimate + half))),
        slopes.get(SLOPES, gone),
        slopes.get(TASK_SLOPES, gone),
        said_of(names, rows.factor),
        found.singular,
        level,
        layout.df,
        names,
        layout.crossed,
        given_up,
    )
