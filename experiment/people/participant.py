"""A simulated participant: sees what the display shows, answers with the events of a person.

It knows what is on the view: the texts of the HUD, and of the scene only what `look` reports as
visible strongly enough. It is a tool for planning studies, never evidence about people.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict

import numpy as np
from numpy.random import Generator as Random
from numpy.typing import NDArray

from seethrough.experiment.pages.pages import Page
from seethrough.experiment.people.code_hash import code_sha256
from seethrough.experiment.people.forms import Opinions
from seethrough.experiment.people.persons.person import Person, mood_for
from seethrough.renderer.events import Event, KeyPress, KeyRelease
from seethrough.renderer.scene.visibility import Visibility
from seethrough.renderer.techniques.base import Parameters
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.skills.effects import EffectUse, checked
from seethrough.tasks.kit.skills.glance import Glance
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.profile import AVERAGE, Profile
from seethrough.tasks.kit.skills.strategy import Play
from seethrough.tasks.kit.skills.sweep import Sweep, sweep_of
from seethrough.tasks.kit.unsure import BUTTON
from seethrough.tasks.kit.unsure import KEY as UNSURE


class SimulatedParticipant:
    """Sits through a session: `begin_trial`, then `events` again and again; `answer` for pages."""

    def __init__(
        self,
        rng: Random,
        profile: Profile = AVERAGE,
        without: Iterable[str] = (),
        traits: NDArray[np.float64] | None = None,
    ) -> None:
        self.person = Person(rng, profile, checked(without), traits)
        self.opinions = Opinions(self.person)
        self.effects: dict[str, EffectUse] = {}
        self._strategy: Play | None = None
        self._sweep: Sweep | None = None
        self._task, self._began = "", 0.0
        self._mood: Mood | None = None
        self._blind = True  # has seen no target in this trial

    def about(self, seed: int) -> dict[str, object]:
        """What a sidecar says of it, so that anybody can simulate it again."""
        return {
            "simulation_seed": seed,
            "profile": asdict(self.person.profile),
            "without": sorted(self.person.without),
            "code": code_sha256(),
        }

    def begin_trial(self, task: str, now: float) -> None:
        """Meet a new trial. Raises ValueError for a task that there is not."""
        if task not in TASKS:
            raise ValueError(f"task = {task}, expected one of {', '.join(TASKS)}")
        self._mood = mood_for(self.person, task, now)
        self.effects = self._mood.effects
        self._strategy = self._sweep = None
        self._blind = True
        self._task, self._began = task, now
        self.opinions.begin(task)

    def events(
        self,
        view: View,
        look: Callable[[], Visibility],
        now: float,
        task: str,
        drawn_with: Parameters | None = None,
        aspect: float = 4 / 3,
    ) -> list[Event]:
        """What it does next, at times from `now` on. It may think first: the times say so.

        `drawn_with` is the technique (its parameters) and `aspect` the width of the view over its
        height: hands that work the technique search with it first.
        """
        look = self._seeing(look, view)
        if self._strategy is None and self._sweep is None:
            self._sweep = sweep_of(self._begun(task, now), drawn_with, aspect)
        sweep = self._sweep
        if sweep is None:
            return self._next(Glance(view, look, now), task)
        events = sweep.events(view, look, now)
        if not events:
            glance = Glance(view, sweep.seen(look), now - sweep.spent)
            events = sweep.later(self._next(glance, task))
        self.opinions.spent(self._task, events[-1].time - self._began)
        return events

    def _next(self, glance: Glance, task: str) -> list[Event]:
        """What its strategy does next."""
        if self._strategy is None:
            self._strategy = TASKS[task].simulate.play(self._begun(task, glance.now), glance)
            return next(self._strategy)
        try:
            events = self._strategy.send(glance)
            if BUTTON in glance.view.hud and self._blind and _answers(events):
                time = events[-1].time
                events = [KeyPress(time, UNSURE), KeyRelease(time + 0.1, UNSURE)]
        except StopIteration:
            # The answer did not count (a key lost, a limit changed): press enter again.
            now = glance.now
            events = [KeyPress(now + 1.0, "enter"), KeyRelease(now + 1.1, "enter")]
        self.opinions.spent(self._task, events[-1].time - self._began)
        return events

    def _seeing(self, look: Callable[[], Visibility], view: View) -> Callable[[], Visibility]:
        """A look that remembers whether any target showed."""

        def seeing() -> Visibility:
            seen = look()
            self._blind &= not seen.pixels[view.scene.targets].any()
            return seen

        return seeing

    def answer(self, page: Page) -> tuple[dict[str, str], float]:
        """Read and fill in a page: answers by name, and the seconds it took."""
        return self.opinions.answer(page)

    def _begun(self, task: str, now: float) -> Mood:
        if self._mood is None or self._task != task:
            self.begin_trial(task, now)
        assert self._mood is not None
        return self._mood


def _answers(events: Sequence[Event]) -> bool:
    """Whether they confirm an answer."""
    return any(isinstance(event, KeyPress) and event.key == "enter" for event in events)
