"""What the pointer does to techniques that follow it: its place, and a number that keys change.

Where the pointer has not moved, or is captured to walk, the place is the middle of the view.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil, log

from seethrough.renderer.events import Event, KeyPress, PointerMove, Wheel
from seethrough.renderer.techniques.base import Floats, Gesture, Shot

MOST_STEPS = 60  # of the wheel at once: 1.1 to that power is 300


@dataclass(frozen=True)
class Pointing:
    """Where the pointer is, in view units (None: it has not moved), and how far it works."""

    pointer: tuple[float, float] | None
    depth: float

    def pixel(self, shot: Shot) -> tuple[float, float]:
        """Column and row of the place, in pixels."""
        x, y = self.pointer or (shot.aspect / 2, 0.5)
        return x * shot.size[1], y * shot.size[1]

    def direction(self, shot: Shot) -> Floats:
        """(3,) from the eye through the place, in the world, of view depth 1."""
        column, row = self.pixel(shot)
        right, up, back = shot.camera.rotation.T
        x, y = column - shot.size[0] / 2, shot.size[1] / 2 - row
        found: Floats = (x * right + y * up) / shot.camera.lens(shot.size[1]) - back
        return found


def place_of(shot: Shot, point: Floats) -> tuple[float, float] | None:
    """Where a point of the world (3,) lies on the view, in view units; None outside of it."""
    away = point - shot.camera.eye
    depth = float(away @ shot.camera.forward)
    if depth <= shot.camera.near:
        return None
    right, up, _ = shot.camera.rotation.T
    scale = shot.camera.lens(shot.size[1]) / depth / shot.size[1]
    x, y = shot.aspect / 2 + float(away @ right) * scale, 0.5 - float(away @ up) * scale
    return (x, y) if 0 <= x <= shot.aspect and 0 <= y <= 1 else None


def reaching(state: Pointing, shot: Shot, point: Floats, step: float) -> tuple[Gesture, ...]:
    """What hands do so that `followed` brings a state to a point of the world or just beyond: the
    pointer goes there, the wheel does the rest."""
    place = place_of(shot, point)
    if place is None:
        return ()
    depth = float((point - shot.camera.eye) @ shot.camera.forward)
    steps = ceil(log(depth / state.depth) / log(1 + step) - 1e-9) if step > 0 else 0
    steps = min(max(steps, -MOST_STEPS), MOST_STEPS)
    turn = (Gesture("wheel", place, steps),) if steps else ()
    return (Gesture("pointer", place), *turn)


def followed(state: Pointing, event: Event, step: float) -> tuple[Pointing, bool]:
    """The state after an event: the pointer moves it, q and e bring it nearer and farther by a
    `step` (a share), and so does the wheel. A move of the pointer is left to others as well."""
    if isinstance(event, PointerMove):
        return replace(state, pointer=(event.x, event.y)), False
    if isinstance(event, KeyPress) and event.key in ("q", "e"):
        factor = 1 + step if event.key == "e" else 1 / (1 + step)
        return replace(state, depth=state.depth * factor), True
    if isinstance(event, Wheel):
        return replace(state, depth=state.depth * (1 + step) ** event.dy), True
    return state, False
