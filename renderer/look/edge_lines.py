"""The lines on the screen of edges that may show: where a smooth surface turns away from the eye,
and creases that face it."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.look.edge_arrays import Box, Edges, Lines, Point, Poses, View

Codes = NDArray[np.uint8]


@njit(cache=True, nogil=True, error_model="numpy")
def lines_of(edges: Edges, poses: Poses, view: View, out: Lines) -> tuple[int, int, Box]:
    """Put the lines of all objects into `out`, which has room for all edges. Returns how many there
    are, through how many pixels they run together, and the part of the picture that those are in:
    its left, lower, right and upper border."""
    longest = np.zeros(2, np.int64)
    for m in range(len(edges.starts) - 1):
        for n in range(2):
            longest[n] = max(longest[n], edges.starts[m + 1, n] - edges.starts[m, n])
    found, front = np.empty(longest[0], np.int32), np.zeros(longest[1] + 1, np.uint8)
    ends, numbers, span, inked = edges.ends, out.numbers, out.span, out.inked
    columns, through = out.flat, out.through
    left, below, right, above = view.width, view.height, 0, 0
    count, pixels = 0, 0
    for o in range(len(poses.mesh)):
        turn, move, shines = poses.turn[o], poses.move[o], poses.through[o]
        xx, xy, xz, xw = turn[0, 0], turn[0, 1], turn[0, 2], move[0]
        yx, yy, yz, yw = turn[1, 0], turn[1, 1], turn[1, 2], move[1]
        zx, zy, zz, zw = -turn[2, 0], -turn[2, 1], -turn[2, 2], -move[2]
        start = edges.starts[poses.mesh[o], 0]
        for k in range(_showing(edges, poses, o, front, found)):
            e, turns = start + found[k] // 2, found[k] % 2 > 0
            px, py, pz = ends[e, 0, 0], ends[e, 0, 1], ends[e, 0, 2]
            qx, qy, qz = ends[e, 1, 0], ends[e, 1, 1], ends[e, 1, 2]
            flat, (u0, v0, w0), (u1, v1, w1) = _on_screen(
                (xx * px + xy * py + xz * pz + xw,
                 yx * px + yy * py + yz * pz + yw,
                 zx * px + zy * py + zz * pz + zw),
                (xx * qx + xy * qy + xz * qz + xw,
                 yx * qx + yy * qy + yz * qz + yw,
                 zx * qx + zy * qy + zz * qz + zw),
                view,
            )  # fmt: skip
            long, wide = (view.width, view.height) if flat else (view.height, view.width)
            first, last = max(int(np.ceil(u0 - 0.5)), 0), min(int(np.ceil(u1 - 0.5)), long)
            low = int(np.floor(max(min(v0, v1), 0.0)))
            high = int(np.floor(min(max(v0, v1), wide - 1))) + 1
            if first >= last or low >= high:
                continue
            slope = 1.0 / (u1 - u0)
            columns[count], through[count] = flat, shines
            span[count, 0], span[count, 1] = first, last
            numbers[count, 0], numbers[count, 1], numbers[count, 2] = u0, v0, w0
            numbers[count, 3], numbers[count, 4], numbers[count, 5] = v1 - v0, w1 - w0, slope
            steep = np.sqrt(1.0 + ((v1 - v0) * slope) ** 2)
            inked[count] = view.half * steep if turns else 0.0
            count += 1
            pixels += last - first
            x0, y0, x1, y1 = (first, low, last, high) if flat else (low, first, high, last)
            left, below = min(left, x0), min(below, y0)
            right, above = max(right, x1), max(above, y1)
    return count, pixels, (left, below, right, above)


@njit(cache=True, nogil=True, error_model="numpy")
def _showing(edges: Edges, poses: Poses, o: int, front: Codes, found: NDArray[np.int32]) -> int:
    """Which edges of an object may show, counted from its mesh's first: twice that, and 1 more
    where its surface turns away. Returns how many. Nothing branches: which edges do is what a
    processor cannot guess."""
    m = poses.mesh[o]
    (e0, f0), (e1, f1) = edges.starts[m], edges.starts[m + 1]
    x, y, z = poses.eye[o, 0], poses.eye[o, 1], poses.eye[o, 2]
    planes, sides, crease = edges.planes[f0:f1], edges.sides[e0:e1], edges.crease[e0:e1]
    for f in range(len(planes)):
        d = planes[f, 0] * x + planes[f, 1] * y + planes[f, 2] * z
        front[f] = d > planes[f, 3]
    front[len(planes)] = 0
    count = 0
    for e in range(len(sides)):
        a, b = front[sides[e, 0]], front[sides[e, 1]]
        turns = a ^ b
        found[count] = 2 * e + turns
        count += turns | (a & crease[e])
    return count


@njit(cache=True, nogil=True, forceinline=True, error_model="numpy")
def _on_screen(a: Point, b: Point, view: View) -> tuple[bool, Point, Point]:
    """Whether the line between two points runs along columns, and both of its ends: how far along
    and across, in pixels, and 1 / depth. Of what lies before the near plane both are the same."""
    (ax, ay, az), (bx, by, bz) = a, b
    if az < view.near and bz < view.near:
        return True, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
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
    first, last = ((x0, y0, w0), (x1, y1, w1)) if flat else ((y0, x0, w0), (y1, x1, w1))
    return (flat, last, first) if last[0] < first[0] else (flat, first, last)
