"""The static depth test (Elmqvist2009 §VI-G): a still of a world, and three pairs of things in it:
which is nearer?"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from seethrough.experiment.pages.pages import PICTURE_ASPECT, Choice, Page, Picture
from seethrough.experiment.study.design.design import STUDY_SCENES, generator
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.look import PLAIN, Look
from seethrough.renderer.scene.scene import Object
from seethrough.renderer.scene.transforms import rotation_y
from seethrough.renderer.techniques.base import Parameters
from seethrough.tasks.catalog import WORLDS
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.world import WorldParameters

PAIRS = 3
RATIO = 1.2  # the farther of a pair is at least this much farther: ours
STREAM = (STUDY_SCENES, 99)
MOST_SCENES = 60
HEADINGS = 24
SMALLEST = 0.08  # of half the picture's height: radius of a thing that can be recognised
APART = 0.6  # of the sum of two radii: things that stand apart in the picture


@dataclass(frozen=True, eq=False)
class DepthTest:
    """A still, and pairs of kinds in it, each with the position (0 or 1) of the nearer."""

    view: View
    pairs: tuple[tuple[str, str], ...]
    nearer: tuple[int, ...]

    def pages(self, technique: Parameters, look: Look = PLAIN) -> list[Page]:
        """The picture once for each pair, large."""
        picture = Picture(lambda: self.view.dressed(look), technique, height=0.56)
        return [
            Page(
                f"depth test {n}",
                "depth.title",
                (
                    picture,
                    Choice(f"pair_{n}", "depth.question", tuple(f"kind.{kind}" for kind in pair)),
                ),
            )
            for n, pair in enumerate(self.pairs)
        ]

    def right(self, number: int, answers: dict[str, str]) -> bool:
        """Whether the answers of a pair's page (from 0) name the nearer one."""
        return answers[f"pair_{number}"] == str(self.nearer[number])


@lru_cache(maxsize=4)
def depth_test(seed: int, world: str, place: WorldParameters) -> DepthTest:
    """The test of a study, in a world of such parameters: the same for everybody. Raises ValueError
    if no scene shows six kinds.

    Each kind in a pair occurs once in the picture, so that its name is enough to point at it, and
    is large enough to be recognised. The window's shape plays no part: every picture on
    a page has the same.
    """
    for number in range(MOST_SCENES):
        rng = generator(seed, (*STREAM, number))
        made = WORLDS[world].make(rng, place)
        for camera in _around(WORLDS[world].viewer(made, place, PICTURE_ASPECT).camera()):
            view = View(made.scene, camera)
            depths = _depths(view)
            names = [str(name) for name in rng.permutation(sorted(depths))]
            pairs = _pairs(names, depths)
            if len(pairs) == PAIRS:
                nearer = tuple(int(depths[a] > depths[b]) for a, b in pairs)
                return DepthTest(view, pairs, nearer)
    raise ValueError(f"{world}: expected a scene with {2 * PAIRS} kinds in one view")


def _around(camera: Camera) -> list[Camera]:
    """The start's view turned to every side."""
    lens = {"fov_y": camera.fov_y, "near": camera.near, "far": camera.far}
    turns = [rotation_y(2 * np.pi * k / HEADINGS)[:3, :3] for k in range(HEADINGS)]
    return [Camera(camera.eye, turn @ camera.rotation, **lens) for turn in turns]


def _depths(view: View) -> dict[str, float]:
    """View depth of each kind that occurs just once in the picture, large, whole and by itself."""
    things = [i for i, o in enumerate(view.scene.objects) if o.target]
    centers = view.scene.centers[things]
    kinds = np.array([view.scene.objects[i].kind for i in things])
    depth = view.camera.depth(centers)
    ahead = depth > view.camera.near
    size = np.array([_radius(view.scene.objects[i]) for i in things]) / np.where(ahead, depth, 1)
    size /= np.tan(view.camera.fov_y / 2)  # half-heights of the picture
    place = view.camera.places(centers)
    shown = ahead & (np.abs(place) < [PICTURE_ASPECT * 1.15, 1.15]).all(axis=1)
    whole = shown & (np.abs(place) + size[:, None] < [PICTURE_ASPECT, 1.0]).all(axis=1)
    found = {}
    for i in np.nonzero(whole & (size >= SMALLEST))[0]:
        apart = np.linalg.norm(place - place[i], axis=1) >= APART * (size + size[i])
        apart[i] = True
        if apart[shown].all() and (kinds[shown] == kinds[i]).sum() == 1:
            found[str(kinds[i])] = float(depth[i])
    return found


def _radius(thing: Object) -> float:
    return thing.mesh.radius * float(np.linalg.norm(thing.transform[:3, 0]))


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
