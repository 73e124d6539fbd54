"""Was the comparison fair? Order effects, learning, timing faults and difficulty, by condition."""

from __future__ import annotations

import numpy as np
import pandas as pd

from seethrough.analysis.cells import Array, level_codes, means, sums, table_of
from seethrough.analysis.comparison import Measure, measure
from seethrough.analysis.exclude import focus_lost
from seethrough.analysis.load.schema import TRANSPARENCY
from seethrough.analysis.measures import design
from seethrough.analysis.stats.within import TermTest, dummies, one_way, term_tests


def condition_means(trials: pd.DataFrame) -> pd.DataFrame:
    """Mean log time per participant, session and block: one row per condition as it was met."""
    keys = ["participant", "session", "block", "transparency", "scenario"]
    table = trials.assign(y=np.log(trials["time"]))
    by_task = table.groupby([*keys, "task"], observed=True)["y"].mean().reset_index()
    rows = by_task.groupby(keys, observed=True)["y"].mean().reset_index()
    rows = rows.sort_values(["participant", "session", "block"])
    rows["condition"] = rows["transparency"].astype("str") + " " + rows["scenario"].astype("str")
    before = rows.groupby("participant", observed=True)["transparency"].shift()
    rows["carry"] = (before.astype("str") == "dynamic").astype(float)
    rows["first"] = before.isna().astype(float)
    return rows


def order_tests(trials: pd.DataFrame) -> list[TermTest]:
    """Period, carry-over (of the technique met before) and sequence, on log time.

    Model: participant + period + condition + carry-over; the sequence is tested between
    participants. Reported, never used to choose an analysis (Freeman 1989; Senn 2002).
    """
    rows = condition_means(trials)
    _, group = np.unique(rows["participant"].astype("str"), return_inverse=True)
    terms = {
        "period": dummies(rows["block"].to_numpy()),
        "condition": dummies(rows["condition"].to_numpy(dtype="str")),
        # the first condition has no predecessor: its own period dummy takes that up
        "carry-over": rows[["carry"]].to_numpy(),
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
    return slopes.groupby("participant", observed=True)["slope"].mean().to_numpy()


def learning_curve(trials: pd.DataFrame) -> pd.DataFrame:
    """Geometric mean time by position in the task set and transparency."""
    rows = trials.assign(y=np.log(trials["time"]))
    keys = ["transparency", "trial_in_set"]
    by_person = rows.groupby(["participant", *keys], observed=True)["y"].mean().reset_index()
    curve = by_person.groupby(keys, observed=True)["y"]
    table = curve.agg(log_time="mean", people="size").reset_index()
    table = table.assign(time=np.exp(table["log_time"]))
    order = level_codes(table["transparency"], TRANSPARENCY)
    return table.iloc[np.lexsort((table["trial_in_set"], order))].reset_index(drop=True)


def share_missed(trials: pd.DataFrame) -> Measure | None:
    """Frames missed of frames shown, per participant and level."""
    levels = {"transparency": design(trials)["transparency"]}
    (missed, frames), counts, names = sums(trials, ["frames_missed", "frames"], levels)
    if levels["transparency"] != TRANSPARENCY:
        return None
    with np.errstate(invalid="ignore", divide="ignore"):
        cells = table_of(missed / frames, counts, names, levels)
    return measure("frames_missed", "share of frames missed", "", 4, cells)


def focus_losses(trials: pd.DataFrame) -> Measure | None:
    """Share of trials in which the window lost its focus."""
    table = trials.assign(lost=focus_lost(trials).astype(float))
    cells = means(table, "lost", {"transparency": design(trials)["transparency"]})
    return measure("focus_lost", "share of trials with focus lost", "", 4, cells)


def timeouts(trials: pd.DataFrame) -> Measure | None:
    """Share of trials that ended at their limit."""
    cells = means(trials, "timed_out", {"transparency": design(trials)["transparency"]})
    return measure("timed_out", "share of trials timed out", "", 4, cells)
