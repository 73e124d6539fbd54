"""Edges smoothed where they cross pixels, on the CPU: for each pixel row or column that a line runs
through, the pixel that it cuts takes as much of the neighbour beyond as lies on that side. Outlines
are ink on as much of each pixel as a band about the line covers there, after that.

A line counts where it can be seen: one of the two pixels beside it is as far away as the line, or
farther. What shows through something transparent has no depth of its own in the picture; there the
colours have to break at the line, and nowhere more beside it.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.look.edge_arrays import STEPS, Lines, Picture, Point, Poses, Room, View

NEARER = 0.004  # of its depth, by which a pixel may be nearer than a line on its surface
UNIT = 1.0 / (2**32 - 1)
INK, DARK = 0.12, 0.8  # of outlines: a grey, and how much of it there is
JUMP, FLAT = 0.3, 1e-6  # part of a step of depth that steps beside it have at most, and rounding
LEFT, RIGHT, BELOW, ABOVE = 1, 2, 3, 4
LEAST = 2.0 / 255.0  # a step of colour that is worth smoothing
FIRM = 0.1  # the same, from which on an outline through something has all of its ink


@njit(cache=True, nogil=True)
def smoothed(lines: Lines, poses: Poses, view: View, picture: Picture, room: Room) -> int:
    """Smooth the picture's colours by the lines, as `view` says, and draw outlines. Returns how
    many pixels were changed."""
    room.counts[:] = 0
    most = 0
    for k in range(len(lines.starts) - 1):
        most = max(most, lines.starts[k + 1, 1] - lines.starts[k, 1])
    front = np.zeros(most + 1, np.bool_)
    planes, ends, sides, crease = lines.planes, lines.ends, lines.sides, lines.crease
    turn, move = poses.turn, poses.move
    for o in range(len(poses.mesh)):
        m = poses.mesh[o]
        e0, f0 = lines.starts[m, 0], lines.starts[m, 1]
        e1, f1 = lines.starts[m + 1, 0], lines.starts[m + 1, 1]
        ex, ey, ez = poses.eye[o, 0], poses.eye[o, 1], poses.eye[o, 2]
        for f in range(f0, f1):
            d = planes[f, 0] * ex + planes[f, 1] * ey + planes[f, 2] * ez
            front[f - f0] = d > planes[f, 3]
        front[f1 - f0] = False
        xx, xy, xz, xw = turn[o, 0, 0], turn[o, 0, 1], turn[o, 0, 2], move[o, 0]
        yx, yy, yz, yw = turn[o, 1, 0], turn[o, 1, 1], turn[o, 1, 2], move[o, 1]
        zx, zy, zz, zw = -turn[o, 2, 0], -turn[o, 2, 1], -turn[o, 2, 2], -move[o, 2]
        through = poses.through[o]
        for e in range(e0, e1):
            a, b = front[sides[e, 0]], front[sides[e, 1]]
            if (a != b) or (a and crease[e]):
                px, py, pz = ends[e, 0, 0], ends[e, 0, 1], ends[e, 0, 2]
                qx, qy, qz = ends[e, 1, 0], ends[e, 1, 1], ends[e, 1, 2]
                _walk(
                    (xx * px + xy * py + xz * pz + xw,
                     yx * px + yy * py + yz * pz + yw,
                     zx * px + zy * py + zz * pz + zw),
                    (xx * qx + xy * qy + xz * qz + xw,
                     yx * qx + yy * qy + yz * qz + yw,
                     zx * qx + zy * qy + zz * qz + zw),
                    through, view.half if a != b else 0.0, view, picture, room,
                )  # fmt: skip
    _apply(picture, room)
    _draw_ink(picture, room)
    return room.counts[0] + room.counts[1]


@njit(cache=True, nogil=True)
def _apply(picture: Picture, room: Room) -> None:
    """Give the pixels that lines run through their new colours, and make the room empty again."""
    color, decoded, encoded = picture.color, picture.decoded, picture.encoded
    width, count = color.shape[1], room.counts[0]
    for i in range(count):
        r, c = room.pixels[i] // width, room.pixels[i] % width
        way, part = room.taken[r, c], room.best[r, c]
        rr, cc = r + (way == ABOVE) - (way == BELOW), c + (way == RIGHT) - (way == LEFT)
        for n in range(3):
            own, other = decoded[color[r, c, n]], decoded[color[rr, cc, n]]
            mixed = own + part * (other - own)
            room.colors[i, n] = encoded[int(min(max(mixed, 0.0), 1.0) * STEPS + 0.5)]
    for i in range(count):
        r, c = room.pixels[i] // width, room.pixels[i] % width
        room.best[r, c] = 0.0
        for n in range(3):
            color[r, c, n] = room.colors[i, n]


@njit(cache=True, nogil=True, forceinline=True)
def _walk(
    a: Point, b: Point, through: bool, half: float, view: View, picture: Picture, room: Room
) -> None:  # fmt: skip
    """Take what a line between two points says of the pixels that it runs through; its ink reaches
    `half` a pixel or more to both sides, or there is none."""
    (ax, ay, az), (bx, by, bz) = a, b
    if az < view.near and bz < view.near:
        return
    if az < view.near:
        t = (view.near - az) / (bz - az)
        ax, ay, az = ax + t * (bx - ax), ay + t * (by - ay), view.near
    elif bz < view.near:
        t = (view.near - bz) / (az - bz)
        bx, by, bz = bx + t * (ax - bx), by + t * (ay - by), view.near
    w0, w1 = 1.0 / az, 1.0 / bz
    x0, y0 = view.x + view.scale * ax * w0, view.y + view.scale * ay * w0
    x1, y1 = view.x + view.scale * bx * w1, view.y + view.scale * by * w1
    height, width = picture.depth.shape
    flat = abs(x1 - x0) >= abs(y1 - y0)
    u0, v0, u1, v1 = (x0, y0, x1, y1) if flat else (y0, x0, y1, x1)
    if u1 < u0:
        u0, v0, w0, u1, v1, w1 = u1, v1, w1, u0, v0, w0
    long, wide = (width, height) if flat else (height, width)
    first, last = max(int(np.ceil(u0 - 0.5)), 0), min(int(np.ceil(u1 - 0.5)), long)
    if first >= last:
        return
    slope = 1.0 / (u1 - u0)
    half *= np.sqrt(1.0 + ((v1 - v0) * slope) ** 2)
    for i in range(first, last):
        t = (i + 0.5 - u0) * slope
        v = v0 + t * (v1 - v0)
        j = int(np.floor(v))
        if j < 1 or j >= wide - 1:
            continue
        part = v - j  # of the pixel, below the line
        after = part > 0.5
        other = j + 1 if after else j - 1
        part = 1.0 - part if after else part
        r, c, rr, cc = (j, i, other, i) if flat else (i, j, i, other)
        smooths = view.smooth and part > room.best[r, c]
        if not smooths and half == 0.0:
            continue
        shown = 1.0
        if through:
            step = _breaks(picture, r, c, rr, cc)
            if step == 0.0:
                continue
            shown = min(step / FIRM, 1.0)
        else:
            z = max(_depth(picture, r, c), _depth(picture, rr, cc))
            if view.a * (w0 + t * (w1 - w0)) < (1.0 - NEARER) * (view.b - z):
                continue
        if smooths:
            if room.best[r, c] == 0.0:
                room.pixels[room.counts[0]] = r * width + c
                room.counts[0] += 1
            room.best[r, c] = part
            if flat:
                room.taken[r, c] = ABOVE if after else BELOW
            else:
                room.taken[r, c] = RIGHT if after else LEFT
        if half > 0.0 and (through or _parts(picture, r, c, rr, cc)):
            _ink(i, v - half, v + half, shown, flat, room)


@njit(cache=True, nogil=True, forceinline=True)
def _ink(i: int, low: float, high: float, shown: float, flat: bool, room: Room) -> None:
    """Ink in a column or row of pixels, from `low` to `high`, of which `shown` is seen."""
    height, width = room.ink.shape
    for q in range(max(int(np.floor(low)), 0), min(int(np.ceil(high)), height if flat else width)):
        r, c = (q, i) if flat else (i, q)
        part = shown * (min(q + 1.0, high) - max(float(q), low))
        if part > room.ink[r, c]:
            if room.ink[r, c] == 0.0:
                room.inked[room.counts[1]] = r * width + c
                room.counts[1] += 1
            room.ink[r, c] = part


@njit(cache=True, nogil=True)
def _draw_ink(picture: Picture, room: Room) -> None:
    """Put the ink onto the picture, and make the room empty again."""
    color, decoded, encoded = picture.color, picture.decoded, picture.encoded
    width = color.shape[1]
    for i in range(room.counts[1]):
        r, c = room.inked[i] // width, room.inked[i] % width
        part = DARK * min(room.ink[r, c], np.float32(1.0))
        room.ink[r, c] = 0.0
        for n in range(3):
            own = decoded[color[r, c, n]]
            mixed = min(max(own + part * (INK - own), 0.0), 1.0)
            color[r, c, n] = encoded[int(mixed * STEPS + 0.5)]


@njit(cache=True, nogil=True, forceinline=True)
def _depth(picture: Picture, r: int, c: int) -> float:
    """The buffer's number from 0 to 1."""
    return UNIT * picture.depth[r, c]


@njit(cache=True, nogil=True, forceinline=True)
def _parts(picture: Picture, r: int, c: int, rr: int, cc: int) -> bool:
    """Whether one surface ends between two pixels: the buffer's depths, which are linear on a
    plane, jump there, or colours break. Edges that lie within a surface part nothing."""
    height, width = picture.depth.shape
    dr, dc = rr - r, cc - c
    here, there = _depth(picture, r, c), _depth(picture, rr, cc)
    before = abs(here - _depth(picture, r - dr, c - dc))
    fr, fc = rr + dr, cc + dc
    inside = 0 <= fr < height and 0 <= fc < width
    after = abs(_depth(picture, fr, fc) - there) if inside else 0.0
    jump = JUMP * abs(there - here) - FLAT
    return jump > max(before, after) or _breaks(picture, r, c, rr, cc) > 0.0


@njit(cache=True, nogil=True, forceinline=True)
def _breaks(picture: Picture, r: int, c: int, rr: int, cc: int) -> float:
    """By how much colours break between two pixels, 0 if they break more beside them in that
    direction, or not to be seen."""
    height, width = picture.depth.shape
    step = _step(picture, r, c, rr, cc)
    if step < LEAST:
        return 0.0
    dr, dc = rr - r, cc - c
    if _step(picture, r, c, r - dr, c - dc) > step:
        return 0.0
    fr, fc = rr + dr, cc + dc
    inside = 0 <= fr < height and 0 <= fc < width
    return 0.0 if inside and _step(picture, rr, cc, fr, fc) > step else step


@njit(cache=True, nogil=True, forceinline=True)
def _step(picture: Picture, r: int, c: int, rr: int, cc: int) -> float:
    """The largest difference of two pixels in a channel."""
    found = 0.0
    for n in range(3):
        own, other = picture.color[r, c, n], picture.color[rr, cc, n]
        found = max(found, abs(picture.decoded[own] - picture.decoded[other]))
    return found
