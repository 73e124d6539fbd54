"""What a session says of a trial that ended, and who keeps it. Protocols only."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from seethrough.renderer.events import Event
from seethrough.tasks.kit.base import Outcome, View
from seethrough.tasks.kit.hud import FloorPlan

if TYPE_CHECKING:
    from seethrough.experiment.study.design.design import Trial


@dataclass(frozen=True)
class TrialRecord:
    """A trial that ended; times in seconds on the session's clock."""

    trial: Trial
    outcome: Outcome | None
    targets: int
    first_frame: float
    confirmed: float
    away: float
    timed_out: bool
    frames: int
    frames_missed: int
    worst_frame: float
    path_length: float
    turned: float
    repeat: bool = False
    solution: FloorPlan | None = None  # for the feedback of a practice trial
    within: float = 0.0  # s: how much longer than `time` it may have been
    early: int = 0  # presses from before the first frame, which answered nothing

    @property
    def time(self) -> float:
        """Completion time: first frame shown to the answer's confirmation."""
        return self.confirmed - self.first_frame


class Recorder(Protocol):
    """Keeps what happened; the only writer of data."""

    def trial_begins(self, trial: Trial) -> None:
        """Open the traces of a trial."""

    def event(self, event: Event) -> None:
        """One input event of the running trial."""

    def frame(self, time: float, view: View, digest: str = "") -> None:
        """One frame shown in the running trial; the digest of its pixels now and then."""

    def trial_ends(self, record: TrialRecord) -> None:
        """A completed trial: on disk when this returns."""

    def answers(self, rows: list[Mapping[str, str]]) -> None:
        """Rows of the questionnaire: on disk when this returns."""

    def note(self, trial: Trial | None, text: str) -> None:
        """A note of the experimenter's: on disk when this returns."""

    def close(self, status: str) -> None:
        """The session ended: `complete`, `left`, `time limit`, `display lost` or `plug-in
        failed`."""
