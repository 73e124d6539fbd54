"""One trial: from its stream to a scored record."""

from __future__ import annotations

from functools import partial

from seethrough.experiment.pages.pages import PICTURE_ASPECT
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.session import viewpoint
from seethrough.experiment.session.options import as_asked, with_confidence
from seethrough.experiment.session.running import Running
from seethrough.experiment.session.strangers import called
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.experiment.study.config import Study
from seethrough.experiment.study.design.design import Trial
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.renderer.scene.look import Look
from seethrough.renderer.techniques.base import Parameters
from seethrough.tasks.explore import EXPLORE
from seethrough.tasks.kit.base import Task, View, opaque
from seethrough.tasks.kit.hud import Inset


class TrialRun:
    """Plays trials of a study in a world."""

    def __init__(self, study: Study, world: Surroundings) -> None:
        self.study = study
        self.world = world
        self.scenes = world.scenes or StudyScenes(study)

    def technique(self, trial: Trial) -> Parameters:
        """What the trial is drawn with."""
        return self.study.part(trial.levels).technique

    def task(self, trial: Trial) -> Task:
        """The trial's task, with what the study lets one say of it."""
        if trial.task == EXPLORE.name:
            return opaque(EXPLORE)
        return as_asked(self.world.tasks[trial.task], self.study, trial)

    def look(self, trial: Trial) -> Look:
        """How the trial's scene looks."""
        return self.study.part(trial.levels).look

    def begin(self, trial: Trial) -> object:
        """The task's first state, from the trial's own stream."""
        aspect = self.world.display.aspect
        begin = partial(self.scenes.begin, self.task(trial), trial, aspect)
        return called("world", trial.world, "make", begin)

    def preview(self, trial: Trial) -> View:
        """What the instruction page shows: a scene of the task that is no trial's scene, seen from
        where it shows what is asked for."""
        example = self.scenes.example(trial)
        task, state = self.task(trial), self.begin(example)
        view = task.view(state)
        camera = viewpoint.best(view.scene, task.example(state, PICTURE_ASPECT))
        shown = View(view.scene, camera, tuple(e for e in view.hud if isinstance(e, Inset)))
        return shown.dressed(self.look(trial))

    def play(self, trial: Trial, limit: float) -> TrialRecord:
        """Run one trial to its confirmed answer or its limit (seconds; 0: none). Raises Leave."""
        world = self.world
        state = world.waiting(partial(self.begin, trial))
        running = Running(self, trial, state, limit)
        world.recorder.trial_begins(trial)
        world.input.begin_trial(trial.task, trial.training)
        running.show()
        while not running.ended:
            for event in map(running.admitted, world.input.events(running.view)):
                if event is None:
                    continue
                world.recorder.event(event)
                if running.take(event):
                    break
            if not running.ended:
                running.show()
        return with_confidence(running.record(), self.study, world)
