"""The base of a machinist's vise: 304 polygons, closed volumes, concave, large and small faces.

Our own model of the size and character of Chen1996's figure 15, whose data are lost. It was
fixed while only the BSP baseline had run on it.
"""

from __future__ import annotations

import numpy as np

from seethrough.renderer.models.translucent.solids import Faces, box, disc, prism, turned

# The upper part stands turned on its foot, in radians.
SWIVEL = 0.5


def faces() -> Faces:
    """304 faces; x along the screw, y up, in units of about a centimetre."""
    return [
        *_foot(),
        *turned([*_body(), *_jaws(), *_screw()], SWIVEL),
    ]


def _foot() -> Faces:
    """Swivel plate, two lugs and turntable."""
    plate = prism(disc((0, 0), 7.0, 12, 0.3), 1, 0.0, 1.2, 0.93)
    table = prism(disc((0, 0), 5.2, 10, 0.2), 1, 1.3, 2.4, 0.9)
    lug = [
        (-1.3, 7.1),
        (1.3, 7.1),
        (1.3, 8.6),
        (0.5, 9.4),
        (0.5, 8.3),
        (-0.5, 8.3),
        (-0.5, 9.4),
        (-1.3, 8.6),
    ]
    lugs = prism(lug, 1, 0.2, 1.0, 0.9) + prism([(-z, -x) for z, x in lug], 1, 0.2, 1.0, 0.9)
    return plate + table + lugs


def _body() -> Faces:
    """The channel the slide runs in, its ribs, the anvil behind it, and the pads beside it."""
    channel = [
        (2.5, -2.0), (2.5, 2.0), (7.0, 2.0), (7.0, 1.4), (4.0, 1.4), (4.0, -1.4), (7.0, -1.4),
        (7.0, -2.0),
    ]  # fmt: skip
    anvil = [
        (-9.0, 4.2), (-5.2, 4.2), (-5.2, 8.2), (-6.0, 8.2), (-6.0, 7.4), (-8.2, 7.4),
        (-8.2, 6.6), (-9.0, 6.6),
    ]  # fmt: skip
    horn = prism([(-11.5, 5.2), (-9.1, 4.4), (-9.1, 6.4), (-11.5, 5.9)], 2, -0.7, 0.7, 0.6)
    pads = box((-4.0, 4.6, 2.1), (4.0, 5.4, 2.6)) + box((-4.0, 4.6, -2.6), (4.0, 5.4, -2.1))
    ribs: Faces = []
    for sign in (-1.0, 1.0):
        web = [(2.5, sign * 2.05), (2.5, sign * 4.6), (4.3, sign * 2.05)]
        ribs += prism(web, 0, -3.0, -2.5, 0.8) + prism(web, 0, 2.5, 3.0, 0.8)
    return ribs + (
        prism([(y, z) for y, z in channel], 0, -5.0, 5.0)
        + prism(anvil, 2, -1.8, 1.8, 0.85)
        + horn
        + pads
    )


def _jaws() -> Faces:
    """Fixed and moving jaw with their serrated plates, and the slide."""
    fixed = [
        (-5.0, 7.1), (-2.6, 7.1), (-1.4, 8.4), (-1.4, 11.0), (-3.0, 11.0), (-3.0, 9.6),
        (-4.2, 8.4), (-5.0, 8.4),
    ]  # fmt: skip
    moving = [(8.6 - x, y) for x, y in fixed]
    slide = [
        (4.6, -1.2), (5.5, -1.2), (5.5, -0.7), (6.4, -0.7), (6.4, 0.7), (5.5, 0.7), (5.5, 1.2),
        (4.6, 1.2),
    ]  # fmt: skip
    tooth = 0.55
    saw = [(-1.3, 10.9), (-1.3, 8.6)]
    for i in range(4):
        saw += [(-0.7, 8.6 + tooth * i), (-0.9, 8.6 + tooth * (i + 0.9))]
    other = [(8.6 - x, y) for x, y in saw]
    return (
        prism(fixed, 2, -3.0, 3.0, 0.9)
        + prism(moving, 2, -3.0, 3.0, 0.9)
        + prism(slide, 0, -4.6, 12.8, 0.9)
        + prism(saw, 2, -2.8, 2.8)
        + prism(other, 2, -2.8, 2.8)
    )


def _screw() -> Faces:
    """A winding thread in two slit nuts, the handle with its knobs, and two guide rods."""
    parts: Faces = []
    for i in range(12):
        a, b = 1.1 * i, 1.1 * i + 1.3
        flight = [(0.1, a), (0.62, a), (0.62, b)]
        wedge = [(3.3 + r * float(np.cos(t)), r * float(np.sin(t))) for r, t in flight]
        parts += prism(wedge, 0, 6.0 + 0.45 * i, 6.35 + 0.45 * i, 0.75)
    angles = np.linspace(0.3, 2 * np.pi - 0.3, 8) + 0.9
    ring = [(3.3 + 1.1 * float(np.cos(a)), 1.1 * float(np.sin(a))) for a in angles]
    ring += [(3.3 + 0.8 * float(np.cos(a)), 0.8 * float(np.sin(a))) for a in angles[::-1]]
    parts += prism(ring, 0, 6.1, 8.6, 0.97) + prism(ring, 0, 8.8, 11.2, 0.97)
    handle: Faces = []
    for sign in (-1.0, 1.0):
        low, high = sorted((sign * 1.0, sign * 6.0))
        handle += prism(disc((13.5, 3.3), 0.3, 6, 0.35), 2, low, high)
        low, high = sorted((sign * 6.1, sign * 6.9))
        handle += prism(disc((13.5, 3.3), 0.55, 6, 0.35), 2, low, high, 0.8)
    parts += turned(handle, 0.6, (3.3, 0.0), axis=0)
    for z in (-2.45, 2.45):
        parts += prism(disc((5.9, z), 0.35, 7, 0.3), 0, -8.4, 11.0, 0.6)
    return parts
