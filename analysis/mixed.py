"""A linear mixed model of single trials, as a sensitivity analysis beside the contrast scores.

statsmodels fits it; its z tests are replaced by t on n − 1 (it knows no denominator degrees of
freedom), and the participants' random slope for the technique is required: with a random
intercept alone the trials of one person would count as independent evidence.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
import pandas as pd

from analysis.load.schema import TRANSPARENCY
from analysis.measures import design
from analysis.stats.distributions import t_quantile, t_two_sided
from analysis.stats.undefined import Interval, Number, Undefined, no_interval

MOST_PARTICIPANTS = 400


@dataclass(frozen=True, slots=True)
class MixedEffect:
    """The technique's effect on log time, averaged over tasks; `ratio` is dynamic / standard."""

    n: int
    trials: int
    estimate: Number
    error: Number
    t: Number
    p: Number
    ratio: Number
    interval: Interval
    sd_slope: Number


def _none(n: int, trials: int, why: str) -> MixedEffect:
    gone = Undefined(why)
    return MixedEffect(n, trials, gone, gone, gone, gone, gone, no_interval(why), gone)


def mixed_model(trials: pd.DataFrame) -> MixedEffect:
    """log time ~ transparency × task + (1 + transparency | participant), by REML."""
    n, count = trials["participant"].nunique(), len(trials)
    levels = design(trials)
    if levels["transparency"] != TRANSPARENCY:
        return _none(n, count, "there is only one transparency level")
    if n < 3:
        return _none(n, count, "fewer than three participants")
    if n > MOST_PARTICIPANTS:
        return _none(
            n,
            count,
            f"left out for more than {MOST_PARTICIPANTS} participants, where it takes minutes and "
            "agrees with the contrast scores",
        )
    technique = np.where(trials["transparency"] == "dynamic", 0.5, -0.5)
    tasks = levels["task"]
    # sum coding: the technique's coefficient is its mean effect over the tasks
    task = (
        np.stack(
            [
                (trials["task"] == t).to_numpy(float)
                - (trials["task"] == tasks[-1]).to_numpy(float)
                for t in tasks[:-1]
            ],
            axis=1,
        )
        if len(tasks) > 1
        else np.zeros((count, 0))
    )
    fixed = np.column_stack([np.ones(count), technique, task, technique[:, None] * task])
    return _fit(trials, fixed, np.column_stack([np.ones(count), technique]), n)


def _fit(trials: pd.DataFrame, fixed: np.ndarray, random: np.ndarray, n: int) -> MixedEffect:
    from statsmodels.regression.mixed_linear_model import MixedLM  # two seconds of import

    y = np.log(trials["time"].to_numpy())
    count = len(y)
    model = MixedLM(y, fixed, groups=trials["participant"].astype("str").to_numpy(), exog_re=random)
    with warnings.catch_warnings(record=True):
        # what statsmodels warns of (boundary, Hessian) is judged by its result below
        warnings.simplefilter("always")
        try:
            result = model.fit(reml=True)
        except (np.linalg.LinAlgError, ValueError) as failure:
            return _none(n, count, f"the model cannot be fitted ({failure})")
        estimate, error = float(result.fe_params[1]), float(result.bse_fe[1])
        slope = float(np.sqrt(max(0.0, result.cov_re[1, 1])))
    if not result.converged or not np.isfinite(error) or error <= 0:
        return _none(n, count, "the model did not converge")
    half = t_quantile(0.975, n - 1) * error
    ends = (float(np.exp(estimate - half)), float(np.exp(estimate + half)))
    p = t_two_sided(estimate / error, n - 1)
    return MixedEffect(
        n, count, estimate, error, estimate / error, p, float(np.exp(estimate)), ends, slope
    )
