"""What visualization asks of a technique (Elmqvist2009 §IV: R1 to R7), measured on exact pictures.

R1 every target comes to show, from wherever one looks; R2 behind any number of layers; R3 only
where the target is, not the whole thing before it; R4 of polygons; R5 in real time; R6 without
anybody's hands; R7 with the context and its depth kept. Hands that a technique has reach for each
target in turn; what they then show is what R1 and R2 say.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from seethrough import registry
from seethrough.experiment.suites.finding import Finding, note
from seethrough.experiment.suites.technique_scenes import BLUE, GREY, RED, SHAPES, Case, room
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.base import Floats, Parameters, Shot, Technique
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.kit.gestures import after

SIZE = (96, 72)
VIEWS, LAYERS = 6, (1, 2, 4, 8, 16)
SHOWS = 0.05  # share of a target that is enough to find it
HIDDEN = 0.5  # share of a target whose hiding makes it a hidden one
AHEAD = look_at(np.array([0.0, 0.0, 9.0]), np.zeros(3), fov_y=0.6, near=1, far=60)


@dataclass(frozen=True)
class Measured:
    """`found` of `hidden` targets of which enough shows, over all views, and the `least` share of
    one; `layers` behind which a target still shows, the most of LAYERS, or 0; `kept` share of a
    large wall that is as before, with a small target behind it; `context` share of everything else
    that is left; whether it works `alone`, without hands."""

    found: int
    hidden: int
    least: float
    layers: int
    kept: float
    context: float
    alone: bool

    def words(self) -> dict[str, str]:
        """R1 to R7, as a table says them."""
        deep = f"{self.layers} layers" + (" and more" if self.layers == LAYERS[-1] else "")
        return {
            "R1": f"{self.found} of {self.hidden} (least {100 * self.least:.0f} %)",
            "R2": deep if self.layers else "none",
            "R3": f"{100 * self.kept:.0f} % stays",
            "R4": "yes",
            "R6": "yes" if self.alone else "needs hands",
            "R7": f"{100 * self.context:.0f} % stays",
        }


def measure(technique: Technique) -> Measured:
    """What a technique does with its default parameters."""
    p = technique.Parameters()
    shares, left = [], []
    for case in _round():
        plain, whole = _plain(case), _whole(case)
        targets = [k for k in whole if plain[k] < (1 - HIDDEN) * whole[k]]
        shown, context = _shown(case, p, targets)
        shares += [shown[k] / whole[k] for k in targets]
        left.append(context)
    layers = 0
    for count in LAYERS:
        case = _panes(count)
        if _shown(case, p, [count])[0][count] < SHOWS * _whole(case)[count]:
            break
        layers = count
    found = sum(share >= SHOWS for share in shares)
    return Measured(
        found, len(shares), float(min(shares)), layers, _stays(p), float(np.mean(left)),
        not technique.active(p),
    )  # fmt: skip


def _shown(case: Case, p: Parameters, targets: list[int]) -> tuple[dict[int, float], float]:
    """Pixels of each target, with hands where they reach for it, and the share of the area of
    everything else that is left, with hands at the first."""
    found, left = {}, 1.0
    rules, shot = p.technique, Shot(case.scene, case.camera, SIZE)
    begun = rules.begin(p)
    once: Floats | None = None
    for number, k in enumerate(targets):
        state = begun
        if rules.active(p):
            gestures = rules.reach(p, begun, shot, case.scene.centers[k])
            state = after(p, begun, shot, gestures)
        if once is None or rules.active(p):
            truth = exact(case.scene, case.camera, rules.exactly(p), SIZE, state)
            once = truth.weights[: len(case.scene.objects)].sum(axis=(1, 2))
        found[k] = float(once[k])
        if number == 0:
            others = ~case.scene.targets
            left = float(once[others].sum() / _plain(case)[others].sum())
    return found, left


@lru_cache
def _plain(case: Case) -> Floats:
    """(n,) pixels of each object in the standard picture."""
    truth = exact(case.scene, case.camera, Standard(), SIZE)
    pixels: Floats = truth.weights.sum(axis=(1, 2))
    return pixels


@lru_cache
def _whole(case: Case) -> dict[int, float]:
    """Pixels of each target as if nothing else were there."""
    found = {}
    for k in np.nonzero(case.scene.targets)[0].tolist():
        alone = Scene((case.scene.objects[k],), case.scene.background)
        truth = exact(alone, case.camera, Standard(), SIZE)
        if truth.weights.sum() > 4:
            found[k] = float(truth.weights.sum())
    return found


@lru_cache
def _round() -> tuple[Case, ...]:
    """The room, from round about: what is in the way is a wall or a crate."""
    plan = room()
    return tuple(Case(f"{k}", plan.scene, _from(2 * np.pi * k / VIEWS + 0.2)) for k in range(VIEWS))


def _from(turn: float) -> Camera:
    eye = np.array([9.0 * np.sin(turn), 1.6, 9.0 * np.cos(turn)])
    return look_at(eye, np.array([0.5, 1.0, -1.0]), fov_y=0.9, near=0.1, far=100)


@lru_cache
def _panes(count: int) -> Case:
    """So many panes, called walls, before a ball."""
    panes = [
        Object(
            geometry.box(5, 4, 0.05), transforms.translation(0, 0, 4 - 0.2 * k), BLUE, kind="wall"
        )
        for k in range(count)
    ]
    ball = Object(SHAPES[0], transforms.translation(0, 0, -2), RED, True)
    return Case(f"{count} panes", Scene((*panes, ball)), AHEAD)


def _stays(p: Parameters) -> float:
    """The share of a wall that is as before, with a target behind it a hundredth as large."""
    wall = Object(geometry.box(6, 4.5, 0.2), transforms.translation(0, 0, 1), GREY, kind="wall")
    ball = Object(SHAPES[0], transforms.placed((0, 0, -1), None, 0.35), RED, True)
    scene = Scene((wall, ball))
    rules, shot = p.technique, Shot(scene, AHEAD, SIZE)
    state = rules.begin(p)
    if rules.active(p):
        state = after(p, state, shot, rules.reach(p, state, shot, scene.centers[1]))
    before = exact(scene, AHEAD, Standard(), SIZE)
    own = exact(scene, AHEAD, rules.exactly(p), SIZE, state)
    there = before.weights[0] > 0
    same = np.abs(own.picture - before.picture).max(axis=2) < 1 / 255
    return float((same & there).sum() / there.sum())


def asked(technique: Technique) -> Finding:
    """What was measured, in a line; nothing is asked of it."""
    try:
        words = measure(technique).words()
    except Exception as error:  # a stranger's code may raise anything
        return Finding(
            "requirements", False, f"{type(error).__name__}: {error}{registry.place_of(error)}"
        )
    return note("requirements", ", ".join(f"{r} {found}" for r, found in words.items()))
