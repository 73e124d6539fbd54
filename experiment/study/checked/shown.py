"""How much of what is asked for each condition shows, scene by scene.

From the views that the difficulty certificate has, which every scene of a world shares. A scene is
looked at in every condition that leaves it as it is, also in those in which nobody meets it. What
is told describes conditions; that one scene is better than another it does not say.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from seethrough.experiment.display.looking import Looking
from seethrough.experiment.study.checked.certificate import UNCOVERED, trials_of
from seethrough.experiment.study.config import Study
from seethrough.experiment.study.design.design import Trial
from seethrough.experiment.study.design.factors import CHANGED, Levels
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.renderer.look.dressed import dressed
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.scene.visibility import Visibility, better
from seethrough.renderer.techniques.base import Parameters, Shot
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.gestures import after
from seethrough.tasks.kit.skills.glance import CLEAR

if TYPE_CHECKING:
    from moderngl import Context

LEAST = 0.05  # share of a thing's own pixels up to which a view shows nothing of it


@dataclass(frozen=True)
class Shown:
    """One scene in one condition: `levels` of every factor. `asked` things in it; of their own
    pixels the shares that show (`shown`) and that are set off (`clear`), means over things and the
    views that hold them; `hidden` things of which no view shows anything."""

    trial: Trial
    levels: Levels
    asked: int
    shown: float
    clear: float
    hidden: int


class Shower:
    """Looks at a study's scenes in its conditions."""

    def __init__(self, study: Study, context: Context) -> None:
        self.study = study
        self._scenes = StudyScenes(study)
        self._size = (study.display.width, study.display.height)
        self._looking = Looking(context, self._size)

    def scenes(self) -> list[Trial]:
        """A trial of each scene, in the order in which people meet them."""
        found: dict[object, Trial] = {}
        for trial in trials_of(self.study):
            found.setdefault((self.study.part(trial.levels).place, trial.task, trial.stream), trial)
        return list(found.values())

    def conditions(self, trial: Trial) -> list[Levels]:
        """The cells that would leave the trial's scene, and what is asked in it, as they are."""
        changed = [f.name for f in self.study.factors if f.scenes == CHANGED]
        place = self.study.part(trial.levels).place
        found = []
        for cell, part in self.study.parts.items():
            levels = self.study.plan.levels(cell)
            same = all(levels[name] == trial.levels[name] for name in changed)
            if same and part.place == place and trial.task in part.design.tasks:
                found.append(levels)
        return found

    def of(self, trial: Trial) -> list[Shown]:
        """What each condition shows of a trial's scene."""
        task, setting = TASKS[trial.task], self.study.setting(trial)
        aspect = self._size[0] / self._size[1]
        state = self._scenes.begin(task, trial, aspect)
        first = task.view(state)
        index = np.array(list(task.example(state, aspect).asked), dtype=np.int64)
        cameras = setting.world.views(setting.place, first.camera)
        whole = self._whole(first.scene, cameras, index)
        known: dict[object, tuple[float, float, int]] = {}
        found = []
        for levels in self.conditions(trial):
            part = self.study.part(levels)
            if (key := (part.technique, part.look)) not in known:
                scene = dressed(first.scene, part.look)
                seen = [self._seen(scene, camera, part.technique, index) for camera in cameras]
                known[key] = measured(seen, whole, index, self._pixels)
            found.append(Shown(trial, levels, len(index), *known[key]))
        return found

    @property
    def _pixels(self) -> int:
        width, height = self._looking.size
        return width * height

    def _whole(
        self, scene: Scene, cameras: Sequence[Camera], index: NDArray[np.int64]
    ) -> NDArray[np.float64]:
        """(views, k) pixels that each asked thing would have with nothing before it."""
        asked = np.isin(np.arange(len(scene.objects)), index)
        if not np.array_equal(asked, scene.targets):
            things = zip(scene.objects, asked.tolist(), strict=True)
            scene = replace(scene, objects=tuple(replace(o, target=own) for o, own in things))
        self._looking.technique = UNCOVERED
        looks = [self._looking.look(View(scene, camera)).pixels[index] for camera in cameras]
        return np.array(looks, dtype=np.float64)

    def _seen(
        self, scene: Scene, camera: Camera, p: Parameters, index: NDArray[np.int64]
    ) -> Visibility:
        """What a technique shows in a view; one that hands work, once they reach each thing."""
        self._looking.technique = p
        seen = self._looking.look(View(scene, camera))
        if p.technique.active(p):
            shot, begun = Shot(scene, camera, self._looking.size), p.technique.begin(p)
            for k in index.tolist():
                reach = p.technique.reach(p, begun, shot, scene.centers[k])
                drawn = after(p, begun, shot, reach)
                seen = better(seen, self._looking.look(View(scene, camera, drawn=drawn)))
        return seen


def measured(
    seen: Sequence[Visibility],
    whole: NDArray[np.float64],
    index: NDArray[np.int64],
    pixels: int,
) -> tuple[float, float, int]:
    """(shown, clear, hidden) of some views of so many pixels: see Shown. `whole` (views, k)."""
    area = np.array([look.area[index] for look in seen]) * pixels
    set_off = np.array([np.minimum(look.contrast[index] / CLEAR, 1.0) for look in seen])
    there = whole > 0
    share = np.where(there, np.minimum(area / np.maximum(whole, 1), 1.0), 0.0)
    views = np.maximum(there.sum(axis=0), 1)
    held = there.any(axis=0)
    if not held.any():
        return 0.0, 0.0, len(index)
    means = [float((part.sum(axis=0) / views)[held].mean()) for part in (share, share * set_off)]
    return means[0], means[1], int((share.max(axis=0) <= LEAST).sum())


def apart(found: Sequence[Shown], factor: str) -> float:
    """How far a factor's levels are apart in what they show of a scene: means over its cells."""
    by: dict[str, list[float]] = {}
    for one in found:
        by.setdefault(one.levels[factor], []).append(one.shown)
    means = [float(np.mean(own)) for own in by.values()]
    return max(means) - min(means)


def breaking(study: Study, scenes: Sequence[Sequence[Shown]]) -> Iterator[Trial]:
    """The scenes that the study's rule does not select."""
    select = study.design.select
    if select is None or not select.factor or select.least is None:
        return
    for found in scenes:
        if apart(found, select.factor) < select.least:
            yield found[0].trial
