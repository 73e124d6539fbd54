"""The jeep: engine, gearbox, axles, seats and more inside a body, as separate pieces.

The scene of Elmqvist2009's performance table ("an engine inside a jeep", about 115k polygons).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.forms.shapes import Color, Shape, assemble, join, shade
from seethrough.renderer.models.forms.surfaces import (
    ball,
    box,
    copies,
    curve,
    disc,
    lathe,
    pillow,
    ring,
    rod,
    rounded,
    sweep,
    tube,
)
from seethrough.renderer.models.vehicles.jeep_engine import (
    AXLE_Y,
    DARK,
    IRON,
    RUST,
    TRACK,
    axle,
    engine,
    gearbox,
    off_road_wheel,
    shaft,
    springs,
)
from seethrough.renderer.models.vehicles.wheels import STEEL, hull, plate
from seethrough.renderer.scene.geometry import Mesh
from seethrough.renderer.scene.scene import Object, Scene

OLIVE: Color = (0.36, 0.42, 0.22)
CANVAS: Color = (0.62, 0.54, 0.36)
FRONT, REAR = -1.02, 1.02
LENGTH = 2.0
"""The jeep's length in world units, as that of the other vehicles."""


INSIDE = ("engine", "gearbox", "front axle", "rear axle", "driver's seat", "passenger's seat")


def jeep_scene(targets: Sequence[str] = INSIDE) -> Scene:
    """The pieces as objects; those named in `targets` are targets."""
    return Scene(tuple(Object(mesh, target=name in targets, kind=name) for name, mesh in jeep()))


@cache
def jeep() -> tuple[tuple[str, Mesh], ...]:
    """Names and meshes of the pieces, all in one frame: standing on y = 0, facing −z.

    The wheels share one mesh's triangles but stand in their own places, so they are own meshes.
    """
    pieces = pieces_in_metres()
    whole = assemble(*pieces.values(), size=LENGTH)
    starts = np.cumsum([0, *(len(p.vertices) for p in pieces.values())])
    placed = zip(pieces.items(), starts[:-1], starts[1:], strict=True)
    return tuple(
        (name, shade(replace(piece, vertices=whole.vertices[a:b])))
        for (name, piece), a, b in placed
    )


def pieces_in_metres() -> dict[str, Shape]:
    """Every piece by name, in metres."""
    wheel = off_road_wheel()
    left = wheel.mirrored()
    seat = _seat()
    return {
        "body": _body(),
        "engine": engine(),
        "radiator": _radiator(),
        "battery": _battery(),
        "gearbox": gearbox(),
        "frame": _frame(),
        "front axle": axle(FRONT, 1),
        "rear axle": axle(REAR, -1),
        "front springs": springs(FRONT),
        "rear springs": springs(REAR),
        "front shaft": shaft((0.2, 0.54, -0.2), (0.2, AXLE_Y, FRONT + 0.28)),
        "rear shaft": shaft((0.2, 0.54, 0.08), (0.2, AXLE_Y, REAR - 0.28)),
        "exhaust": _exhaust(),
        "fuel tank": _tank(),
        "steering": _steering(),
        "driver's seat": seat.at(-0.33),
        "passenger's seat": seat.at(0.33),
        "rear bench": _bench(),
        "front left wheel": left.at(-TRACK, AXLE_Y, FRONT),
        "front right wheel": wheel.at(TRACK, AXLE_Y, FRONT),
        "rear left wheel": left.at(-TRACK, AXLE_Y, REAR),
        "rear right wheel": wheel.at(TRACK, AXLE_Y, REAR),
        "spare wheel": wheel.turned("y", -90).at(0.25, 0.85, 1.66),
        "jerrycan": _jerrycan(),
    }


def _sheet(z: Floats, bottom: Floats, top: Floats, x: float) -> Shape:
    """An upright panel along z at the side x, its edges given at the places z."""
    return hull(z, np.full(len(z), 0.014), bottom, top, OLIVE, 0.012, 2).at(x=x)


def _body() -> Shape:
    """Tub, bonnet, wings, grille and windscreen frame, each of sheets as thin as metal."""
    z = np.array([-0.55, -0.54, *np.linspace(-0.4, -0.3, 6), *np.linspace(-0.2, 0.25, 12),
                  *np.linspace(0.3, 0.42, 6), *np.linspace(0.6, 1.5, 40)])  # fmt: skip
    top = np.interp(z, [-0.55, -0.4, -0.3, 0.3, 0.42, 1.5], [1.0, 1.0, 0.72, 0.72, 0.98, 0.98])
    room = 0.46**2 - (z - REAR) ** 2
    low = np.maximum(0.5, np.where(room > 0, AXLE_Y + np.sqrt(np.maximum(room, 0)), 0))
    parts = [
        _sheet(z, low, top, 0.74).both(),
        box((1.46, 0.028, 1.14), OLIVE, 0.01).at(0, 0.51, 0.02),
        box((1.46, 0.48, 0.028), OLIVE, 0.01).at(0, 0.74, 1.5),
        box((1.46, 0.5, 0.028), OLIVE, 0.01).at(0, 0.76, -0.55),
        box((0.28, 0.028, 0.94), OLIVE, 0.01).at(0.6, 0.84, 1.02).both(),
        box((0.92, 0.028, 0.95), OLIVE, 0.01).at(0, 0.60, 1.03),
        _bonnet(), _wing().both(), _grille(), _windscreen(),
        box((1.5, 0.12, 0.07), DARK, 0.02).at(0, 0.52, -1.62),
        box((1.2, 0.1, 0.06), DARK, 0.02).at(0, 0.52, 1.56),
        disc(0.05, 0.04, (0.75, 0.06, 0.05), 24, 0.01).turned("x", 90).at(0.62, 0.66, 1.52).both(),
    ]  # fmt: skip
    roll = curve(
        [(0.68, 0.9, 0.62), (0.68, 1.35, 0.66), (0.58, 1.51, 0.66), (0.4, 1.54, 0.66),
         (-0.4, 1.54, 0.66), (-0.58, 1.51, 0.66), (-0.68, 1.35, 0.66), (-0.68, 0.9, 0.62)], 48
    )  # fmt: skip
    return join(*parts, sweep(roll, 0.026, DARK, 16))


def _bonnet() -> Shape:
    """The lid over the engine, arched across, with its side sheets and catches."""
    z = np.linspace(-1.46, -0.53, 20)
    half = np.interp(z, [-1.46, -0.53], [0.44, 0.56])
    u = np.linspace(-1, 1, 25)
    rings = []
    for zi, w in zip(z, half, strict=True):
        arch = 1.075 - 0.10 * u**4 + 0.03 * (zi + 1.46)
        outer = np.column_stack([u * w, arch])
        inner = np.column_stack([u * (w - 0.02), arch - 0.022])[::-1]
        rings.append(np.column_stack([np.concatenate([inner[::-1], outer[::-1]]), np.full(50, zi)]))
    lid = tube(np.array(rings), OLIVE, strips=True)
    side = _sheet(z, np.full(20, 0.74), np.full(20, 0.985) + 0.03 * (z + 1.46), 0.0)
    lean = side.bent(
        lambda p: p + np.outer(np.interp(p[:, 2], [-1.46, -0.53], [0.425, 0.545]), (1, 0, 0))
    )
    star = disc(0.11, 0.012, (0.9, 0.9, 0.85), 5).turned("y", 18).at(0, 1.097, -1.0)
    catches = copies(box((0.03, 0.1, 0.05), DARK, 0.01), [(0.49, 0.93, -1.2), (0.53, 0.94, -0.7)])
    return join(lid, lean.both(), star, catches.both())


def _wing() -> Shape:
    """A flat mudguard over the right front wheel."""
    path = curve([(0.6, 0.56, -1.53), (0.6, 0.74, -1.5), (0.6, 0.82, -1.38), (0.6, 0.83, -1.0),
                  (0.6, 0.82, -0.62), (0.6, 0.72, -0.54), (0.6, 0.52, -0.52)], 40)  # fmt: skip
    return sweep(path, 1.0, OLIVE, section=rounded(0.022, 0.33, 0.01, 2))


def _grille() -> Shape:
    """Nine upright slots between two lamps."""
    bars = copies(
        box((0.032, 0.34, 0.03), OLIVE, 0.008),
        [(x, 0.84, -1.475) for x in np.linspace(-0.27, 0.27, 10)],
    )
    rails = copies(box((0.9, 0.06, 0.035), OLIVE, 0.012), [(0, 1.03, -1.475), (0, 0.66, -1.475)])
    cheek = box((0.16, 0.4, 0.035), OLIVE, 0.012).at(0.37, 0.845, -1.475)
    lamp = join(
        ring([(0.075, -0.03), (0.095, -0.03), (0.09, 0.03), (0.075, 0.03)], STEEL, 40),
        ball((0.078, 0.03, 0.078), (0.98, 0.96, 0.85), 32).at(y=0.012),
        disc(0.08, 0.02, STEEL, 32).at(y=-0.02),
    ).turned("x", -90).at(0.37, 0.86, -1.51)  # fmt: skip
    return join(bars, rails, cheek.both(), lamp.both())


def _windscreen() -> Shape:
    post = rod((0.66, 0.98, -0.52), (0.62, 1.46, -0.36), 0.022, OLIVE, 16)
    bars = join(
        rod((-0.62, 1.46, -0.36), (0.62, 1.46, -0.36), 0.022, OLIVE, 16),
        rod((-0.66, 1.02, -0.507), (0.66, 1.02, -0.507), 0.022, OLIVE, 16),
        rod((0, 1.02, -0.507), (0, 1.46, -0.36), 0.016, OLIVE, 16),
    )
    wiper = rod((0.3, 1.03, -0.53), (0.42, 1.25, -0.46), 0.008, DARK)
    mirror = disc(0.07, 0.02, STEEL, 28, 0.006).turned("x", 90).at(0.83, 1.2, -0.42)
    arm = rod((0.66, 1.1, -0.48), (0.82, 1.2, -0.415), 0.009, DARK)
    return join(post.both(), bars, wiper.both(), join(mirror, arm).both())


def _radiator() -> Shape:
    core = box((0.5, 0.38, 0.05), (0.2, 0.2, 0.22), 0.01).at(0, 0.82, -1.42)
    fins = copies(
        box((0.5, 0.006, 0.062), (0.55, 0.56, 0.58)),
        [(0, y, -1.42) for y in np.linspace(0.65, 0.99, 24)],
    )
    tank = copies(pillow((0.52, 0.06, 0.09), DARK, 0.35, 24), [(0, 1.01, -1.42), (0, 0.63, -1.42)])
    hose = sweep(
        curve([(0.1, 1.01, -1.4), (0.1, 1.0, -1.3), (0.05, 0.93, -1.26)], 14), 0.025, DARK, 16
    )
    return join(core, fins, tank, hose)


def _battery() -> Shape:
    case = box((0.16, 0.16, 0.24), DARK, 0.012).at(0.36, 0.82, -0.72)
    lid = box((0.165, 0.03, 0.245), (0.7, 0.2, 0.15), 0.01).at(0.36, 0.91, -0.72)
    poles = copies(disc(0.016, 0.04, STEEL, 16), [(0.36, 0.94, z) for z in (-0.8, -0.64)])
    return join(case, lid, poles)


def _frame() -> Shape:
    rail = curve([(0.37, 0.5, -1.6), (0.37, 0.5, -0.6), (0.37, 0.46, -0.3), (0.37, 0.46, 0.4),
                  (0.37, 0.5, 0.8), (0.37, 0.5, 1.53)], 40)  # fmt: skip
    rails = sweep(rail, 1.0, DARK, section=rounded(0.1, 0.05, 0.008, 2)).both()
    cross = copies(
        box((0.74, 0.06, 0.05), DARK, 0.01), [(0, 0.48, z) for z in (-1.45, -0.15, 0.5, 1.45)]
    )
    return join(rails, cross)


def _exhaust() -> Shape:
    pipe = curve(
        [(0.25, 0.68, -0.86), (0.27, 0.5, -0.8), (0.3, 0.42, -0.5), (0.3, 0.4, 0.1),
         (0.3, 0.45, 0.6), (0.3, 0.56, 1.0), (0.45, 0.5, 1.3), (0.5, 0.45, 1.56)], 60
    )  # fmt: skip
    pot = lathe([(0.03, -0.3), (0.08, -0.26), (0.085, 0.26), (0.03, 0.3)], IRON, 32).turned("x", 90)
    return join(sweep(pipe, 0.026, RUST, 18), pot.scaled(1.3, 1, 1).at(0.3, 0.405, 0.25))


def _tank() -> Shape:
    tank = box((0.5, 0.2, 0.34), (0.3, 0.32, 0.3), 0.05, 5).at(-0.38, 0.62, 0.28)
    neck = rod((-0.6, 0.68, 0.4), (-0.72, 0.8, 0.45), 0.03, DARK, 20)
    straps = copies(
        box((0.515, 0.215, 0.03), DARK, 0.05, 5), [(-0.38, 0.62, z) for z in (0.2, 0.36)]
    )
    return join(tank, neck, straps)


def _steering() -> Shape:
    angle = np.arange(48) * np.pi / 24
    path = np.column_stack([0.2 * np.cos(angle), np.zeros(48), 0.2 * np.sin(angle)])
    rim = sweep(path, 0.014, DARK, 14, closed=True)
    ends = [(0.2 * np.sin(a), 0, 0.2 * np.cos(a)) for a in (0.5, 2.6, 4.7)]
    spokes = join(*(rod((0, -0.02, 0), end, 0.01, STEEL, 12) for end in ends))
    wheel = join(rim, spokes, disc(0.035, 0.03, DARK, 24, 0.008).at(y=-0.01)).turned("x", 58)
    column = rod((-0.33, 1.1, -0.16), (-0.33, 0.62, -0.95), 0.02, DARK, 16)
    box_ = box((0.09, 0.12, 0.1), IRON, 0.02, 3).at(-0.33, 0.58, -1.0)
    link = rod((-0.33, 0.5, -1.05), (0.45, 0.42, -1.2), 0.014, STEEL, 12)
    return join(wheel.at(-0.33, 1.1, -0.16), column, box_, link)


def _seat() -> Shape:
    """A canvas seat on a tube frame."""
    cushion = pillow((0.46, 0.14, 0.46), CANVAS, 0.35, 36).at(0, 0.78, 0.15)
    back = pillow((0.46, 0.5, 0.12), CANVAS, 0.35, 36).turned("x", 10).at(0, 1.04, 0.42)
    path = curve(
        [(0, 0.54, -0.02), (0, 0.7, -0.05), (0, 0.71, 0.34), (0, 1.0, 0.42), (0, 1.28, 0.5)], 24
    )
    tubes = sweep(path, 0.016, DARK, 12).at(0.22).both()
    feet = rod((0.22, 0.53, 0.3), (0.22, 0.71, 0.32), 0.014, DARK, 12).both()
    return join(cushion, back, tubes, feet)


def _bench() -> Shape:
    cushion = pillow((0.86, 0.13, 0.4), CANVAS, 0.3, 36).at(0, 0.79, 1.05)
    back = pillow((0.86, 0.36, 0.11), CANVAS, 0.3, 36).turned("x", 8).at(0, 1.0, 1.3)
    legs = copies(
        rod((0, 0.61, 0), (0, 0.75, 0), 0.016, DARK, 12),
        [(x, 0, z) for x in (-0.38, 0.38) for z in (0.9, 1.2)],
    )
    return join(cushion, back, legs)


def _jerrycan() -> Shape:
    can = box((0.16, 0.46, 0.34), OLIVE, 0.035, 5)
    grip = copies(
        rod((0, 0, -0.08), (0, 0, 0.08), 0.012, OLIVE, 12),
        [(x, 0.27, 0.02) for x in (-0.05, 0, 0.05)],
    )
    corners = [
        (0.083, -0.15, -0.11),
        (0.083, 0.15, 0.11),
        (0.083, 0.12, 0.13),
        (0.083, -0.18, -0.09),
    ]
    groove = plate(corners, 0.012, DARK)
    return join(can, grip, groove).turned("y", 90).at(-0.42, 0.84, 1.62)
