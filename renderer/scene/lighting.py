"""The light that every picture is shaded with, on the GPU and in the reference.

A sky and a ground, a key light from the upper left and a little light from the viewer, so that
shape reads from every side. The light is white and there is no gloss: a red target stays pure
red, and a distractor gets no red. Colours are display values (gamma 2): a colour times the root
of the light that falls on it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

GROUND = 0.16
SKY = 0.38
KEY = 0.46
HEAD = 0.14
_FROM_THE_UPPER_LEFT = np.array([-0.42, 0.72, 0.55])
KEY_DIRECTION = _FROM_THE_UPPER_LEFT / np.linalg.norm(_FROM_THE_UPPER_LEFT)


def shade(normals: NDArray[np.float64], to_eye: NDArray[np.float64]) -> NDArray[np.float64]:
    """(...,) factor on display colours; `normals` and `to_eye` (..., 3) need not be unit length."""
    n = normals / np.linalg.norm(normals, axis=-1, keepdims=True)
    v = to_eye / np.linalg.norm(to_eye, axis=-1, keepdims=True)
    sky = 0.5 + 0.5 * n[..., 1]
    key = np.maximum(n @ KEY_DIRECTION, 0.0)
    head = np.maximum((n * v).sum(axis=-1), 0.0)
    return np.sqrt(GROUND + (SKY - GROUND) * sky + KEY * key + HEAD * head)


def glsl() -> str:
    """The same as a GLSL function `float shade(vec3 normal, vec3 to_eye)`, and its parts."""
    x, y, z = KEY_DIRECTION
    return f"""
float steady(vec3 n) {{  // light that falls on a surface of unit normal from wherever it is seen
    float sky = 0.5 + 0.5 * n.y;
    float key = max(dot(n, vec3({x:.9f}, {y:.9f}, {z:.9f})), 0.0);
    return {GROUND} + {SKY - GROUND:.9f} * sky + {KEY} * key;
}}

float bright(float steady_light, float head) {{
    return sqrt(steady_light + {HEAD} * max(head, 0.0));
}}

float shade(vec3 normal, vec3 to_eye) {{
    vec3 n = normalize(normal);
    return bright(steady(n), dot(n, normalize(to_eye)));
}}
"""
