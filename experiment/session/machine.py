"""Is this machine fit for the study: OpenGL, frame times of the hardest scene, refresh, disk."""

from __future__ import annotations

import shutil
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from seethrough.experiment.display.driver import samples_for
from seethrough.experiment.session.frames import MISSED
from seethrough.experiment.study.config import Study
from seethrough.experiment.study.design.design import Trial
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.plan.explain import of_cluster
from seethrough.renderer.plan.planner import plan
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.transforms import rotation_y
from seethrough.tasks.catalog import TASKS

if TYPE_CHECKING:
    from moderngl import Context


TURN = 0.5  # rad/s of the view while frames are timed: every frame is another picture


@dataclass(frozen=True)
class FrameTimes:
    """Milliseconds a frame took to draw, and the part that took over 1.5 display periods."""

    frames: int
    median: float
    p99: float
    missed: float


def frame_times(study: Study, trial: Trial, context: Context, seconds: float) -> FrameTimes:
    """Draw a trial's first view, turning, for so long."""
    size = (study.display.width, study.display.height)
    task = TASKS[trial.task]
    part = study.part(trial.levels)
    view = task.view(StudyScenes(study).begin(task, trial, size[0] / size[1])).dressed(part.look)
    technique = part.technique
    renderer = Renderer(context, size, samples_for(study.display.samples, context))
    renderer.draw(view.scene, view.camera, technique)
    context.finish()
    took: list[float] = []
    start = time.perf_counter()
    while (now := time.perf_counter()) - start < seconds or len(took) < 3:
        renderer.draw(view.scene, _turned(view.camera, TURN * (now - start)), technique)
        context.finish()
        took.append(time.perf_counter() - now)
    times = np.array(took)
    missed = float((times > MISSED / study.display.refresh).mean())
    median, p99 = np.percentile(times, [50, 99]) * 1000
    return FrameTimes(len(took), float(median), float(p99), missed)


def crossings(study: Study, trial: Trial) -> list[str]:
    """What the trial's first view cuts along one another, where objects intersect and the study
    orders polygons: how many there are, and of how many pieces."""
    size = (study.display.width, study.display.height)
    task = TASKS[trial.task]
    view = task.view(StudyScenes(study).begin(task, trial, size[0] / size[1]))
    frame = plan(view.scene, view.camera, study.part(trial.levels).technique, size)
    return [of_cluster(view.scene, members) for members in frame.clusters]


def _turned(camera: Camera, angle: float) -> Camera:
    """The camera carried round the vertical axis through the origin."""
    turn = rotation_y(angle)[:3, :3]
    lens = {"fov_y": camera.fov_y, "near": camera.near, "far": camera.far}
    return Camera(turn @ camera.eye, turn @ camera.rotation, **lens)


def free_disk(folder: Path) -> float:
    """GiB free where data would go."""
    return shutil.disk_usage(folder).free / 2**30
