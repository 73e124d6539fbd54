"""Fading about the pointer (Gutwin, Dyck and Fedak 2003): opacity by distance from the pointer.

Within the radius things have the least opacity, and it rises to 1 over the softness beyond: on the
screen, whatever their depth.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seethrough.renderer.declared import key
from seethrough.renderer.events import Event, PointerMove
from seethrough.renderer.techniques import pointing, reaching
from seethrough.renderer.techniques.base import Bools, Shot, Texts
from seethrough.renderer.techniques.layered import Layered, Layering
from seethrough.renderer.techniques.pointing import Pointing
from seethrough.renderer.techniques.seen import Look, Surfaces

TEXTS: Texts = {
    "en": {
        "fade.controls": "Whatever is near the pointer turns transparent.",
        "fade.controls.walking": "Whatever is in the middle of the view turns transparent.",
    },
    "de": {
        "fade.controls": "Was nahe beim Zeiger ist, wird durchsichtig.",
        "fade.controls.walking": "Was in der Mitte des Bildes ist, wird durchsichtig.",
    },
}


@dataclass(frozen=True)
class FadeParameters(Layered):
    """How clear things are about the pointer, and how far about it."""

    least: float = key(0.15, "opacity at the pointer", low=0, high=1)
    radius: float = key(
        0.12, "how far about the pointer they are as clear", "heights of the view", low=0, high=10
    )
    softness: float = key(
        0.12, "over how far beyond they become opaque", "heights of the view", low=0.001, high=10
    )


class Fade(Layering[FadeParameters, Pointing]):
    """Clear about the pointer, opaque elsewhere."""

    name = "fade"
    title = "Fading about the pointer"
    instruction = "Whatever is near the pointer turns transparent."
    source = "Gutwin2003"
    misses = "misses R4 (two dimensions)"
    takes = frozenset({"pointer"})
    texts = TEXTS
    Parameters = FadeParameters
    strength = """
uniform vec2 pixel;
uniform float near_;
uniform float soft;
uniform float least;
float opacity_of(Surface s) {
    return mix(least, 1.0, clamp((distance(s.place, pixel) - near_) / soft, 0.0, 1.0));
}
"""

    def begin(self, p: FadeParameters) -> Pointing:
        """At the middle of the view."""
        return Pointing(None, 1.0)

    def on_event(
        self, p: FadeParameters, state: Pointing, event: Event, shot: Shot
    ) -> tuple[Pointing, bool]:
        """The pointer carries it."""
        if not isinstance(event, PointerMove):
            return state, False
        return pointing.followed(state, event, 0.0)

    def touches(self, p: FadeParameters, state: Pointing, shot: Shot) -> Bools:
        """What reaches into the square about the pointer."""
        half = (p.radius + p.softness) * shot.size[1] + 1
        x, y = state.pixel(shot)
        box = np.array([[x - half, y - half, x + half, y + half]])
        return reaching.reached(shot, box, np.array([np.inf]))

    def rule(self, p: FadeParameters, state: Pointing, seen: Surfaces, known: object) -> Look:
        """By the distance of the pixel from the pointer."""
        height = seen.shot.size[1]
        away = np.hypot(*(seen.place - state.pixel(seen.shot)).T) / height
        rise = np.clip((away - p.radius) / p.softness, 0, 1)
        ruled = self.touches(p, state, seen.shot)[seen.object]
        alpha = np.where(ruled, p.least + (1 - p.least) * rise, 1.0)
        return self.look(p, seen, alpha)

    def uniforms(self, p: FadeParameters, state: Pointing, shot: Shot) -> dict[str, object]:
        """Where the pointer is, and the distances, in pixels."""
        height = shot.size[1]
        return {
            **super().uniforms(p, state, shot),
            "pixel": state.pixel(shot),
            "near_": p.radius * height,
            "soft": p.softness * height,
            "least": p.least,
        }


TECHNIQUE = Fade()
