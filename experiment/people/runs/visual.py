"""Visual mode: real sessions on an offscreen display, one participant after the other or several at
once.

A process opens one graphics context and looks through one pair of eyes, whoever sits behind them:
memory does not grow with the number of people.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from seethrough.experiment.display.clock import SimulatedClock
from seethrough.experiment.display.driver import open_context
from seethrough.experiment.display.looking import Looking
from seethrough.experiment.display.offscreen import OffscreenDisplay
from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.people.simulated_input import SimulatedInput
from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.session.session import run_session
from seethrough.experiment.session.software import provenance
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.experiment.study.beside.own_model_files import keep
from seethrough.experiment.study.config import Study
from seethrough.experiment.study.design.design import SIMULATED, generator
from seethrough.experiment.study.shown.described import design_entry
from seethrough.experiment.workers import ordered_map
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.skills.profile import AVERAGE, Profile

if TYPE_CHECKING:
    from moderngl import Context

    from seethrough.experiment.record.trial_record import TrialRecord

Ended = Callable[["TrialRecord", SimulatedParticipant], None]


@dataclass(frozen=True)
class Visual:
    """What a worker needs to know; everything in it can be sent to another process."""

    study: Study
    seed: int
    out: Path
    profile: Profile = AVERAGE
    without: frozenset[str] = frozenset()


class Seat:
    """Where simulated people sit down one after the other, before one display."""

    def __init__(self, job: Visual) -> None:
        self.job = job
        self._context: Context = open_context(looks=True)
        self._looking: Looking | None = None

    def play(self, slot: int, ended: Ended) -> None:
        """A participant's whole session. Raises InputError if it is there already."""
        job, clock = self.job, SimulatedClock()
        screen = job.study.session_part(slot).display
        window = (screen.width, screen.height)
        if self._looking is None:
            self._looking = Looking(self._context, window, simple=True)
        self._looking.resize(window)
        display = OffscreenDisplay(self._context, window, clock, self._looking)
        rng = generator(job.seed, (SIMULATED, slot))
        person = SimulatedParticipant(rng, job.profile, job.without)
        described = provenance(job.study, display.describe(), **person.about(job.seed))
        name = job.study.general.name
        who = Who(
            name, f"S{slot:02d}", "simulated", slot, described, design=design_entry(job.study)
        )
        keep(job.study, job.out)
        world = Surroundings(
            display, SimulatedInput(person, display, clock), clock, FileRecorder(job.out, who),
            TASKS, lambda record: ended(record, person),
        )  # fmt: skip
        run_session(job.study, slot, world)


_seats: list[Seat] = []  # this process's, made once by `_prepare`


def _prepare(job: Visual) -> None:
    _seats[:] = [Seat(job)]


def _play(slot: int) -> int:
    _seats[0].play(slot, lambda record, person: None)
    return slot


def play(job: Visual, slots: Sequence[int], workers: int) -> Iterator[int]:
    """Slots as they are done, in order, each by one of so many processes."""
    return ordered_map(_play, slots, workers, _prepare, (job,))
