"""What a simulated person is like in one trial."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.random import Generator

from seethrough.tasks.kit.skills.effects import EffectUse
from seethrough.tasks.kit.skills.profile import Profile


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
