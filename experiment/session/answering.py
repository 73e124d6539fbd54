"""Sessions without pictures or eyes: whoever answers at once, to see what comes out of a design."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from seethrough.experiment.display.clock import SimulatedClock
from seethrough.experiment.pages.pages import Answers, Page, Ranking
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.session.session import run_session
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.experiment.study.study import Study
from seethrough.renderer.events import Event, Tick
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Scene
from seethrough.tasks.kit.base import NoParameters, Outcome, Task, View
from seethrough.tasks.kit.measure import Measure
from seethrough.tasks.kit.world import NO_KEYS, NO_TEXTS

NOTHING = View(Scene(()), look_at(np.array([0.0, 0.0, 9.0]), np.zeros(3)))
FRAME = 0.5  # s


def played(study: Study, slot: int) -> list[TrialRecord]:
    """The records of a slot's session; every answer is right, every page filled in somehow."""
    clock = SimulatedClock()
    hand, records = _Hand(clock), _Records()
    scenes: Any = _NoScenes()  # neither scenes nor tasks are asked for more than this
    run_session(study, slot, Surroundings(hand, hand, clock, records, _Tasks(), scenes=scenes))
    return records.ended


class _Task:
    """Any task, answered by the first event."""

    name = code = version = source = title = instruction = ""
    worlds: tuple[str, ...] = ()
    measures: tuple[Measure, ...] = ()
    Parameters, texts = NoParameters, NO_TEXTS
    simulate, takes = None, NO_KEYS

    def begin(self, made: object, setting: object, aspect: float) -> bool:
        return False

    def view(self, state: bool) -> View:
        return NOTHING

    def on_event(self, state: bool, event: Event) -> bool:
        return True

    def outcome(self, state: bool) -> Outcome | None:
        return Outcome("", "", True) if state else None

    def solution(self, state: bool) -> None:
        return None


class _Tasks(Mapping[str, Task]):
    """A task of every name."""

    def __getitem__(self, name: str) -> Any:
        return _Task()

    def __iter__(self) -> Iterator[str]:
        return iter(())

    def __len__(self) -> int:
        return 0


class _NoScenes:
    """Begins a trial without a scene."""

    def begin(self, task: Any, trial: object, aspect: float) -> object:
        return task.begin(None, None, aspect)


class _Hand:
    """A display that shows nothing, and a person who answers at once."""

    aspect = 4 / 3

    def __init__(self, clock: SimulatedClock) -> None:
        self._clock = clock

    def show(self, view: View, technique: object) -> float:
        return self._clock.now()

    def digest(self) -> str:
        return ""

    def progress(self, fraction: float) -> None:
        return None

    def describe(self) -> Mapping[str, str]:
        return {}

    def begin_trial(self, task: str, training: bool) -> None:
        return None

    def events(self, view: View) -> list[Event]:
        self._clock.advance(self._clock.now() + FRAME)
        return [Tick(self._clock.now())]

    def ask(self, page: Page) -> Answers:
        ranks = {
            b.name: ",".join(map(str, range(1, len(b.options) + 1)))
            for b in page.asked
            if isinstance(b, Ranking)
        }
        return {"button": "0", **dict.fromkeys(page.required, "0"), **ranks}


class _Records:
    """Keeps the trials that count."""

    def __init__(self) -> None:
        self.ended: list[TrialRecord] = []

    def trial_ends(self, record: TrialRecord) -> None:
        self.ended.append(record)

    def trial_begins(self, trial: object) -> None:
        return None

    def event(self, event: object) -> None:
        return None

    def frame(self, time: float, view: object, digest: str = "") -> None:
        return None

    def answers(self, rows: object) -> None:
        return None

    def note(self, trial: object, text: str) -> None:
        return None

    def close(self, status: str) -> None:
        return None
