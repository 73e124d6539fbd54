"""Furniture to sit or lie on. Seats face −z."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from seethrough.renderer.models.forms.shapes import Color, Shape, assemble, join
from seethrough.renderer.models.forms.surfaces import (
    box,
    copies,
    curve,
    disc,
    lathe,
    pillow,
    rod,
    rounded,
    slab,
    sweep,
)

OAK: Color = (0.66, 0.44, 0.22)
WALNUT: Color = (0.36, 0.21, 0.12)
LINEN: Color = (0.96, 0.95, 0.91)


def turned_leg(height: float, radius: float, color: Color, sides: int = 40) -> Shape:
    """A leg from the lathe, its foot at the origin: square block, beads, taper."""
    profile = [(0.42, 0), (0.5, 0.03), (0.5, 0.08), (0.38, 0.11), (0.45, 0.25), (0.72, 0.55),
               (0.9, 0.66), (0.78, 0.70), (0.5, 0.72), (0.85, 0.745), (0.85, 0.76), (0.5, 0.785),
               (0.62, 0.80), (1.0, 0.83), (1.0, 1.0)]  # fmt: skip
    steps = np.array(profile) * (radius, height)
    return lathe(steps, color, sides, sharp=60)


def chair() -> Shape:
    """A wooden dining chair: turned legs, spindle back."""
    seat = slab(
        [(-0.24, -0.24), (0.24, -0.24), (0.27, 0.0), (0.29, 0.24), (-0.29, 0.24), (-0.27, 0.0)],
        0.05, OAK, 0.012).turned("x", -90).at(y=0.56)  # fmt: skip
    front = turned_leg(0.54, 0.035, OAK).at(0.235, 0, -0.19)
    post = curve([(0.2, 0, 0.25), (0.2, 0.35, 0.2), (0.2, 0.6, 0.2), (0.215, 1.22, 0.33)], 12)
    back = sweep(post, np.linspace(0.027, 0.022, 12), OAK, 16)
    knob = lathe([(0.01, 0), (0.028, 0.02), (0.03, 0.04), (0.012, 0.07), (0, 0.072)], OAK, 12)
    rail = curve(
        [(-0.25, 1.15, 0.30), (-0.12, 1.19, 0.345), (0.12, 1.19, 0.345), (0.25, 1.15, 0.30)], 12
    )
    top = sweep(rail, 0.045, OAK, section=rounded_bar(1.5, 0.5))
    spindles = [
        sweep(curve([(0.72 * x, 0.57, 0.2), (0.85 * x, 0.85, 0.265), (x, 1.15, 0.33)], 8),
              [0.012, 0.015, 0.019, 0.02, 0.019, 0.016, 0.014, 0.012], OAK)
        for x in (-0.14, -0.07, 0, 0.07, 0.14)
    ]  # fmt: skip
    bars = join(
        rod((0.235, 0.22, -0.19), (0.2, 0.22, 0.225), 0.014, OAK),
        rod((-0.217, 0.27, 0.02), (0.217, 0.27, 0.02), 0.014, OAK),
    )
    legs = join(front, back, knob.at(0.216, 1.215, 0.33)).both()
    cushion = pillow((0.46, 0.07, 0.42), (0.62, 0.16, 0.14), 0.4, 28).at(0, 0.60, -0.02)
    return assemble(seat, cushion, legs, top, *spindles, bars, bars.mirrored(), size=1.3)


def rounded_bar(width: float, height: float) -> np.ndarray:
    """(24, 2) cross-section of a flat bar with round edges, in units of its radius."""
    return rounded(2 * width, 2 * height, 0.8 * height, 5)


def directors_chair() -> Shape:
    """A folding film set chair: crossed legs, canvas seat and back."""
    canvas = (0.13, 0.16, 0.20)
    bar = rounded_bar(1.0, 0.65)
    w, d = 0.36, 0.27

    def stick(a: Sequence[float], b: Sequence[float], radius: float = 0.024) -> Shape:
        return sweep([a, b], radius, OAK, section=bar)

    crossed = [stick((-w, 0.06, z), (w, 0.60, z + 0.03 * s)) for s, z in ((1, -d), (1, d))] + [
        stick((w, 0.06, z + 0.03), (-w, 0.60, z + 0.03)) for z in (-d, d)
    ]
    side = join(
        stick((w, 0.035, -d - 0.08), (w, 0.035, d + 0.1), 0.03),
        stick((w, 0.62, -d - 0.04), (w, 0.62, d + 0.06), 0.026),
        stick((w, 0.62, -d + 0.02), (w, 0.86, -d + 0.02)),
        stick((w, 0.62, d), (w, 1.28, d + 0.06)),
        box((0.085, 0.03, 2 * d + 0.12), OAK, 0.012).at(w, 0.875, 0.0),
    ).both()
    sag = curve([(-w, 0.635), (-0.2, 0.60), (0, 0.588), (0.2, 0.60), (w, 0.635)], 16)
    seat = strip(sag, 0.018, 2 * d, canvas)
    bow = curve([(-w - 0.03, 0), (-0.2, 0.022), (0, 0.03), (0.2, 0.022), (w + 0.03, 0)], 16)
    back = strip(bow, 0.02, 0.25, canvas).turned("x", -90).turned("x", 5).at(y=1.14, z=d + 0.075)
    return assemble(*crossed, side, seat, back, size=1.3)


def strip(path: np.ndarray, thickness: float, width: float, color: Color) -> Shape:
    """Cloth along a path (n, 2) in x and y, `width` along z."""
    return sweep(
        np.column_stack([path, np.zeros(len(path))]), 1.0, color, sharp=40,
        section=[(-thickness / 2, -width / 2), (thickness / 2, -width / 2),
                 (thickness / 2, width / 2), (-thickness / 2, width / 2)],
    )  # fmt: skip


def _upholstered(width: float, seats: int, color: Color, trim: Color) -> list[Shape]:
    """Base, back, round arms, cushions and feet of a sofa with the given inner width."""
    dark = tuple(0.86 * c for c in color)
    arm = join(
        box((0.2, 0.42, 0.86), color, 0.05, 4).at(y=0.33),
        sweep([(0, 0.55, -0.45), (0, 0.55, 0.40)], 0.135, color, 20),
        disc(0.095, 0.012, dark, 20, 0.004).turned("x", 90).at(0, 0.55, -0.455),
    ).at(x=width / 2 + 0.1)
    feet = lathe([(0.028, 0), (0.03, 0.01), (0.045, 0.1), (0.05, 0.13)], trim, 12)
    places = [(x, 0, z) for x in (-width / 2 - 0.08, width / 2 + 0.08) for z in (-0.34, 0.38)]
    step = width / seats
    middles = (np.arange(seats) - (seats - 1) / 2) * step
    seat = pillow((step * 0.99, 0.2, 0.72), color, 0.28, 28).at(y=0.40, z=-0.09)
    rest = pillow((step * 0.98, 0.46, 0.2), color, 0.36, 28).turned("x", 12).at(y=0.68, z=0.24)
    return [
        arm.both(),
        box((width + 0.04, 0.2, 0.8), dark, 0.03).at(y=0.23),
        box((width + 0.1, 0.72, 0.16), color, 0.06, 4).turned("x", 8).at(y=0.55, z=0.36),
        *(part.at(x=x) for part in (seat, rest) for x in middles),
        copies(feet, places),
    ]


def sofa() -> Shape:
    """A red sofa for three."""
    parts = _upholstered(1.6, 3, (0.70, 0.13, 0.13), WALNUT)
    throw = pillow((0.34, 0.34, 0.14), (0.92, 0.80, 0.45), 0.5, 20).turned("z", 20).turned("x", 18)
    return assemble(*parts, throw.turned("y", -10).at(0.58, 0.66, 0.10), size=2.0)


def armchair() -> Shape:
    """A green easy chair with a high back and wings."""
    green, dark = (0.16, 0.40, 0.26), (0.12, 0.31, 0.20)
    parts = _upholstered(0.58, 1, green, WALNUT)
    back = pillow((0.66, 0.86, 0.2), green, 0.4, 28).turned("x", 10).at(y=0.88, z=0.33)
    wing = pillow((0.12, 0.5, 0.34), green, 0.5, 20).turned("y", 12).at(0.34, 0.98, 0.2)
    across, up = np.meshgrid([-0.18, 0, 0.18], [0.95, 1.12])
    places = np.stack([across, up, 0.215 + 0.17 * (up - 0.95)], axis=-1).reshape(-1, 3)
    buttons = copies(pillow((0.04, 0.04, 0.03), dark, 1.0, 8), places)
    return assemble(*parts, back, wing.both(), buttons, size=1.35)


def bed() -> Shape:
    """A double bed: headboard at the far end, duvet turned down, two pillows."""
    blue = (0.25, 0.42, 0.70)
    head = slab(
        [(-0.78, 0), (0.78, 0), (0.78, 0.78), *curve([(0.72, 0.86), (0, 1.08), (-0.72, 0.86)], 17),
         (-0.78, 0.78)], 0.07, WALNUT, 0.015).at(z=0.97)  # fmt: skip
    foot = box((1.56, 0.46, 0.06), WALNUT, 0.02).at(y=0.28, z=-0.98)
    rails = box((0.05, 0.2, 1.9), WALNUT, 0.015).at(0.745, 0.27, 0).both()
    posts = lathe([(0.035, 0), (0.05, 0.06), (0.05, 0.5), (0.03, 0.54), (0.055, 0.6), (0, 0.66)],
                  WALNUT, 16)  # fmt: skip
    mattress = box((1.44, 0.26, 1.88), LINEN, 0.07, 4).at(y=0.42)
    duvet = pillow((1.56, 0.34, 1.42), blue, 0.16, 40).at(y=0.46, z=-0.27)
    fold = pillow((1.56, 0.13, 0.3), LINEN, 0.3, 32).at(y=0.63, z=0.36)
    rest = pillow((0.6, 0.2, 0.38), LINEN, 0.45, 28).turned("x", -14).at(0.36, 0.64, 0.70).both()
    return assemble(head, foot, rails, copies(posts, [(x, 0, -0.98) for x in (-0.78, 0.78)]),
                    mattress, duvet, fold, rest, size=2.0)  # fmt: skip
