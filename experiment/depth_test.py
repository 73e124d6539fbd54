"""The static depth test (004 §VI-G): a still of the building with dynamic transparency on, and
three pairs of things in it: which is nearer?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from experiment.config import Study
from experiment.design import STUDY_SCENES, generator
from experiment.pages import Choice, Page, Paragraph, Picture
from renderer.camera import Camera
from renderer.transforms import rotation_y
from tasks.base import View
from tasks.catalog import TASKS

PAIRS = 3
RATIO = 1.25  # the farther of a pair is at least this much farther: ours
STREAM = (STUDY_SCENES, 99)
MOST_SCENES = 60
HEADINGS = 16
SMALLEST = 0.06  # radius of a thing over its depth: some 7° across, a fortieth of the picture


@dataclass(frozen=True, eq=False)
class DepthTest:
    """A still, and pairs of kinds in it, each with the position (0 or 1) of the nearer."""

    view: View
    pairs: tuple[tuple[str, str], ...]
    nearer: tuple[int, ...]

    def page(self, technique: object) -> Page:
        """The picture and a choice for each pair."""
        choices = tuple(
            Choice(f"pair_{n}", "", tuple(f"kind.{kind}" for kind in pair))
            for n, pair in enumerate(self.pairs)
        )
        picture = Picture(self.view, technique, height=0.42)
        text, question = Paragraph("depth.text"), Paragraph("depth.question")
        return Page("depth test", "depth.title", (text, picture, question, *choices))

    def score(self, answers: dict[str, str]) -> int:
        """How many pairs are right, of three."""
        return sum(answers[f"pair_{n}"] == str(near) for n, near in enumerate(self.nearer))


def depth_test(study: Study, aspect: float) -> DepthTest:
    """The study's own test, the same for everybody. Raises ValueError if no scene shows six kinds.

    Each kind in a pair occurs once in the picture, so that its name is enough to point at it, and
    is large enough to be recognised.
    """
    task = TASKS["unique"]
    for number in range(MOST_SCENES):
        rng = generator(study.study.seed, (*STREAM, number))
        scene = task.make_scene(rng, study.walkthrough)
        shown = task.view(task.begin(rng, study.walkthrough, aspect, scene))
        for camera in _around(shown.camera):
            view = View(shown.scene, camera)
            depths = _depths(view, aspect)
            names = [str(name) for name in rng.permutation(sorted(depths))]
            pairs = _pairs(names, depths)
            if len(pairs) == PAIRS:
                nearer = tuple(int(depths[a] > depths[b]) for a, b in pairs)
                return DepthTest(view, pairs, nearer)
    raise ValueError(f"walkthrough: expected a scene with {2 * PAIRS} kinds in one view")


def _around(camera: Camera) -> list[Camera]:
    """The start's view turned to every side."""
    lens = {"fov_y": camera.fov_y, "near": camera.near, "far": camera.far}
    turns = [rotation_y(2 * np.pi * k / HEADINGS)[:3, :3] for k in range(HEADINGS)]
    return [Camera(camera.eye, turn @ camera.rotation, **lens) for turn in turns]


def _depths(view: View, aspect: float) -> dict[str, float]:
    """View depth of each kind that occurs just once in the picture, large and well inside it."""
    inside: dict[str, list[float]] = {}
    for center, thing in zip(view.scene.centers, view.scene.objects, strict=True):
        if not thing.target:
            continue
        x, y, depth = _on_picture(view.camera, center, aspect)
        if depth > view.camera.near and abs(x) < 1.15 and abs(y) < 1.15:
            radius = thing.mesh.radius * np.linalg.norm(thing.transform[:3, 0])
            fits = abs(x) < 0.85 and abs(y) < 0.85 and radius >= SMALLEST * depth
            inside.setdefault(thing.kind, []).append(depth if fits else np.nan)
    return {k: d[0] for k, d in inside.items() if len(d) == 1 and np.isfinite(d[0])}


def _on_picture(camera: Camera, point: np.ndarray, aspect: float) -> tuple[float, float, float]:
    depth = float(camera.depth(point[None])[0])
    clip = camera.projection(aspect) @ camera.view() @ np.append(point, 1.0)
    return clip[0] / abs(clip[3]), clip[1] / abs(clip[3]), depth


def _pairs(names: list[str], depths: dict[str, float]) -> tuple[tuple[str, str], ...]:
    """Up to three disjoint pairs that differ clearly in depth."""
    pairs: list[tuple[str, str]] = []
    left = list(names)
    while left and len(pairs) < PAIRS:
        first = left.pop(0)
        for other in left:
            near, far = sorted((depths[first], depths[other]))
            if far >= RATIO * near:
                left.remove(other)
                pairs.append((first, other))
                break
    return tuple(pairs)
