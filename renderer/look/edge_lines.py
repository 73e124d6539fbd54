"""The lines on the screen of edges that may show: where a smooth surface turns away from the eye,
and creases that face it."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bools, Ints
from seethrough.renderer.look.edge_arrays import Edges, Lines, Point, Poses, View

Codes = NDArray[np.uint8]


@njit(cache=True, nogil=True, error_model="numpy")
def lines_of(edges: Edges, poses: Poses, view: View, out: Lines, box: Ints) -> int:
    """Put the lines of all objects into `out`, which has room for all edges. Returns how many there
    are; `box` (5,) becomes the left, lower, right and upper border of the pixels they run along,
    and how many those are, line by line."""
    longest = np.zeros(2, np.int64)
    for m in range(len(edges.starts) - 1):
        for k in range(2):
            longest[k] = max(longest[k], edges.starts[m + 1, k] - edges.starts[m, k])
    found, front = np.empty(longest[0], np.int32), np.zeros(longest[1] + 1, np.uint8)
    box[0], box[1], box[2], box[3], box[4] = view.width, view.height, 0, 0, 0
    count = 0
    for o in range(len(poses.mesh)):
        turn, move = poses.turn[o], poses.move[o]
        xx, xy, xz, xw = turn[0, 0], turn[0, 1], turn[0, 2], move[0]
        yx, yy, yz, yw = turn[1, 0], turn[1, 1], turn[1, 2], move[1]
        zx, zy, zz, zw = -turn[2, 0], -turn[2, 1], -turn[2, 2], -move[2]
        for k in range(_showing(edges, poses, o, front, found)):
            e = abs(found[k]) - 1
            px, py, pz = edges.ends[e, 0, 0], edges.ends[e, 0, 1], edges.ends[e, 0, 2]
            qx, qy, qz = edges.ends[e, 1, 0], edges.ends[e, 1, 1], edges.ends[e, 1, 2]
            count = _line(
                (xx * px + xy * py + xz * pz + xw,
                 yx * px + yy * py + yz * pz + yw,
                 zx * px + zy * py + zz * pz + zw),
                (xx * qx + xy * qy + xz * qz + xw,
                 yx * qx + yy * qy + yz * qz + yw,
                 zx * qx + zy * qy + zz * qz + zw),
                poses.through[o], found[k] > 0, view, out, count, box,
            )  # fmt: skip
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def _showing(edges: Edges, poses: Poses, o: int, front: Codes, found: NDArray[np.int32]) -> int:
    """Which edges of an object may show, each + 1, below 0 where it is no outline. Returns how
    many. Nothing branches: which edges do is what a processor cannot guess."""
    m = poses.mesh[o]
    e0, f0 = edges.starts[m, 0], edges.starts[m, 1]
    e1, f1 = edges.starts[m + 1, 0], edges.starts[m + 1, 1]
    x, y, z = poses.eye[o, 0], poses.eye[o, 1], poses.eye[o, 2]
    planes, sides, crease = edges.planes, edges.sides, edges.crease
    for f in range(f0, f1):
        d = planes[f, 0] * x + planes[f, 1] * y + planes[f, 2] * z
        front[f - f0] = d > planes[f, 3]
    front[f1 - f0] = 0
    count = 0
    for e in range(e0, e1):
        a, b = front[sides[e, 0]], front[sides[e, 1]]
        turns = a ^ b
        found[count] = (e + 1) * (2 * np.int32(turns) - 1)
        count += turns | (a & np.uint8(crease[e]))
    return count


@njit(cache=True, nogil=True, forceinline=True, error_model="numpy")
def _line(
    a: Point, b: Point, through: bool, turns: bool, view: View, out: Lines, count: int, box: Ints
) -> int:
    """Put the line between two points into `out` after `count` others, if it is on the screen.
    Returns how many there are then."""
    (ax, ay, az), (bx, by, bz) = a, b
    if az < view.near and bz < view.near:
        return count
    if az < view.near:
        t = (view.near - az) / (bz - az)
        ax, ay, az = ax + t * (bx - ax), ay + t * (by - ay), view.near
    elif bz < view.near:
        t = (view.near - bz) / (az - bz)
        bx, by, bz = bx + t * (ax - bx), by + t * (ay - by), view.near
    w0, w1 = 1.0 / az, 1.0 / bz
    x0, y0 = 0.5 * view.width + view.scale * ax * w0, 0.5 * view.height + view.scale * ay * w0
    x1, y1 = 0.5 * view.width + view.scale * bx * w1, 0.5 * view.height + view.scale * by * w1
    flat = abs(x1 - x0) >= abs(y1 - y0)
    u0, v0, u1, v1 = (x0, y0, x1, y1) if flat else (y0, x0, y1, x1)
    if u1 < u0:
        u0, v0, w0, u1, v1, w1 = u1, v1, w1, u0, v0, w0
    long, wide = (view.width, view.height) if flat else (view.height, view.width)
    first, last = max(int(np.ceil(u0 - 0.5)), 0), min(int(np.ceil(u1 - 0.5)), long)
    low, high = int(np.floor(max(min(v0, v1), 0.0))), int(np.floor(min(max(v0, v1), wide - 1))) + 1
    if first >= last or low >= high:
        return count
    slope = 1.0 / (u1 - u0)
    out.flat[count], out.through[count] = flat, through
    out.span[count, 0], out.span[count, 1] = first, last
    out.numbers[count, 0], out.numbers[count, 1], out.numbers[count, 2] = u0, v0, w0
    out.numbers[count, 3], out.numbers[count, 4] = v1 - v0, w1 - w0
    out.numbers[count, 5] = slope
    steep = np.sqrt(1.0 + ((v1 - v0) * slope) ** 2)
    out.inked[count] = view.half * steep if turns else 0.0
    along, across = (0, 1) if flat else (1, 0)
    box[along], box[along + 2] = min(box[along], first), max(box[along + 2], last)
    box[across], box[across + 2] = min(box[across], low), max(box[across + 2], high)
    box[4] += last - first
    return count + 1
