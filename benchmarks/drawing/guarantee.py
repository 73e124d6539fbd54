"""Whether every target keeps the share of the picture that the exact picture gives it.

An average over all pixels cannot see one target vanish. So, of each target that the exact picture
shows at MANY pixels or more, how much of its shares our picture keeps: Σ min(ours, exact) / Σ exact
over its pixels. What a picture shows of a target is read from the picture itself: with the target
in one pure colour and all else black, a pixel is the target's share times its light. And along
paths, how many pixels jump from one frame to the next where the exact picture's do not.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import degrees, pi, radians

import numpy as np
from numpy.typing import NDArray

from seethrough.benchmarks.rows import Row, row
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.plan.planner import plan
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.geometry import Mesh
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.scene.visibility import SEEN
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.tasks.kit.controls import orbit, walk
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import abstract_scene
from seethrough.tasks.worlds.building.building import unique_building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

EXACT = DynamicTransparency(exact=True)
MANY = 5  # pixels of a target that count as a view of it
KEPT = 0.8  # of its shares: what every target must keep in the default picture
JUMP, JUMPING = 40, 40  # steps of 1/255 that count as a jump; the pixels that may
WORLDS, BUILDINGS, YAWS = range(1, 49), range(1, 25), 8
PATHS, FRAMES, PATH_SIZE = range(1, 11), 300, (640, 480)
TURN, STEP = radians(0.2), 0.04  # of an orbit, and of a walk: 2 cm, a world unit is half a metre
_BLACK, _PURE = (0.0, 0.0, 0.0), ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))

Ways = dict[str, DynamicTransparency]


@dataclass(frozen=True)
class Worst:
    """The least or the most of something, and the world and the angle or frame that it is from."""

    value: float
    world: int
    where: float
    count: int  # of all that was looked at
    bad: int  # of these beyond the limit


def abstract_views(seed: int, aspect: float) -> tuple[Scene, list[Camera]]:
    """A world of the abstract scenario, and what YAWS turns show of it."""
    parameters = AbstractParameters()
    scene = abstract_scene(np.random.default_rng(seed), parameters)
    return scene, [orbit(parameters, aspect, 2 * pi * k / YAWS).camera() for k in range(YAWS)]


def building_views(seed: int, aspect: float) -> tuple[Scene, list[Camera]]:
    """A building, and what YAWS turns show of it from where a walk begins."""
    parameters = BuildingParameters()
    made = unique_building(np.random.default_rng(seed), parameters)
    turns = [2 * pi * k / YAWS for k in range(YAWS)]
    return made.scene, [walk(parameters, made.start, turn).camera() for turn in turns]


def orbit_path(seed: int, aspect: float) -> tuple[Scene, list[Camera]]:
    """A world, and an orbit about it that begins somewhere else for each."""
    parameters = AbstractParameters()
    scene = abstract_scene(np.random.default_rng(seed), parameters)
    turns = 2 * pi * (seed - 1) / len(PATHS) + TURN * np.arange(FRAMES)
    return scene, [orbit(parameters, aspect, float(turn)).camera() for turn in turns]


def walk_path(seed: int, aspect: float) -> tuple[Scene, list[Camera]]:
    """A building, and a straight walk through it, through walls if need be."""
    parameters = BuildingParameters()
    made = unique_building(np.random.default_rng(seed), parameters)
    yaw = 2 * pi * (seed - 1) / len(PATHS)
    ahead = STEP * np.arange(FRAMES)
    places = zip(
        made.start[0] - np.sin(yaw) * ahead, made.start[1] - np.cos(yaw) * ahead, strict=True
    )
    return made.scene, [walk(parameters, (float(x), float(z)), yaw).camera() for x, z in places]


def figures(renderer: Renderer, ways: Ways, default: str) -> Iterator[Row]:
    """All rows, of 800 × 600 pictures and of paths of smaller ones."""
    for name, make, seeds in (
        (f"{len(WORLDS)} abstract worlds", abstract_views, WORLDS),
        (f"{len(BUILDINGS)} buildings", building_views, BUILDINGS),
    ):
        for way, worst in least_kept(renderer, make, seeds, ways).items():
            where, must = f"{name}: {way}", KEPT if way == default else None
            yield row("least share of a target kept", where, worst.value, "", must, 0.95, more=True)
            yield row("of world", where, worst.world, "")
            yield row("at yaw", where, worst.where, "°")
            yield row(f"targets under {KEPT}", where, worst.bad, f"of {worst.count}")
    size = renderer.size
    renderer.resize(PATH_SIZE)
    for name, path in ((f"{len(PATHS)} orbits", orbit_path), (f"{len(PATHS)} walks", walk_path)):
        for way, worst in most_jumping(renderer, path, PATHS, ways).items():
            where, must = f"{name}: {way}", JUMPING if way == default else None
            yield row("most pixels that jump", where, worst.value, "", must)
            yield row("of world", where, worst.world, "")
            yield row("at frame", where, worst.where, "")
            yield row(f"frames over {JUMPING}", where, worst.bad, f"of {worst.count}")
    renderer.resize(size)


Make = Callable[[int, float], tuple[Scene, Sequence[Camera]]]  # of a seed and an aspect


def least_kept(renderer: Renderer, make: Make, seeds: range, ways: Ways) -> dict[str, Worst]:
    """What each way keeps of the target that loses most in the views of some worlds; `where` is a
    yaw in degrees."""
    found: dict[str, list[tuple[float, int, float]]] = {way: [] for way in ways}
    for seed in seeds:
        scene, cameras = make(seed, renderer.size[0] / renderer.size[1])
        guarantee = Guarantee(renderer, scene)
        for k, camera in enumerate(cameras):
            for way, values in guarantee.kept(camera, ways)[1].items():
                found[way] += [(float(v), seed, degrees(2 * pi * k / YAWS)) for v in values]
    return {
        way: Worst(*min(rows), len(rows), sum(r[0] < KEPT for r in rows))
        for way, rows in found.items()
    }


def most_jumping(renderer: Renderer, path: Make, seeds: range, ways: Ways) -> dict[str, Worst]:
    """Pixels of each way that jump where the exact picture's do not, in the worst frame of some
    paths; `where` is the frame."""
    found: dict[str, list[tuple[float, int, float]]] = {way: [] for way in ways}
    for seed in seeds:
        scene, cameras = path(seed, renderer.size[0] / renderer.size[1])
        last: dict[str, NDArray[np.int16]] = {}
        for frame, camera in enumerate(cameras):
            drawn = {
                way: renderer.read().astype(np.int16)
                for way in each_drawn(renderer, scene, camera, {"": EXACT, **ways})
            }
            jumps = {way: np.abs(drawn[way] - old).max(axis=2) > JUMP for way, old in last.items()}
            for way in ways if jumps else ():
                found[way].append((float((jumps[way] & ~jumps[""]).sum()), seed, frame))
            last = drawn
    return {
        way: Worst(*max(rows), len(rows), sum(r[0] > JUMPING for r in rows))
        for way, rows in found.items()
    }


def each_drawn(renderer: Renderer, scene: Scene, camera: Camera, ways: Ways) -> Iterator[str]:
    """Each way once it is drawn. Ways that differ in the doubt they allow and leave none over are
    the same picture, and are drawn once."""
    last: tuple[DynamicTransparency, bytes] | None = None
    for way, technique in ways.items():
        frame = plan(scene, camera, technique, renderer.size, renderer.without)
        this = (
            replace(technique, doubt=0.0),
            frame.exact.tobytes() + frame.doubtful.tobytes() + frame.crossing.tobytes(),
        )
        if this != last:
            renderer.draw(scene, camera, technique)
        last = this
        yield way


class Guarantee:
    """A scene's pictures of its targets, three at a time."""

    def __init__(self, renderer: Renderer, scene: Scene) -> None:
        self._renderer, self._scene = renderer, scene
        white: dict[Mesh, Mesh] = {}
        for thing in scene.objects:
            if thing.mesh not in white:
                white[thing.mesh] = replace(thing.mesh, colors=np.ones_like(thing.mesh.colors))
        self._black = [replace(o, mesh=white[o.mesh], color=_BLACK) for o in scene.objects]

    def kept(
        self, camera: Camera, ways: Ways, exact: DynamicTransparency = EXACT
    ) -> tuple[NDArray[np.int64], dict[str, NDArray[np.float64]]]:
        """Targets in view (t,), and what each way keeps of them (t,), from 0 to 1."""
        shares = self._shares(camera, exact)
        shown = (shares >= SEEN).sum(axis=1) >= MANY
        targets, shares = np.nonzero(self._scene.targets)[0][shown], shares[shown]
        found = {way: np.ones(len(targets)) for way in ways}
        for first in range(0, len(targets), 3):
            three = targets[first : first + 3]
            scene = self._colored(three)
            truth = np.zeros(0)
            for way in each_drawn(self._renderer, scene, camera, {"": exact, **ways}):
                picture = self._picture()
                if way == "":
                    truth = np.where(picture > 0, picture, np.inf)
                    continue
                for k in range(len(three)):
                    share = shares[first + k]
                    ratio = np.minimum(picture[:, k] / truth[:, k], 1.0)
                    found[way][first + k] = (share * ratio).sum() / share.sum()
        return targets, found

    def _shares(self, camera: Camera, exact: DynamicTransparency) -> NDArray[np.float64]:
        """(targets, pixels) of the exact picture."""
        size, count = self._renderer.size, int(self._scene.targets.sum())
        row_of = np.full(len(self._scene.objects) + 1, -1)
        row_of[1:][self._scene.targets] = np.arange(count)
        shares = np.zeros((count, size[0] * size[1]))
        for ids, share in self._renderer.shares(self._scene, camera, exact, size):
            which = row_of[ids.ravel()]
            there = np.nonzero(which >= 0)[0]
            shares[which[there], there] += share.ravel()[there]
        return shares

    def _colored(self, three: NDArray[np.int64]) -> Scene:
        objects = list(self._black)
        for i, color in zip(three.tolist(), _PURE, strict=False):
            objects[i] = replace(objects[i], color=color)
        scene = Scene(tuple(objects), _BLACK)
        scene.__dict__["separations"] = self._scene.separations  # the same objects, found once
        return scene

    def _picture(self) -> NDArray[np.float64]:
        """(pixels, 3) of the last frame, in the driver's own numbers, the upper row first."""
        width, height = self._renderer.size
        rows = np.frombuffer(self._renderer.raw(), np.float16).reshape(height, width, 4)
        return rows[::-1, :, :3].reshape(-1, 3).astype(float)
