"""Was the comparison fair? Order effects, learning, timing faults and difficulty, by condition."""

from __future__ import annotations

import numpy as np
import pandas as pd

from seethrough.analysis.cells import Cells, level_codes, means, sums, table_of
from seethrough.analysis.comparison import Pair, pair_of
from seethrough.analysis.design import Contrast, Design, Factor
from seethrough.analysis.exclude import focus_lost
from seethrough.analysis.measures import levels_present
from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.within import TermTest, dummies, one_way, term_tests


def condition_means(trials: pd.DataFrame, design: Design) -> pd.DataFrame:
    """Mean log time per participant, session and block: one row per condition as it was met.

    `condition`: the levels that stay the same through the person's blocks; `before`: the main
    factor's level in the block before, "" in the first.
    """
    factors = [f.name for f in block_factors(trials, design)]
    keys = ["participant", "session", "block", *factors]
    table = trials.assign(y=np.log(trials["time"]))
    by_task = table.groupby([*keys, "task"], observed=True)["y"].mean().reset_index()
    rows = by_task.groupby(keys, observed=True)["y"].mean().reset_index()
    rows = rows.sort_values(["participant", "session", "block"]).reset_index(drop=True)
    rows["condition"] = rows[factors].astype("str").agg(" ".join, axis=1) if factors else ""
    main = design.main
    if main is None or main.name not in factors:
        return rows.assign(before="")
    before = rows.groupby("participant", observed=True)[main.name].shift()
    return rows.assign(before=before.astype("object").where(before.notna(), "").astype("str"))


def block_factors(trials: pd.DataFrame, design: Design) -> list[Factor]:
    """The within factors whose level stays the same through a block."""
    keys = ["participant", "session", "block"]
    return [
        f
        for f in design.factors
        if f.within and (trials.groupby(keys, observed=True)[f.name].nunique() <= 1).all()
    ]


def order_tests(trials: pd.DataFrame, design: Design) -> list[TermTest]:
    """Period, carry-over (of the main factor's level met before) and sequence, on log time.

    Model: participant + period + condition + carry-over; the sequence is tested between
    participants. Reported, never used to choose an analysis (Freeman 1989; Senn 2002).
    """
    rows = condition_means(trials, design)
    _, group = np.unique(rows["participant"].astype("str"), return_inverse=True)
    main = design.main
    others = [] if main is None else [level for level in main.levels if level != main.baseline]
    before = rows["before"].to_numpy(dtype="str")
    terms = {
        "period": dummies(rows["block"].to_numpy()),
        "condition": dummies(rows["condition"].to_numpy(dtype="str")),
        # the first condition has no predecessor: its own period dummy takes that up
        "carry-over": (before[:, None] == np.array(others, dtype="str")[None, :]).astype(float),
    }
    tests = term_tests(rows["y"].to_numpy(), group, terms)
    by_person = rows.groupby("participant", observed=True)
    order = by_person["condition"].agg(" → ".join)
    level = by_person["y"].mean()
    sequence = one_way(level.to_numpy(), order[level.index].to_numpy(dtype="str"))
    return [t for t in tests if t.name != "condition"] + [sequence]


def learning_slopes(trials: pd.DataFrame) -> Array:
    """Per participant: mean slope of log time over the trials of a task set, per trial (n,).

    Within a set task and condition stay the same, so the slope is practice alone.
    """
    rows = trials.assign(y=np.log(trials["time"]), x=trials["trial_in_set"].astype(float))
    keys = ["participant", "session", "task_set"]
    grouped = rows.groupby(keys, observed=True)
    x = rows["x"] - grouped["x"].transform("mean")
    rows = rows.assign(xy=x * rows["y"], xx=x * x)
    parts = rows.groupby(keys, observed=True)[["xy", "xx"]].sum().reset_index()
    parts = parts[parts["xx"] > 0]
    if not len(parts):
        return np.empty(0)
    slopes = parts.assign(slope=parts["xy"] / parts["xx"])
    of_people: Array = slopes.groupby("participant", observed=True)["slope"].mean().to_numpy()
    return of_people


def learning_curve(trials: pd.DataFrame, factor: Factor) -> pd.DataFrame:
    """Geometric mean time by level and position: level, trial_in_set, log_time, people, time."""
    rows = trials.assign(y=np.log(trials["time"]))
    keys = [factor.name, "trial_in_set"]
    by_person = rows.groupby(["participant", *keys], observed=True)["y"].mean().reset_index()
    curve = by_person.groupby(keys, observed=True)["y"]
    table = curve.agg(log_time="mean", people="size").reset_index()
    table = table.assign(time=np.exp(table["log_time"]))
    table = table.rename(columns={factor.name: "level"})
    order = level_codes(table["level"], factor.levels)
    return table.iloc[np.lexsort((table["trial_in_set"], order))].reset_index(drop=True)


def share_missed(trials: pd.DataFrame, factor: Factor) -> list[Pair]:
    """Frames missed of frames shown, per participant and level."""
    levels = _levels(trials, factor)
    (missed, frames), counts, names = sums(trials, ["frames_missed", "frames"], levels)
    with np.errstate(invalid="ignore", divide="ignore"):
        cells = table_of(missed / frames, counts, names, levels)
    return _pairs("frames_missed", "share of frames missed", cells, factor)


def focus_losses(trials: pd.DataFrame, factor: Factor) -> list[Pair]:
    """Share of trials in which the window lost its focus."""
    table = trials.assign(lost=focus_lost(trials).astype(float))
    cells = means(table, "lost", _levels(trials, factor))
    return _pairs("focus_lost", "share of trials with focus lost", cells, factor)


def timeouts(trials: pd.DataFrame, factor: Factor) -> list[Pair]:
    """Share of trials that ended at their limit."""
    cells = means(trials, "timed_out", _levels(trials, factor))
    return _pairs("timed_out", "share of trials timed out", cells, factor)


def _levels(trials: pd.DataFrame, factor: Factor) -> dict[str, tuple[str, ...]]:
    return {factor.name: levels_present(trials, factor.name, factor.levels)}


def _pairs(key: str, label: str, cells: Cells, factor: Factor) -> list[Pair]:
    """Each level against the baseline, of those who have both."""
    contrasts: tuple[Contrast, ...] = factor.contrasts()
    several = len(contrasts) > 1
    found = [
        pair_of(
            f"{key}/{c.key}" if several else key,
            f"{label}: {c.baseline} → {c.level}" if several else label,
            "", 4, cells, c,
        )
        for c in contrasts
    ]  # fmt: skip
    return [pair for pair in found if pair is not None]
