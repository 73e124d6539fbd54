"""The moments of a session at which its study asks something between trials."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from zlib import crc32

from seethrough.experiment.study.design.design import PARTICIPANT, TaskSet, Trial, generator
from seethrough.experiment.study.design.factors import Factor, Levels
from seethrough.experiment.study.study import Study
from seethrough.experiment.study.tables.reading import Question

QUESTION_STREAM = 999_999  # in the names of questions' streams: no trial has it
SHUFFLED = "shuffled"
Asked = tuple[str, Question, dict[str, str]]  # name, question, the levels that it is about


@dataclass(frozen=True)
class Moment:
    """After which trial, with its task, something is asked: of the trial, the task set or the
    condition that it ends (`when`). `levels` are those of the trial, by factor."""

    when: str
    levels: Levels
    trial: int
    task: str

    @property
    def mark(self) -> Mapping[str, str]:
        """What rows say of it: a condition is told by its levels."""
        if self.when == "condition":
            return {}
        return {"after_trial": str(self.trial), "after_task": self.task}

    def about(self, factors: Sequence[Factor]) -> dict[str, str]:
        """The levels that it is about: of what people meet, and of what changes within blocks only
        where it is a single trial."""
        return {
            f.name: self.levels[f.name]
            for f in factors
            if f.block or (f.mixed and self.when == "trial")
        }


def moments_of(task_sets: Sequence[TaskSet]) -> tuple[Moment, ...]:
    """Every moment of a session, in order."""
    found = []
    for number, task_set in enumerate(task_sets):
        found += [_moment("trial", trial) for trial in task_set.trials]
        last = task_set.trials[-1]
        found.append(_moment("task_set", last))
        following = task_sets[number + 1 : number + 2]
        if not following or following[0].trials[0].block != last.block:
            found.append(_moment("condition", last))
    return tuple(found)


def _moment(when: str, trial: Trial) -> Moment:
    return Moment(when, trial.levels, trial.number, trial.task)


def asked_at(study: Study, slot: int, now: Moment, every: Sequence[Moment]) -> list[Asked]:
    """All that is asked at a moment, of `every` one of the session.

    What is asked once for each level of some factors is asked when they are met for the last time.
    """
    later = [m for m in every if m.when == now.when and m.trial > now.trial]
    found = []
    for name, question in study.part(now.levels).questions.items():
        if question.when_asked != now.when or not question.meant_for(now.levels):
            continue
        about = now.about(study.factors)
        if question.table.each is not None:
            about = {f: now.levels[f] for f in question.table.each}
            if any(_again(study, name, about, m) for m in later):
                continue
        found.append((name, question, about))
    return in_order(study, slot, found, now.trial)


def _again(study: Study, name: str, about: Levels, later: Moment) -> bool:
    """Whether a later moment is about the same levels."""
    question = study.part(later.levels).questions.get(name)
    if question is None or not question.meant_for(later.levels):
        return False
    return about.items() <= later.levels.items()


def in_order(study: Study, slot: int, asked: Sequence[Asked], trial: int = 0) -> list[Asked]:
    """What is asked at one moment, neighbours that are shuffled in this participant's order."""
    found: list[Asked] = []
    for shuffled, run in groupby(asked, lambda one: one[1].table.order == SHUFFLED):
        those = list(run)
        if shuffled:
            word = crc32(" ".join(one[0] for one in those).encode())
            stream = (PARTICIPANT, slot, QUESTION_STREAM, word, trial)
            those = [
                those[i] for i in generator(study.general.seed, stream).permutation(len(those))
            ]
        found += those
    return found
