"""Perspective cut-away by hand (Coffin and Höllerer 2006): the viewer digs into what is in the way.

Each press of Q digs a hole from where the viewer is, under the pointer, as deep as the pointer
works; the holes stay when the viewer walks on. E deepens the last one, R fills all. A hole is swept
by a ball: what lies nearer to its axis than the radius is removed, and its wall is drawn.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from seethrough.renderer.declared import key
from seethrough.renderer.events import Event, KeyPress, Wheel
from seethrough.renderer.techniques import pointing, removal
from seethrough.renderer.techniques.base import Bools, Floats, Gesture, Shot, Texts
from seethrough.renderer.techniques.pointing import Pointing
from seethrough.renderer.techniques.seen import Look, Surfaces

MOST = 16  # holes: one more, and the first is filled


TEXTS: Texts = {
    "en": {
        "dig.controls": "Q digs a hole under the pointer, through whatever is in the way. E or "
        "the wheel deepens it, R fills all holes.",
        "dig.controls.walking": "Q digs a hole in the middle of the view, through whatever is "
        "in the way. E or the wheel deepens it, R fills all holes.",
    },
    "de": {
        "dig.controls": "Q gräbt unter dem Zeiger ein Loch durch alles, was im Weg steht. E "
        "oder das Rad vertieft es, R füllt alle Löcher.",
        "dig.controls.walking": "Q gräbt in der Mitte des Bildes ein Loch durch alles, was im "
        "Weg steht. E oder das Rad vertieft es, R füllt alle Löcher.",
    },
}


@dataclass(frozen=True)
class DigParameters(removal.Removing):
    """How wide and how deep holes are."""

    radius: float = key(0.8, "of a hole", "world units", low=0, high=1000)
    depth: float = key(12.0, "how deep a new hole is", "world units", low=0.01, high=10_000)
    step: float = key(0.1, "by which share E or the wheel deepens a hole", low=0, high=1)


@dataclass(frozen=True)
class Digging:
    """Where the pointer is, and the axes of the holes: from (x, y, z) to (x, y, z) each."""

    at: Pointing
    holes: tuple[tuple[float, ...], ...] = ()


class Dig(removal.Removal[DigParameters, Digging]):
    """Holes that the viewer digs."""

    name = "dig"
    title = "Digging"
    instruction = (
        "Q digs a hole under the pointer, through whatever is in the way, E deepens it, R fills "
        "all holes."
    )
    source = "Coffin2006"
    misses = "misses R2, R6, R7"
    takes = frozenset({"pointer", "wheel", "key:q", "key:e", "key:r"})
    texts = TEXTS
    Parameters = DigParameters
    removes = f"""
uniform vec3 starts[{MOST}];   // of the holes' axes, from the eye
uniform vec3 ends[{MOST}];
uniform int holes;
uniform float radius;
float apart(vec3 point, int k) {{
    vec3 along = ends[k] - starts[k];
    float t = clamp(dot(point - starts[k], along) / max(dot(along, along), 1e-30), 0.0, 1.0);
    return distance(point, starts[k] + t * along);
}}
bool removed(Surface s) {{
    for (int k = 0; k < holes; k++) if (apart(s.offset, k) < radius) return true;
    return false;
}}
bool pierced(Surface s) {{ return holes > 0; }}
"""

    def begin(self, p: DigParameters) -> Digging:
        """No hole, the pointer in the middle."""
        return Digging(Pointing(None, p.depth))

    def on_event(
        self, p: DigParameters, state: Digging, event: Event, shot: Shot
    ) -> tuple[Digging, bool]:
        """Dig, deepen and fill."""
        word = event.key if isinstance(event, KeyPress) else ""
        if word == "q":
            eye = shot.camera.eye
            end = eye + state.at.direction(shot) * state.at.depth
            axis = (*eye.tolist(), *end.tolist())
            return replace(state, holes=(*state.holes, axis)[-MOST:]), True
        if word == "r":
            return replace(state, holes=()), True
        if word == "e" or isinstance(event, Wheel):
            by = (1 + p.step) ** (event.dy if isinstance(event, Wheel) else 1)
            return replace(state, holes=_deeper(state.holes, by)), True
        at, used = pointing.followed(state.at, event, p.step)
        return replace(state, at=at), used

    def reach(
        self, p: DigParameters, state: Digging, shot: Shot, point: Floats
    ) -> tuple[Gesture, ...]:
        """A hole is dug there, and deepened up to the point."""
        place = pointing.place_of(shot, point)
        if place is None:
            return ()
        deeper = pointing.reaching(replace(state.at, depth=p.depth), shot, point, p.step)[1:]
        return (Gesture("pointer", place), Gesture("key:q"), *deeper)

    def touches(self, p: DigParameters, state: Digging, shot: Shot) -> Bools:
        """What is nearer to a hole's axis than its radius and that of the object's sphere."""
        scene = shot.scene
        found = np.zeros(len(scene.objects), dtype=bool)
        for start, end in _axes(state, np.zeros(3)):
            found |= _apart(scene.centers, start, end) < p.radius + scene.radii
        return found & ~scene.targets & ~scene.impenetrable

    def rule(self, p: DigParameters, state: Digging, seen: Surfaces, known: object) -> Look:
        """Removed near the axis of a hole."""
        signed = np.full(len(seen.depth), -np.inf)
        for start, end in _axes(state, seen.shot.camera.eye):
            signed = np.maximum(signed, p.radius - _apart(seen.offset, start, end))
        touched = self.touches(p, state, seen.shot)[seen.object]
        pierced = np.full(seen.shot.size[0] * seen.shot.size[1], bool(state.holes))
        return removal.look(p, seen, signed, pierced, opened=touched)

    def uniforms(self, p: DigParameters, state: Digging, shot: Shot) -> Mapping[str, object]:
        """The holes' axes."""
        axes = list(_axes(state, shot.camera.eye))
        none = [(np.zeros(3), np.zeros(3))] * (MOST - len(axes))
        return {
            **super().uniforms(p, state, shot),
            "starts": [tuple(a.tolist()) for a, _ in (*axes, *none)],
            "ends": [tuple(b.tolist()) for _, b in (*axes, *none)],
            "holes": len(axes),
            "radius": p.radius,
        }


def _deeper(holes: tuple[tuple[float, ...], ...], by: float) -> tuple[tuple[float, ...], ...]:
    """The last hole, longer by a factor."""
    if not holes:
        return holes
    start, end = np.array(holes[-1][:3]), np.array(holes[-1][3:])
    return (*holes[:-1], (*holes[-1][:3], *(start + by * (end - start)).tolist()))


def _axes(state: Digging, eye: Floats) -> list[tuple[Floats, Floats]]:
    """Start and end of each hole's axis, from a point."""
    return [(np.array(hole[:3]) - eye, np.array(hole[3:]) - eye) for hole in state.holes]


def _apart(points: Floats, start: Floats, end: Floats) -> Floats:
    """(p,) distances of points (p, 3) from the stretch between two others."""
    along = end - start
    t = np.clip((points - start) @ along / max(float(along @ along), 1e-30), 0, 1)
    found: Floats = np.linalg.norm(points - start - t[:, None] * along, axis=1)
    return found


TECHNIQUE = Dig()
