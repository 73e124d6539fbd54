"""Fog, on the CPU as on the GPU: of a colour it leaves 2^(−d / half), with d the distance from the
eye beyond where the fog begins, and puts the background's in place of the rest.

By distance, not by view depth: who turns round sees a thing in as much fog as before. What shows
through something transparent is in the fog between the eye and itself, as often as it is seen.
"""

from __future__ import annotations

import numpy as np

from seethrough.renderer.arrays import Floats
from seethrough.renderer.scene.look import Look


def hazed(
    color: Floats, offset: Floats, background: tuple[float, float, float], look: Look
) -> Floats:
    """(k, 3) colours at (k, 3) offsets from the eye, as seen through the fog."""
    if look.fog <= 0:
        return color
    through = np.maximum(np.linalg.norm(offset, axis=1) - look.fog_start, 0.0)
    left = np.exp2(-through / look.fog)[:, None]
    return np.asarray(background) * (1 - left) + color * left


GLSL = """
#ifdef FOG_COLOR
vec3 hazed(vec3 color, vec3 offset) {
    float left = exp2(-max(length(offset) - FOG_START, 0.0) * FOG_RATE);
    return mix(FOG_COLOR, color, left);
}
#else
vec3 hazed(vec3 color, vec3 offset) { return color; }
#endif
"""
