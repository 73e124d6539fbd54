"""A gearbox of 60 parts: shafts, gears and bearings in a housing with openings. Metres."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.models.forms.shapes import Color, Shape, join
from seethrough.renderer.models.forms.surfaces import ball, box, disc, lathe, ring, rod, tube
from seethrough.renderer.models.shipped.glb import Node
from seethrough.renderer.scene.transforms import translation

CAST: Color = (0.55, 0.58, 0.60)
STEEL: Color = (0.75, 0.76, 0.78)
BRONZE: Color = (0.72, 0.50, 0.22)
BLUED: Color = (0.25, 0.30, 0.42)
RUBBER: Color = (0.12, 0.12, 0.13)
RED: Color = (0.70, 0.16, 0.12)
WIDE, HIGH, DEEP, WALL = 0.56, 0.30, 0.40, 0.016  # of the housing
Z = (-0.11, 0.0, 0.11)  # of the three shafts, which lie along x
SHAFTS = ("input", "middle", "output")
# Along a shaft: what is on it, by name, where (x), pitch radius and teeth.
GEARS = (
    (("input gear", -0.15, 0.035, 14), ("idle gear", 0.02, 0.055, 22),
     ("pump gear", 0.15, 0.045, 18)),
    (("first gear", -0.15, 0.073, 30), ("second gear", 0.02, 0.053, 22),
     ("third gear", 0.10, 0.040, 16)),
    (("reverse gear", -0.07, 0.060, 24), ("output gear", 0.10, 0.068, 28),
     ("speedometer gear", 0.19, 0.028, 12)),
)  # fmt: skip


def assembly_file() -> tuple[list[Node], dict[str, Shape]]:
    """60 nodes: the housing in six plates, what turns in it, and what holds it together."""
    shapes = {
        "side": _lid(WIDE, HIGH), "end": _end(), "top": _lid(WIDE, DEEP), "bearing": _bearing(),
        "seal": ring([(0.012, -0.004), (0.024, -0.004), (0.024, 0.004), (0.012, 0.004)], RUBBER),
        "bolt": _bolt(), "shaft": _along(lathe([(0.012, -0.33), (0.012, 0.33)], STEEL, 24)),
        "key": box((0.03, 0.006, 0.006), BRONZE), "ring": _ring(), "plug": _plug(),
        "sleeve": _along(lathe([(0.018, -0.014), (0.022, -0.010), (0.022, 0.010),
                                (0.018, 0.014)], BRONZE, 24)),
        "fork": _fork(), "pump": _pump(), "sieve": _sieve(), "spring": _spring(),
    }  # fmt: skip
    nodes = _housing()
    for number, (shaft, z) in enumerate(zip(SHAFTS, Z, strict=True)):
        nodes.append(_target(f"{shaft} shaft", "shaft", (0, 0, z)))
        for name, x, radius, teeth in GEARS[number]:
            shapes[name] = _gear(radius, teeth, (BLUED, STEEL, BRONZE)[number])
            nodes.append(_target(name, name, (x, 0, z)))
        for side, x in (("left", -0.255), ("right", 0.255)):
            nodes.append(_target(f"{side} bearing of the {shaft} shaft", "bearing", (x, 0, z)))
        nodes.append(_node(f"seal of the {shaft} shaft", "seal", (-0.275, 0, z), _X))
        nodes.append(_node(f"key of the {shaft} shaft", "key", (-0.15, 0.012, z)))
        nodes.append(_node(f"retaining ring of the {shaft} shaft", "ring", (0.225, 0, z)))
    nodes += [
        _target("sliding sleeve", "sleeve", (-0.01, 0, Z[2])),
        _target("shift fork", "fork", (-0.01, 0.02, Z[2])),
        _target("oil pump", "pump", (0.12, -0.09, -0.05)),
        _target("oil sieve", "sieve", (-0.06, -0.115, 0.02)),
        _target("detent spring", "spring", (-0.12, 0.07, 0.14)),
        _target("detent ball", "ball", (-0.12, 0.035, 0.14)),
        _node("oil plug", "plug", (0.0, -0.165, 0.1)),
        _node("breather", "breather", (0.0, 0.175, 0.06)),
    ]
    shapes |= {"ball": ball(0.011, RED, 20), "breather": _plug().mirrored("y")}
    bolts = 60 - len(nodes)
    places = [(x, 0.158, z) for z in (-0.185, 0.185) for x in np.linspace(-0.26, 0.26, bolts // 2)]
    places += [(0.0, 0.158, 0.0)] * (bolts % 2)
    nodes += [_node(f"bolt {i}", "bolt", at) for i, at in enumerate(places, start=1)]
    return nodes, shapes


_X = np.array([[0.0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])  # y becomes x


def _node(name: str, shape: str, at: tuple[float, float, float],
          turn: NDArray[np.float64] | None = None, **extras: object) -> Node:  # fmt: skip
    place = translation(*at)
    return Node(name, shape, place if turn is None else place @ turn, extras)


def _target(name: str, shape: str, at: tuple[float, float, float]) -> Node:
    return _node(name, shape, at, target=True, group="inside")


def _housing() -> list[Node]:
    """Two sides, two ends, lid and floor."""
    upright = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    nodes = [
        _node(f"{name} side", "side", (0, 0, z), upright, group="housing")
        for name, z in (("front", -DEEP / 2), ("back", DEEP / 2))
    ]
    nodes += [
        _node(f"{name} end", "end", (x, 0, 0), group="housing")
        for name, x in (("left", -WIDE / 2), ("right", WIDE / 2))
    ]
    return nodes + [
        _node(name, "top", (0, y, 0), group="housing")
        for name, y in (("lid", HIGH / 2), ("floor", -HIGH / 2))
    ]


def _lid(wide: float, deep: float) -> Shape:
    """A frame with two openings through which some of the inside shows, flat in x and z."""
    rim = 0.2 * deep
    long = box((wide, WALL, rim), CAST, 0.004)
    short = box((0.16 * wide, WALL, deep), CAST, 0.004)
    rib = box((0.05 * wide, 1.5 * WALL, deep), CAST, 0.004)
    return join(
        *(long.at(0, 0, z) for z in (-(deep - rim) / 2, (deep - rim) / 2)),
        *(short.at(x, 0, 0) for x in (-0.42 * wide, 0.42 * wide)), rib,
    )  # fmt: skip


def _end() -> Shape:
    plate = box((WALL, HIGH, DEEP), CAST, 0.004)
    boss = [_along(disc(0.04, 0.034, CAST, 32, 0.004)).at(0, 0, z) for z in Z]
    return join(plate, *boss)


def _along(one: Shape) -> Shape:
    """What is turned about y, about x."""
    return one.turned("z", 90)


def _gear(radius: float, teeth: int, color: Color) -> Shape:
    """A spur gear with a hub, its axis along x."""
    step = 2 * np.pi / teeth
    shares, depths = (-0.30, -0.14, 0.14, 0.30), (-0.006, 0.006, 0.006, -0.006)
    angles = np.array([k * step + s * step for k in range(teeth) for s in shares])
    radii = np.array([radius + d for _ in range(teeth) for d in depths])
    outline = np.column_stack([radii * np.cos(angles), radii * np.sin(angles)])
    bottom, top = (np.column_stack([outline[:, 0], np.full(len(outline), y), -outline[:, 1]])
                   for y in (-0.012, 0.012))  # fmt: skip
    wheel = tube([bottom, top], color, sharp=20)
    hub = disc(min(0.024, radius * 0.6), 0.04, color, 24, 0.003)
    return _along(join(wheel, hub))


def _bearing() -> Shape:
    outer = ring([(0.028, -0.008), (0.034, -0.008), (0.034, 0.008), (0.028, 0.008)], STEEL)
    inner = ring([(0.013, -0.008), (0.018, -0.008), (0.018, 0.008), (0.013, 0.008)], STEEL)
    a = np.arange(9) * 2 * np.pi / 9
    balls = [ball(0.0062, BRONZE, 10).at(0.023 * np.cos(t), 0, 0.023 * np.sin(t)) for t in a]
    return _along(join(outer, inner, *balls))


def _ring() -> Shape:
    return _along(ring([(0.012, -0.002), (0.019, -0.002), (0.019, 0.002), (0.012, 0.002)], BLUED))


def _bolt() -> Shape:
    return join(disc(0.010, 0.008, STEEL, 6).at(y=0.006), disc(0.005, 0.03, STEEL, 12).at(y=-0.01))


def _plug() -> Shape:
    return join(disc(0.014, 0.010, RED, 6), disc(0.010, 0.02, STEEL, 16).at(y=0.01))


def _fork() -> Shape:
    arms = join(box((0.008, 0.06, 0.008), RED).at(0, 0, 0.028),
                box((0.008, 0.06, 0.008), RED).at(0, 0, -0.028))  # fmt: skip
    return join(arms, box((0.008, 0.012, 0.064), RED).at(0, 0.034, 0),
                box((0.01, 0.07, 0.012), RED).at(0, 0.072, 0))  # fmt: skip


def _pump() -> Shape:
    body = box((0.08, 0.05, 0.06), BRONZE, 0.008)
    return join(body, disc(0.014, 0.03, BRONZE, 24).at(0, 0.035, 0))


def _sieve() -> Shape:
    bars = [box((0.09, 0.004, 0.004), STEEL).at(0, 0, z) for z in np.linspace(-0.03, 0.03, 7)]
    bars += [box((0.004, 0.004, 0.064), STEEL).at(x, 0.004, 0) for x in np.linspace(-0.04, 0.04, 9)]
    return join(*bars, box((0.1, 0.01, 0.07), STEEL, 0.003).at(0, -0.01, 0))


def _spring() -> Shape:
    """Five turns, of straight pieces."""
    t = np.linspace(0, 5 * 2 * np.pi, 61)
    path = np.column_stack([0.009 * np.cos(t), t / t[-1] * 0.05 - 0.025, 0.009 * np.sin(t)])
    return join(*(rod(a, b, 0.002, BLUED, 6) for a, b in pairwise(path)))
