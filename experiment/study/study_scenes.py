"""The scenes of a study: made for a trial, or once for everybody who shares them."""

from __future__ import annotations

from dataclasses import replace

from seethrough.experiment.study.config import Study
from seethrough.experiment.study.design.design import TRAINING_TRIAL, Trial, generator
from seethrough.experiment.study.study_items import StudyItems
from seethrough.tasks.explore import EXPLORE
from seethrough.tasks.kit.base import Setting, Task
from seethrough.tasks.kit.world import OWN, Place


class StudyScenes:
    """Begins trials; keeps the scenes that are the same for everybody."""

    def __init__(self, study: Study) -> None:
        self.study = study
        self._items = StudyItems(study)
        self._shared: dict[tuple[object, str, tuple[int, ...]], Place] = {}

    def setting(self, trial: Trial) -> Setting:
        """Where and how a trial's task is set, and which item it asks for, if they are counted."""
        setting = self.study.setting(trial)
        if trial.task == EXPLORE.name:
            return setting
        return replace(setting, item=self._items.of(trial))

    def begin(self, task: Task, trial: Trial, aspect: float) -> object:
        """The first state of a trial."""
        setting = self.setting(trial)
        return task.begin(self._made(task, trial, setting), setting, aspect)

    def _made(self, task: Task, trial: Trial, setting: Setting) -> Place:
        rng = generator(self.study.general.seed, trial.stream)
        if setting.place.scenes == OWN:
            return task.make_scene(rng, setting)
        key = (setting.place, trial.task, trial.stream)
        if key not in self._shared:
            self._shared[key] = task.make_scene(rng, setting)
        return self._shared[key]

    def exploring(self, trial: Trial) -> Trial:
        """What one looks around in before the practice: a place like this trial's, no trial's."""
        return replace(
            trial, in_set=0, task=EXPLORE.name, scene="explore", training=True,
            stream=(*trial.stream[:-1], 3 * TRAINING_TRIAL),
        )  # fmt: skip

    def example(self, trial: Trial) -> Trial:
        """A trial like this one whose scene no trial of the study uses: for instructions."""
        return replace(
            trial,
            stream=(*trial.stream[:-1], 2 * TRAINING_TRIAL),
            scene="example",
            training=True,
        )
