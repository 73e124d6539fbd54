"""How a simulated person does a task: what every task brings along as its `simulate`."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass, field

from seethrough.renderer.events import Event
from seethrough.tasks.kit.skills.glance import Glance
from seethrough.tasks.kit.skills.mood import Mood

Play = Generator[list[Event], Glance, None]


@dataclass(frozen=True)
class Strategy:
    """`play` looks at what is displayed, gives the next events, and gets what is displayed then,
    until it has confirmed an answer.

    `effects` are those that not every task calls for, each with the reason why this one does
    (tasks/kit/skills/effects.py). `heights`, in radians above the middle, are those from which a
    world that one turns is usually looked at: data mode draws these looks beforehand.
    """

    play: Callable[[Mood, Glance], Play]
    effects: Mapping[str, str] = field(default_factory=dict)
    heights: tuple[float, ...] = ()

    @property
    def walks(self) -> bool:
        """Whether one finds one's way in it."""
        return "drift" in self.effects
