"""One simulated person: drawn once from a profile, and what a trial finds them like."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import exp
from zlib import crc32

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.skills.effects import plan_effects
from seethrough.tasks.kit.skills.learned import Learned
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.profile import Profile

# A person's paces at these are drawn together, in this order: what was simulated before there were
# other tasks stays as it was. At any other task the pace has a stream of its own.
TOGETHER = ("count", "pattern", "unique", "count_in_building")
TRAITS = 2 + len(TOGETHER)
PACE = 0  # last word of the stream of a pace at another task: no trial's has three words


@dataclass
class Person:
    """Pace and care for a whole session; experience grows with each trial, and so does what is
    `learned` at each task.

    `pace` multiplies mental times at each task, `care` multiplies patience and divides slips.
    `traits` (2 + tasks,) are the person's standard normal deviates: of care, of pace, of pace at
    each task. Without them they are drawn.
    """

    rng: Generator
    profile: Profile
    without: frozenset[str] = frozenset()
    traits: NDArray[np.float64] | None = None
    pace: dict[str, float] = field(init=False)
    _own: float = field(init=False)
    care: float = field(init=False)
    experience: dict[str, int] = field(default_factory=dict)
    learned: dict[str, Learned] = field(default_factory=dict)
    began: float | None = None

    def __post_init__(self) -> None:
        given = self.traits is not None
        draws = np.array(self.traits) if given else self.rng.standard_normal(TRAITS)
        p = self.profile
        if "people" in self.without:
            draws[:] = 0
        self.care = p.care * exp(p.sd_care * draws[0])
        # Who is careful is slower as well: half of what makes a person careful costs pace.
        self._own = p.sd_person * draws[1]
        self.pace = {
            task: self._pace(task, draw) for task, draw in zip(TOGETHER, draws[2:], strict=True)
        }

    def pace_at(self, task: str) -> float:
        """The pace at a task."""
        if task not in self.pace:
            alike = "people" in self.without
            rng = _stream(self.rng, _number(task), 0, PACE)
            self.pace[task] = self._pace(task, 0.0 if alike else rng.standard_normal())
        return self.pace[task]

    def _pace(self, task: str, draw: float) -> float:
        p, walks = self.profile, TASKS[task].simulate.walks
        return p.pace * exp(self._own + (p.sd_task_walking if walks else p.sd_task) * draw)


def mood_for(person: Person, task: str, now: float) -> Mood:
    """The person at the start of a trial at `now`; counts the trial as experience.

    Each trial has a stream of its own, named by the task and how often it was done: two profiles,
    or a person with and without an effect, meet each trial with the same luck.
    """
    done = person.experience.get(task, 0)
    rng = _stream(person.rng, _number(task), done)
    person.experience[task] = done + 1
    if person.began is None:
        person.began = now
    p = person.profile
    strategy = TASKS[task].simulate
    effects = plan_effects(strategy.effects, done, person.without)
    pace = person.pace_at(task)
    if effects["learning"].used:
        pace *= 1 + p.learning * exp(-p.learning_rate * done)
    spread = p.sd_trial_walking if strategy.walks else p.sd_trial
    spread *= effects["trial_noise"].used
    if effects["fatigue"].used:
        spread *= 1 + p.fatigue * (now - person.began) / 3600
    pace *= exp(spread * rng.standard_normal())
    learned = person.learned.setdefault(task, Learned())
    learned.begin()
    return Mood(rng, p, effects, pace, person.care, learned)


def _number(task: str) -> int:
    """A task's number in the names of streams, the same whatever tasks there are besides."""
    together = task in TOGETHER
    return TOGETHER.index(task) if together else len(TOGETHER) + crc32(task.encode())


def _stream(rng: Generator, *key: int) -> Generator:
    """The stream of that name below the person's own; drawing from one moves no other."""
    own = rng.bit_generator.seed_seq
    assert isinstance(own, np.random.SeedSequence)
    return np.random.default_rng(
        np.random.SeedSequence(own.entropy, spawn_key=(*own.spawn_key, *key))
    )
