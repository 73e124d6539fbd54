"""Which trials count. Every row that does not is named, with the rule that took it out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import pandas as pd

from analysis.errors import DataError

MISSED_SHARE = 0.05


@dataclass(frozen=True, slots=True)
class Excluded:
    """A trial left out."""

    rule: str
    row_id: str
    participant: str
    file: str
    row: int


def _timed_out(t: pd.DataFrame) -> pd.Series:
    return t["timed_out"] == 1


def _focus_lost(t: pd.DataFrame) -> pd.Series:
    return t["time_clean"] < t["time"]


def _frames_missed(t: pd.DataFrame) -> pd.Series:
    # A simulated participant waits for no display: its frames are as far apart as it looks.
    shown = t["source"].astype("str") != "simulated"
    return shown & (t["frames_missed"] > MISSED_SHARE * t["frames"])


RULES: dict[str, tuple[str, Callable[[pd.DataFrame], pd.Series]]] = {
    "timed_out": ("the trial ended at its time limit", _timed_out),
    "focus_lost": ("the window lost its focus during the trial", _focus_lost),
    "frames_missed": ("over 5 % of the trial's frames were missed", _frames_missed),
}
"""Rules that a study may freeze or a report may ask for; `participant:ID` is one more."""

REPEATED = "repeated"


def apply_rules(
    trials: pd.DataFrame, rules: Sequence[str]
) -> tuple[pd.DataFrame, tuple[Excluded, ...]]:
    """The trials that count, and those that do not, each by its first rule.

    Earlier attempts at a repeated trial never count. Raises DataError for an unknown rule.
    """
    # attempts count on through the sessions of a participant who was interrupted
    last = trials.groupby(["participant", "trial"], observed=True)["attempt"]
    reason = pd.Series("", index=trials.index, dtype="object")
    reason[trials["attempt"] < last.transform("max")] = REPEATED
    for rule in rules:
        hit = _hits(trials, rule)
        reason[hit & (reason == "")] = rule
    out = trials[reason != ""]
    columns = (out[name] for name in ("row_id", "participant", "_file", "_row"))
    named = tuple(
        Excluded(why, str(row_id), str(participant), str(file), int(row))
        for why, row_id, participant, file, row in zip(reason[out.index], *columns, strict=True)
    )
    return trials[reason == ""], named


def _hits(trials: pd.DataFrame, rule: str) -> pd.Series:
    kind, _, name = rule.partition(":")
    if kind == "participant" and name:
        return trials["participant"].astype("str") == name
    if rule not in RULES:
        known = ", ".join([*RULES, "participant:ID"])
        raise DataError(f"exclude = {rule!r}: expected one of {known}")
    return RULES[rule][1](trials)
