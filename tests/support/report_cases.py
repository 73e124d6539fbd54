"""The twelve data folders that the report is held to R on: who did what, from integers alone.

Every number comes from PCG64's raw 64-bit words and from arithmetic, times are whole milliseconds:
any machine and any numpy gives the same folders, so that R's values can be kept.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from seethrough.experiment.study.design.design import Trial
from seethrough.tasks.kit.base import Outcome

SECONDS = {"count": 50.0, "pattern": 20.0, "unique": 55.0, "count_in_building": 120.0}
ITEMS = ("efficiency", "ease", "enjoy")
LETTERS = "CKRXY"
LIMIT = 90.0  # seconds, of the folder with timed-out trials

VIEW = "transparency"


class Draws:
    """Random numbers of one stream, by raw words: numpy never changes what those are."""

    def __init__(self, *key: int) -> None:
        self._bits = np.random.PCG64(np.random.SeedSequence(20261128, spawn_key=key))

    def below(self, n: int) -> int:
        """A whole number in 0 … n − 1."""
        return int(self._bits.random_raw()) % n

    def share(self) -> float:
        """In [0, 1)."""
        return (int(self._bits.random_raw()) >> 11) * 2.0**-53

    def bell(self) -> float:
        """Mean 0, variance 1, nearly normal: twelve shares less six."""
        return sum(self.share() for _ in range(12)) - 6.0

    def pick(self, options: Sequence[Any]) -> Any:
        """One of the options."""
        return options[self.below(len(options))]


@dataclass(frozen=True)
class Play:
    """A trial as somebody did it; times in seconds. `repeat`: it is done again right after."""

    trial: Trial
    outcome: Outcome | None
    targets: int
    time: float
    away: float = 0.0
    timed_out: bool = False
    frames: int = 0
    missed: int = 0
    session: int = 1
    repeat: bool = False


@dataclass(frozen=True)
class Answer:
    """A row of the questionnaire; no transparency: asked once."""

    item: str
    value: int
    transparency: str = ""
    scenario: str = ""
    text: str = ""


Plays = list[Play]
Answers = list[Answer]


@dataclass(frozen=True)
class Case:
    """A folder. `study` overrides tables of the published study's file; the changes take a
    participant's number (from 1) and what a plain participant would have done."""

    name: str
    people: int = 16
    source: str = "human"
    study: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    change: Callable[[int, Plays], Plays] = lambda _, plays: plays
    change_answers: Callable[[int, Answers], Answers] = lambda _, answers: answers
    certificate: bool = False


def plain_plays(person: int, trials: Sequence[Trial]) -> Plays:
    """An ordinary participant: faster and a little more accurate with the technique."""
    draws = Draws(1, person)
    habit = 0.3 * draws.bell()
    gain = -0.6 + 0.2 * draws.bell()
    plays = []
    for trial in trials:
        log = math.log(SECONDS[trial.task]) + habit + 0.35 * draws.bell()
        log += gain if trial.levels[VIEW] == "dynamic" else 0.0
        log -= 0.03 * trial.in_set
        time = round(math.exp(log), 3)
        outcome, targets = _outcome(trial, draws)
        away = round(time * 0.1, 3) if draws.below(25) == 0 else 0.0
        frames = int(time * 60)
        share = 0.08 if draws.below(20) == 0 else 0.01
        missed = int(frames * share * draws.share())
        plays.append(Play(trial, outcome, targets, time, away, False, frames, missed))
    return plays


def _outcome(trial: Trial, draws: Draws) -> tuple[Outcome, int]:
    """An answer with its score, and how many targets there were."""
    dynamic = trial.levels[VIEW] == "dynamic"
    if trial.task == "pattern":
        truth = draws.pick(LETTERS)
        right = draws.below(100) < (92 if dynamic else 85)
        return Outcome(truth if right else "Q", truth, right), 12
    if trial.task == "unique":
        away = round(1.0 + 8 * draws.share() + (0.0 if dynamic else 2 * draws.share()), 3)
        return Outcome("1.0 2.0", "3.0 4.0", away < 5, distance=away), 1
    truth = 20 + draws.below(21) if trial.task == "count" else 4 + draws.below(9)
    off = draws.pick((-1, 0, 0, 0, 0, 1) if dynamic else (-2, -1, -1, 0, 0, 1))
    return Outcome(str(truth + off), str(truth), off == 0, count_error=off), truth


def plain_answers(person: int, conditions: Sequence[tuple[str, str]]) -> Answers:
    """Ratings of every condition, and what is asked once."""
    draws = Draws(2, person)
    found = []
    for transparency, scenario in conditions:
        for item in ITEMS:
            centre = 2.7 if transparency == "dynamic" else 1.8
            value = min(4, max(0, round(centre + 0.8 * draws.bell())))
            found.append(Answer(item, value, transparency, scenario))
    wish = draws.below(10)
    text = "neutral" if wish == 9 else ""
    found.append(Answer("preference", int(wish < 7), text=text))
    found.append(Answer("depth_self_report", 2 + draws.below(3)))
    found.append(Answer("depth_test", 2 + draws.below(2)))
    return found


def _scored(play: Play, **new: Any) -> Play:
    """The play with parts of its outcome replaced."""
    assert play.outcome is not None
    return replace(play, outcome=replace(play.outcome, **new))


# thirds: means of three that are equal, but not as sums of doubles in another order
_EQUAL_TIMES = ((10.1, 10.2, 10.3), (10.3, 10.2, 10.1))
_EQUAL_MARKS = ((0.1, 0.2, 0.3), (0.3, 0.2, 0.1))


def _thirds(person: int, plays: Plays) -> Plays:
    found = []
    for play in plays:
        level, k = int(play.trial.levels[VIEW] == "dynamic"), play.trial.in_set - 1
        if play.trial.task in ("count", "pattern") and person % 3 == 0:
            play = replace(play, time=_EQUAL_TIMES[level][k])
        if play.trial.task == "count" and person % 3 == 1:
            play = replace(play, time=20.0 + person)  # one time three times: no fastest third
        if play.trial.task == "unique":
            marks = _EQUAL_MARKS[level if person % 2 else 0]
            factor = 1 + (person % 4 if level or person % 4 > 1 else 0)
            play = _scored(play, distance=round(factor * marks[k], 1))
        found.append(play)
    return found


# the ratings of ten people as a reviewer found them: their means over three items tie in thirds
_SUMS = (4, 6, 2, 10, 5, 11, 2, 8, 3, 12)
_STEPS = (2, 2, 2, 2, 2, -2, -2, 2, 2, -2)
_SPREAD = ((0, 0, 0), (0, 0, 1), (0, 1, 1), (1, 1, 1))


def _three_items(total: int) -> tuple[int, int, int]:
    """Three ratings 0–4 with this sum, 0–12."""
    whole, rest = divmod(total, 3)
    first, second, third = (whole + more for more in _SPREAD[rest])
    return first, second, third


def _thirds_answers(person: int, answers: Answers) -> Answers:
    """In sums over the items: a step of two thirds one way or the other, in every pair."""
    total, step = _SUMS[(person - 1) % 10], _STEPS[(person - 1) % 10]
    totals = {
        ("standard", "abstract"): total,
        ("standard", "walkthrough"): min(12, max(0, total - step)),
        ("dynamic", "abstract"): min(12, max(0, total + (step if person % 3 else -step))),
        ("dynamic", "walkthrough"): min(12, max(0, total + 1)),
    }
    found = []
    for answer in answers:
        if answer.item in ITEMS:
            three = _three_items(totals[answer.transparency, answer.scenario])
            # the largest one first for odd people: other sums of doubles, the same number
            order = ITEMS if person % 2 else ITEMS[::-1]
            answer = replace(answer, value=three[order.index(answer.item)])
        found.append(answer)
    return found


def _missing(person: int, plays: Plays) -> Plays:
    """P03 has no T3 with the technique, P05 no T2 at all, P07 a trial less, P09 half of T1."""
    lost = {
        3: lambda t: t.task == "unique" and t.levels[VIEW] == "dynamic",
        5: lambda t: t.task == "pattern",
        7: lambda t: t.number == 1,
        9: lambda t: t.task == "count" and t.in_set > 1 and t.levels[VIEW] == "standard",
    }.get(person, lambda t: False)
    return [p for p in plays if not lost(p.trial)]


def _missing_answers(person: int, answers: Answers) -> Answers:
    if person == 4:
        return [a for a in answers if (a.item, a.transparency) != ("ease", "dynamic")]
    if person == 6:
        return [a for a in answers if a.transparency]
    return answers


def _outlier(person: int, plays: Plays) -> Plays:
    """Somebody left the room for eleven days."""
    first = next(p for p in plays if p.trial.task == "count" and p.trial.levels[VIEW] == "dynamic")
    return [replace(p, time=1e6) if person == 5 and p is first else p for p in plays]


def _repeated(person: int, plays: Plays) -> Plays:
    """Every fourth participant did some trials again; P06 came back for a second session; P09
    answered two trials before anybody can have looked."""
    found = []
    for play in plays:
        if person % 4 == 0 and play.trial.number % 7 == 0:
            again = replace(play, time=round(play.time * 3 + 1, 3), repeat=True)
            found += [again] * (2 if play.trial.number == 14 else 1)
        if person == 9 and play.trial.number in (3, 17):
            play = replace(play, time=0.15, away=0.0, frames=9, missed=0)
        if person == 11 and play.trial.number == 5:  # exactly one frame in twenty: it counts
            play = replace(play, frames=400, missed=20)
        if person == 6 and play.trial.number > 13:
            play = replace(play, session=2)
        found.append(play)
    return found


def _timed_out(person: int, plays: Plays) -> Plays:
    over = [replace(p, outcome=None, time=LIMIT, timed_out=True) for p in plays]
    return [o if p.time > LIMIT else p for p, o in zip(plays, over, strict=True)]


def _offset(person: int, plays: Plays) -> Plays:
    return [replace(p, time=p.time + 1e9, frames=int(1e6), missed=p.missed) for p in plays]


def _identical(person: int, plays: Plays) -> Plays:
    """Under both levels the same times, answers and faults; people and tasks differ."""
    first = {(p.trial.task, p.trial.in_set): p for p in plays if p.trial.levels[VIEW] == "standard"}
    return [replace(first[p.trial.task, p.trial.in_set], trial=p.trial) for p in plays]


def _identical_answers(person: int, answers: Answers) -> Answers:
    value = {(a.item, a.scenario): a.value for a in answers if a.transparency in ("standard", "")}
    return [replace(a, value=value[a.item, a.scenario]) for a in answers]


CASES = (
    Case("plain", certificate=True),
    Case("thirds", people=10, change=_thirds, change_answers=_thirds_answers),
    Case("missing", change=_missing, change_answers=_missing_answers, certificate=True),
    Case("outlier", change=_outlier),
    Case(
        "repeated",
        study={"analysis": {"exclude": ["too_fast", "focus_lost", "frames_missed"]}},
        change=_repeated,
    ),
    Case("timed_out", study={"task": {"limit": LIMIT}}, change=_timed_out),
    Case("three", people=3),
    Case("two_hundred", people=200, source="simulated"),
    Case(
        "one_level",
        change=lambda _, plays: [p for p in plays if p.trial.levels[VIEW] == "standard"],
        change_answers=lambda _, answers: [a for a in answers if a.transparency != "dynamic"],
    ),
    Case("one_task", change=lambda _, plays: [p for p in plays if p.trial.task == "count"]),
    Case("offset", change=_offset),
    Case("identical", change=_identical, change_answers=_identical_answers),
)
