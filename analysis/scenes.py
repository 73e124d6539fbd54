"""The mixed model once more, with the scenes as a second sample crossed with the participants.

Where many people meet the same scenes, a model without them speaks of these scenes only: what one
scene adds is counted as evidence once a person. A scene's level and the effect of the main factor
in it are free to differ, as far as the data can hold that; t has the smaller of the participants'
and the scenes' degrees of freedom.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from seethrough.analysis.design import Design, Factor
from seethrough.analysis.mixed import MixedEffect, Rows, person_terms, rows_of, said_of
from seethrough.analysis.stats import reml
from seethrough.analysis.stats.distributions import t_quantile, t_two_sided

FEWEST = 7
"""Shared scenes from which they are a sample: of fewer the spread cannot be estimated."""
LEAST = 0.01
"""Of the residuals' s.d.: scenes, or a mean of their levels and slopes, that spread by less do not
spread at all. At that border the likelihood is flat, and where a search ends there is chance."""
MOST_WORK = 5e10
"""Multiplications that a fit may take from each start: some ten seconds."""
SCENE_SLOPES = "(1 + {} | scene)"
SCENE_LEVELS = "(1 | scene)"
STEPS = (SCENE_SLOPES, SCENE_LEVELS)


@dataclass(frozen=True, slots=True)
class SceneEffect:
    """A level's effect on log time, for people and scenes like these.

    `sd_scene`: between scenes, `sd_slope`: of the effect between scenes, None where it is not in
    the model. `step`: which of `STEPS`; `singular`: whether a variance of the participants' terms
    is on the boundary, for a scene's that is given up.
    """

    level: str
    scenes: int
    trials: int
    estimate: float
    error: float
    df: int
    sd_scene: float
    sd_slope: float | None
    model: str
    step: str
    singular: bool

    @property
    def t(self) -> float:
        return self.estimate / self.error

    @property
    def p(self) -> float:
        return t_two_sided(self.t, self.df)

    @property
    def ratio(self) -> float:
        return float(np.exp(self.estimate))

    @property
    def interval(self) -> tuple[float, float]:
        """Of the ratio level / baseline, 95 %."""
        half = t_quantile(0.975, self.df) * self.error
        return float(np.exp(self.estimate - half)), float(np.exp(self.estimate + half))


@dataclass(frozen=True, slots=True)
class Scenes:
    """`shared`: scenes that two people or more met; the effects, none where scenes are no random
    effect; which fuller models were given up, and why."""

    shared: int
    effects: tuple[SceneEffect, ...] = ()
    given_up: tuple[str, ...] = ()


def shared_scenes(trials: pd.DataFrame) -> tuple[str, ...]:
    """The scenes that two people or more met."""
    met = trials[["scene", "participant"]].astype("str").drop_duplicates()
    count = met.groupby("scene")["participant"].size()
    return tuple(str(name) for name in count.index[count > 1])


def scene_model(trials: pd.DataFrame, design: Design, plain: MixedEffect) -> Scenes:
    """The model that `plain` is of, with scenes crossed; for what they have not the fit's steps say
    why."""
    names, factor = shared_scenes(trials), design.main
    if len(names) < FEWEST or factor is None or not plain.terms:
        return Scenes(len(names))
    rows = rows_of(trials, design, factor)
    if isinstance(rows, str):
        return Scenes(len(names))
    own = trials["scene"].astype("str").to_numpy()
    place = {name: i for i, name in enumerate(names)}
    code = np.array([place.get(name, -1) for name in own], dtype=np.intp)
    given_up: list[str] = []
    for step in STEPS:
        said = said_of((*plain.terms, step), factor)
        term = _term(step, rows, code, len(names))
        why = _refused(step, trials, factor, term, len(names))
        effects = () if why else _fit(rows, plain, term, step, said)
        if isinstance(effects, str):
            why, effects = effects, ()
        if effects:
            return Scenes(len(names), effects, tuple(given_up))
        given_up.append(f"{said}: {why}")
    return Scenes(len(names), (), tuple(given_up))


def _term(step: str, rows: Rows, code: NDArray[np.intp], scenes: int) -> reml.Term:
    """The scenes' columns: 0 in trials whose scene nobody else met."""
    shared = (code >= 0).astype(np.float64)[:, None]
    columns = np.column_stack([shared, shared * rows.layout.level])
    used = columns if step == SCENE_SLOPES else columns[:, :1]
    return reml.Term(used, np.maximum(code, 0), scenes)


def _refused(step: str, trials: pd.DataFrame, factor: Factor, term: reml.Term, scenes: int) -> str:
    """Why a step cannot be tried; empty if it can."""
    if step == SCENE_SLOPES:
        levels = trials[["scene", factor.name]].astype("str").drop_duplicates()
        if int((levels.groupby("scene").size() == len(factor.levels)).sum()) < FEWEST:
            return "too few scenes were met under every level"
    if scenes * term.size >= int(np.count_nonzero(term.columns[:, 0])):
        return "as many effects of scenes as trials in them"
    return ""


def _fit(
    rows: Rows, plain: MixedEffect, term: reml.Term, step: str, said: str
) -> tuple[SceneEffect, ...] | str:
    """The effects, or why there are none."""
    known, layout = person_terms(rows.layout), rows.layout
    terms = [known[name][0] for name in plain.terms]
    wide = sum(t.size * t.parts for t in terms)
    across = layout.fixed.shape[1] + term.size * term.parts
    people = int(layout.person.max()) + 1
    most = int(MOST_WORK / (people * wide * (wide + across) * 4 + across**3))
    if most < 100:
        return "would take too long"
    try:
        found = reml.fit(rows.y, layout.fixed, layout.person, terms, term, min(3000, most))
    except np.linalg.LinAlgError:
        return "cannot be fitted"
    if not found.converged or not np.all(found.errors[1 : len(rows.others) + 1] > 0):
        return "did not converge"
    least = float(np.min(np.linalg.eigvalsh(found.covariances[-1])))
    if np.sqrt(max(0.0, least)) < LEAST * found.sigma:
        return "singular: a variance of scenes is estimated as 0, or a correlation as ±1"
    spread = rows.unit * np.sqrt(np.diag(found.covariances[-1]))
    return tuple(
        SceneEffect(
            level,
            term.parts,
            len(rows.y),
            rows.unit * float(found.beta[i]),
            rows.unit * float(found.errors[i]),
            min(layout.df, term.parts - 1),
            float(spread[0]),
            float(spread[i]) if len(spread) > 1 else None,
            said,
            step,
            found.singular,
        )
        for i, level in enumerate(rows.others, start=1)
    )
