"""Scenes for data mode, made once: a pool for each task whose scenes are everybody's own.

Every such trial draws its scene from the pool by its own stream; shared scenes are those of the
study, the same for everybody, as in the real session.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from seethrough.experiment.people.runs.look_tables import Draw, TableEyes, moved
from seethrough.experiment.people.runs.looks import KeptLooks
from seethrough.experiment.study.config import Study
from seethrough.experiment.study.design.design import STUDY_SCENES, Trial, generator
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.look import PLAIN
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.scene.visibility import Visibility
from seethrough.renderer.techniques.base import Parameters
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import Task, View
from seethrough.tasks.kit.world import FILES, OWN, Place, WorldParameters, lattice_of

if TYPE_CHECKING:
    from seethrough.experiment.display.looking import Looking

SIMPLE = "simple models, "  # what tables were looked at with
POOL = 100  # second word of the pool's streams: no scene set of a study has such a number


class Pool(StudyScenes):
    """Scenes by name, and their visibility tables by scene and technique, in `looks`.

    `draw(technique)` makes the function that draws with it; without it only what the tables hold
    can be looked at. A pool of no worlds plays every trial in its own, as the real session does.
    """

    def __init__(
        self,
        study: Study,
        size: int,
        draw: Callable[[Parameters], Draw] | None = None,
        looks: KeptLooks | None = None,
    ) -> None:
        if size < 0:
            raise ValueError(f"pool = {size}: expected at least 1 scene a task, 0 for the study's")
        super().__init__(study)
        self.size, self._draw = size, draw
        self.looks = looks or KeptLooks()
        self._scenes: dict[tuple[str, WorldParameters], Place] = {}
        self._names: dict[int, tuple[str, str]] = {}  # id of a scene → its name, moving
        self._draws: dict[Parameters, Draw | None] = {}
        self._eyes: dict[tuple[int, Parameters], TableEyes] = {}

    def begin(self, task: Task, trial: Trial, aspect: float) -> object:
        """The first state of a trial."""
        rng = generator(self.study.general.seed, trial.stream)
        stream = trial.stream
        if self.size and self.study.setting(trial).place.scenes == OWN:
            stream = self._stream(trial.task, int(rng.integers(self.size)))
        return self._begun(task, trial, aspect, stream)

    def world(self, trial: Trial, which: int, aspect: float) -> object:
        """As `begin`, in the pool's world number `which` of an abstract task."""
        stream = self._stream(trial.task, which)
        return self._begun(TASKS[trial.task], trial, aspect, stream)

    def look(self, view: View, technique: Parameters) -> Visibility:
        """What is seen in a view of one of the pool's scenes, with a technique; where one clicks,
        at the places where it is hit."""
        eyes = self.eyes(view.scene, technique)
        seen = eyes.look(view.scene, view.camera)
        if view.aim is None:
            return seen
        width, height = window_of(self.study)
        lattice = eyes.nearest(view.camera)
        return moved(seen, view.scene, lattice, view.camera, width / height)

    def eyes(self, scene: Scene, technique: Parameters) -> TableEyes:
        """Eyes for one of the pool's scenes with a technique."""
        key = (id(scene), technique)
        if key not in self._eyes:
            self._eyes[key] = self._open(scene, technique)
        return self._eyes[key]

    def _stream(self, task: str, which: int) -> tuple[int, ...]:
        return (STUDY_SCENES, POOL, sorted(self.study.tasks()).index(task), which)

    def _begun(self, task: Task, trial: Trial, aspect: float, stream: tuple[int, ...]) -> object:
        setting = self.setting(trial)
        name = f"{trial.task}-" + "-".join(map(str, stream))
        if (name, setting.place) not in self._scenes:
            made = task.make_scene(generator(self.study.general.seed, stream), setting)
            self._scenes[name, setting.place] = made
            lattice = lattice_of(setting.world, setting.place)
            # A file's scene is the same in many trials: what it is, its fingerprint says.
            called = name if setting.place.scenes != FILES else setting.world.name
            self._names[id(made.scene)] = (called, lattice)
        return task.begin(self._scenes[name, setting.place], setting, aspect)

    def _open(self, scene: Scene, technique: Parameters) -> TableEyes:
        name, moving = self._names[id(scene.bare or scene)]
        own = fingerprint(scene, technique, window_of(self.study))
        table = f"{name}-{own}/{technique.technique.name}"
        if technique not in self._draws:
            self._draws[technique] = None if self._draw is None else self._draw(technique)
        return TableEyes(self.looks, table, len(scene.objects), moving, self._draws[technique])


def drawing(study: Study, size: int, looks: KeptLooks | None = None) -> Pool:
    """A pool that draws what its tables lack, in the study's window's shape."""
    return Pool(study, size, LazyDraw(study), looks)


def window_of(study: Study) -> tuple[int, int]:
    """(width, height) in pixels of the window that people would look at."""
    return (study.display.width, study.display.height)


def fingerprint(scene: Scene, technique: object, window: tuple[int, int]) -> str:
    """What a table depends on besides its viewpoints: objects, their meshes, the technique, the
    look, and the window, whose pixels the technique counts."""
    digest = hashlib.sha256(f"{SIMPLE}{technique!r}, {window[0]} × {window[1]}".encode())
    if scene.look != PLAIN:
        digest.update(repr(scene.look).encode())
    digest.update((np.round(scene.transforms, 6) + 0.0).astype("<f8").tobytes())
    for thing in scene.objects:
        about = f"{thing.kind},{thing.color},{len(thing.mesh.triangles)}"
        if thing.group is not None or thing.importance or thing.impenetrable:
            about += f",{thing.group},{thing.importance},{thing.impenetrable}"
        digest.update(f"{about},{thing.target};".encode())
        if thing.mesh.colors.size:
            digest.update(np.round(thing.mesh.colors.mean(axis=0), 6).astype("<f8").tobytes())
    return digest.hexdigest()[:12]


class LazyDraw:
    """`draw` for a pool: looks as `Looking` has them, in the study's window.

    The context is made when something must be drawn for the first time.
    """

    def __init__(self, study: Study) -> None:
        self.study = study
        self._looking: Looking | None = None

    def __call__(self, technique: Parameters) -> Draw:
        """What draws with a technique."""
        return lambda scene, camera: self._look(scene, camera, technique)

    def _look(self, scene: Scene, camera: Camera, technique: Parameters) -> Visibility:
        if self._looking is None:
            from seethrough.experiment.display.driver import open_context
            from seethrough.experiment.display.looking import Looking

            self._looking = Looking(open_context(looks=True), window_of(self.study), simple=True)
        self._looking.technique = technique
        return self._looking.look(View(scene, camera))
