"""Which trials count. Every row that does not is named, with the rule that took it out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import pandas as pd

from seethrough.analysis.errors import DataError
from seethrough.analysis.stats.ties import difference_signs

MISSED_ONE_IN = 20
"""More than one in so many frames missed, that is 5 %; in whole numbers, so exactly 5 % is not."""
TOO_FAST = 0.2
"""Seconds: about the fastest simple reaction of anybody to anything (Luce 1986); an answer here
takes a look, a decision and more than one key. A study may set another limit."""


@dataclass(frozen=True, slots=True)
class Excluded:
    """A trial left out."""

    rule: str
    row_id: str
    participant: str
    file: str
    row: int


def _timed_out(t: pd.DataFrame, too_fast: float) -> pd.Series:
    return t["timed_out"] == 1


def _focus_lost(t: pd.DataFrame, too_fast: float) -> pd.Series:
    return focus_lost(t)


def focus_lost(t: pd.DataFrame) -> pd.Series:
    """Whether some of a trial passed while the window had no focus."""
    lost = difference_signs(t["time"].to_numpy(), t["time_clean"].to_numpy()) > 0
    return pd.Series(lost, index=t.index)


def _frames_missed(t: pd.DataFrame, too_fast: float) -> pd.Series:
    # A simulated participant waits for no display: its frames are as far apart as it looks.
    shown = t["source"].astype("str") != "simulated"
    return shown & (t["frames_missed"] * MISSED_ONE_IN > t["frames"])


def _too_fast(t: pd.DataFrame, too_fast: float) -> pd.Series:
    return t["time"] < too_fast


RULES: dict[str, tuple[str, Callable[[pd.DataFrame, float], pd.Series]]] = {
    "timed_out": ("the trial ended at its time limit", _timed_out),
    "focus_lost": ("the window lost its focus during the trial", _focus_lost),
    "frames_missed": ("over 5 % of the trial's frames were missed", _frames_missed),
    "too_fast": ("the answer came sooner than anybody can look and answer", _too_fast),
}
"""Rules that a study may freeze or a report may ask for; `participant:ID` is one more."""

REPEATED = "repeated"


def apply_rules(
    trials: pd.DataFrame, rules: Sequence[str], too_fast: float = TOO_FAST
) -> tuple[pd.DataFrame, tuple[Excluded, ...]]:
    """The trials that count, and those that do not, each by its first rule.

    Earlier attempts at a repeated trial never count. `too_fast`: that rule's limit in seconds.
    Raises DataError for an unknown rule.
    """
    # attempts count on through the sessions of a participant who was interrupted
    last = trials.groupby(["participant", "trial"], observed=True)["attempt"]
    reason = pd.Series("", index=trials.index, dtype="object")
    reason[trials["attempt"] < last.transform("max")] = REPEATED
    for rule in rules:
        hit = _hits(trials, rule, too_fast)
        reason[hit & (reason == "")] = rule
    out = trials[reason != ""]
    columns = (out[name] for name in ("row_id", "participant", "_file", "_row"))
    named = tuple(
        Excluded(why, str(row_id), str(participant), str(file), int(row))
        for why, row_id, participant, file, row in zip(reason[out.index], *columns, strict=True)
    )
    return trials[reason == ""], named


def why(rule: str, too_fast: float) -> str:
    """What a rule leaves out, in words, with its limit."""
    if rule == REPEATED:
        return "a later attempt replaced it"
    if rule not in RULES:
        return "left out by name"
    return RULES[rule][0] + (f" (within {too_fast:g} s)" if rule == "too_fast" else "")


def _hits(trials: pd.DataFrame, rule: str, too_fast: float) -> pd.Series:
    kind, _, name = rule.partition(":")
    if kind == "participant" and name:
        return trials["participant"].astype("str") == name
    if rule not in RULES:
        known = ", ".join([*RULES, "participant:ID"])
        raise DataError(f"exclude = {rule!r}: expected one of {known}")
    return RULES[rule][1](trials, too_fast)
