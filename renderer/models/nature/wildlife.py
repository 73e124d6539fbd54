"""An elephant and a rabbit."""

from __future__ import annotations

import numpy as np

from seethrough.renderer.models.forms.blend import Limb as L
from seethrough.renderer.models.forms.blend import body, chain
from seethrough.renderer.models.forms.shapes import Color, Shape, assemble
from seethrough.renderer.models.forms.surfaces import ball, curve, sweep
from seethrough.renderer.models.nature.animals import BLACK, WHITE, eye_pair, mirrored, whiskers

HIDE: Color = (0.50, 0.50, 0.53)


def _elephant_half(side: int, fore: float, hind: float) -> list[L]:
    """Ear, legs and toes of one side; `fore` and `hind` are how far behind the feet stand."""
    x, ear, nail = side * 0.30, (0.44, 0.43, 0.46), (0.85, 0.82, 0.75)
    front = [(x, 1.15, -0.45), (x, 0.6, -0.47 + fore / 2), (x, 0.1, -0.45 + fore)]
    back = [(x, 1.1, 0.55), (x, 0.62, 0.56 + hind / 2), (x, 0.1, 0.62 + hind)]
    toes = [(x + dx, 0.05, z - 0.15) for z in (front[2][2], back[2][2]) for dx in (-0.09, 0, 0.09)]
    flap = [
        L((0.36, 1.66, -0.78), (0.72, 1.62, -0.60), 0.2, 0.24, ear, (1, 1, 0.34), 0.06),
        L((0.40, 1.40, -0.76), (0.70, 1.32, -0.60), 0.24, 0.2, ear, (1, 1, 0.34), 0.06),
        L((0.50, 1.12, -0.70), (0.58, 1.06, -0.66), 0.16, 0.12, ear, (1, 1, 0.4), 0.06),
    ]
    return [
        *chain(front, [0.27, 0.185, 0.175], HIDE, soft=0.08),
        *chain(back, [0.32, 0.19, 0.175], HIDE, soft=0.08),
        *(L(toe, toe, 0.05, 0.05, nail, soft=0.01) for toe in toes),
        *(flap if side > 0 else mirrored(flap)),
    ]


def elephant() -> Shape:
    """An African elephant: wide ears, trunk, tusks."""
    grey = HIDE
    trunk = curve([(0, 1.55, -1.15), (0, 1.25, -1.36), (0, 0.85, -1.42), (0, 0.45, -1.42),
                   (0, 0.28, -1.56), (0, 0.34, -1.72)], 10)  # fmt: skip
    limbs = [
        *chain([(0, 1.30, 0.55), (0, 1.36, 0.0), (0, 1.34, -0.40)], [0.50, 0.58, 0.52], grey,
               soft=0.15, flat=(0.86, 1, 1)),
        L((0, 1.62, -0.92), (0, 1.50, -0.86), 0.33, 0.34, grey, (0.92, 1, 1), 0.15),
        L((0, 1.86, -0.90), (0, 1.84, -0.86), 0.2, 0.2, grey, (1.2, 1, 1), 0.15),
        L((0, 1.28, -1.02), (0, 1.22, -1.05), 0.14, 0.1, grey, soft=0.1),
        *chain(trunk, np.linspace(0.2, 0.07, 10), grey, soft=0.06),
        *_elephant_half(1, -0.14, 0.08),
        *_elephant_half(-1, 0.10, -0.12),
    ]  # fmt: skip
    bow = curve(
        [(0.19, 1.32, -1.1), (0.22, 1.12, -1.3), (0.21, 1.05, -1.52), (0.17, 1.1, -1.72)], 14
    )
    tusk = sweep(bow, np.linspace(0.06, 0.012, 14), (0.96, 0.93, 0.84), 12).both()
    bow = curve([(0, 1.45, 1.0), (0, 1.2, 1.14), (0, 0.8, 1.14)], 10)
    tail = sweep(bow, np.linspace(0.05, 0.02, 10), grey)
    tuft = ball((0.05, 0.12, 0.05), BLACK, 12).at(0, 0.74, 1.14)
    eyes = eye_pair(0.285, 1.66, -1.10, 0.04)
    return assemble(body(limbs, 0.062), tusk, tail, tuft, eyes, size=1.9)


def rabbit() -> Shape:
    """A sitting rabbit with tall ears."""
    fur, light, pink = (0.62, 0.52, 0.42), WHITE, (0.90, 0.62, 0.62)
    limbs = [
        *chain([(0, 0.34, 0.22), (0, 0.42, 0.02), (0, 0.50, -0.20)], [0.28, 0.27, 0.19], fur,
               soft=0.1),
        L((0, 0.36, -0.22), (0, 0.26, -0.10), 0.16, 0.18, light, soft=0.06),
        *chain([(0, 0.60, -0.26), (0, 0.72, -0.34)], [0.15, 0.14], fur, soft=0.08),
        L((0, 0.76, -0.36), (0, 0.72, -0.48), 0.155, 0.10, fur, (0.9, 1, 1), 0.05),
        L((0, 0.67, -0.53), (0, 0.66, -0.50), 0.055, 0.06, light, soft=0.04),
    ]  # fmt: skip
    half = [
        L((0.055, 0.68, -0.545), (0.04, 0.68, -0.53), 0.042, 0.04, light, soft=0.03),
        *chain([(0.06, 0.88, -0.30), (0.085, 1.08, -0.25), (0.11, 1.30, -0.21),
                (0.12, 1.42, -0.20)], [0.05, 0.082, 0.075, 0.03], fur, soft=0.03, flat=(1, 1, 0.5)),
        L((0.20, 0.30, 0.20), (0.22, 0.20, 0.06), 0.21, 0.15, fur, soft=0.06),
        *chain([(0.22, 0.07, 0.20), (0.22, 0.06, -0.16)], [0.075, 0.062], fur, soft=0.04),
        *chain([(0.11, 0.34, -0.26), (0.11, 0.16, -0.32), (0.11, 0.05, -0.38)],
               [0.10, 0.066, 0.058], fur),
    ]  # fmt: skip
    tail = L((0, 0.30, 0.50), (0, 0.31, 0.51), 0.12, 0.11, light, soft=0.02)
    coat = body([*limbs, *half, *mirrored(half), tail], 0.03)
    inner = ball((0.035, 0.19, 0.012), pink, 14).turned("x", 10).turned("z", -7)
    inner = inner.at(0.094, 1.16, -0.282)
    nose = ball((0.026, 0.018, 0.018), pink, 10).at(0, 0.715, -0.582)
    eyes = eye_pair(0.118, 0.79, -0.445, 0.036)
    hairs = whiskers(0.675, -0.575, (-0.02, 0.015))
    return assemble(coat, inner.both(), nose, eyes, *hairs, size=1.3)
