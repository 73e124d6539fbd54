"""Compiles what is compiled at first use, so that no participant waits for it.

    python -m seethrough.experiment.session.warm

numba keeps the result on disk, and so do Mesa and most drivers of graphics cards. start.py does
this once, at the end of the installation.
"""

from __future__ import annotations

import sys
from itertools import product

import numpy as np

from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import session_for
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.per_pixel.few_sorter import MASKS, SLICES
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.tasks.catalog import TASKS

SIZE = (160, 120)
CAMERA = Camera(np.zeros(3), np.eye(3), near=0.5, far=60.0)
USUAL = (8, 4)  # more objects or masks than that seldom meet in a block of pixels


def warm() -> None:
    """Draw and look at a trial of each task set, and sort pixels in every way that a trial may.

    Raises RuntimeError without OpenGL.
    """
    study = load("demo")
    scenes, renderer = StudyScenes(study), Renderer(standalone(), SIZE)
    for task_set in session_for(1, study.plan):
        trial = task_set.trials[0]
        task, technique = TASKS[trial.task], study.part(trial.levels).technique
        view = task.view(scenes.begin(task, trial, SIZE[0] / SIZE[1]))
        renderer.draw(view.scene, view.camera, technique)
        renderer.look(view.scene, view.camera, technique, SIZE)
    counts = SLICES[SLICES <= USUAL[0]].tolist(), MASKS[MASKS <= USUAL[1]].tolist()
    for objects, targets in product(*counts):
        for pierced in (False, True):
            if targets <= objects:
                scene = _stack(objects, targets, pierced)
                renderer.draw(scene, CAMERA, DynamicTransparency(exact=True))


def _stack(objects: int, targets: int, pierced: bool) -> Scene:
    """Plates one behind the other, the targets farthest; `pierced` ones have masks to look up, and
    stand in a building, where something is impenetrable."""
    shape = geometry.torus(0.8, 0.3) if pierced else geometry.box(1, 1, 0.1)
    stack = [
        Object(shape, transforms.translation(0, 0, -2 - k), target=k >= objects - targets)
        for k in range(objects)
    ]
    floor = Object(geometry.box(1, 1, 1), transforms.translation(0, -40, -2), impenetrable=True)
    return Scene((*stack, *[floor] * pierced))


if __name__ == "__main__":
    try:
        warm()
    except RuntimeError as error:
        sys.exit(str(error))
