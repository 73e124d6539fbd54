"""What is drawn on a floor, on the CPU as on the GPU: lines of a grid, and shadows.

A floor is what is of kind "floor", seen from above. Lines are averaged over the ellipse that a
pixel covers on the floor, taken as a box along each axis: what is far away turns into an even tone
instead of into noise. All of it follows from where the eye is, not from where it looks.
"""

from __future__ import annotations

import numpy as np

from seethrough.renderer.arrays import Bools, Floats
from seethrough.renderer.scene.look import Look

KIND = "floor"
STEEP = 0.5  # the least cosine between a floor's surface and the vertical
WIDTH = 0.03  # of a line, as a part of the distance between lines
# Texels of the map of shadows that lie side by side, the last as the first of the next strip: what
# is near on the floor is near in memory, where a software rasteriser otherwise waits for each row.
STRIP = 32
DARK = 0.35  # how much of the floor's colour a line takes


def painted(
    color: Floats, offset: Floats, normal: Floats, eye: Floats, pixel: float, look: Look
) -> Floats:
    """(k, 3) lit colours of floors with what is drawn on them: `offset` (k, 3) from the eye to the
    surface, `normal` (k, 3), both in the world; `pixel` is the slope that a pixel spans."""
    up = facing_up(normal)
    return np.where(up[:, None], color * (1 - DARK * _lines(offset, eye, pixel, look)), color)


def facing_up(normal: Floats) -> Bools:
    """(k,) which of a floor's surfaces are drawn on."""
    return np.asarray(normal[:, 1] > STEEP * np.linalg.norm(normal, axis=1))


def _lines(offset: Floats, eye: Floats, pixel: float, look: Look) -> Floats:
    """(k, 1) how much of a pixel's floor are lines."""
    if look.floor_grid <= 0:
        return np.zeros((len(offset), 1))
    far = np.linalg.norm(offset, axis=1)
    flat = offset[:, ::2]
    level = np.maximum(np.linalg.norm(flat, axis=1), 1e-9)
    across = 0.5 * pixel * far
    along = across * far / np.maximum(np.abs(offset[:, 1]), 1e-9)
    left = np.ones(len(offset))
    for k in range(2):
        own, other = flat[:, k] / level, flat[:, 1 - k] / level
        half = np.hypot(along * own, across * other)
        left *= 1 - _covered(flat[:, k] + eye[2 * k], half, look.floor_grid)
    return (1 - left)[:, None]


def _covered(place: Floats, half: Floats, period: float) -> Floats:
    """(k,) the part of [place − half, place + half] within lines about multiples of a period."""
    width = WIDTH * period
    a, b = place - half + width / 2, place + half + width / 2
    return (_within(b, period, width) - _within(a, period, width)) / (2 * half)


def _within(x: Floats, period: float, width: float) -> Floats:
    """(k,) how much of [0, x] lies within [m·period, m·period + width]."""
    turns = np.floor(x / period)
    return turns * width + np.minimum(x - turns * period, width)


def floors(kinds: tuple[str, ...]) -> Bools:
    """(n,) which objects are floors."""
    return np.array([kind == KIND for kind in kinds], dtype=bool)


# Where each triangle of a floor has one normal and one colour (`flat`), a vertex knows what its
# pixels would all work out, and whether they are drawn on: from this cosine on.
FLAT = f"FLOOR_FLAT {STEEP}"

GLSL = f"""
#ifdef FLOOR
uniform vec3 eye;
uniform float pixel;  // the slope that a pixel spans
flat in float on_floor;
uniform sampler2DArray shadows;  // what is left of the floor's colour, over the floor, in strips
uniform vec4 shadows_place;  // the middle of its first texel along x, its lowest z; texels for a
                             // unit along x, 1 / its side along z
#ifdef FLOOR_FLAT
flat in vec3 floor_color;
flat in vec4 floor_light;    // unit normal, light from wherever it is seen
in vec2 shadows_at;          // where on the map
#endif

float within(float x, float period, float width) {{
    float turns = floor(x / period);
    return turns * width + min(x - turns * period, width);
}}

float shadow(vec2 at) {{
    float strip = floor(at.x * {1 / (STRIP - 1):.9e});
    float along = at.x * {1 / STRIP:.9e} - ({1 - 1 / STRIP:.9e} * strip - {0.5 / STRIP:.9e});
    return texture(shadows, vec3(along, at.y, strip)).r;
}}

float line(float place, float wide, float period) {{
    float width = {WIDTH} * period, a = place - wide + 0.5 * width, b = place + wide + 0.5 * width;
    return (within(b, period, width) - within(a, period, width)) / (2.0 * wide);
}}

vec3 painted(vec3 color, vec3 normal, vec3 offset) {{
#ifdef FLOOR_FLAT
    float shown = on_floor;
#else
    float shown = on_floor > 0.0 && normal.y > {STEEP} * length(normal) ? 1.0 : 0.0;
    vec2 shadows_at = (offset.xz + eye.xz - shadows_place.xy) * shadows_place.zw;
#endif
    float left = 1.0;
#ifdef FLOOR_GRID
    float far = length(offset), across = 0.5 * pixel * far;
    float along = across * far / max(abs(offset.y), 1e-9);
    vec2 way = offset.xz / max(length(offset.xz), 1e-9);
    vec2 wide = sqrt(along * along * way * way + across * across * way.yx * way.yx);
    vec2 place = offset.xz + eye.xz;
    left *= 1.0 - line(place.x, wide.x, FLOOR_GRID);
    left *= 1.0 - line(place.y, wide.y, FLOOR_GRID);
    left = 1.0 - {DARK} * (1.0 - left);
#endif
#ifdef FLOOR_SHADOWS
    left *= shadow(shadows_at);
#endif
    return color * max(left, 1.0 - shown);
}}
#else
vec3 painted(vec3 color, vec3 normal, vec3 offset) {{ return color; }}
#endif
"""
