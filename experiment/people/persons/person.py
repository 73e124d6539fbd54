"""One simulated person: drawn once from a profile, and what a trial finds them like."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import exp

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from seethrough.experiment.people.persons.profile import Profile
from seethrough.experiment.people.persons.study_effects import WALKING, EffectUse, plan_effects

TASKS = ("count", "pattern", "unique", "count_in_building")
TRAITS = 2 + len(TASKS)


@dataclass
class Person:
    """Pace and care for a whole session; experience grows with each trial.

    `pace` multiplies mental times at each task, `care` multiplies patience and divides slips.
    `traits` (2 + tasks,) are the person's standard normal deviates: of care, of pace, of pace at
    each task. Without them they are drawn.
    """

    rng: Generator
    profile: Profile
    without: frozenset[str] = frozenset()
    traits: NDArray[np.float64] | None = None
    pace: dict[str, float] = field(init=False)
    care: float = field(init=False)
    experience: dict[str, int] = field(default_factory=dict)
    began: float | None = None

    def __post_init__(self) -> None:
        given = self.traits is not None
        draws = np.array(self.traits) if given else self.rng.standard_normal(TRAITS)
        p = self.profile
        if "people" in self.without:
            draws[:] = 0
        self.care = p.care * exp(p.sd_care * draws[0])
        # Who is careful is slower as well: half of what makes a person careful costs pace.
        own = p.sd_person * draws[1]
        self.pace = {
            task: p.pace * exp(own + (p.sd_task_walking if task in WALKING else p.sd_task) * draw)
            for task, draw in zip(TASKS, draws[2:], strict=True)
        }


@dataclass(frozen=True)
class Mood:
    """What a person is like in one trial."""

    rng: Generator
    profile: Profile
    effects: dict[str, EffectUse]
    pace: float
    care: float

    def uses(self, effect: str) -> bool:
        """Whether this trial calls for the effect."""
        return self.effects[effect].used


def mood_for(person: Person, task: str, now: float) -> Mood:
    """The person at the start of a trial at `now`; counts the trial as experience.

    Each trial has a stream of its own, named by the task and how often it was done: two profiles,
    or a person with and without an effect, meet each trial with the same luck.
    """
    done = person.experience.get(task, 0)
    rng = _stream(person.rng, TASKS.index(task) if task in TASKS else len(TASKS), done)
    person.experience[task] = done + 1
    if person.began is None:
        person.began = now
    p = person.profile
    effects = plan_effects(task, done, person.without)
    pace = person.pace.get(task, p.pace)
    if effects["learning"].used:
        pace *= 1 + p.learning * exp(-p.learning_rate * done)
    spread = p.sd_trial_walking if task in WALKING else p.sd_trial
    spread *= effects["trial_noise"].used
    if effects["fatigue"].used:
        spread *= 1 + p.fatigue * (now - person.began) / 3600
    pace *= exp(spread * rng.standard_normal())
    return Mood(rng, p, effects, pace, person.care)


def _stream(rng: Generator, *key: int) -> Generator:
    """The stream of that name below the person's own; drawing from one moves no other."""
    own = rng.bit_generator.seed_seq
    return np.random.default_rng(
        np.random.SeedSequence(own.entropy, spawn_key=(*own.spawn_key, *key))
    )
