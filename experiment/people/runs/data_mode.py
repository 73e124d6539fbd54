"""Data mode: the real session with visibility tables in place of what a display would draw.

The session, the trials, the pages and the tasks are those of visual mode
(experiment/session/session.py); only the eyes are others, and the rows stay in memory.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from seethrough.experiment.display.clock import SimulatedClock
from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.people.runs.pool import Pool
from seethrough.experiment.people.simulated_input import SimulatedInput
from seethrough.experiment.record.recorder import trial_row
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.session.session import run_session
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.experiment.session.trial import TrialRun
from seethrough.experiment.study.config import Study
from seethrough.experiment.study.design.design import SIMULATED, Trial, generator
from seethrough.renderer.events import Event
from seethrough.renderer.scene.visibility import Visibility
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.skills.profile import AVERAGE, Profile

if TYPE_CHECKING:
    from seethrough.renderer.techniques.base import Parameters

Row = dict[str, object]


class TableDisplay:
    """Shows nothing; `look` reads from the pool's tables what would be seen."""

    def __init__(self, pool: Pool, clock: SimulatedClock, aspect: float) -> None:
        self.pool, self.clock = pool, clock
        self._aspect = aspect
        self._shown: View | None = None
        self.technique: Parameters | None = None  # what the view shown last is drawn with

    @property
    def aspect(self) -> float:
        """Width / height of the view."""
        return self._aspect

    def show(self, view: View, technique: Parameters) -> float:
        """Keep the view; the time now."""
        self._shown = view
        self.technique = technique
        return self.clock.now()

    def digest(self) -> str:
        """Nothing is drawn for nobody."""
        return ""

    def progress(self, fraction: float) -> None:
        """Nobody sees the progress line."""

    def describe(self) -> Mapping[str, str]:
        """No driver draws."""
        return {"window": "no"}

    def look(self) -> Visibility:
        """What is seen in the view shown last. Raises RuntimeError before the first."""
        if self._shown is None or self.technique is None:
            raise RuntimeError("nothing has been shown yet")
        return self.pool.look(self._shown, self.technique)


@dataclass
class Played:
    """A session as it went: the recorder of data mode. `events` of each trial, where asked for."""

    study: str
    participant: str
    slot: int
    keep: bool = False
    trials: list[Row] = field(default_factory=list)
    questions: list[Row] = field(default_factory=list)
    records: list[TrialRecord] = field(default_factory=list)
    events: list[list[Event]] = field(default_factory=list)
    status: str = ""

    def trial_begins(self, trial: Trial) -> None:
        """Room for its events; training counts as well."""
        if self.keep:
            self.events.append([])

    def event(self, event: Event) -> None:
        """One input event of the running trial."""
        if self.keep:
            self.events[-1].append(event)

    def frame(self, time: float, view: View, digest: str = "") -> None:
        """Nobody replays it."""

    def trial_ends(self, record: TrialRecord) -> None:
        """The trial's row, as the recorder of a real session writes it."""
        if self.keep:
            self.records.append(record)
        more = {"slot": self.slot, "attempt": 1}
        self.trials.append(
            {**self._identity(f"trial{record.trial.number:03d}"), **trial_row(record), **more}
        )

    def answers(self, rows: list[Mapping[str, str]]) -> None:
        """Rows of the questionnaire."""
        for row in rows:
            number = len(self.questions) + 1
            self.questions.append({**self._identity(f"question{number:03d}"), **row})

    def note(self, trial: Trial | None, text: str) -> None:
        """Nobody writes any."""

    def close(self, status: str) -> None:
        """How it ended."""
        self.status = status

    def _identity(self, row: str) -> Row:
        return {
            "row_id": f"simulated-{self.participant}-1-{row}",
            "study": self.study,
            "participant": self.participant,
            "session": 1,
            "source": "simulated",
        }


def play_session(
    study: Study,
    slot: int,
    seed: int,
    pool: Pool,
    profile: Profile = AVERAGE,
    without: frozenset[str] = frozenset(),
    keep: bool = False,
) -> Played:
    """A participant's whole session; `keep` its records and events as well as the rows."""
    person = SimulatedParticipant(generator(seed, (SIMULATED, slot)), profile, without)
    played = Played(study.general.name, f"S{slot:02d}", slot, keep)
    run_session(study, slot, _world(person, pool, study, played))
    return played


def play_trial(
    person: SimulatedParticipant, pool: Pool, trial: Trial
) -> tuple[TrialRecord, list[Event]]:
    """One trial alone, and its events."""
    played = Played(pool.study.general.name, "S01", 1, keep=True)
    world = _world(person, pool, pool.study, played)
    record = TrialRun(pool.study, world).play(trial, 0.0)
    return record, played.events[-1]


def _world(person: SimulatedParticipant, pool: Pool, study: Study, played: Played) -> Surroundings:
    clock = SimulatedClock()
    display = TableDisplay(pool, clock, study.display.width / study.display.height)
    seat = SimulatedInput(person, display, clock)
    return Surroundings(display, seat, clock, played, TASKS, scenes=pool)
