"""Compiles what is compiled at first use, so that no participant waits for it.

    python -m experiment.warm

numba keeps the result on disk. start.py does this once, at the end of the installation.
"""

from __future__ import annotations

import sys

from experiment.config import load
from experiment.design import session_for
from experiment.scenes import StudyScenes
from renderer.gpu.context import standalone
from renderer.gpu.renderer import Renderer
from tasks.catalog import TASKS

SIZE = (160, 120)


def warm() -> None:
    """Draw and look at a trial of each scenario. Raises RuntimeError without OpenGL."""
    study = load("demo")
    scenes, renderer = StudyScenes(study), Renderer(standalone(), SIZE)
    for task_set in session_for(1, study.design.factors()):
        trial = task_set.trials[0]
        if trial.transparency == "dynamic":
            task = TASKS[trial.task]
            view = task.view(scenes.begin(task, trial, SIZE[0] / SIZE[1]))
            renderer.draw(view.scene, view.camera, study.dynamic)
            renderer.look(view.scene, view.camera, study.dynamic, SIZE)


if __name__ == "__main__":
    try:
        warm()
    except RuntimeError as error:
        sys.exit(str(error))
