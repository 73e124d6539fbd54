"""One plate a cell: what a study's participants see in each, in one picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

from seethrough.experiment.study.design.design import Trial, session_for
from seethrough.experiment.study.study import Study
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.tasks.catalog import TASKS

if TYPE_CHECKING:
    from moderngl import Context


MOST = 60  # plates of a picture
TITLE = 22  # pixels of the words above a plate


def first_trials(study: Study) -> list[Trial]:
    """The first trial of each task in each cell, of the first person of each group."""
    found: dict[tuple[str, ...], Trial] = {}
    for slot in range(1, len(study.plan.groups) + 1):
        for task_set in session_for(slot, study.plan):
            for trial in task_set.trials:
                found.setdefault((*trial.levels.values(), trial.task), trial)
    order = {cell: k for k, cell in enumerate(study.plan.cells)}
    return [found[key] for key in sorted(found, key=lambda key: (order[key[:-1]], key[-1]))]


def plates(study: Study, context: Context, size: tuple[int, int], samples: int) -> Image.Image:
    """A picture of all plates (Pillow), each with the levels and the task above it. Raises
    ValueError where there are too many."""
    from PIL import Image, ImageDraw

    from seethrough.renderer.gpu.renderer import Renderer

    trials = first_trials(study)
    if len(trials) > MOST:
        raise ValueError(f"{len(trials)} plates, expected at most {MOST}")
    across = max(1, round(np.sqrt(len(trials) * 1.2)))
    rows = -(-len(trials) // across)
    width, height = size
    sheet = Image.new("RGB", (across * width, rows * (height + TITLE)), "white")
    words, scenes = ImageDraw.Draw(sheet), StudyScenes(study)
    renderer = Renderer(context, size, samples)
    for k, trial in enumerate(trials):
        task = TASKS[trial.task]
        part = study.part(trial.levels)
        view = task.view(scenes.begin(task, trial, width / height)).dressed(part.look)
        renderer.draw(view.scene, view.camera, part.technique)
        x, y = k % across * width, k // across * (height + TITLE)
        said = ", ".join((*trial.levels.values(), trial.task))
        words.text((x + 4, y + 4), said, fill="black", font_size=14)
        sheet.paste(Image.fromarray(renderer.read()), (x, y + TITLE))
    return sheet
