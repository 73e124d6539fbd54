"""Everything a session touches."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from seethrough.experiment.display.clock import Clock
from seethrough.experiment.display.display import Display, Input
from seethrough.experiment.record.trial_record import Recorder, TrialRecord
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.tasks.kit.base import Task


@dataclass(frozen=True)
class Surroundings:
    """Everything a session touches."""

    display: Display
    input: Input
    clock: Clock
    recorder: Recorder
    tasks: Mapping[str, Task]
    progress: Callable[[TrialRecord], None] = lambda record: None
    scenes: StudyScenes | None = None  # others than the study's own
    period: float | None = None  # s, of the display, where it was measured
    waiting: Callable[[Callable[[], object]], object] = lambda work: work()  # says so, then does it
    explores: bool = False  # whether who plays looks around first, as people do who are let
    flip_within: Callable[[], float] = lambda: 0.0  # s: the last flip may have been so much earlier
