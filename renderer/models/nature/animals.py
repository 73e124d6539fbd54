"""Animals: one soft body each, with eyes, ears and the like set into it."""

from __future__ import annotations

import numpy as np

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.forms.blend import Limb, Point, body, chain
from seethrough.renderer.models.forms.shapes import Color, Shape, assemble, join
from seethrough.renderer.models.forms.surfaces import ball, curve, sweep

BLACK: Color = (0.06, 0.05, 0.05)
WHITE: Color = (0.95, 0.94, 0.90)


def mirrored(limbs: list[Limb]) -> list[Limb]:
    """The same limbs on the other side of x = 0."""
    return [Limb(_flip(p.a), _flip(p.b), p.ra, p.rb, p.color, p.flat, p.soft) for p in limbs]


def _flip(p: Point) -> Point:
    return (-p[0], p[1], p[2])


def eye_pair(x: float, y: float, z: float, radius: float, iris: Color = BLACK) -> Shape:
    """Two eyes that look forward and aside, each with a pupil and a glint."""
    out = np.array([0.45, 0.1, -0.9]) * radius
    eye = ball(radius, iris, 10).at(x, y, z)
    pupil = ball(radius * 0.62, BLACK, 8).at(*(np.array([x, y, z]) + out * 0.5))
    glint = ball(radius * 0.3, (1, 1, 1), 6).at(
        *(np.array([x, y, z]) + out * 0.85 + (0, radius * 0.35, 0))
    )
    return join(eye, pupil, glint).both()


def _stripes(places: Floats) -> Floats:
    """How dark a tabby's coat is at (n, 3) places."""
    x, y, z = places.T
    wave = np.sin(30 * z + 7 * np.abs(x) + 3 * np.sin(9 * y))
    return np.clip(1.6 * wave, 0, 1) * np.clip((y - 0.27) * 9, 0, 1)


CAT_FUR: Color = (0.88, 0.52, 0.20)
CAT_LIGHT: Color = (0.97, 0.90, 0.80)


def _cat_half(side: int, fore: float, hind: float) -> list[Limb]:
    """Ear and legs of one side; `fore` and `hind` are how far behind the paws stand."""
    x, fur = 0.085 * side, CAT_FUR
    front = [(x, 0.36, -0.24), (x, 0.2, -0.25 + fore / 2), (x, 0.055, -0.25 + fore)]
    back = [(x, 0.38, 0.27), (x * 1.1, 0.24, 0.24 + hind / 2), (x, 0.16, 0.36 + hind),
            (x, 0.055, 0.33 + hind)]  # fmt: skip
    ear = [(x * 0.95, 0.755, -0.41), (x * 1.28, 0.885, -0.405)]
    return [
        *chain(front, [0.075, 0.05, 0.042], fur),
        _paw(x, 0.035, -0.25 + fore, 0.042, CAT_LIGHT),
        *chain(back, [0.115, 0.075, 0.045, 0.042], fur),
        _paw(x, 0.035, 0.33 + hind, 0.042, CAT_LIGHT),
        *chain(ear, [0.07, 0.006], fur, soft=0.02, flat=(1, 1, 0.5)),
    ]


def _paw(x: float, y: float, z: float, radius: float, color: Color) -> Limb:
    end = (x, y - 0.003, z - 0.055)
    return Limb((x, y, z), end, radius, radius * 0.86, color, soft=0.02)


def whiskers(y: float, z: float, spread: tuple[float, ...]) -> list[Shape]:
    """Pairs of whiskers from either side of a muzzle at (±.05, y, z)."""
    pairs = []
    for d in spread:
        tip = (0.24, y - 0.015 + 2.4 * d, z + 0.01)
        hair = [(0.05, y, z), (0.14, y + 0.005 + d, z - 0.015), tip]
        pairs.append(sweep(hair, [0.004, 0.003, 0.001], WHITE, 4).both())
    return pairs


def cat() -> Shape:
    """A ginger tabby, tail up."""
    fur, light, pink, dark = CAT_FUR, CAT_LIGHT, (0.93, 0.60, 0.58), (0.55, 0.25, 0.07)
    limbs = [
        *chain([(0, 0.44, 0.30), (0, 0.43, 0.05), (0, 0.45, -0.22)], [0.135, 0.15, 0.13], fur,
               flat=(0.86, 1, 1)),
        Limb((0, 0.35, -0.24), (0, 0.37, 0.18), 0.075, 0.09, light),
        *chain([(0, 0.50, -0.28), (0, 0.60, -0.38)], [0.11, 0.10], fur),
        Limb((0, 0.67, -0.43), (0, 0.66, -0.43), 0.145, 0.145, fur, (1.08, 0.94, 0.95), 0.04),
        Limb((0.045, 0.615, -0.555), (0.03, 0.615, -0.545), 0.052, 0.05, light, soft=0.03),
        Limb((-0.045, 0.615, -0.555), (-0.03, 0.615, -0.545), 0.052, 0.05, light, soft=0.03),
        Limb((0, 0.57, -0.53), (0, 0.58, -0.50), 0.035, 0.05, light, soft=0.03),
        Limb((0, 0.68, -0.545), (0, 0.645, -0.58), 0.03, 0.02, fur, soft=0.04),
        Limb((0, 0.45, -0.33), (0, 0.38, -0.30), 0.07, 0.06, light, soft=0.06),
        *_cat_half(1, -0.06, 0.05),
        *_cat_half(-1, 0.05, -0.06),
    ]  # fmt: skip
    tail = curve([(0, 0.50, 0.38), (0, 0.53, 0.52), (0.02, 0.66, 0.60), (0.03, 0.84, 0.58),
                  (0.03, 0.98, 0.62), (0.03, 1.05, 0.70)], 7)  # fmt: skip
    limbs += chain(tail, [0.05, 0.043, 0.04, 0.038, 0.037, 0.036, 0.03], fur, soft=0.04)
    coat = body(limbs, 0.0215).tinted(dark, _stripes)
    inner = ball((0.036, 0.055, 0.012), pink, 10).turned("z", -14).at(0.094, 0.80, -0.438).both()
    nose = ball((0.024, 0.016, 0.016), pink, 8).at(0, 0.648, -0.597)
    eyes = eye_pair(0.066, 0.695, -0.545, 0.033, (0.55, 0.75, 0.20))
    hairs = whiskers(0.615, -0.585, (-0.02, 0.01, 0.035))
    return assemble(coat, inner, nose, eyes, *hairs, size=1.3)


def _dog_half(side: int, fore: float, hind: float) -> list[Limb]:
    """Ear and legs of one side; `fore` and `hind` are how far behind the paws stand."""
    x, e, tan, white = 0.11 * side, 0.01 * side, (0.70, 0.42, 0.18), WHITE
    front = [(x, 0.52, -0.25), (x, 0.30, -0.24 + fore / 2), (x, 0.07, -0.26 + fore)]
    knee = (x * 1.1, 0.38, 0.30 + hind / 2)
    ear = [(10 * e, 1.01, -0.46), (16.5 * e, 0.94, -0.47), (18 * e, 0.80, -0.49),
           (17.5 * e, 0.74, -0.50)]  # fmt: skip
    return [
        *chain(front, [0.105, 0.062, 0.052], white),
        _paw(x, 0.045, -0.26 + fore, 0.054, white),
        *chain([(x, 0.55, 0.34), knee], [0.15, 0.10], tan),
        *chain([knee, (x, 0.24, 0.44 + hind), (x, 0.07, 0.40 + hind)], [0.09, 0.056, 0.05], white),
        _paw(x, 0.045, 0.40 + hind, 0.054, white),
        *chain(ear, [0.05, 0.075, 0.085, 0.05], (0.48, 0.26, 0.10), soft=0.015, flat=(0.42, 1, 1)),
    ]


def dog() -> Shape:
    """A beagle: hanging ears, long muzzle, three colours."""
    tan, saddle, white = (0.70, 0.42, 0.18), (0.16, 0.12, 0.10), WHITE
    limbs = [
        *chain([(0, 0.60, 0.36), (0, 0.58, 0.1), (0, 0.58, -0.22)], [0.15, 0.165, 0.20], saddle,
               flat=(0.85, 1, 1)),
        Limb((0, 0.50, -0.26), (0, 0.52, 0.15), 0.15, 0.12, white, (0.85, 1, 1)),
        Limb((0, 0.56, -0.36), (0, 0.50, -0.34), 0.13, 0.12, white),
        *chain([(0, 0.68, -0.30), (0, 0.84, -0.44)], [0.14, 0.115], tan, soft=0.08),
        Limb((0, 0.93, -0.49), (0, 0.92, -0.53), 0.135, 0.125, tan, soft=0.06),
        Limb((0, 0.865, -0.60), (0, 0.84, -0.78), 0.082, 0.066, white, soft=0.06),
        Limb((0, 0.81, -0.58), (0, 0.79, -0.72), 0.05, 0.04, white, soft=0.04),
        *_dog_half(1, -0.09, 0.07),
        *_dog_half(-1, 0.07, -0.09),
    ]  # fmt: skip
    tail = curve([(0, 0.68, 0.46), (0, 0.80, 0.58), (0, 0.97, 0.62), (0, 1.10, 0.56)], 6)
    limbs += chain(tail, [0.055, 0.05, 0.045, 0.04, 0.035, 0.022], saddle)
    coat = body(limbs, 0.027).tinted(white, lambda p: (p[:, 1] - 1.0) * 40 * (p[:, 2] > 0.45))
    nose = ball((0.045, 0.036, 0.035), BLACK, 10).at(0, 0.875, -0.845)
    band = _tilted_circle((0, 0.745, -0.36), (0, 0.62, -0.75), 0.15)
    collar = sweep(band, 0.022, (0.80, 0.12, 0.10), 6, closed=True)
    eyes = eye_pair(0.073, 0.955, -0.635, 0.026, (0.25, 0.13, 0.05))
    return assemble(coat, nose, collar, eyes, size=1.45)


def _tilted_circle(center: Point, axis: Point, radius: float, n: int = 24) -> Floats:
    """(n, 3) a circle about an axis that lies in the plane x = 0."""
    up = np.array(axis) / np.linalg.norm(axis)
    across = np.array([1.0, 0, 0])
    third = np.cross(up, across)
    angle = 2 * np.pi * np.arange(n)[:, None] / n
    return np.array(center) + radius * (np.cos(angle) * across + np.sin(angle) * third)


BAY: Color = (0.50, 0.25, 0.10)
HORSE_BLACK: Color = (0.09, 0.07, 0.06)


def _horse_half(side: int, fore: float, hind: float) -> list[Limb]:
    """Ear and legs of one side; `fore` and `hind` are how far behind the hooves stand."""
    x, bay, black = 0.16 * side, BAY, HORSE_BLACK
    elbow, knee = (x, 0.92, -0.46 + fore * 0.3), (x, 0.58, -0.47 + fore * 0.8)
    fetlock, hoof = (x, 0.18, -0.45 + fore * 1.2), (x, 0.06, -0.49 + fore * 1.25)
    stifle, hock = (x * 1.05, 0.88, 0.46 + hind * 0.3), (x, 0.62, 0.66 + hind * 0.9)
    pastern, rear_hoof = (x, 0.18, 0.62 + hind * 1.2), (x, 0.06, 0.58 + hind * 1.25)
    ear = [(0.065 * side, 2.02, -0.91), (0.095 * side, 2.17, -0.92)]
    return [
        *chain([(x, 1.14, -0.46), elbow], [0.17, 0.10], bay),
        *chain([elbow, knee], [0.095, 0.066], bay),
        *chain([knee, fetlock], [0.066, 0.048], black),
        *chain([fetlock, hoof], [0.058, 0.085], black, soft=0.03),
        *chain([(x, 1.20, 0.52), stifle], [0.23, 0.13], bay),
        *chain([stifle, hock], [0.12, 0.072], bay),
        *chain([hock, pastern], [0.07, 0.05], black),
        *chain([pastern, rear_hoof], [0.06, 0.085], black, soft=0.03),
        *chain(ear, [0.045, 0.008], bay, soft=0.03, flat=(0.8, 1, 1)),
    ]


def horse() -> Shape:
    """A bay horse in walk, black mane and tail, white blaze."""
    bay, black, muzzle = BAY, HORSE_BLACK, (0.22, 0.13, 0.10)
    limbs = [
        *chain([(0, 1.30, 0.52), (0, 1.24, 0.15), (0, 1.24, -0.15), (0, 1.27, -0.46)],
               [0.26, 0.27, 0.28, 0.25], bay, soft=0.12, flat=(0.88, 1, 1)),
        Limb((0, 1.17, -0.58), (0, 1.22, -0.45), 0.19, 0.2, bay, soft=0.1),
        *chain([(0, 1.34, -0.52), (0, 1.62, -0.76), (0, 1.90, -0.92)], [0.21, 0.155, 0.12], bay,
               soft=0.1, flat=(0.72, 1, 1)),
        *chain([(0, 1.93, -0.97), (0, 1.80, -1.12), (0, 1.62, -1.32)], [0.125, 0.105, 0.078], bay,
               soft=0.06, flat=(0.8, 1, 1)),
        Limb((0, 1.60, -1.33), (0, 1.57, -1.36), 0.078, 0.07, muzzle, (0.85, 1, 1), 0.03),
        *_horse_half(1, -0.20, 0.12),
        *_horse_half(-1, 0.13, -0.18),
    ]  # fmt: skip
    tail = curve([(0, 1.42, 0.74), (0, 1.38, 0.92), (0, 1.05, 1.02), (0, 0.62, 1.0)], 7)
    limbs += chain(tail, [0.06, 0.08, 0.09, 0.095, 0.09, 0.07, 0.03], black, soft=0.04)
    mane = curve([(0, 2.10, -0.97), (0, 2.06, -0.82), (0, 1.84, -0.70), (0, 1.62, -0.56),
                  (0, 1.50, -0.38)], 8)  # fmt: skip
    thickness = [0.04, 0.075, 0.09, 0.10, 0.10, 0.10, 0.08, 0.04]
    limbs += chain(mane, thickness, black, soft=0.03, flat=(0.55, 1, 1))
    coat = body(limbs, 0.04).tinted(WHITE, _blaze)
    eyes = eye_pair(0.098, 1.91, -1.06, 0.025)
    nostrils = ball((0.014, 0.022, 0.022), BLACK, 8).at(0.052, 1.60, -1.395).both()
    return assemble(coat, eyes, nostrils, size=1.9)


def _blaze(p: Floats) -> Floats:
    """How white a horse's face is at (n, 3) places."""
    x, y, z = p.T
    ridge = np.minimum(1.3 - np.abs(x) / 0.04, (y + 0.95 * z - 0.62) / 0.05)
    return 6 * ridge * (z < -0.97) * (y > 1.58)


def bird() -> Shape:
    """A blue songbird on its feet."""
    blue, breast, wing = (0.16, 0.42, 0.80), (0.93, 0.48, 0.18), (0.08, 0.22, 0.52)
    beak, leg = (0.95, 0.72, 0.10), (0.45, 0.28, 0.15)
    limbs = [
        *chain([(0, 0.52, 0.18), (0, 0.55, 0.0), (0, 0.62, -0.16)], [0.15, 0.215, 0.19], blue,
               soft=0.08),
        Limb((0, 0.47, 0.02), (0, 0.56, -0.17), 0.19, 0.19, breast, soft=0.05),
        Limb((0, 0.42, 0.14), (0, 0.44, 0.24), 0.13, 0.09, WHITE, soft=0.06),
        Limb((0, 0.86, -0.25), (0, 0.84, -0.25), 0.165, 0.165, blue, soft=0.08),
        Limb((0, 0.76, -0.32), (0, 0.74, -0.31), 0.12, 0.12, breast, soft=0.05),
        *chain([(0, 0.48, 0.25), (0, 0.36, 0.62)], [0.09, 0.06], wing, 0.06, flat=(1, 0.35, 1)),
        Limb((0.05, 0.36, 0.58), (0.075, 0.30, 0.80), 0.06, 0.05, wing, (1, 0.35, 1), 0.02),
        Limb((-0.05, 0.36, 0.58), (-0.075, 0.30, 0.80), 0.06, 0.05, wing, (1, 0.35, 1), 0.02),
    ]  # fmt: skip
    for s in (1, -1):
        limbs += chain(
            [(0.19 * s, 0.62, -0.12), (0.21 * s, 0.54, 0.10), (0.13 * s, 0.44, 0.42)],
            [0.12, 0.13, 0.035],
            wing,
            soft=0.03,
            flat=(0.4, 1, 1),
        )
        limbs += [Limb((0.09 * s, 0.36, 0.0), (0.09 * s, 0.24, 0.0), 0.06, 0.028, breast)]
    plumage = body(limbs, 0.0235)
    bill = sweep(
        [(0, 0.845, -0.39), (0, 0.838, -0.46), (0, 0.825, -0.60)], [0.058, 0.045, 0.002], beak, 10
    )
    feet = [sweep([(0.09, 0.27, 0.0), (0.09, 0.02, -0.02)], 0.018, leg)]
    for dx, dz in ((-0.07, -0.13), (0, -0.15), (0.07, -0.13), (0, 0.10)):
        feet.append(
            sweep([(0.09, 0.02, -0.02), (0.09 + dx, 0.014, -0.02 + dz)], [0.018, 0.008], leg, 6)
        )
    eyes = eye_pair(0.115, 0.90, -0.345, 0.034)
    return assemble(plumage, bill, eyes, join(*feet).both(), size=1.15)
