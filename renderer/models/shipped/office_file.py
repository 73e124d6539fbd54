"""An office of three rooms with 40 things in it, to walk through. Metres; one enters at +z."""

from __future__ import annotations

from math import pi

import numpy as np

from seethrough.renderer.models.forms.shapes import Color, Shape, join
from seethrough.renderer.models.forms.surfaces import ball, box, disc, lathe, rod
from seethrough.renderer.models.shipped.glb import Node
from seethrough.renderer.scene.transforms import rotation_y, translation

WOOD: Color = (0.66, 0.48, 0.30)
GREY: Color = (0.55, 0.57, 0.60)
DARK: Color = (0.13, 0.14, 0.16)
WHITE: Color = (0.92, 0.92, 0.90)
RED: Color = (0.78, 0.16, 0.12)
BLUE: Color = (0.14, 0.32, 0.62)
GREEN: Color = (0.18, 0.50, 0.24)
YELLOW: Color = (0.93, 0.76, 0.14)
WALL_COLOR: Color = (0.85, 0.83, 0.78)
HIGH, THICK = 2.6, 0.12
WIDE, DEEP = 12.0, 8.0  # x from −6 to 6, z from −4 to 4
# Walls by where they begin and end, (x, z) each; gaps are doorways.
WALLS = (
    ((-6, -4), (6, -4)), ((-6, -4), (-6, 4)), ((6, -4), (6, 4)),
    ((-6, 4), (-0.6, 4)), ((0.6, 4), (6, 4)),
    ((-2, -4), (-2, 0.8)), ((-2, 2.0), (-2, 4)),
    ((2, -4), (2, 0.8)), ((2, 2.0), (2, 4)),
)  # fmt: skip
# name, shape, (x, y, z), turn in degrees; those with a ! are looked for.
THINGS = (
    ("left desk", "desk", (-5.2, 0, -2.0), 90), ("left chair", "chair", (-4.4, 0, -2.0), 90),
    ("left screen", "screen", (-5.4, 0.75, -2.0), 90),
    ("!red mug", "red mug", (-5.0, 0.75, -2.6), 0),
    ("!telephone", "telephone", (-5.1, 0.75, -1.35), 90),
    ("left shelf", "shelf", (-4.0, 0, -3.75), 0), ("!globe", "globe", (-4.3, 1.62, -3.75), 0),
    ("!blue folder", "folder", (-3.8, 0.83, -3.72), 0),
    ("left cabinet", "cabinet", (-5.6, 0, 1.5), 90), ("!radio", "radio", (-5.6, 1.1, 1.5), 90),
    ("!waste bin", "bin", (-2.5, 0, 3.4), 0), ("left plant", "plant", (-5.4, 0, 3.4), 0),
    ("!umbrella", "umbrella", (-2.3, 0, 2.6), 0),
    ("meeting table", "round table", (0, 0, -1.6), 0),
    ("north chair", "chair", (0, 0, -2.75), 0), ("south chair", "chair", (0, 0, -0.45), 180),
    ("west chair", "chair", (-1.15, 0, -1.6), 90), ("east chair", "chair", (1.15, 0, -1.6), -90),
    ("!laptop", "laptop", (0.1, 0.75, -1.3), 0), ("!water jug", "jug", (-0.2, 0.75, -1.9), 0),
    ("!calculator", "calculator", (0.3, 0.75, -1.75), 20),
    ("whiteboard", "board", (0, 1.4, -3.9), 0), ("!wall clock", "clock", (1.3, 2.0, -3.91), 0),
    ("coat stand", "stand", (1.5, 0, 3.4), 0), ("!briefcase", "briefcase", (1.35, 0, 0.4), 15),
    ("middle plant", "plant", (-1.5, 0, 3.4), 0),
    ("right desk", "desk", (5.2, 0, -1.0), -90), ("right chair", "chair", (4.4, 0, -1.0), -90),
    ("right screen", "screen", (5.4, 0.75, -1.0), -90),
    ("!desk lamp", "lamp", (5.3, 0.75, -0.3), -90),
    ("!yellow cup", "yellow cup", (5.0, 0.75, -1.6), 0),
    ("printer", "printer", (3.0, 0.72, -3.5), 0),
    ("printer table", "small table", (3.0, 0, -3.5), 0),
    ("!paper stack", "paper", (3.45, 0.72, -3.4), 0),
    ("right shelf", "shelf", (4.8, 0, -3.75), 0), ("!trophy", "trophy", (4.6, 1.23, -3.72), 0),
    ("!toy car", "toy car", (5.1, 0.44, -3.7), 0),
    ("sofa", "sofa", (5.3, 0, 2.2), -90), ("!cushion", "cushion", (5.25, 0.55, 2.7), -70),
    ("!fire extinguisher", "extinguisher", (2.25, 0, 3.5), 0),
)  # fmt: skip
CAMERAS = (("entrance", (0, 1.6, 5.5), 0), ("left room", (-2.6, 1.6, 1.4), 65),
           ("meeting room", (0, 1.6, 3.2), 0), ("right room", (2.6, 1.6, 1.4), -65))  # fmt: skip


def office_file() -> tuple[list[Node], dict[str, Shape]]:
    """Nodes and shapes: floor, walls, 40 things, four places to stand."""
    shapes = {name: make() for name, make in MADE.items()}
    nodes = [Node("floor", "floor", extras={"kind": "floor", "impenetrable": True})]
    shapes["floor"] = box((WIDE + THICK, 0.1, DEEP + THICK), (0.50, 0.44, 0.38)).at(y=-0.05)
    for number, ((x0, z0), (x1, z1)) in enumerate(WALLS, start=1):
        long = (abs(x1 - x0) + THICK, abs(z1 - z0) + THICK)
        shapes[f"wall {number}"] = box((long[0], HIGH, long[1]), WALL_COLOR)
        at = translation((x0 + x1) / 2, HIGH / 2, (z0 + z1) / 2)
        nodes.append(Node(f"wall {number}", f"wall {number}", at, {"wall": True}))
    for name, shape, (x, y, z), turn in THINGS:
        place = translation(x, y, z) @ rotation_y(turn * pi / 180)
        nodes.append(
            Node(name.lstrip("!"), shape, place, {"target": True} if name[0] == "!" else {})
        )
    nodes += [
        Node(name, "", translation(*at) @ rotation_y(turn * pi / 180), fov_y=pi / 3)
        for name, at, turn in CAMERAS
    ]
    return nodes, shapes


def _legs(wide: float, high: float, deep: float, color: Color) -> Shape:
    leg = box((0.05, high, 0.05), color).at(y=high / 2)
    return join(*(leg.at(x=x, z=z) for x in (-wide / 2, wide / 2) for z in (-deep / 2, deep / 2)))


def _table(wide: float, high: float, deep: float) -> Shape:
    top = box((wide, 0.04, deep), WOOD, 0.01).at(y=high - 0.02)
    return join(top, _legs(wide - 0.12, high - 0.04, deep - 0.12, DARK))


def _chair() -> Shape:
    seat = box((0.45, 0.06, 0.45), BLUE, 0.02).at(y=0.46)
    back = box((0.43, 0.45, 0.05), BLUE, 0.02).at(y=0.78, z=-0.21)
    return join(seat, back, _legs(0.38, 0.43, 0.38, GREY))


def _screen() -> Shape:
    glass = box((0.52, 0.30, 0.01), (0.20, 0.36, 0.50)).at(y=0.32, z=0.022)
    return join(
        box((0.56, 0.34, 0.03), DARK, 0.008).at(y=0.32),
        glass,
        box((0.04, 0.16, 0.03), DARK).at(y=0.08),
        box((0.24, 0.02, 0.18), DARK).at(y=0.01),
    )


def _mug(color: Color) -> Shape:
    cup = lathe([(0.034, 0), (0.042, 0.01), (0.042, 0.095), (0.036, 0.095), (0.034, 0.012)], color)
    return join(
        cup,
        box((0.012, 0.05, 0.012), color).at(0.055, 0.05, 0),
        box((0.022, 0.01, 0.012), color).at(0.046, 0.075, 0),
        box((0.022, 0.01, 0.012), color).at(0.046, 0.025, 0),
    )


def _telephone() -> Shape:
    return join(
        box((0.18, 0.05, 0.20), DARK, 0.015).at(y=0.025),
        box((0.20, 0.03, 0.05), RED, 0.012).at(0, 0.07, -0.06),
        *(
            box((0.02, 0.008, 0.02), WHITE).at(x, 0.053, z)
            for x in (-0.04, 0, 0.04)
            for z in (0.0, 0.035, 0.07)
        ),
    )


def _shelf() -> Shape:
    boards = [box((1.2, 0.03, 0.32), WOOD).at(y=y) for y in (0.02, 0.42, 0.81, 1.21, 1.60)]
    sides = [box((0.03, 1.6, 0.32), WOOD).at(x, 0.8, 0) for x in (-0.6, 0.6)]
    return join(*boards, *sides)


def _globe() -> Shape:
    return join(
        ball(0.14, BLUE, 24).at(y=0.19),
        disc(0.09, 0.02, WOOD).at(y=0.01),
        rod((0, 0.02, 0), (0, 0.06, 0), 0.012, DARK),
        box((0.14, 0.06, 0.06), GREEN, 0.02).at(0.03, 0.24, 0.09),
    )


def _plant() -> Shape:
    pot = lathe([(0.14, 0), (0.19, 0.32), (0.16, 0.32), (0.15, 0.28)], (0.62, 0.32, 0.20), 20)
    a = np.arange(10) * 2.4
    leaves = [
        ball((0.05, 0.20, 0.02), GREEN, 10)
        .turned("x", 35)
        .at(0, 0.5, 0.16)
        .turned("y", float(np.degrees(t)))
        .at(y=0.05 * (k % 4))
        for k, t in enumerate(a)
    ]
    return join(pot, rod((0, 0.2, 0), (0, 0.75, 0), 0.02, GREEN), *leaves)


def _umbrella() -> Shape:
    cloth = lathe([(0.01, 0.04), (0.05, 0.6), (0.012, 0.66)], YELLOW, 12)
    return join(
        cloth,
        rod((0, 0, 0), (0, 0.85, 0), 0.008, DARK),
        rod((0, 0.85, 0), (0.06, 0.85, 0), 0.012, WOOD),
    )


def _laptop() -> Shape:
    lid = join(
        box((0.32, 0.21, 0.01), GREY, 0.004), box((0.29, 0.18, 0.004), (0.2, 0.4, 0.6)).at(z=0.007)
    )
    return join(
        box((0.32, 0.015, 0.22), GREY, 0.005).at(y=0.008),
        box((0.28, 0.004, 0.10), DARK).at(0, 0.017, -0.03),
        lid.turned("x", -15).at(0, 0.115, -0.13),
    )


def _jug() -> Shape:
    body = lathe(
        [(0.05, 0), (0.075, 0.06), (0.06, 0.18), (0.065, 0.24), (0.055, 0.24), (0.05, 0.18)],
        (0.55, 0.75, 0.80),
        24,
    )
    return join(body, box((0.012, 0.14, 0.014), (0.55, 0.75, 0.80)).at(0.09, 0.14, 0))


def _calculator() -> Shape:
    keys = [
        box((0.018, 0.006, 0.014), WHITE).at(x, 0.018, z)
        for x in (-0.03, 0, 0.03)
        for z in (0.0, 0.025, 0.05)
    ]
    return join(
        box((0.10, 0.016, 0.16), DARK, 0.004).at(y=0.008),
        box((0.08, 0.004, 0.03), GREEN).at(0, 0.018, -0.05),
        *keys,
    )


def _clock() -> Shape:
    face = join(disc(0.17, 0.03, DARK, 32), disc(0.15, 0.034, WHITE, 32))
    hands = join(
        box((0.015, 0.01, 0.10), DARK).at(0, 0.02, -0.04),
        box((0.13, 0.01, 0.012), DARK).at(0.055, 0.02, 0),
    )
    return join(face, hands).turned("x", 90)


def _stand() -> Shape:
    pegs = [
        rod((0, 1.7, 0), (0.15 * np.cos(t), 1.8, 0.15 * np.sin(t)), 0.012, WOOD)
        for t in np.arange(6) * pi / 3
    ]
    return join(rod((0, 0, 0), (0, 1.75, 0), 0.025, WOOD), disc(0.2, 0.04, WOOD).at(y=0.02), *pegs)


def _briefcase() -> Shape:
    return join(
        box((0.42, 0.30, 0.10), (0.35, 0.20, 0.10), 0.02).at(y=0.15),
        box((0.14, 0.02, 0.02), DARK).at(y=0.34),
        *(box((0.02, 0.05, 0.02), DARK).at(x, 0.32, 0) for x in (-0.06, 0.06)),
    )


def _lamp() -> Shape:
    shade = lathe([(0.09, 0.0), (0.03, 0.10), (0.02, 0.10), (0.07, 0.0)], RED, 24)
    return join(
        disc(0.08, 0.02, DARK).at(y=0.01),
        rod((0, 0.02, 0), (0.05, 0.25, 0), 0.01, DARK),
        rod((0.05, 0.25, 0), (-0.10, 0.42, 0), 0.01, DARK),
        shade.at(-0.10, 0.34, 0),
    )


def _trophy() -> Shape:
    return join(
        box((0.10, 0.05, 0.10), DARK).at(y=0.025),
        lathe(
            [(0.015, 0.05), (0.012, 0.12), (0.05, 0.18), (0.06, 0.26), (0.05, 0.26), (0.02, 0.17)],
            (0.86, 0.68, 0.20),
            24,
        ),
    )


def _toy_car() -> Shape:
    wheels = [
        disc(0.022, 0.02, DARK, 16).turned("x", 90).at(x, 0.022, z)
        for x in (-0.06, 0.06)
        for z in (-0.045, 0.045)
    ]
    return join(
        box((0.20, 0.05, 0.09), RED, 0.015).at(y=0.05),
        box((0.10, 0.04, 0.08), WHITE, 0.012).at(-0.01, 0.092, 0),
        *wheels,
    )


def _sofa() -> Shape:
    return join(
        box((1.7, 0.25, 0.75), GREEN, 0.04).at(y=0.30),
        box((1.7, 0.45, 0.2), GREEN, 0.05).at(0, 0.62, -0.30),
        *(box((0.2, 0.35, 0.75), GREEN, 0.04).at(x, 0.48, 0) for x in (-0.85, 0.85)),
        _legs(1.5, 0.18, 0.55, DARK),
    )


def _extinguisher() -> Shape:
    body = lathe([(0.07, 0), (0.075, 0.02), (0.075, 0.40), (0.03, 0.46), (0.02, 0.5)], RED, 24)
    return join(
        body,
        box((0.10, 0.03, 0.03), DARK).at(0.03, 0.52, 0),
        rod((0.07, 0.50, 0), (0.11, 0.25, 0), 0.012, DARK),
    )


def _radio() -> Shape:
    return join(
        box((0.34, 0.18, 0.10), WOOD, 0.015).at(y=0.09),
        disc(0.06, 0.01, DARK, 24).turned("x", 90).at(-0.08, 0.09, 0.052),
        disc(0.02, 0.02, WHITE, 16).turned("x", 90).at(0.10, 0.06, 0.055),
        rod((0.13, 0.18, 0), (0.22, 0.42, 0), 0.004, GREY),
    )


def _printer() -> Shape:
    return join(
        box((0.45, 0.25, 0.38), WHITE, 0.02).at(y=0.125),
        box((0.30, 0.02, 0.25), WHITE).at(0, 0.10, 0.28),
        box((0.35, 0.01, 0.20), GREY).at(0, 0.255, -0.05),
    )


def _cabinet() -> Shape:
    fronts = [
        box((0.44, 0.32, 0.02), (0.62, 0.64, 0.67), 0.004).at(0, y, 0.27) for y in (0.2, 0.55, 0.9)
    ]
    grips = [box((0.12, 0.02, 0.02), DARK).at(0, y + 0.08, 0.29) for y in (0.2, 0.55, 0.9)]
    return join(box((0.48, 1.1, 0.52), GREY, 0.006).at(y=0.55), *fronts, *grips)


MADE = {
    "desk": lambda: _table(1.6, 0.75, 0.75), "chair": _chair, "screen": _screen,
    "red mug": lambda: _mug(RED), "yellow cup": lambda: _mug(YELLOW), "telephone": _telephone,
    "shelf": _shelf, "globe": _globe,
    "folder": lambda: join(box((0.07, 0.31, 0.26), BLUE, 0.006).at(y=0.155),
                           box((0.072, 0.08, 0.03), WHITE).at(y=0.2, z=0.12)),
    "cabinet": _cabinet, "radio": _radio,
    "bin": lambda: lathe([(0.12, 0), (0.15, 0.32), (0.14, 0.32), (0.115, 0.02)], GREY, 20),
    "plant": _plant, "umbrella": _umbrella,
    "round table": lambda: join(disc(0.75, 0.04, WOOD, 40, 0.008).at(y=0.73),
                                rod((0, 0, 0), (0, 0.72, 0), 0.05, DARK),
                                disc(0.3, 0.03, DARK).at(y=0.015)),
    "laptop": _laptop, "jug": _jug, "calculator": _calculator,
    "board": lambda: join(box((1.6, 1.0, 0.03), GREY), box((1.52, 0.92, 0.034), WHITE)),
    "clock": _clock, "stand": _stand, "briefcase": _briefcase, "lamp": _lamp,
    "printer": _printer, "small table": lambda: _table(1.1, 0.72, 0.55),
    "paper": lambda: box((0.21, 0.06, 0.30), WHITE).at(y=0.03), "trophy": _trophy,
    "toy car": _toy_car, "sofa": _sofa,
    "cushion": lambda: box((0.40, 0.12, 0.40), YELLOW, 0.05).turned("x", 60),
    "extinguisher": _extinguisher,
}  # fmt: skip
