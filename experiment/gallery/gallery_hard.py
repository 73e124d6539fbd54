"""The gallery's hard cases: what breaks renderers, as pictures; what is refused, as messages."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from seethrough.experiment.gallery.gallery_plates import DYNAMIC, Plate, Section
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.scene import Color, Object, Scene
from seethrough.renderer.techniques.base import Parameters
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import abstract_scene

RED, BLUE, GOLD, GREEN = (0.9, 0.15, 0.1), (0.2, 0.4, 0.9), (0.9, 0.7, 0.2), (0.3, 0.8, 0.4)
FRONT = look_at(np.array([0.0, 1.5, 9.0]), np.zeros(3), fov_y=0.7, near=0.2, far=80)
RING = geometry.torus(0.9, 0.3, 32, 16)
PANE = geometry.box(5, 4, 0.1)


def sections() -> Iterator[Section]:
    """The issue's list, in its order."""
    yield Section("Cameras and targets in odd places", "", tuple(_places()))
    yield Section("None, few and many targets", "", tuple(_counts()))
    yield Section("Objects that meet", "", tuple(_meetings()))
    yield Section("Large numbers, odd windows", "", tuple(_numbers()))
    yield Section("Refused by name", "Before anything is drawn.", (), tuple(_refused()))


def _at(
    mesh: geometry.Mesh,
    x: float,
    y: float,
    z: float,
    color: Color,
    target: bool = False,
    group: int | None = None,
) -> Object:
    return Object(mesh, transforms.translation(x, y, z), color, target=target, group=group)


def _plate(
    name: str,
    caption: str,
    *objects: Object,
    camera: Camera = FRONT,
    technique: Parameters = DYNAMIC,
    size: tuple[int, int] = (400, 300),
) -> Plate:
    return Plate(f"hard-{name}", caption, Scene(objects), camera, technique, size)


def _places() -> Iterator[Plate]:
    ball, wall = geometry.sphere(2.0, 3), _at(PANE, 0, 0, -1, BLUE)
    inside = Camera(np.zeros(3), np.eye(3), 0.9, 0.1, 100)
    shell = (_at(ball, 0, 0, 0, BLUE), _at(PANE, 0.5, 0, -4, GREEN))
    target = _at(RING, 0.5, 0, -6, RED, target=True)
    yield _plate("inside", "From inside a ball", *shell, target, camera=inside)
    face = replace(inside, eye=np.array([0.0, 0.2, -3.95]))
    yield _plate("face", "The camera on the face of a box", *shell, target, camera=face)
    tiny = _at(geometry.sphere(0.01, 1), 0, 0, -8, RED, target=True)
    yield _plate("tiny", "A target smaller than a pixel, its mask shows", wall, tiny)
    half = _at(RING, 4.7, 0.2, -4, RED, target=True)
    yield _plate("half", "A target half outside", _at(PANE, 3, 0, -1, BLUE), half)
    behind = _at(RING, 0, 0, 12, RED, target=True)
    yield _plate("behind", "The target is behind the camera: standard", wall, behind)
    close = look_at(np.array([0.0, 0.3, 0.9]), np.zeros(3), fov_y=1.2, near=0.5, far=30)
    yield _plate(
        "near-plane",
        "A target and its occluder cut by the near plane",
        _at(geometry.sphere(0.35, 3), 0.25, 0.1, 0.1, BLUE),
        _at(RING, 0, 0, -1.2, RED, target=True),
        camera=close,
    )
    long = _at(geometry.box(0.2, 4, 40), -1.2, 0, -10, (0.75, 0.72, 0.6))
    hidden = _at(RING, -3.2, 0.5, -2, RED, target=True)
    yield _plate("long-wall", "A wall longer than the room that it hides", long, hidden)


def _counts() -> Iterator[Plate]:
    world = abstract_scene(np.random.default_rng(1), AbstractParameters())
    view = look_at(np.array([0, 45.0, 85.0]), np.zeros(3), fov_y=0.6, near=5, far=250)
    order = np.argsort(view.depth(world.centers))
    for count in (0, 1, 20, 200):
        chosen = set(order[count // 2 + 60 : count // 2 + 60 + count].tolist())
        if count == 200:
            chosen = set(range(200))
        objects = (replace(o, target=i in chosen) for i, o in enumerate(world.objects))
        words = f"{count} target{'s' * (count != 1)} of 200"
        yield _plate(f"targets-{count}", words, *objects, camera=view)
    least = replace(DYNAMIC, combine="min")
    objects = (replace(o, target=True) for o in world.objects)
    words = "200 targets, the least mask counts"
    yield _plate("targets-200-min", words, *objects, camera=view, technique=least)
    rng = np.random.default_rng(2)
    line = [_at(geometry.sphere(1.0, 2), 0, 0, -2.2 * i, tuple(rng.random(3)), target=True)
            for i in range(50)]  # fmt: skip
    along = look_at(np.array([0.5, 0.5, 6.0]), np.array([0, 0, -20.0]), fov_y=0.5, near=1, far=200)
    yield _plate("line-50", "50 targets in one line of sight", *line, camera=along)
    for count in (12, 200):
        yield from _panes(count, rng)


def _panes(count: int, rng: np.random.Generator) -> Iterator[Plate]:
    step = 4.8 / count
    panes = [
        Object(
            geometry.box(5, 5, 0.4 * step),
            transforms.translation(2.4 * i / count - 1, 0, 3 - i * step),
            tuple(rng.uniform(0.2, 1, 3)),
        )
        for i in range(count)
    ]
    target = _at(RING, 0.5, 0, -4, RED, target=True)
    words = f"{count} panes before a target"
    yield _plate(f"panes-{count}", words, *panes, target)
    kept = replace(DYNAMIC, min_transmittance=0.5)
    words = f"{count} panes, half the target's light kept for sure"
    yield _plate(f"panes-{count}-kept", words, *panes, target, technique=kept)


def _meetings() -> Iterator[Plate]:
    ball = _at(geometry.sphere(1.6, 3), 0, 0, -3, RED, target=True)
    bars = [
        Object(geometry.box(6, 0.8, 0.8), transforms.rotation_z(a) @ transforms.rotation_y(b), c)
        for a, b, c in ((0.3, 0.7, BLUE), (1.6, 0.2, GOLD), (2.6, -0.6, GREEN))
    ]
    yield _plate("crossing", "Boxes that cross each other", *bars, ball)
    rings = [
        Object(RING, transforms.placed((0.9 * k - 0.9, 0, 0), transforms.rotation_x(1.57 * k)), c)
        for k, c in enumerate((BLUE, GOLD, GREEN))
    ]
    yield _plate("links", "Rings through rings", *rings, ball)
    box = geometry.box(2, 2, 2)
    for name, words, step in (
        ("touch", "Boxes that touch", 2.0),
        ("coincide", "Boxes at one place, the later one shows", 0.0),
    ):
        pair = (_at(box, -step / 2, 0, 0, BLUE), _at(box, step / 2, 0, 0, GOLD))
        yield _plate(name, words, *pair, ball)
    tiles = [_at(geometry.box(1.9, 1.9, 0.2), 1.3 * k - 1.3, 0.3 * k, 0, c)
             for k, c in enumerate((BLUE, GOLD, GREEN))]  # fmt: skip
    yield _plate("plane", "Overlapping tiles in one plane", *tiles, ball)
    dolls = (
        _at(geometry.sphere(r, 3), 0, 0, 0, c, target=r < 1, group=1)
        for r, c in zip((0.7, 1.4, 2.1), (RED, GREEN, BLUE), strict=True)
    )
    wide = replace(DYNAMIC, width=25)
    yield _plate("dolls", "Nested dolls: a group with a fixed order", *dolls, technique=wide)


def _numbers() -> Iterator[Plate]:
    wall, target = _at(PANE, 0.6, 0, 0, BLUE), _at(RING, 0, 0, -4, RED, target=True)
    small, shift = transforms.scaling(0.01), np.array([1e6, -1e6, 1e6])
    far = (
        replace(o, transform=transforms.translation(*shift) @ small @ o.transform)
        for o in (wall, target)
    )
    there = replace(FRONT, eye=FRONT.eye * 0.01 + shift, near=0.002, far=0.8)
    yield _plate("million", "Coordinates of 1e6, details of 1e-2", *far, camera=there)
    things = (
        _at(geometry.sphere(0.08, 3), 0.06, 0.02, -0.4, BLUE),
        _at(geometry.box(0.7, 0.7, 0.7), 0, 0, -3, RED, target=True),
        Object(geometry.cone(1, 2, 24), transforms.placed((9e3, 0, -6e4), None, 9e3), GREEN),
    )
    deep = Camera(np.zeros(3), np.eye(3), 0.7, 0.1, 1e5)
    yield _plate("near-far", "From arm's length to mountains, 1 : 1e6", *things, camera=deep)
    for words, size in (
        ("A window of 1 × 1 pixel", (1, 1)),
        ("A window of 301 × 7 pixels", (301, 7)),
        ("A window of 4096 × 4096 pixels, shown smaller", (4096, 4096)),
    ):
        name = f"window-{size[0]}x{size[1]}"
        yield _plate(name, words, wall, target, size=size)


def _refused() -> Iterator[tuple[str, str]]:
    """What was given, and what was said."""
    for words, value in (("A transform with NaN", np.nan), ("An infinite transform", np.inf)):
        matrix = np.eye(4)
        matrix[0, 3] = value
        try:
            Object(RING, matrix, kind="lamp")
        except ValueError as error:
            yield words, str(error)
    faults: tuple[tuple[str, Callable[[], object]], ...] = (
        ("An opacity above 1", lambda: replace(DYNAMIC, alpha_target=1.5)),
        ("A mask nobody knows", lambda: replace(DYNAMIC, mask="square")),
    )
    for words, make in faults:
        try:
            make()
        except ValueError as error:
            yield words, str(error)
