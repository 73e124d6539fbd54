"""After LabBSP2010's assignment: a cottage with plain and textured windows, a tree of leaves that
intersect, a fish bowl with fish, a fence, and a cow for the brave. Panes let half the light pass.
"""

from __future__ import annotations

import numpy as np

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.translucent.solids import Faces, box, disc, prism, turned
from seethrough.renderer.polygons.polygons import Polygons, join, polygons_from

HALF = 0.5
SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def painted(faces: Faces, color: tuple[float, ...], textured: bool = False) -> Polygons:
    """One object of one colour (r, g, b, opacity); `textured` puts the texture on rectangles."""
    columns = []
    for face in faces:
        uv = SQUARE if textured else np.zeros((len(face), 2))
        flag = np.full((len(face), 1), float(textured))
        columns.append(np.hstack([np.tile(color, (len(face), 1)), uv, flag]))
    return polygons_from(faces, columns, np.zeros(len(faces), np.int64))


def cottage() -> tuple[Polygons, Polygons, Floats]:
    """Two walls of several polygons with a plain pane in the middle, two of one textured quad."""
    clear, opaque = [], [painted(box((-5, -0.2, -4), (5, 0, 4)), (0.45, 0.6, 0.35, 1.0))]
    roof = [(-0.2, 4.6), (4.4, 3.0), (-0.2, 4.8), (-4.8, 3.0)]
    opaque.append(
        painted(prism([(x, y) for x, y in roof[:1] + roof[1:]], 2, -3.2, 3.2), (0.6, 0.3, 0.25, 1))
    )
    for z in (-3.0, 3.0):
        x = [-4.0, -1.5, 1.5, 4.0]
        frame = [_upright(x[0], x[1], 0, 3, z), _upright(x[2], x[3], 0, 3, z)]
        frame += [_upright(x[1], x[2], 0, 1, z), _upright(x[1], x[2], 2.3, 3, z)]
        opaque.append(painted(frame, (0.8, 0.75, 0.65, 1.0)))
        clear.append(painted([_upright(x[1], x[2], 1, 2.3, z)], (0.5, 0.7, 0.9, HALF)))
    for side in (-4.0, 4.0):
        wall = np.array([[side, 0, -3], [side, 0, 3], [side, 3, 3], [side, 3, -3.0]])
        clear.append(painted([wall], (1, 1, 1, 1), textured=True))
    return join(clear), join(opaque), _window_texture()


def _upright(a: float, b: float, low: float, high: float, z: float) -> Floats:
    return np.array([[a, low, z], [b, low, z], [b, high, z], [a, high, z]])


def _window_texture() -> Floats:
    """Bricks around a middle of opacity one half."""
    rows, columns = np.mgrid[0:64, 0:64]
    joint = (rows % 8 == 0) | ((columns + 8 * (rows // 8 % 2)) % 16 == 0)
    picture = np.where(joint[..., None], [0.8, 0.78, 0.75, 1.0], [0.65, 0.35, 0.28, 1.0])
    picture[18:46, 14:50] = [0.5, 0.75, 0.9, HALF]
    return picture


def leaves(count: int = 60) -> tuple[Polygons, Polygons, Floats]:
    """Square leaves turned every way about a trunk: they intersect."""
    rng = np.random.default_rng(np.random.SeedSequence(3, spawn_key=(1,)))
    faces = []
    for _ in range(count):
        middle = np.array([0, 3.2, 0]) + rng.normal(size=3) * [0.9, 0.7, 0.9]
        q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        u, v = 0.55 * q[0], 0.55 * q[1]
        faces.append(np.array([middle - u - v, middle + u - v, middle + u + v, middle - u + v]))
    trunk = painted(prism(disc((0, 0), 0.35, 8), 1, 0.0, 3.0, 0.5), (0.45, 0.32, 0.2, 1.0))
    rows, columns = np.mgrid[0:64, 0:64] / 31.5 - 1
    inside = rows**2 + (1.6 * columns) ** 2 / np.maximum(1.05 - 0.5 * rows, 0.1) < 0.9
    picture = np.where(inside[..., None], [0.75, 1.0, 0.45, HALF], [0.75, 1.0, 0.45, 0.0])
    tints = rng.uniform(0.45, 1.0, (count, 3))
    return (
        join([painted([f], (*t, 1.0), True) for f, t in zip(faces, tints, strict=True)]),
        trunk,
        picture,
    )


def ball(center: tuple[float, ...], radii: tuple[float, ...], around: int, up: int) -> Faces:
    """An ellipsoid of flat rectangles, with triangles at the poles."""
    angles = np.arange(around) * 2 * np.pi / around
    heights = np.linspace(-np.pi / 2, np.pi / 2, up + 1)
    grid = np.array(
        [
            [[np.cos(h) * np.sin(a), np.sin(h), np.cos(h) * np.cos(a)] for a in angles]
            for h in heights
        ]
    )
    grid[0, :], grid[-1, :] = [0, -1, 0], [0, 1, 0]
    grid = grid * radii + center
    faces = []
    for i in range(up):
        for j in range(around):
            k = (j + 1) % around
            corners = [grid[i, j], grid[i, k], grid[i + 1, k], grid[i + 1, j]]
            if i == 0:
                corners = [corners[0], corners[2], corners[3]]
            elif i == up - 1:
                corners = corners[:3]
            faces.append(np.array(corners))
    return faces


def fishbowl() -> tuple[Polygons, Polygons, None]:
    """A bowl of glass, water in it, and five fish."""
    parts = [painted(ball((0, 2, 0), (2, 2, 2), 16, 10), (0.6, 0.8, 0.95, HALF))]
    surface = np.array(
        [[1.7 * np.cos(a), 2.6, -1.7 * np.sin(a)] for a in np.arange(12) * np.pi / 6]
    )
    parts.append(painted([surface], (0.4, 0.7, 0.9, HALF)))
    rng = np.random.default_rng(np.random.SeedSequence(3, spawn_key=(2,)))
    for i in range(5):
        place = rng.uniform(-0.75, 0.75, 3) * [1, 0.6, 1] + [0, 1.8, 0]
        fish = ball(tuple(place), (0.32, 0.16, 0.1), 6, 4)
        tail = np.array([[0.28, 0, 0], [0.55, 0.18, 0.02], [0.55, -0.18, -0.02]]) + place
        whole = turned([*fish, tail], 1.3 * i, (place[2], place[0]))
        parts.append(painted(whole, (1.0, 0.5 + 0.1 * i, 0.15, 0.8)))
    stand = painted(prism(disc((0, 0), 1.2, 12), 1, -0.4, -0.1), (0.5, 0.4, 0.35, 1.0))
    return join(parts), stand, None


def fence() -> tuple[Polygons, Polygons, Floats]:
    """A square of textured panels, two of which cross the others."""
    panels = [
        _upright(-4, 4, 0, 1.5, -2), _upright(-4, 4, 0, 1.5, 2),
        np.array([[-3, 0, -3], [-3, 0, 3], [-3, 1.5, 3], [-3, 1.5, -3.0]]),
        np.array([[3, 0, -3], [3, 0, 3], [3, 1.5, 3], [3, 1.5, -3.0]]),
        np.array([[-4, 0, -3], [4, 0, 3], [4, 1.5, 3], [-4, 1.5, -3.0]]),
    ]  # fmt: skip
    rows, columns = np.mgrid[0:64, 0:64]
    slat = (columns % 8 < 5) | ((rows // 8) % 4 == 1)
    picture = np.where(slat[..., None], [0.95, 0.8, 0.6, HALF], [0.95, 0.8, 0.6, 0.0])
    ground = painted(box((-5, -0.2, -4), (5, 0, 4)), (0.45, 0.6, 0.35, 1.0))
    tints = [(1, 0.8, 0.6), (0.6, 0.9, 1), (0.9, 1, 0.6), (1, 0.6, 0.9), (0.8, 0.8, 0.8)]
    return (
        join([painted([f], (*t, 1), True) for f, t in zip(panels, tints, strict=True)]),
        ground,
        picture,
    )


def cow() -> tuple[Polygons, Polygons, None]:
    """A cow of nine bodies that reach into one another."""
    hide, spot, pink = (0.9, 0.88, 0.85, HALF), (0.35, 0.25, 0.2, HALF), (0.95, 0.7, 0.7, HALF)
    parts = [
        painted(ball((0, 1.6, 0), (1.5, 0.75, 0.7), 14, 9), hide),
        painted(ball((-0.4, 1.9, 0.2), (0.7, 0.55, 0.62), 10, 7), spot),
        painted(ball((1.7, 2.1, 0), (0.6, 0.42, 0.4), 10, 7), hide),
        painted(ball((2.15, 1.95, 0), (0.3, 0.26, 0.28), 8, 5), pink),
        painted(ball((-0.6, 0.95, 0), (0.35, 0.28, 0.3), 8, 5), pink),
    ]
    for x in (-1.0, 1.0):
        for z in (-0.4, 0.4):
            parts.append(painted(prism(disc((z, x), 0.2, 7, 0.3), 1, 0.03, 1.5, 1.3), hide))
    ground = painted(box((-3, -0.2, -2), (3.5, 0, 2)), (0.45, 0.6, 0.35, 1.0))
    return join(parts), ground, None
