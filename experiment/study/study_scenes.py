"""The scenes of a study: abstract ones from the trial's own stream, buildings made once."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from seethrough.experiment.study.config import Study
from seethrough.experiment.study.design import TRAINING_TRIAL, Trial, generator
from seethrough.tasks.kit.base import Task


class StudyScenes:
    """Begins trials; keeps the scenes that are the same for everybody."""

    def __init__(self, study: Study) -> None:
        self.study = study
        self._shared: dict[tuple[Any, tuple[int, ...]], Any] = {}

    def begin(self, task: Task, trial: Trial, aspect: float) -> Any:
        """The first state of a trial."""
        rng = generator(self.study.study.seed, trial.stream)
        part = self.study.part(trial.levels)
        if not part.plan.shared:
            return task.begin(rng, part.place, aspect)
        key = (part.place, trial.stream)
        if key not in self._shared:
            self._shared[key] = task.make_scene(rng, part.place)
        return task.begin(rng, part.place, aspect, self._shared[key])

    def example(self, trial: Trial) -> Trial:
        """A trial like this one whose scene no trial of the study uses: for instructions."""
        return replace(
            trial,
            stream=(*trial.stream[:-1], 2 * TRAINING_TRIAL),
            scene="example",
            training=True,
        )
