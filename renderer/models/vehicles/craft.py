"""What flies or floats, facing −z."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.forms.shapes import Color, Shape, assemble, join
from seethrough.renderer.models.forms.surfaces import (
    box,
    circle,
    copies,
    disc,
    lathe,
    pillow,
    ring,
    rod,
    sweep,
    tube,
)
from seethrough.renderer.models.vehicles.wheels import GLASS, STEEL, tyre, wing

WHITE: Color = (0.94, 0.94, 0.95)
DARK: Color = (0.12, 0.12, 0.13)


def _round_hull(z: Floats, radius: Floats, y: Floats, color: Color, sides: int = 32) -> Shape:
    """Circles along +z, their centres at the heights y."""
    flat = circle(sides)
    rings = np.empty((len(z), sides, 3))
    rings[..., :2] = radius[:, None, None] * flat
    rings[..., 1] += y[:, None]
    rings[..., 2] = z[:, None]
    return tube(rings, color)


BLUE: Color = (0.10, 0.28, 0.62)
SILVER: Color = (0.80, 0.82, 0.86)


def _fuselage() -> Shape:
    """White above, a blue band below the windows, grey underneath."""
    places = [-2.2, -2.17, -2.08, -1.95, -1.75, -1.5, -1.2, 0.9, 1.5, 2.1, 2.3]
    radii = [0, 0.07, 0.15, 0.21, 0.265, 0.295, 0.3, 0.3, 0.22, 0.09, 0.03]
    z = np.array([*places[:7], *np.linspace(-1.0, 0.9, 14), 1.2, 1.5, 1.8, 2.1, 2.3])
    y = 0.75 + np.interp(z, [-2.2, -1.75, -1.2, 0.9, 2.3], [-0.07, -0.02, 0, 0, 0.16])

    def steep(p: Floats) -> Floats:
        """Sine of the angle about the fuselage's middle line, so that borders follow its rings."""
        up = p[:, 1] - np.interp(p[:, 2], z, y)
        return up / np.hypot(p[:, 0], up)

    tube_ = _round_hull(z, np.interp(z, places, radii), y, WHITE)
    tube_ = tube_.painted((0.78, 0.80, 0.83), lambda p: steep(p) < -0.4)
    return tube_.painted(BLUE, lambda p: np.abs(steep(p) + 0.2) < 0.2)


def _jet() -> Shape:
    """The engine under the right wing, with its pylon."""
    case = [(0.15, -0.3), (0.17, 0.0), (0.16, 0.2), (0.13, 0.21), (0.11, -0.05), (0.11, -0.3)]
    core = [(0, -0.42), (0.06, -0.32), (0.10, -0.2), (0.10, 0.09), (0.02, 0.16), (0, 0.165)]
    engine = join(
        ring(case, BLUE, 28, sharp=60),
        disc(0.115, 0.02, DARK, 24).at(y=0.1),
        lathe(core, STEEL, 20),
    ).turned("x", -90)
    pylon = box((0.03, 0.16, 0.4), WHITE, 0.01).at(0.82, 0.58, -0.02)
    return join(engine.at(0.82, 0.43, -0.18), pylon)


def plane() -> Shape:
    """A passenger jet on its wheels."""
    nose = box((0.34, 0.085, 0.16), GLASS, 0.02).turned("x", -38).at(y=0.885, z=-1.93)
    panes = [(0.285, 0.82, v) for v in np.linspace(-1.4, 1.1, 26)]
    windows = copies(pillow((0.045, 0.075, 0.045), GLASS, 0.6, 8), panes).both()
    main = wing((0.12, 0.60, -0.55), 1.05, (2.05, 0.78, 0.62), 0.34, 0.12, SILVER, 10, 24)
    tip = wing((2.03, 0.78, 0.61), 0.34, (2.16, 1.0, 0.82), 0.2, 0.1, BLUE, 4, 16)
    tail = wing((0.05, 0.90, 1.62), 0.52, (0.82, 0.98, 2.02), 0.25, 0.1, SILVER, 6, 20)
    fin = wing((0, 0, 1.45), 0.75, (0.95, 0, 2.1), 0.38, 0.09, BLUE, 8, 20)
    fin = fin.turned("z", 90).at(y=0.9)
    leg = join(tyre(0.12, 0.08, 0.06, 20, 2), disc(0.065, 0.09, STEEL, 16).turned("z", 90))
    gear = join(
        leg.at(0.28, 0.12, 0.25),
        leg.at(0.40, 0.12, 0.25),
        rod((0.34, 0.1, 0.25), (0.34, 0.6, 0.2), 0.025, STEEL),
    )
    front = join(leg.at(0.05, 0.12, -1.5), rod((0.0, 0.12, -1.5), (0, 0.55, -1.5), 0.025, STEEL))
    sides = join(main, tip, tail, _jet(), gear).both()
    return assemble(_fuselage(), nose, windows, sides, fin, front, size=2.0)


def boat() -> Shape:
    """A sailing boat with two sails."""
    navy, wood, sail = (0.10, 0.20, 0.45), (0.66, 0.44, 0.22), (0.96, 0.94, 0.88)
    z = np.linspace(-1.5, 1.3, 30)
    t = (z + 1.5) / 2.8
    w = 0.52 * np.clip(np.sin(np.pi * np.clip(t * 0.62 + 0.02, 0, 1)) ** 0.8, 0.02, 1)
    deck = 0.62 + 0.20 * (1 - t) ** 2 + 0.03 * t**2
    keel = (
        0.16
        + 0.42 * np.clip((0.28 - t) / 0.28, 0, 1) ** 1.6
        + 0.16 * np.clip((t - 0.6) / 0.4, 0, 1) ** 2
    )
    rings = [_section(*at) for at in zip(z, w, deck, keel, strict=True)]
    shell = tube(rings, navy).painted((0.68, 0.14, 0.12), lambda p: p[:, 1] < 0.36)
    shell = shell.painted((0.95, 0.94, 0.9), lambda p: (p[:, 1] > 0.36) & (p[:, 1] < 0.44))
    shell = shell.painted(wood, _on_deck)
    edge = np.column_stack([w, deck + 0.015, z])
    rail = sweep(edge, 0.028, wood, 8).both()
    house = pillow((0.5, 0.3, 0.95), (0.95, 0.94, 0.9), 0.3, 28).at(y=0.78, z=-0.25)
    ports = copies(
        disc(0.05, 0.02, GLASS, 16).turned("z", 90), [(0.245, 0.83, v) for v in (-0.5, -0.25, 0.0)]
    ).both()
    fin = wing((0, 0, -0.35), 0.7, (0.36, 0, -0.12), 0.5, 0.14, (0.68, 0.14, 0.12), 4, 16)
    fin = fin.turned("z", -90).at(y=0.3)
    rudder = (
        wing((0, 0, 1.05), 0.3, (0.5, 0, 1.12), 0.2, 0.12, wood, 4, 12).turned("z", -90).at(y=0.55)
    )
    mast = rod((0, 0.7, -0.3), (0, 3.35, -0.3), 0.035, wood, 14)
    boom = rod((0, 1.0, -0.3), (0.06, 1.0, 1.1), 0.028, wood, 12)
    main = _sail((0, 1.04, -0.25), (0, 3.28, -0.27), (0.06, 1.05, 1.05), 0.16, sail)
    jib = _sail((0, 1.02, -0.42), (0, 2.9, -0.38), (0, 0.90, -1.38), 0.12, (0.85, 0.22, 0.18))
    stay = rod((0, 0.86, -1.46), (0, 3.1, -0.3), 0.008, STEEL, 4)
    flag = pillow((0.02, 0.14, 0.3), (0.85, 0.22, 0.18), 0.3, 12).at(0, 3.4, -0.12)
    return assemble(
        shell, rail, house, ports, fin, rudder, mast, boom, main, jib, stay, flag, size=2.0
    )


def _section(z: float, width: float, deck: float, keel: float) -> Floats:
    """A boat's cross-section, with corners at the heights where its paint changes."""
    level = np.array([1.0, 0.62, 0.55, 0.5, 0.44, 0.36, 0.32, 0.28, 0.24, 0.2, 0.18, 0.0])
    y = np.clip(level, keel, deck)
    x = width * np.cos(np.arcsin(((deck - y) / (deck - keel)) ** 1.33))
    half = np.column_stack([x, y])
    ring = np.concatenate([half[::-1], half * (-1, 1)])
    return np.column_stack([ring, np.full(len(ring), z)])


def _on_deck(p: Floats) -> NDArray[np.bool_]:
    z = p[:, 2]
    t = (z + 1.5) / 2.8
    return p[:, 1] > 0.62 + 0.20 * (1 - t) ** 2 + 0.03 * t**2 - 0.004


def _sail(
    tack: ArrayLike, head: ArrayLike, clew: ArrayLike, belly: float, color: Color, n: int = 14
) -> Shape:
    """A three-cornered sail that the wind fills towards +x."""
    foot, peak, end = (np.array(c, float) for c in (tack, head, clew))
    s = np.linspace(0, 0.995, n)[:, None]
    along = np.linspace(0, 1, n)
    luff, leech = foot + (peak - foot) * s, end + (peak - end) * s
    front = luff[:, None] * (1 - along[:, None]) + leech[:, None] * along[:, None]
    fill = belly * np.sin(np.pi * along) * (1 - s**2) + 0.01
    rings = np.concatenate([front, front[:, ::-1]], axis=1)
    rings[:, :n, 0] += fill
    rings[:, n:, 0] += fill[:, ::-1] - 0.02
    if np.cross(end - foot, peak - foot)[0] < 0:
        rings = rings[:, ::-1]
    return tube(rings, color, sharp=60, strips=True)
