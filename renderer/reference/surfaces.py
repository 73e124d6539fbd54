"""All surfaces at all pixels, front and back, by scan conversion of its own in float64."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bools, Floats, Ints
from seethrough.renderer.reference.pixel_fragments import to_edges, triangles
from seethrough.renderer.techniques.base import Shot
from seethrough.renderer.techniques.seen import Surfaces

NEAR = 1.0 / 256.0  # pixels: closer to an edge, float32 may fall to its other side


def surfaces(
    shot: Shot, parts: NDArray[np.int64] | None = None
) -> tuple[Surfaces, NDArray[np.bool_]]:
    """The surfaces, and the pixels (2, h, w) whose middle lies within 1/256 pixel of the edge of a
    triangle that faces the eye, and of one that does not: there they may be others.

    `parts` (n, 4): the first and last row and column between which each object is looked at; else
    all of it is.
    """
    width, height = shot.size
    near_edge = np.zeros((2, height, width), dtype=np.bool_)
    found, outlines = [], []
    for i, thing in enumerate(shot.scene.objects):
        pieces, owners, front = triangles(thing, shot.camera, shot.size, back=True)
        outlines.append(np.ascontiguousarray(pieces[front][:, :, :2]))
        part = np.array([0, height - 1, 0, width - 1]) if parts is None else parts[i]
        rows = _converted(pieces, front, width, near_edge, part)
        found.append((np.full(len(rows), i), owners[rows[:, 1].astype(int)], rows))
    objects = np.concatenate([np.zeros(0, np.int64), *(f[0] for f in found)])
    owners = np.concatenate([np.zeros(0, np.int64), *(f[1] for f in found)])
    rows = np.concatenate([np.zeros((0, 14)), *(f[2] for f in found)])
    pixel = rows[:, 0].astype(np.int64)
    order = np.lexsort((-objects, rows[:, 3], pixel))
    rows, pixel = rows[order], pixel[order]
    turned = shot.camera.rotation.T
    return Surfaces(
        shot=shot,
        pixel=pixel,
        depth=rows[:, 3],
        object=objects[order],
        triangle=owners[order],
        front=rows[:, 2] > 0,
        normal=rows[:, 5:8] @ turned,
        offset=rows[:, 8:11] @ turned,
        color=rows[:, 11:14],
        slack=rows[:, 4],
        starts=np.searchsorted(pixel, np.arange(width * height + 1)),
        outlines=tuple(outlines),
        edge=near_edge[0].ravel(),
        edges=near_edge.any(axis=0).ravel(),
    ), near_edge


def _converted(
    pieces: Floats, front: Bools, width: int, near_edge: Bools, part: NDArray[np.int64]
) -> Floats:
    """(m, 14) pixel, piece, whether it faces the eye, depth, slack, then normal, point and colour
    in camera coordinates, of one object's surfaces."""
    count = _scan(pieces, front, width, near_edge, part, np.zeros((0, 14)))
    rows = np.empty((count, 14))
    _scan(pieces, front, width, near_edge, part, rows)
    return rows


@njit(cache=True)
def _scan(
    pieces: Floats, front: Bools, width: int, near_edge: Bools, part: Ints, rows: Floats
) -> int:
    """Put a row for each piece and pixel of a part whose middle it covers, where there is room for
    rows. Returns how many there are."""
    height = near_edge.shape[1]
    k = 0
    for t in range(len(pieces)):
        p = pieces[t]
        side = 0 if front[t] else 1
        ax, ay = p[1, 0] - p[0, 0], p[1, 1] - p[0, 1]
        bx, by = p[2, 0] - p[0, 0], p[2, 1] - p[0, 1]
        area = ax * by - ay * bx
        x0, x1 = min(p[0, 0], p[1, 0], p[2, 0]), max(p[0, 0], p[1, 0], p[2, 0])
        y0, y1 = min(p[0, 1], p[1, 1], p[2, 1]), max(p[0, 1], p[1, 1], p[2, 1])
        top, left = max(part[0], int(y0) - 1), max(part[2], int(x0) - 1)
        for r in range(top, min(part[1] + 1, int(min(y1, height)) + 2)):
            for c in range(left, min(part[3] + 1, int(min(x1, width)) + 2)):
                x, y = c + 0.5, r + 0.5
                if to_edges(p, x, y) < NEAR:
                    near_edge[side, r, c] = True
                if area == 0:
                    continue
                a = ((p[1, 0] - x) * (p[2, 1] - y) - (p[1, 1] - y) * (p[2, 0] - x)) / area
                b = ((p[2, 0] - x) * (p[0, 1] - y) - (p[2, 1] - y) * (p[0, 0] - x)) / area
                g = 1.0 - a - b
                if a < 0 or b < 0 or g < 0:
                    continue
                if k < len(rows):
                    z = 1.0 / (a * p[0, 2] + b * p[1, 2] + g * p[2, 2])
                    # 1/z is linear on the screen: how z changes from pixel to pixel.
                    u, v = p[1, 2] - p[0, 2], p[2, 2] - p[0, 2]
                    slope = z * z * max(abs(u * by - v * ay), abs(v * ax - u * bx)) / abs(area)
                    rows[k, 0], rows[k, 1], rows[k, 2] = r * width + c, t, 1.0 - side
                    rows[k, 3], rows[k, 4] = z, slope * NEAR + 1e-6 * z
                    for m in range(9):
                        value = a * p[0, 3 + m] + b * p[1, 3 + m] + g * p[2, 3 + m]
                        rows[k, 5 + m] = z * value
                k += 1
    return k
