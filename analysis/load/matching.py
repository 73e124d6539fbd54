"""Were the scenes equally hard under both levels? The certificate's measures, by task."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from seethrough.analysis.cells import means
from seethrough.analysis.comparison import Pair, pair_of
from seethrough.analysis.design import Contrast, Design
from seethrough.analysis.load.schema import CERTIFICATE
from seethrough.analysis.measures import levels_of
from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.ties import is_constant
from seethrough.analysis.stats.undefined import Number, Undefined

QUANTITIES: Mapping[str, str] = {
    "targets": "targets",
    "visible": "visible fraction",
    "hidden": "hidden targets",
    "occluders": "occluders",
    "clutter": "objects in view",
    "path": "path (units)",
}
NO_SPREAD = "the scenes do not differ"
ONLY_BETWEEN = "the scenes differ between the levels and not within them"


@dataclass(frozen=True, slots=True)
class Balance:
    """A quantity of a task's scenes under both levels; `smd`: in s.d. of scenes (pooled).

    Both are of the trials of the same people, those who have the task under both levels.
    """

    task: str
    quantity: str
    pair: Pair
    smd: Number


def with_certificate(trials: pd.DataFrame, certificate: pd.DataFrame | None) -> pd.DataFrame:
    """The trials with what the certificate says of their scenes; NaN where it knows a scene not.

    A scene has one row however many trials share it.
    """
    if certificate is None:
        return trials
    names = [name for name in CERTIFICATE if name not in trials]  # the targets were recorded
    known = certificate.drop_duplicates(["scene", "task"])[["scene", "task", *names]]
    keys = {key: trials[key].astype("str") for key in ("scene", "task")}
    left = trials.assign(**keys)
    right = known.assign(**{key: known[key].astype("str") for key in keys})
    return left.merge(right, on=list(keys), how="left", validate="many_to_one")


def balance(trials: pd.DataFrame, design: Design) -> list[Balance]:
    """Every known quantity, task by task, for each level of the factors that leave scenes alone."""
    factors = [f for f in design.crossed if f.scenes == "alone"]
    contrasts = [c for f in factors for c in f.contrasts()]
    found = []
    for quantity in (name for name in QUANTITIES if name in trials):
        known = trials.dropna(subset=[quantity])
        if not len(known):
            continue
        within = design.crossed if design.excluded else factors
        cells = means(known, quantity, levels_of(known, within, design.task_names))
        for task in cells.factors["task"]:
            for contrast in contrasts:
                key = f"{quantity}_{task}" + (f"/{contrast.key}" if len(contrasts) > 1 else "")
                pair = pair_of(key, quantity, "", 3, cells, contrast, at={"task": task})
                # nobody walks in a world that one turns about
                if pair is None or (quantity == "path" and not _any(pair)):
                    continue
                same = known["participant"].astype("str").isin(pair.participants)
                own = _shared(known[same & (known["task"] == task)], design, contrast)
                found.append(Balance(task, quantity, pair, _smd(own, quantity, contrast)))
    return found


def _shared(trials: pd.DataFrame, design: Design, contrast: Contrast) -> pd.DataFrame:
    """The trials of those cells of the other factors that both levels have: a cell that the study
    leaves out would else look like scenes that are not matched."""
    others = [f.name for f in design.crossed if f.name != contrast.factor]
    if not design.excluded or not others:
        return trials
    own = trials[trials[contrast.factor].isin([contrast.baseline, contrast.level])]
    met = own.groupby(others, observed=True)[contrast.factor].transform("nunique")
    return own[met == 2]


def _any(pair: Pair) -> bool:
    return bool(pair.first.any() or pair.second.any())


def _smd(trials: pd.DataFrame, quantity: str, contrast: Contrast) -> Number:
    """(level − baseline) / pooled s.d. of the trials' scenes."""
    parts: list[Array] = [
        trials.loc[trials[contrast.factor] == level, quantity].to_numpy(dtype=np.float64)
        for level in (contrast.baseline, contrast.level)
    ]
    if min(map(len, parts)) < 2:
        return Undefined("fewer than two trials")
    if all(is_constant(x) for x in parts):
        return Undefined(NO_SPREAD if is_constant(np.concatenate(parts)) else ONLY_BETWEEN)
    spread = float(np.sqrt(np.mean([np.var(x, ddof=1) for x in parts])))
    return float((parts[1].mean() - parts[0].mean()) / spread)
