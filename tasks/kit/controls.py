"""How a participant moves the camera (Elmqvist2009 §VI). Motion is integrated exactly between
events.

Between two events the held keys do not change, so the motion has a closed form: what a trial's
events lead to does not depend on the frame rate.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import atan, cos, pi, sin, tan
from typing import Protocol, TypeVar

import numpy as np

from seethrough.renderer.events import Event, KeyPress, KeyRelease, PointerMove, Tick
from seethrough.renderer.scene.camera import Camera

Value = TypeVar("Value")
ARROWS = frozenset({"left", "right", "up", "down"})
MARGIN = 1.02  # how much farther the camera stands than the tightest fit


class Orbiting(Protocol):
    """What a world says of turning it about its middle; `side`: it fits a cube so large."""

    @property
    def side(self) -> float: ...
    @property
    def fov_y(self) -> float: ...
    @property
    def start_pitch(self) -> float: ...
    @property
    def drag_gain(self) -> float: ...
    @property
    def key_rate(self) -> float: ...


class Walking(Protocol):
    """What a world says of walking through it; it ends `side` away."""

    @property
    def side(self) -> float: ...
    @property
    def eye_height(self) -> float: ...
    @property
    def fov_y(self) -> float: ...
    @property
    def speed(self) -> float: ...
    @property
    def turn_gain(self) -> float: ...
    @property
    def key_turn_rate(self) -> float: ...


def of_view(event: Event, pressed: bool) -> Event:
    """The event as the view takes it: a drag that began on a button (`pressed`) turns nothing."""
    if pressed and isinstance(event, PointerMove) and event.dragging:
        return replace(event, dragging=False)
    return event


def changed(value: Value, **changes: object) -> Value:
    """A frozen value with other fields; as `dataclasses.replace`, at a tenth of what that costs.

    For classes whose fields need no check: simulations live on this.
    """
    new = object.__new__(type(value))
    own = new.__dict__
    own.update(value.__dict__)
    own.update(changes)
    return new


@dataclass(frozen=True)
class Held:
    """Which arrow keys are down, and until when their motion has been worked out."""

    keys: frozenset[str] = frozenset()
    time: float | None = None

    def elapsed(self, time: float) -> float:
        """Seconds since the last event; none before the first one, never a negative number."""
        return 0.0 if self.time is None else max(0.0, time - self.time)

    def after(self, event: Event) -> Held:
        """The keys down after `event`."""
        keys, time, before = self.keys, event.time, self.time
        if isinstance(event, KeyPress) and event.key in ARROWS:
            keys = keys | {event.key}
        elif isinstance(event, KeyRelease):
            keys = keys - {event.key}
        return Held(keys, time if before is None or time > before else before)

    def sign(self, positive: str, negative: str) -> int:
        """1, −1 or, with none or both of the two keys, 0."""
        return (positive in self.keys) - (negative in self.keys)


@dataclass(frozen=True)
class Orbit:
    """Looks at the world's centre from a fixed distance. Angles in radians, `pitch` up."""

    yaw: float
    pitch: float
    distance: float
    reach: float
    fov_y: float
    gain: float
    rate: float
    held: Held = Held()

    def on_event(self, event: Event) -> Orbit:
        """Drags turn the world with the pointer; held arrow keys turn it at a steady rate."""
        turn = self.rate * self.held.elapsed(event.time)
        yaw = self.yaw + turn * self.held.sign("right", "left")
        pitch = self.pitch + turn * self.held.sign("up", "down")
        pitch = min(pi / 2, max(-pi / 2, pitch))
        if isinstance(event, PointerMove) and event.dragging:
            yaw -= self.gain * event.dx
            pitch += self.gain * event.dy
        pitch = min(pi / 2, max(-pi / 2, pitch))
        return changed(self, yaw=yaw, pitch=pitch, held=self.held.after(event))

    def camera(self) -> Camera:
        """Where the participant looks from; looking straight down is fine."""
        rotation = turned(self.yaw, -self.pitch)
        near = self.distance - self.reach
        return Camera(
            rotation[:, 2] * self.distance,
            rotation,
            self.fov_y,
            max(near * 0.99, self.distance * 1e-3),
            self.distance + self.reach * 1.01,
        )


def orbit(
    parameters: Orbiting, aspect: float, yaw: float = 0.0, reach: float | None = None
) -> Orbit:
    """An orbit from which the whole cube lies in the view, whichever way it is turned: the sphere
    about the cube fits the narrower angle of the frustum. With a `reach`, the sphere of that radius
    touches the smaller side of the view instead.
    """
    p = parameters
    margin = MARGIN if reach is None else 1.0
    reach = p.side / 2 * 3**0.5 if reach is None else reach
    half = min(p.fov_y / 2, atan(tan(p.fov_y / 2) * aspect))
    distance = margin * reach / sin(half)
    return Orbit(yaw, p.start_pitch, distance, reach, p.fov_y, p.drag_gain, p.key_rate)


@dataclass(frozen=True)
class Walk:
    """A walker at a fixed eye height: the pointer or left and right turn, up and down walk.

    No strafing, no pitch, no collisions, as in the paper.
    """

    x: float
    z: float
    yaw: float
    height: float
    reach: float
    fov_y: float
    speed: float
    gain: float
    turn_rate: float
    held: Held = Held()

    def on_event(self, event: Event) -> Walk:
        """The walker after `event`: on an arc while turning, on a straight line while not."""
        held = self.held
        if isinstance(event, Tick) and held.time is not None and event.time <= held.time:
            return self  # no time has passed
        x, z, yaw = self.x, self.z, self.yaw
        if held.keys:
            x, z, yaw = self._moved(held.elapsed(event.time))
        if isinstance(event, PointerMove):
            yaw -= self.gain * event.dx
        return changed(self, x=x, z=z, yaw=yaw, held=held.after(event))

    def _moved(self, seconds: float) -> tuple[float, float, float]:
        """x, z and yaw after so long with the held keys down."""
        turn = self.turn_rate * seconds * self.held.sign("left", "right")
        # The chord of the arc: the path's length times sin(turn / 2) / (turn / 2), in the
        # direction half-way through the turn.
        bend = sin(turn / 2) / (turn / 2) if turn else 1.0
        chord = self.speed * seconds * self.held.sign("up", "down") * bend
        middle = self.yaw + turn / 2
        return self.x - chord * sin(middle), self.z - chord * cos(middle), self.yaw + turn

    def camera(self) -> Camera:
        """What the walker sees."""
        eye = np.array([self.x, self.height, self.z])
        return Camera(eye, turned(self.yaw), self.fov_y, 0.1, self.reach)


def walk(parameters: Walking, start: tuple[float, float], yaw: float = 0.0) -> Walk:
    """A walker at the start, who can see as far as the building's diagonal."""
    p = parameters
    return Walk(
        *start, yaw, p.eye_height, 2 * p.side, p.fov_y, p.speed, p.turn_gain, p.key_turn_rate
    )


def turned(yaw: float, pitch: float = 0.0) -> np.ndarray:
    """(3, 3) world ← camera for a yaw about +y, then a pitch about the camera's right axis."""
    cy, sy, cp, sp = cos(yaw), sin(yaw), cos(pitch), sin(pitch)
    return np.array([[cy, sy * sp, sy * cp], [0.0, cp, -sp], [-sy, cy * sp, cy * cp]])
