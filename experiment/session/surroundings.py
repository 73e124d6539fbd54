"""Everything a session touches, and what it says of a trial that ended. Protocols only."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from seethrough.experiment.display.clock import Clock
from seethrough.experiment.display.display import Display, Input
from seethrough.experiment.study.design import Trial
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.tasks.kit.base import Outcome, Task
from seethrough.tasks.kit.hud import FloorPlan


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

    def event(self, event: Any) -> None:
        """One input event of the running trial."""

    def frame(self, time: float, view: Any, digest: str = "") -> None:
        """One frame shown in the running trial; the digest of its pixels now and then."""

    def trial_ends(self, record: TrialRecord) -> None:
        """A completed trial: on disk when this returns."""

    def answers(self, rows: list[Mapping[str, str]]) -> None:
        """Rows of the questionnaire: on disk when this returns."""

    def note(self, trial: Trial | None, text: str) -> None:
        """A note of the experimenter's: on disk when this returns."""

    def close(self, status: str) -> None:
        """The session ended: `complete`, `left`, `time limit` or `display lost`."""


@dataclass(frozen=True)
class World:
    """Everything a session touches."""

    display: Display
    input: Input
    clock: Clock
    recorder: Recorder
    tasks: Mapping[str, Task]
    progress: Callable[[TrialRecord], None] = lambda record: None
    scenes: StudyScenes | None = None  # others than the study's own
    period: float | None = None  # s, of the display, where it was measured
    waiting: Callable[[Callable[[], Any]], Any] = lambda work: work()  # says so, then does it
    flip_within: Callable[[], float] = lambda: 0.0  # s: the last flip may have been so much earlier
