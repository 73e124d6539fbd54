"""Where a study's own scenes run into what its techniques cannot do.

Looked at from where the certificate looks, and with the pointer on each target where hands work the
technique. Three things are counted: targets that stay hidden from everywhere; things that vanish
though the standard picture shows them; and cuts through open meshes, which have no inside to show.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from seethrough.experiment.display.looking import HEIGHT
from seethrough.experiment.study.config import Study
from seethrough.experiment.study.design.design import Trial
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.projection import screen_boxes
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.base import Bools, Floats, Parameters, Shot
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.gestures import after

if TYPE_CHECKING:
    from moderngl import Context

MOST_SCENES = 48  # of a technique: more of them say the same
MOST_REACHED = 6  # targets that hands reach for in a view
LEAST = 16.0  # pixels of a target, or of a thing, that are enough to count
HIDDEN = 0.05  # share of a target up to which it is hidden
VANISHED = 0.05  # share of what the standard picture shows of a thing
CONTEXT = 0.25  # share of things that may vanish


@dataclass
class Met:
    """What one technique did to scenes: how many there were, and in how many of them what
    happened; `worst` is the largest share of things that vanished."""

    name: str
    scenes: int = 0
    hidden: int = 0
    targets: int = 0
    vanished: int = 0
    worst: float = 0.0
    open: set[str] = field(default_factory=set)

    def warnings(self) -> Iterator[str]:
        """A line for each of its failures that the scenes run into."""
        if self.hidden:
            yield (
                f"in {self.hidden} of {self.scenes} scenes a target stays hidden under {self.name} "
                f"({self.targets} targets)"
            )
        if self.vanished:
            yield (
                f"in {self.vanished} of {self.scenes} scenes more than {100 * CONTEXT:.0f} % of "
                f"the things that one would see vanish under {self.name} (up to "
                f"{100 * self.worst:.0f} %)"
            )
        if self.open:
            kinds = ", ".join(sorted(self.open))
            yield f"{self.name} cuts open meshes, which show holes: {kinds}"


class Warner:
    """Looks at a study's scenes, drawn with their techniques."""

    def __init__(self, study: Study, context: Context) -> None:
        self.study = study
        self._scenes = StudyScenes(study)
        size = (study.display.width, study.display.height)
        self._aspect = size[0] / size[1]
        self._size = (round(HEIGHT * self._aspect), HEIGHT)
        self._renderer = Renderer(context, size)
        self._standard = Standard()

    def trials(self, every: list[Trial]) -> dict[str, list[Trial]]:
        """Technique → trials with scenes of their own, spread over the study; the standard one has
        no rule to fail."""
        found: dict[str, dict[object, Trial]] = {}
        for trial in every:
            part = self.study.part(trial.levels)
            if part.technique != Standard():
                key = (part.technique, part.place, trial.task, trial.stream)
                found.setdefault(part.technique_name, {}).setdefault(key, trial)
        return {name: _spread(list(own.values())) for name, own in found.items()}

    def met(self, name: str, trials: list[Trial]) -> Met:
        """What a technique does to the scenes of some trials."""
        met = Met(name)
        for trial in trials:
            self._add(met, trial)
        return met

    def _add(self, met: Met, trial: Trial) -> None:
        task, setting = TASKS[trial.task], self.study.setting(trial)
        first = task.view(self._scenes.begin(task, trial, self._aspect))
        p = self.study.part(trial.levels).technique
        cameras = setting.world.views(setting.place, first.camera)
        hidden, lost, kinds = self.judged(first.scene, cameras, p)
        met.scenes += 1
        met.targets += hidden
        met.hidden += hidden > 0
        met.vanished += lost > CONTEXT
        met.worst = max(met.worst, lost)
        met.open |= kinds

    def judged(
        self, scene: Scene, cameras: list[Camera], p: Parameters
    ) -> tuple[int, float, set[str]]:
        """Of a scene: how many targets stay hidden in each view in which they are large enough,
        which share of other things vanishes, and the kinds of the open meshes that are cut."""
        targets = np.nonzero(scene.targets)[0]
        best = np.full(len(targets), np.nan)  # the largest share of each that shows
        things, gone = 0, 0
        kinds: set[str] = set()
        for camera in cameras:
            plain, own = self._seen(scene, camera, p)
            best = np.fmax(best, self._shares(scene, camera, own[targets], best))
            others = ~scene.targets & (plain >= LEAST)
            things += int(others.sum())
            gone += int((own[others] < VANISHED * plain[others]).sum())
            if getattr(p, "cap", "none") != "none":
                touched = p.technique.touches(p, p.technique.begin(p), self._shot(scene, camera))
                kinds |= open_kinds(scene, touched)
        return int((best < HIDDEN).sum()), gone / max(things, 1), kinds

    def _shot(self, scene: Scene, camera: Camera) -> Shot:
        return Shot(scene, camera, self._size)

    def _shares(self, scene: Scene, camera: Camera, shown: Floats, best: Floats) -> Floats:
        """(t,) which share of what each target is alone shows in so many pixels; NaN where it is
        too small, or out of view. A target is drawn alone only where its box does not tell."""
        targets = np.nonzero(scene.targets)[0]
        boxes = screen_boxes(scene.corners[targets], camera, self._size)
        low = np.maximum(boxes.extents[:, :2], 0)
        high = np.minimum(boxes.extents[:, 2:], self._size)
        area = np.where(boxes.inside, (high - low).clip(0).prod(axis=1), 0.0)
        found = np.full(len(targets), np.nan)
        for k, target in enumerate(targets):
            if best[k] >= HIDDEN or area[k] < LEAST:
                continue
            if shown[k] >= HIDDEN * area[k]:  # and so of what is in the box
                found[k] = 1.0
                continue
            only = Scene((scene.objects[target],), scene.background)
            alone = self._areas(only, camera, self._standard, None)[0]
            found[k] = shown[k] / alone if alone >= LEAST else np.nan
        return found

    def _seen(self, scene: Scene, camera: Camera, p: Parameters) -> tuple[Floats, Floats]:
        """Pixels of each object in the standard picture (n,), and under the technique (n,)."""
        plain = self._areas(scene, camera, self._standard, None)
        own = self._areas(scene, camera, p, None)
        if p.technique.active(p):
            shot = self._shot(scene, camera)
            targets = np.nonzero(scene.targets)[0]
            begun = p.technique.begin(p)
            for k in targets[np.argsort(plain[targets], kind="stable")][:MOST_REACHED]:
                gestures = p.technique.reach(p, begun, shot, scene.centers[k])
                state = after(p, begun, shot, gestures)
                own = np.maximum(own, self._areas(scene, camera, p, state))
        return plain, own

    def _areas(self, scene: Scene, camera: Camera, p: Parameters, state: object) -> Floats:
        if not len(scene.objects):
            return np.zeros(0)
        area = self._renderer.look(scene, camera, p, self._size, state).area
        own = area[: len(scene.objects)]  # what a technique adds (a balloon's rods) stands behind
        return own * self._size[0] * self._size[1]


def open_kinds(scene: Scene, touched: Bools) -> set[str]:
    """Kinds of the touched things whose mesh has a border."""
    things = (scene.objects[k] for k in np.nonzero(touched)[0])
    return {thing.kind or "thing" for thing in things if not thing.mesh.closed}


def _spread(trials: list[Trial]) -> list[Trial]:
    """At most so many, evenly from first to last."""
    if len(trials) <= MOST_SCENES:
        return trials
    return [trials[k * len(trials) // MOST_SCENES] for k in range(MOST_SCENES)]
