"""What a simulated person is like in one trial."""

from __future__ import annotations

from dataclasses import dataclass, field

from numpy.random import Generator

from seethrough.tasks.kit.skills.effects import EffectUse
from seethrough.tasks.kit.skills.learned import Learned
from seethrough.tasks.kit.skills.profile import Profile


@dataclass(frozen=True)
class Mood:
    """What a person is like in one trial; `learned` goes on from trial to trial of a task."""

    rng: Generator
    profile: Profile
    effects: dict[str, EffectUse]
    pace: float
    care: float
    learned: Learned = field(default_factory=Learned)

    def uses(self, effect: str) -> bool:
        """Whether this trial calls for the effect."""
        return self.effects[effect].used
