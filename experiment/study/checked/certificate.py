"""The difficulty certificate: how hard is each trial's scene, and are the conditions alike?

Measured without the technique, from fixed views that every scene of a world shares, so that the
numbers say something about the scene and nothing about a participant.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from seethrough.experiment.display.looking import Looking
from seethrough.experiment.study.config import Study
from seethrough.experiment.study.design.design import Trial, session_for
from seethrough.experiment.study.design.factors import ALONE
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import Setting, View
from seethrough.tasks.kit.world import moving_of

if TYPE_CHECKING:
    from moderngl import Context


# Shows every penetrable occluder half: a target's pixels are then those it would have alone, down
# to six things in front of it (a share of 1/64 is the least that counts).
UNCOVERED = DynamicTransparency(alpha_target=0.5, alpha_edge=1.0, width=0.0)
LOST = 0.4  # pixels; a distractor hides part of a target if it gives up half of one or more


Looked = tuple[NDArray[np.float64], int, int]


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
    """One measure of a task's scenes, level by level of a factor: its means, and how far they are
    apart. Where the factor changes scenes they may be, and `bound` is None; the factor "" stands
    for the sets of scenes.

    `difference` is in the measure's own unit for shares (visible, hidden), else a share of the
    mean over all levels. `compared` are the trials that it is of.
    """

    task: str
    measure: str
    levels: tuple[tuple[str, float], ...]
    difference: float
    bound: float | None
    factor: str = ""
    compared: tuple[Difficulty, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether the levels are alike enough."""
        return self.bound is None or self.difference <= self.bound


def trials_of(study: Study, participants: int | None = None) -> list[Trial]:
    """Every trial of the study, with its level; walkthrough scenes occur once a participant."""
    slots = study.plan.slots(participants or study.general.participants)
    return [
        trial
        for slot in slots
        for task_set in session_for(slot, study.plan)
        for trial in task_set.trials
    ]


class Certifier:
    """Measures trials; a scene that several trials share is measured once."""

    def __init__(self, study: Study, context: Context) -> None:
        self.study = study
        self.aspect = study.display.width / study.display.height
        self._scenes = StudyScenes(study)
        self._looking = Looking(context, (study.display.width, study.display.height))
        self._known: dict[object, Difficulty] = {}
        self._looks: dict[tuple[int, bytes, bytes], tuple[Scene, Looked]] = {}

    def measure(self, trial: Trial) -> Difficulty:
        """The difficulty of a trial's scene."""
        key = (self.study.part(trial.levels).place, trial.task, trial.stream)
        if key not in self._known:
            self._known[key] = self._measured(trial)
        return replace(self._known[key], trial=trial)

    def _measured(self, trial: Trial) -> Difficulty:
        task = TASKS[trial.task]
        setting = self.study.setting(trial)
        state = self._scenes.begin(task, trial, self.aspect)
        first = task.view(state)
        scene = first.scene
        cameras = setting.world.views(setting.place, first.camera)
        asked = list(task.example(state, self.aspect).asked)
        looks = [self._looked(scene, camera) for camera in cameras]
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
            _path(setting, first.camera, scene.centers[asked]),
        )

    def _looked(self, scene: Scene, camera: Camera) -> Looked:
        """As `_both`; a scene that several trials share is looked at once from each place."""
        key = (id(scene), camera.eye.tobytes(), camera.rotation.tobytes())
        if key not in self._looks:
            self._looks[key] = (scene, self._both(scene, camera))
        return self._looks[key][1]

    def _both(self, scene: Scene, camera: Camera) -> Looked:
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


def _path(setting: Setting, first: Camera, asked: NDArray[np.float64]) -> float:
    """World units to go; 0 where nobody walks."""
    walks = moving_of(setting.world, setting.place) == "walk"
    return setting.world.path(first, asked) if walks else 0.0


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
    """How hard the scenes are, task by task and measure by measure: along every factor, and set by
    set where scenes are shared. Levels that leave scenes alone have to be alike, and so have sets.

    Where cells are left out, such levels are compared in those scenes that all of them have: a
    level that lacks the densest ones is easier, whatever its scenes are.
    """
    found = []
    for task in dict.fromkeys(d.trial.task for d in measured):
        own = [d for d in measured if d.trial.task == task]
        for factor in study.factors:
            by: dict[str, list[Difficulty]] = {
                level: [d for d in own if d.trial.levels[factor.name] == level]
                for level in factor.names
            }
            there = {level: of for level, of in by.items() if of}
            matched = factor.scenes == ALONE
            if matched:
                there = _common(study, there)
            if len(there) > 1:
                found += [_match(study, there, m, factor.name, matched) for m in MEASURES]
        found += _sets(study, own)
    return found


def _common(study: Study, by: dict[str, list[Difficulty]]) -> dict[str, list[Difficulty]]:
    """Of each level those trials whose scenes are made as some of every other level are; all where
    levels have nothing in common."""
    kinds = {level: {_changed(study, d) for d in own} for level, own in by.items()}
    shared = set.intersection(*kinds.values()) if kinds else set()
    if not shared:
        return by
    return {level: [d for d in own if _changed(study, d) in shared] for level, own in by.items()}


def _changed(study: Study, d: Difficulty) -> tuple[str, ...]:
    """A trial's levels of the factors that change scenes."""
    return tuple(d.trial.levels[f.name] for f in study.factors if f.scenes != ALONE)


def _sets(study: Study, own: Sequence[Difficulty]) -> list[Match]:
    """The sets of a task's shared scenes against each other, each scene once.

    Over a whole cycle every level meets every set, so that levels are alike whatever the sets are.
    """
    scenes = {d.trial.scene: d for d in own if study.part(d.trial.levels).plan.shared}
    places: dict[tuple[str, ...], dict[str, list[Difficulty]]] = {}
    for d in scenes.values():
        places.setdefault(_changed(study, d), {}).setdefault(
            set_of(d.trial.scene, d.trial.task), []
        ).append(d)
    return [
        _match(study, dict(sorted(sets.items())), measure, "", True)
        for sets in places.values()
        if len(sets) > 1
        for measure in MEASURES
    ]


def set_of(scene: str, task: str) -> str:
    """The set of a shared scene, from its name: A."""
    return scene.rpartition(f"-{task}-")[0].rpartition("-")[2]


def _match(
    study: Study, by: Mapping[str, Sequence[Difficulty]], measure: str, factor: str, matched: bool
) -> Match:
    levels = tuple(
        (level, float(np.mean([MEASURES[measure](d) for d in own]))) for level, own in by.items()
    )
    task = next(iter(by.values()))[0].trial.task
    means = [mean for _, mean in levels]
    apart = max(means) - min(means)
    if measure not in SHARES:
        apart = apart / float(np.mean(means)) if apart > 0 else 0.0
    bound = study.design.tolerance if measure in SHARES else study.design.imbalance
    compared = tuple(d for own in by.values() for d in own)
    return Match(task, measure, levels, apart, bound if matched else None, factor, compared)


def worst(match: Match) -> Difficulty:
    """The trial to draw again: the one that adds most to the difference."""
    means = dict(match.levels)
    middle = float(np.mean(list(means.values())))

    def of(d: Difficulty) -> str:
        if match.factor:
            return d.trial.levels[match.factor]
        return set_of(d.trial.scene, d.trial.task)

    def pull(d: Difficulty) -> float:
        side = 1.0 if means[of(d)] > middle else -1.0
        return side * (MEASURES[match.measure](d) - middle)

    return max(match.compared, key=pull)
