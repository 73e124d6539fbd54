"""Furniture that is not for sitting. Fronts face −z."""

from __future__ import annotations

import numpy as np

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.forms.shapes import Color, Shape, assemble, join
from seethrough.renderer.models.forms.surfaces import (
    ball,
    box,
    boxes,
    copies,
    curve,
    disc,
    lathe,
    pillow,
    ring,
    rod,
    slab,
    sweep,
)
from seethrough.renderer.models.seats import OAK, WALNUT, turned_leg

BRASS: Color = (0.80, 0.62, 0.25)
BLACK: Color = (0.07, 0.07, 0.08)


def table() -> Shape:
    """A white kitchen table on four turned legs."""
    white, apron = (0.95, 0.94, 0.90), (0.80, 0.79, 0.75)
    top = box((1.7, 0.06, 0.95), white, 0.025, 4).at(y=0.80)
    rails = join(
        box((1.4, 0.11, 0.03), apron, 0.006).at(z=0.36).both("z"),
        box((0.03, 0.11, 0.70), apron, 0.006).at(x=0.71).both(),
    ).at(y=0.72)
    legs = copies(
        turned_leg(0.77, 0.055, white, 56),
        [(x, 0, z) for x in (-0.71, 0.71) for z in (-0.36, 0.36)],
    )
    return assemble(top, rails, legs, size=1.7)


def lamp() -> Shape:
    """A table lamp: ceramic foot, pleated shade."""
    blue, cream = (0.12, 0.36, 0.46), (0.98, 0.86, 0.56)
    foot = curve(
        [(0.13, 0.03), (0.10, 0.08), (0.22, 0.28), (0.24, 0.38), (0.15, 0.55), (0.05, 0.66)], 22
    )
    vase = lathe([(0.0, 0.03), *foot, (0, 0.66)], blue, 56, sharp=60)
    plinth = disc(0.17, 0.05, BRASS, 32, 0.012).at(y=0.025)
    stem = lathe(
        [(0.03, 0.65), (0.045, 0.68), (0.02, 0.70), (0.02, 1.25), (0.035, 1.27), (0, 1.31)],
        BRASS,
        16,
    )
    shade = ring([(0.43, 0.72), (0.44, 0.72), (0.25, 1.22), (0.24, 1.22)], cream, 72, sharp=75)
    pleats = shade.bent(_pleated)
    hems = [
        ring(
            np.array(
                [(r + 0.012, y - 0.014), (r + 0.016, y), (r + 0.012, y + 0.014), (r - 0.016, y)]
            ),
            (0.85, 0.68, 0.36),
            48,
        )
        for r, y in ((0.435, 0.725), (0.245, 1.215))
    ]
    spokes = [
        rod((0, 1.2, 0), (0.24 * np.cos(a), 1.2, 0.24 * np.sin(a)), 0.008, BRASS, 6)
        for a in (0, 2.1, 4.2)
    ]
    bulb = ball((0.07, 0.1, 0.07), (1, 0.97, 0.85), 16).at(y=0.98)
    return assemble(plinth, vase, stem, pleats, *hems, *spokes, bulb, size=1.3)


def _pleated(p: np.ndarray) -> np.ndarray:
    wave = 1 + 0.018 * np.cos(36 * np.arctan2(p[:, 2], p[:, 0]))
    return p * np.stack([wave, np.ones_like(wave), wave], axis=1)


def television() -> Shape:
    """A tube television: wooden case on splayed legs, antenna, round screen, knobs."""
    case = box((1.3, 0.86, 0.5), (0.55, 0.33, 0.16), 0.07, 4)
    hump = box((0.8, 0.55, 0.25), (0.25, 0.22, 0.20), 0.09, 4).at(-0.1, 0, 0.3)
    bezel = pillow((0.96, 0.74, 0.06), (0.86, 0.84, 0.78), 0.25, 32).at(-0.12, 0, -0.245)
    screen = pillow((0.84, 0.62, 0.12), (0.33, 0.47, 0.55), 0.42, 40).at(-0.12, 0, -0.245)
    shine = (
        pillow((0.16, 0.22, 0.02), (0.62, 0.74, 0.80), 0.7, 16)
        .turned("z", -18)
        .at(-0.34, 0.13, -0.302)
    )
    knob = join(
        disc(0.075, 0.06, (0.86, 0.84, 0.78), 24, 0.01),
        box((0.02, 0.02, 0.12), (0.2, 0.2, 0.2)).at(y=0.035),
    ).turned("x", -90)
    knobs = copies(knob, [(0.5, 0.25, -0.27), (0.5, 0.03, -0.27)])
    slot = box((0.17, 0.018, 0.02), (0.22, 0.14, 0.08))
    slots = copies(slot, [(0.5, y, -0.25) for y in np.arange(-0.15, -0.36, -0.045)])
    leg = (
        sweep([(0.45, -0.38, 0.14), (0.58, -0.85, 0.24)], [0.045, 0.022], WALNUT, 14)
        .both()
        .both("z")
    )
    feet = copies(
        ball(0.028, BRASS, 10), [(x, -0.84, z) for x in (-0.58, 0.58) for z in (-0.24, 0.24)]
    )
    ears = join(
        rod((0.02, 0.45, 0.05), (0.42, 1.05, 0.05), 0.013, (0.7, 0.7, 0.72)),
        ball(0.03, (0.7, 0.7, 0.72), 10).at(0.42, 1.05, 0.05),
    ).both()
    dome = ball((0.13, 0.08, 0.1), (0.2, 0.2, 0.2), 20).at(0, 0.43, 0.05)
    return assemble(case, hump, bezel, screen, shine, knobs, slots, leg, feet, ears, dome, size=1.6)


def bookshelf() -> Shape:
    """A tall case with four shelves of books."""
    w, h, d, t = 0.95, 1.75, 0.32, 0.035
    case = join(
        box((t, h, d), OAK, 0.006).at(w / 2, h / 2, 0).both(),
        box((w, h - 0.04, 0.015), (0.45, 0.29, 0.14)).at(y=h / 2, z=d / 2 - 0.01),
        copies(box((w, t, d), OAK, 0.006), [(0, y, 0) for y in np.linspace(0.06, h - t / 2, 5)]),
        box((w + 0.08, 0.05, d + 0.05), OAK, 0.015).at(y=h + 0.02),
        box((w, 0.08, d - 0.02), OAK).at(y=0.04),
    )
    floors = np.linspace(0.06, h - t / 2, 5)[:4] + t / 2
    return assemble(case, _books(w - t, floors), size=1.8)


COVERS = np.array(
    [(0.65, 0.12, 0.12), (0.12, 0.25, 0.52), (0.14, 0.42, 0.26), (0.85, 0.66, 0.20),
     (0.45, 0.18, 0.42), (0.90, 0.86, 0.76), (0.20, 0.20, 0.22), (0.82, 0.40, 0.14)]
)  # fmt: skip


def _books(width: float, floors: Floats, count: int = 17) -> Shape:
    """Rows of upright books, each with a band round its back; always the same ones."""
    rng = np.random.default_rng(7)
    size = rng.uniform((0.03, 0.24, 0.19), (0.065, 0.35, 0.25), (len(floors), count, 3))
    size[..., 0] *= (width - 0.06 - 0.003 * count) / size[..., 0].sum(axis=1, keepdims=True)
    right = np.cumsum(size[..., 0] + 0.003, axis=1) - width / 2 + 0.01
    center = np.stack(
        [right - size[..., 0] / 2, floors[:, None] + size[..., 1] / 2, np.full(right.shape, -0.02)],
        -1,
    )
    cover, place = size.reshape(-1, 3), center.reshape(-1, 3)
    books = boxes(cover, place, COVERS[rng.integers(len(COVERS), size=len(cover))], 0.008)
    band = np.column_stack([cover[:, 0] + 0.002, np.full(len(cover), 0.02), cover[:, 2] + 0.002])
    gold = np.tile((0.95, 0.85, 0.55), (len(cover), 1))
    return join(books, boxes(band, place + cover * (0, 0.3, 0), gold, 0.003))


def piano() -> Shape:
    """A grand piano with its lid up; the keys face −z."""
    black, gold = BLACK, (0.72, 0.50, 0.16)
    bent = curve([(0.75, 0.25), (0.74, 0.0), (0.62, -0.3), (0.32, -0.55), (0.2, -0.85),
                  (0.05, -1.1), (-0.25, -1.25), (-0.6, -1.2), (-0.75, -1.0)], 32)[::-1]  # fmt: skip

    def outline(front: float) -> Floats:
        """Seen from above, y forward; enough corners on the straight sides to balance the bend."""
        before = [(x, front) for x in np.linspace(0.75, -0.75, 10)[front == 0.25 :]]
        bass = [(-0.75, y) for y in np.linspace(front, -1.0, 12)[1:-1]]
        return np.array([*bent, *before, *bass])

    rim = slab(outline(0.42), 0.26, black, 0.02).turned("x", -90).at(y=0.80)
    plate = slab(outline(0.26) * 0.95, 0.02, gold).turned("x", -90).at(y=0.925)
    lid = slab(outline(0.25), 0.03, (0.13, 0.13, 0.15), 0.01).turned("x", -90)
    lid = lid.at(x=0.75).turned("z", 38).at(x=-0.75, y=0.96)
    prop = rod((0.45, 0.92, 0.25), (0.28, 1.72, 0.25), 0.014, (0.2, 0.2, 0.22))
    leg = lathe(
        [(0.05, 0.0), (0.05, 0.05), (0.035, 0.08), (0.075, 0.55), (0.085, 0.6), (0.085, 0.7)],
        black,
        20,
    )
    legs = copies(leg, [(-0.62, 0, -0.3), (0.62, 0, -0.3), (-0.3, 0, 0.95)])
    keybed = box((1.5, 0.07, 0.34), black, 0.01).at(y=0.70, z=-0.55)
    cheeks = box((0.08, 0.16, 0.34), black, 0.02).at(0.71, 0.78, -0.55).both()
    desk = box((0.8, 0.26, 0.025), black, 0.01).turned("x", 20).at(y=1.06, z=-0.22)
    pedals = copies(
        box((0.05, 0.02, 0.18), BRASS, 0.008), [(x, 0.08, -0.32) for x in (-0.09, 0, 0.09)]
    )
    lyre = join(
        box((0.3, 0.08, 0.1), black, 0.02).at(y=0.1),
        box((0.06, 0.6, 0.05), black).at(0.09, 0.4).both(),
    )
    return assemble(rim, plate, lid, prop, legs, keybed, cheeks, desk, pedals, lyre.at(z=-0.2),
                    _keys(1.34), size=1.9)  # fmt: skip


def _keys(width: float) -> Shape:
    """52 white and 36 black keys, their middle at x = 0, their fronts at z = −0.71."""
    step = width / 52
    white = box((step * 0.9, 0.03, 0.24), (0.97, 0.96, 0.92)).at(y=0.765, z=-0.58)
    sharp = box((step * 0.55, 0.03, 0.15), BLACK, 0.004).at(y=0.79, z=-0.535)
    x = (np.arange(52) - 25.5) * step
    # The lowest key is A; of the gaps after A to G those after B and E have no black key.
    has = np.isin(np.arange(51) % 7, [0, 2, 3, 5, 6])
    front = np.zeros((52, 3))
    front[:, 0] = x
    between = np.zeros((int(has.sum()), 3))
    between[:, 0] = x[:-1][has] + step / 2
    return join(copies(white, front), copies(sharp, between))
