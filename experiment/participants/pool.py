"""Scenes for data mode, made once: a pool of abstract worlds for each task, the study's buildings.

Every abstract trial draws its world from the pool by its own stream; buildings are those of the
study, the same for everybody.
"""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

import numpy as np

from experiment.config import Study
from experiment.design import STUDY_SCENES, Trial, generator
from experiment.participants.tables import Draw, Table, TableEyes, load, save
from renderer.camera import Camera
from renderer.scene import Scene
from renderer.visibility import Visibility
from tasks.catalog import TASKS

POOL = 100  # second word of the pool's streams: no scene set of a study has such a number


class Pool:
    """Scenes by name, and their visibility tables by scene and transparency level.

    `draw(level)` makes the function that draws for a level; without it only what the tables hold
    can be looked at.
    """

    def __init__(self, study: Study, size: int, draw: Any = None) -> None:
        if size < 1:
            raise ValueError(f"pool = {size}: expected at least 1 scene a task")
        self.study, self.size, self._draw = study, size, draw
        self.tables: dict[str, Table] = {}
        self._scenes: dict[str, Any] = {}
        self._draws: dict[str, Draw | None] = {}
        self._digests: dict[str, str] = {}

    def begin(self, trial: Trial, aspect: float) -> tuple[str, Any]:
        """The name of a trial's scene in the pool, and the trial's first state in it."""
        rng = generator(self.study.study.seed, trial.stream)
        return self.scene(trial, int(rng.integers(self.size)), aspect)

    def scene(self, trial: Trial, which: int, aspect: float) -> tuple[str, Any]:
        """As `begin`, in the pool's world number `which` (walkthrough: in the trial's own)."""
        task = TASKS[trial.task]
        rng = generator(self.study.study.seed, trial.stream)
        if trial.scenario == "abstract":
            parameters: Any = self.study.abstract
            stream: tuple[int, ...] = (STUDY_SCENES, POOL, sorted(TASKS).index(trial.task), which)
        else:
            parameters, stream = self.study.walkthrough, trial.stream
        name = f"{trial.task}-" + "-".join(map(str, stream))
        if name not in self._scenes:
            made = generator(self.study.study.seed, stream)
            self._scenes[name] = task.make_scene(made, parameters)
        return name, task.begin(rng, parameters, aspect, self._scenes[name])

    def eyes(self, name: str, trial: Trial, scene: Scene) -> TableEyes:
        """Eyes for a scene of the pool, at the trial's transparency level."""
        level = trial.transparency
        if name not in self._digests:
            self._digests[name] = fingerprint(scene, self.study.dynamic)
        key = f"{name}-{self._digests[name]}/{level}"
        table = self.tables.setdefault(key, Table(len(scene.objects)))
        if level not in self._draws:
            self._draws[level] = None if self._draw is None else self._draw(level)
        return TableEyes(table, trial.scenario, self._draws[level])

    def save(self, path: Path) -> None:
        """Write all tables."""
        path.parent.mkdir(parents=True, exist_ok=True)
        save(path, self.tables)

    def load(self, path: Path) -> None:
        """Read tables written by `save`."""
        self.tables |= load(path)

    @property
    def looks(self) -> int:
        """How many viewpoints the tables hold."""
        return sum(len(t.rows) for t in self.tables.values())


def fingerprint(scene: Scene, technique: object) -> str:
    """What a table depends on besides its viewpoints: objects, their meshes, the technique."""
    digest = hashlib.sha256(repr(technique).encode())
    digest.update((np.round(scene.transforms, 6) + 0.0).astype("<f8").tobytes())
    for thing in scene.objects:
        digest.update(f"{thing.kind},{thing.color},{len(thing.mesh.triangles)};".encode())
    return digest.hexdigest()[:12]


class LazyDraw:
    """`draw` for a pool: small id pictures from the real renderer.

    The context is made when something must be drawn for the first time.
    """

    def __init__(self, study: Study, aspect: float) -> None:
        from experiment.looking import HEIGHT

        self.study, self.size = study, (round(HEIGHT * aspect), HEIGHT)
        self._renderer: Any = None

    def __call__(self, level: str) -> Draw:
        """What draws for a transparency level."""
        from renderer.techniques.standard import Standard

        technique = self.study.dynamic if level == "dynamic" else Standard()
        return lambda scene, camera: self._look(scene, camera, technique)

    def _look(self, scene: Scene, camera: Camera, technique: Any) -> Visibility:
        if self._renderer is None:
            from renderer.gpu.context import standalone
            from renderer.gpu.renderer import Renderer

            self._renderer = Renderer(standalone(), self.size)
        return self._renderer.look(scene, camera, technique, self.size)


def same(a: Any, b: Any) -> bool:
    """Whether two looks are the same to the last bit."""
    return all(
        np.array_equal(getattr(a, n), getattr(b, n), equal_nan=True)
        for n in ("pixels", "weight", "position", "contrast", "area")
    )
