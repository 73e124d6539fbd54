"""The lines on the screen of edges that may show: where a smooth surface turns away from the eye,
and creases that face it."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats
from seethrough.renderer.look.edge_arrays import Box, Edges, Lines, Point, Poses, View

Codes = NDArray[np.uint8]


@njit(cache=True, nogil=True, error_model="numpy")
def lines_of(edges: Edges, poses: Poses, view: View, out: Lines) -> tuple[int, Box]:
    """Put the lines of all objects that are drawn into `out`. Returns how many there are, and the
    part of the picture that their pixels are in: its left, lower, right and upper border. If `out`
    has no room for all edges, it only returns how many those are."""
    starts, ends, sides, crease = edges.starts, edges.ends, edges.sides, edges.crease
    planes, mesh, drawn, see_through = edges.planes, poses.mesh, poses.drawn, poses.through
    numbers, span, inked, columns, through = out.numbers, out.span, out.inked, out.flat, out.through
    most, longest, largest = 0, 0, 0
    for o in range(len(drawn)):
        if drawn[o]:
            m = mesh[o]
            size = starts[m + 1, 0] - starts[m, 0]
            most, longest = most + size, max(longest, size)
            largest = max(largest, starts[m + 1, 1] - starts[m, 1])
    if most > len(columns):
        return most, (0, 0, 0, 0)
    found, front = np.empty(longest, np.int32), np.zeros(largest + 1, np.uint8)
    turn, eye = np.empty((3, 4)), np.empty(3)
    left, below, right, above = view.width, view.height, 0, 0
    count = 0
    for o in range(len(drawn)):
        if not drawn[o]:
            continue
        m, shines = mesh[o], see_through[o]
        _place(poses, o, turn, eye)
        xx, xy, xz, xw = turn[0, 0], turn[0, 1], turn[0, 2], turn[0, 3]
        yx, yy, yz, yw = turn[1, 0], turn[1, 1], turn[1, 2], turn[1, 3]
        zx, zy, zz, zw = -turn[2, 0], -turn[2, 1], -turn[2, 2], -turn[2, 3]
        start, end = starts[m, 0], starts[m + 1, 0]
        own = planes[starts[m, 1] : starts[m + 1, 1]]
        showing = _showing(
            own, sides[start:end], crease[start:end], eye, view.smooth, front, found
        )  # fmt: skip
        for k in range(showing):
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
            x0, y0, x1, y1 = (first, low, last, high) if flat else (low, first, high, last)
            left, below = min(left, x0), min(below, y0)
            right, above = max(right, x1), max(above, y1)
    return count, (left, below, right, above)


@njit(cache=True, nogil=True, error_model="numpy")
def _place(poses: Poses, o: int, turn: Floats, eye: Floats) -> None:
    """Fill in an object's turn and move (3, 4), camera ← mesh, and where the eye is in its mesh's
    space (3,)."""
    matrix, inverse, seen, rotation = poses.matrix, poses.inverse, poses.eye, poses.rotation
    for i in range(3):
        for j in range(3):
            turn[i, j] = 0.0
            for k in range(3):
                turn[i, j] += rotation[k, i] * matrix[o, k, j]
        turn[i, 3] = eye[i] = 0.0
        for k in range(3):
            turn[i, 3] += rotation[k, i] * (matrix[o, k, 3] - seen[k])
            eye[i] += inverse[o, i, k] * (seen[k] - matrix[o, k, 3])


@njit(cache=True, nogil=True, error_model="numpy")
def _showing(
    planes: Floats, sides: NDArray[np.uint32], crease: Codes, eye: Floats, creased: bool,
    front: Codes, found: NDArray[np.int32],
) -> int:  # fmt: skip
    """Which of an object's edges may show, creases too if asked for: twice their number, and 1 more
    where its surface turns away. Returns how many. Nothing branches: which edges do is what a
    processor cannot guess."""
    x, y, z = eye[0], eye[1], eye[2]
    for f in range(len(planes)):
        d = planes[f, 0] * x + planes[f, 1] * y + planes[f, 2] * z
        front[f] = d > planes[f, 3]
    front[len(planes)] = 0
    wanted, count = np.uint8(creased), 0
    for e in range(len(sides)):
        a, b = front[sides[e, 0]], front[sides[e, 1]]
        turns = a ^ b
        found[count] = 2 * e + turns
        count += turns | (a & crease[e] & wanted)
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
