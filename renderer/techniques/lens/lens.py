"""Magic lens (Ropinski and Hinrichs 2004): what stands in a volume under the pointer is removed.

A tube reaches from the eye to a depth, and looks round about the pointer; a ball hangs there in
mid-air, about the depth, and looks as large. Pointer, wheel and keys move it. It removes whether
there is a target or not: the viewer has to look for one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from seethrough.renderer.declared import key
from seethrough.renderer.events import Event
from seethrough.renderer.techniques import pointing, reaching, removal
from seethrough.renderer.techniques.base import Bools, Floats, Gesture, Shot, Texts
from seethrough.renderer.techniques.pointing import Pointing
from seethrough.renderer.techniques.seen import Look, Surfaces

SHAPES = ("tube", "ball")


TEXTS: Texts = {
    "en": {
        "lens.controls": "Whatever stands in the lens under the pointer is not shown. Q and "
        "E, or the wheel, bring the lens nearer and move it farther away.",
        "lens.controls.walking": "Whatever stands in the lens in the middle of the view is not "
        "shown. Q and E, or the wheel, bring the lens nearer and move it farther away.",
    },
    "de": {
        "lens.controls": "Was in der Linse unter dem Zeiger steht, wird nicht gezeigt. Q und "
        "E oder das Rad holen die Linse näher und schieben sie weiter weg.",
        "lens.controls.walking": "Was in der Linse in der Mitte des Bildes steht, wird nicht "
        "gezeigt. Q und E oder das Rad holen die Linse näher und schieben sie weiter weg.",
    },
}


@dataclass(frozen=True)
class LensParameters(removal.Removing):
    """Shape, size and place of the lens."""

    shape: str = key("tube", "what the lens removes: all up to its depth, or about it",
                     choices=SHAPES)  # fmt: skip
    radius: float = key(0.15, "how large the lens looks", "heights of the view", low=0, high=10)
    depth: float = key(
        12.0, "how far the lens is from the viewer at first", "world units", low=0.01, high=10_000
    )
    step: float = key(0.1, "by which share a key or the wheel moves it", low=0, high=1)


class Lens(removal.Removal[LensParameters, Pointing]):
    """A volume under the pointer in which nothing penetrable is shown."""

    name = "lens"
    title = "Magic lens"
    instruction = (
        "Whatever stands in the lens under the pointer is not shown: Q and E move it nearer and "
        "farther."
    )
    source = "Ropinski2004"
    misses = "misses R2, R6, R7"
    takes = frozenset({"pointer", "wheel", "key:q", "key:e"})
    texts = TEXTS
    Parameters = LensParameters
    removes = """
uniform bool ball;
uniform vec3 middle;     // from the eye
uniform float ballRadius;
uniform vec2 pixel;
uniform float pixels;
uniform float end;
bool removed(Surface s) {
    if (ball) return distance(s.offset, middle) < ballRadius;
    return s.depth < end && distance(s.place, pixel) < pixels;
}
bool pierced(Surface s) {
    if (!ball) return distance(s.place, pixel) < pixels;
    vec3 ray = normalize(s.offset);
    return length(middle - ray * dot(ray, middle)) < ballRadius;
}
"""

    def begin(self, p: LensParameters) -> Pointing:
        """At the middle of the view, at its first depth."""
        return Pointing(None, p.depth)

    def on_event(
        self, p: LensParameters, state: Pointing, event: Event, shot: Shot
    ) -> tuple[Pointing, bool]:
        """The pointer carries it, keys and wheel move it away."""
        return pointing.followed(state, event, p.step)

    def reach(
        self, p: LensParameters, state: Pointing, shot: Shot, point: Floats
    ) -> tuple[Gesture, ...]:
        """The pointer goes there, the wheel brings it as far."""
        return pointing.reaching(state, shot, point, p.step)

    def touches(self, p: LensParameters, state: Pointing, shot: Shot) -> Bools:
        """What reaches into the rectangle about the lens, and nearer than its end."""
        x, y = state.pixel(shot)
        half = p.radius * shot.size[1]
        end = state.depth + (_ball(p, state, shot)[1] if p.shape == "ball" else 0.0)
        # A ball beside the middle of the picture looks a little longer than it is wide.
        half *= 2.0 if p.shape == "ball" else 1.0
        box = np.array([[x - half - 1, y - half - 1, x + half + 1, y + half + 1]])
        if p.shape == "ball" and 2 * p.radius * np.tan(shot.camera.fov_y / 2) >= 0.5:
            box = reaching.whole(shot, 1)
        return reaching.reached(shot, box, np.array([end]))

    def rule(self, p: LensParameters, state: Pointing, seen: Surfaces, known: object) -> Look:
        """Removed in the tube or ball."""
        x, y = state.pixel(seen.shot)
        width, height = seen.shot.size
        if p.shape == "ball":
            middle, radius = _ball(p, state, seen.shot)
            signed = radius - np.linalg.norm(seen.offset - middle, axis=1)
            ray = seen.offset / np.linalg.norm(seen.offset, axis=1, keepdims=True)
            passing = np.linalg.norm(middle - ray * (ray @ middle)[:, None], axis=1)
            pierced = np.zeros(width * height, dtype=bool)
            pierced[seen.pixel[passing < radius]] = True
            doubt = ~seen.front & (np.abs(passing - radius) < removal.uncertain(seen))
            return removal.look(p, seen, signed, pierced, doubt)
        column, row = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
        inside = p.radius * height - np.hypot(column - x, row - y).ravel()
        before = state.depth - seen.depth
        signed = np.where(inside[seen.pixel] > 0, before, -np.inf)
        doubt = (np.abs(inside) < 1e-3)[seen.pixel] & (before > 0)
        return removal.look(p, seen, signed, inside > 0, doubt)

    def uniforms(self, p: LensParameters, state: Pointing, shot: Shot) -> Mapping[str, object]:
        """Where the lens is and how large."""
        middle, radius = _ball(p, state, shot)
        return {
            **super().uniforms(p, state, shot),
            "ball": p.shape == "ball",
            "middle": tuple(middle.tolist()),
            "ballRadius": radius,
            "pixel": state.pixel(shot),
            "pixels": p.radius * shot.size[1],
            "end": state.depth,
        }


def _ball(p: LensParameters, state: Pointing, shot: Shot) -> tuple[Floats, float]:
    """The middle of the ball from the eye, and its radius in world units."""
    radius = p.radius * 2 * np.tan(shot.camera.fov_y / 2) * state.depth
    return state.direction(shot) * state.depth, float(radius)


TECHNIQUE = Lens()
