"""What drives the jeep: engine, gearbox, axles, springs, wheels. Metres, facing −z."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from seethrough.renderer.models.forms.shapes import Color, Shape, join
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
    spun,
    sweep,
)
from seethrough.renderer.models.vehicles.wheels import RUBBER, STEEL, tyre

IRON: Color = (0.42, 0.44, 0.47)
DARK: Color = (0.14, 0.14, 0.15)
BLUE: Color = (0.16, 0.30, 0.52)
RUST: Color = (0.48, 0.27, 0.16)
AXLE_Y = 0.37
TRACK = 0.63


def _bolts(places: np.ndarray, radius: float, axis: str = "") -> Shape:
    head = lathe([(radius, 0), (radius, radius), (radius * 0.7, radius * 1.3)], STEEL, 6)
    return copies(head.turned(axis, 90) if axis else head, places)


def engine() -> Shape:
    """Four cylinders in line under the bonnet, with fan, belt, manifolds and leads."""
    return join(*engine_parts().values())


def engine_parts() -> dict[str, Shape]:
    """The engine's parts by name, in place."""
    block = box((0.30, 0.30, 0.62), BLUE, 0.03, 4).at(0, 0.70, -0.98)
    ribs = copies(
        box((0.33, 0.22, 0.02), BLUE, 0.008), [(0, 0.70, z) for z in np.linspace(-1.2, -0.76, 8)]
    )
    z = np.linspace(-1.24, -0.72, 8)
    filter_ = join(
        disc(0.12, 0.1, DARK, 40, 0.02).at(y=0.05),
        disc(0.125, 0.02, STEEL, 40, 0.006).at(y=0.11),
        disc(0.02, 0.03, STEEL, 12).at(y=0.13),
    )
    horn = sweep(
        curve([(-0.30, 0.98, -0.86), (-0.25, 0.94, -0.86), (-0.2, 0.87, -0.9)], 12), 0.04, DARK, 20
    )
    return {
        "engine block": join(block, ribs),
        "cylinder head": box((0.28, 0.09, 0.62), IRON, 0.02, 3).at(0, 0.89, -0.98),
        "valve cover": box((0.17, 0.08, 0.54), RUST, 0.035, 5).at(0.02, 0.96, -0.98),
        "oil cap": disc(0.03, 0.04, DARK, 24, 0.008).at(0.02, 1.01, -1.16),
        "oil pan": pillow((0.27, 0.22, 0.60), DARK, 0.3, 36).at(0, 0.53, -0.98),
        "head bolts": _bolts(np.array([(x, 0.935, v) for x in (-0.12, 0.125) for v in z]), 0.011),
        "fan": _fan(),
        "exhaust manifold": _exhaust_ports(),
        "intake pipe": _intake(),
        "distributor": _ignition(),
        "air filter": filter_.at(-0.30, 0.94, -0.86),
        "air hose": horn,
        "dynamo": disc(0.075, 0.2, IRON, 32, 0.015).turned("x", 90).at(0.24, 0.80, -1.14),
    }


def _fan() -> Shape:
    """Fan, pulleys and belt in front of the block."""
    blade = box((0.012, 0.17, 0.07), STEEL, 0.004).turned("y", 28).at(y=0.13)
    blades = spun(blade.turned("y", 90), 6).turned("y", 90)
    hub = disc(0.06, 0.05, DARK, 28, 0.01).turned("x", 90)
    wheel = ring(
        [(0.05, -0.012), (0.078, -0.016), (0.066, 0), (0.078, 0.016), (0.05, 0.012)], IRON, 36
    )
    pulley = wheel.turned("x", 90)
    low, high, side = (0.0, 0.62), (0.0, 0.84), (0.24, 0.80)
    places = [(x, y, -1.31) for x, y in (low, high, side)]
    a = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    arc = np.column_stack([np.cos(a), np.sin(a)]) * 0.07
    far = np.stack([arc + c for c in (low, high, side)])
    # The belt is the convex hull of the pulleys: in each direction the farthest of them.
    best = np.argmax(np.einsum("kij,ij->ki", far, arc), axis=0)
    belt = far[best, np.arange(48)]
    loop = sweep(np.column_stack([belt, np.full(48, -1.31)]), 0.009, DARK, 6, closed=True)
    return join(blades.at(0, 0.84, -1.37), hub.at(0, 0.84, -1.36), copies(pulley, places), loop)


def _exhaust_ports() -> Shape:
    """Exhaust ports on the right, gathered into one pipe."""
    ports = []
    for z in np.linspace(-1.2, -0.78, 4):
        path = curve(
            [(0.12, 0.86, z), (0.2, 0.86, z), (0.245, 0.78, z * 0.6 - 0.36), (0.25, 0.66, -0.86)],
            20,
        )
        ports.append(sweep(path, 0.028, RUST, 18))
        ports.append(disc(0.042, 0.016, RUST, 20).turned("z", 90).at(0.155, 0.86, z))
    return join(*ports)


def _intake() -> Shape:
    """The intake on the left."""
    return sweep(curve([(-0.13, 0.86, -1.16), (-0.2, 0.87, -1.1), (-0.21, 0.87, -0.9),
                        (-0.13, 0.86, -0.8)], 24), 0.03, IRON, 18)  # fmt: skip


def _ignition() -> Shape:
    """Distributor, four plugs and their leads."""
    top = np.array([-0.19, 0.86, -0.66])
    cap = lathe([(0.04, 0), (0.045, 0.06), (0.03, 0.09), (0.012, 0.1), (0.012, 0.12)], RUST, 24)
    parts = [cap.at(*(top - (0, 0.04, 0))), rod((-0.13, 0.72, -0.66), top, 0.02, IRON, 14)]
    for i, z in enumerate(np.linspace(-1.2, -0.78, 4)):
        plug = lathe(
            [(0.012, 0), (0.012, 0.04), (0.008, 0.045), (0.008, 0.07)], (0.9, 0.9, 0.88), 12
        )
        parts.append(plug.at(-0.1, 0.935, z))
        start = np.add(top, (0, 0.06, 0))
        bow = np.add(top, (0.01, 0.12, -0.05 * i))
        path = curve([start, bow, (-0.115, 1.02, z + 0.05), (-0.1, 1.0, z)], 20)
        parts.append(sweep(path, 0.007, DARK, 8))
    return join(*parts)


def gearbox() -> Shape:
    """Bell housing, gearbox with its lever, transfer case."""
    bell = lathe([(0.2, 0), (0.21, 0.03), (0.19, 0.06), (0.13, 0.16), (0.12, 0.2)], IRON, 40)
    ears = copies(
        disc(0.02, 0.05, IRON, 12),
        [(0.205 * np.cos(a), 0.02, 0.205 * np.sin(a)) for a in np.arange(0, 6.2, 0.7)],
    )
    case = box((0.22, 0.24, 0.36), IRON, 0.035, 5).at(0, 0.62, -0.32)
    ribs = copies(
        box((0.24, 0.26, 0.014), IRON, 0.006), [(0, 0.62, z) for z in np.linspace(-0.46, -0.18, 7)]
    )
    transfer = box((0.38, 0.2, 0.18), (0.36, 0.38, 0.40), 0.05, 5).at(0.09, 0.56, -0.06)
    flange = disc(0.055, 0.06, STEEL, 28, 0.01).turned("x", 90)
    lid = box((0.16, 0.03, 0.22), (0.36, 0.38, 0.40), 0.01).at(0, 0.75, -0.3)
    lever = sweep(
        curve([(0, 0.75, -0.28), (0, 0.95, -0.24), (0.01, 1.1, -0.14)], 16), 0.011, STEEL, 12
    )
    places = np.array(
        [(x, 0.765, z) for x in (-0.065, 0.065) for z in np.linspace(-0.39, -0.21, 4)]
    )
    return join(
        join(bell, ears).turned("x", 90).at(0, 0.68, -0.67),
        case, ribs, transfer, lid, lever, _bolts(places, 0.01),
        copies(flange, [(0.2, 0.54, -0.17), (0.2, 0.54, 0.05)]),
        ball(0.03, DARK, 20).at(0.01, 1.11, -0.13),
    )  # fmt: skip


def axle(z: float, forward: float) -> Shape:
    """A live axle with its differential and brake drums; `forward` is +1 where its shaft leads
    to the rear."""
    tube = lathe(
        [(0.045, -0.5), (0.045, -0.2), (0.06, -0.14), (0.06, 0.14), (0.045, 0.2), (0.045, 0.5)],
        DARK,
        24,
    )
    bulb = ball((0.15, 0.16, 0.15), (0.22, 0.23, 0.25), 36).at(0.2, 0, 0)
    plate = disc(0.13, 0.03, IRON, 36, 0.008).turned("x", 90).at(0.2, 0, -0.14 * forward)
    ring_ = [
        (0.2 + 0.11 * np.cos(a), 0.11 * np.sin(a), -0.155 * forward)
        for a in np.arange(0, 6.2, 0.63)
    ]
    bolts = _bolts(np.array(ring_), 0.011, "x")
    nose = lathe([(0.09, 0), (0.06, 0.14), (0.05, 0.16), (0.05, 0.2)], DARK, 28).turned(
        "x", 90 * forward
    )
    drum = join(
        disc(0.15, 0.07, IRON, 40, 0.012),
        copies(disc(0.153, 0.008, IRON, 40), [(0, y, 0) for y in (-0.02, 0, 0.02)]),
    ).turned("z", 90).at(0.52, 0, 0)  # fmt: skip
    parts = [tube.turned("z", 90), bulb, plate, bolts, nose.at(0.2, 0, 0.08 * forward), drum.both()]
    return join(*parts).at(y=AXLE_Y, z=z)


def springs(z: float) -> Shape:
    """Two leaf springs with shackles and dampers."""
    leaves = []
    for i, half in enumerate((0.46, 0.38, 0.30, 0.22, 0.14)):
        t = np.linspace(-1, 1, 18) * half
        path = np.column_stack([np.zeros(18), 0.335 + 0.9 * t**2 * 0.5 - 0.018 * i, t])
        leaves.append(sweep(path, 1.0, (0.3, 0.3, 0.32), section=rounded(0.014, 0.06, 0.006, 2)))
    eye = ring([(0.018, -0.032), (0.032, -0.032), (0.032, 0.032), (0.018, 0.032)], DARK, 20)
    eyes = copies(eye.turned("z", 90), [(0, 0.445, -0.465), (0, 0.445, 0.465)])
    clamp = box((0.09, 0.12, 0.05), DARK, 0.01)
    clamps = copies(clamp, [(0, 0.32, -0.07), (0, 0.32, 0.07)])
    damper = join(
        rod((-0.07, 0.36, 0.1), (-0.07, 0.55, 0.2), 0.035, (0.7, 0.16, 0.1), 18),
        rod((-0.07, 0.5, 0.17), (-0.07, 0.68, 0.27), 0.016, STEEL, 12),
    )
    return join(*leaves, eyes, clamps, damper).at(x=0.37, z=z).both()


def shaft(a: Sequence[float], b: Sequence[float]) -> Shape:
    """A propeller shaft between two joints."""
    cross = join(
        ball(0.045, IRON, 20),
        box((0.11, 0.03, 0.03), STEEL, 0.01),
        box((0.03, 0.11, 0.03), STEEL, 0.01),
    )
    return join(rod(a, b, 0.032, (0.25, 0.25, 0.27), 20), copies(cross, [a, b]))


def off_road_wheel() -> Shape:
    """A wheel about the x axis with a lugged tyre, its outer face at +x."""
    r, w = 0.355, 0.2
    carcass = tyre(r, w, 0.13, 48, 6)
    lug = box((0.105, 0.035, 0.032), RUBBER, 0.008, 1).turned("y", 20).at(0.05, r, 0)
    other = lug.mirrored().turned("x", 360 / 64)
    lugs = spun(join(lug, other), 32)
    dish = lathe(
        [(0, -0.02), (0.21, -0.09), (0.235, -0.1), (0.235, 0.09), (0.215, 0.1), (0.205, 0.04),
         (0.17, 0.02), (0.12, 0.055), (0.07, 0.055), (0.06, 0.03), (0, 0.03)],
        (0.33, 0.38, 0.20), 48, sharp=35,
    )  # fmt: skip
    nuts = [(0.085 * np.cos(a), 0.05, 0.085 * np.sin(a)) for a in np.arange(0, 6.2, 1.257)]
    hub = join(disc(0.045, 0.09, STEEL, 24, 0.012).at(y=0.07), _bolts(np.array(nuts), 0.013))
    return join(carcass, lugs, join(dish, hub).turned("z", -90))
