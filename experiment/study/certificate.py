"""The difficulty certificate: how hard is each trial's scene, and are the conditions alike?

Measured without the technique, from fixed views that every scene of a world shares, so that the
numbers say something about the scene and nothing about a participant.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from seethrough.experiment.display.looking import Looking
from seethrough.experiment.study.config import Study
from seethrough.experiment.study.design import Trial, session_for
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import View

# Shows every penetrable occluder half: a target's pixels are then those it would have alone, down
# to six things in front of it (a share of 1/64 is the least that counts).
UNCOVERED = DynamicTransparency(alpha_target=0.5, alpha_edge=1.0, width=0.0)
LOST = 0.4  # pixels; a distractor hides part of a target if it gives up half of one or more


@dataclass(frozen=True)
class Difficulty:
    """One scene's difficulty; means over the fixed views.

    visible: fraction of the targets' pixels that can be seen, mean over targets in view; hidden:
    targets of which no view shows anything; occluders: distractors that hide part of a target;
    clutter: objects that can be seen; path: world units to walk past every asked object, 0 where
    nobody walks.
    """

    trial: Trial
    targets: int
    visible: float
    hidden: int
    occluders: float
    clutter: float
    path: float


@dataclass(frozen=True)
class Match:
    """One measure of a task's scenes, level by level: its means, and how far they are apart.

    `difference` is in the measure's own unit for shares (visible, hidden), else a share of the
    mean over all levels.
    """

    task: str
    measure: str
    levels: tuple[tuple[str, float], ...]
    difference: float
    bound: float

    @property
    def ok(self) -> bool:
        """Whether the levels are alike enough."""
        return self.difference <= self.bound


def trials_of(study: Study, participants: int | None = None) -> list[Trial]:
    """Every trial of the study, with its level; walkthrough scenes occur once a participant."""
    count = study.study.participants if participants is None else participants
    factors = study.design.factors()
    return [
        trial
        for slot in range(1, count + 1)
        for task_set in session_for(slot, factors)
        for trial in task_set.trials
    ]


class Certifier:
    """Measures trials; a scene that several trials share is measured once."""

    def __init__(self, study: Study, context: Any) -> None:
        self.study = study
        self.aspect = study.display.width / study.display.height
        self._scenes = StudyScenes(study)
        self._looking = Looking(context, (study.display.width, study.display.height))
        self._known: dict[tuple[int, ...], Difficulty] = {}

    def measure(self, trial: Trial) -> Difficulty:
        """The difficulty of a trial's scene."""
        if trial.stream not in self._known:
            self._known[trial.stream] = self._measured(trial)
        return replace(self._known[trial.stream], trial=trial)

    def _measured(self, trial: Trial) -> Difficulty:
        task = TASKS[trial.task]
        setting = self.study.setting(trial)
        state = self._scenes.begin(task, trial, self.aspect)
        first = task.view(state)
        scene = first.scene
        cameras = setting.world.views(setting.place, first.camera)
        asked = list(task.example(state, self.aspect).asked)
        looks = [self._both(scene, camera) for camera in cameras]
        fractions = np.array([fraction for fraction, _, _ in looks])
        in_view = np.isfinite(fractions)
        seen = np.where(in_view, fractions, 0).sum() / max(in_view.sum(), 1)
        shown = np.nanmax(np.where(in_view, fractions, 0), axis=0)
        return Difficulty(
            trial,
            int(scene.targets.sum()),
            float(seen),
            int((shown == 0).sum()),
            float(np.mean([occluders for _, occluders, _ in looks])),
            float(np.mean([clutter for _, _, clutter in looks])),
            setting.world.path(first.camera, scene.centers[asked]),
        )

    def _both(self, scene: Scene, camera: Camera) -> tuple[NDArray[np.float64], int, int]:
        """(targets,) visible fractions, NaN out of view; occluders; visible objects."""
        view = View(scene, camera)
        self._looking.technique = Standard()
        plain = self._looking.look(view)
        self._looking.technique = UNCOVERED
        alone = self._looking.look(view)
        whole = alone.pixels[scene.targets].astype(float)
        with np.errstate(invalid="ignore"):
            fraction = np.where(whole > 0, plain.pixels[scene.targets] / whole, np.nan)
        pixels = self._looking.size[0] * self._looking.size[1]
        hides = ((plain.area - alone.area) * pixels > LOST) & ~scene.targets
        return np.minimum(fraction, 1.0), int(hides.sum()), int(plain.visible.sum())


# What is matched between levels. The path is one of the building's: sets are crossed with levels.
MEASURES: Mapping[str, Callable[[Difficulty], float]] = {
    "visible": lambda d: d.visible,
    "hidden": lambda d: d.hidden / max(d.targets, 1),
    "targets": lambda d: float(d.targets),
    "occluders": lambda d: d.occluders,
    "clutter": lambda d: d.clutter,
    "path": lambda d: d.path,
}
SHARES = ("visible", "hidden")


def matches(study: Study, measured: Sequence[Difficulty]) -> list[Match]:
    """Whether, task by task and measure by measure, the transparency levels are equally hard."""
    return [
        _match(study, [d for d in measured if d.trial.task == task], measure)
        for task in study.design.tasks
        for measure in MEASURES
    ]


def _match(study: Study, own: Sequence[Difficulty], measure: str) -> Match:
    levels = tuple(
        (level, float(np.mean(values)))
        for level in study.design.transparency
        if (values := [MEASURES[measure](d) for d in own if d.trial.transparency == level])
    )
    means = [mean for _, mean in levels]
    apart = max(means) - min(means)
    if measure in SHARES:
        return Match(own[0].trial.task, measure, levels, apart, study.design.tolerance)
    share = apart / float(np.mean(means)) if apart > 0 else 0.0
    return Match(own[0].trial.task, measure, levels, share, study.design.imbalance)


def worst(match: Match, measured: Iterable[Difficulty]) -> Difficulty:
    """The trial to draw again: the one that adds most to the difference."""
    means = dict(match.levels)
    middle = float(np.mean(list(means.values())))

    def pull(d: Difficulty) -> float:
        side = 1.0 if means[d.trial.transparency] > middle else -1.0
        return side * (MEASURES[match.measure](d) - middle)

    own = [d for d in measured if d.trial.task == match.task and d.trial.transparency in means]
    return max(own, key=pull)
