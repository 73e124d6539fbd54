"""Edges smoothed where they cross pixels, on the CPU: for each pixel row or column that a line runs
through, the pixel that it cuts takes as much of the neighbour beyond as lies on that side. Outlines
are ink on as much of each pixel as a band about the line covers there, after that.

A line counts where it can be seen: one of the two pixels beside it is as far away as the line, or
farther. What shows through something transparent has no depth of its own in the picture; there the
colours have to break at the line, and nowhere more beside it.

Most of what is walked is hidden, and on a processor each first touch of a place in memory costs more
than all that is worked out there: so depth is asked first, and all else is kept in the order in which
it is found.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.look.edge_arrays import STEPS, Lines, Picture, Room, View

NEARER = 0.004  # of its depth, by which a pixel may be nearer than a line on its surface
UNIT = 1.0 / (2**32 - 1)
INK, DARK = 0.12, 0.8  # of outlines: a grey, and how much of it there is
JUMP, FLAT = 0.3, 1e-6  # part of a step of depth that steps beside it have at most, and rounding
LEAST = 2.0 / 255.0  # a step of colour that is worth smoothing
FIRM = 0.1  # the same, from which on an outline through something has all of its ink


@njit(cache=True, nogil=True, error_model="numpy")
def smoothed(lines: Lines, count: int, view: View, picture: Picture, room: Room) -> tuple[int, int]:
    """Smooth the picture's colours by the first `count` lines, as `view` says, and draw outlines.
    Returns the first and the last + 1 of the rows that were changed."""
    room.counts[:] = 0
    for k in range(count):
        _walk(k, lines, view, picture, room)
    first, last = len(picture.depth), -1
    for pixels, there in ((room.pixels, room.counts[0]), (room.inked, room.counts[1])):
        for i in range(there):
            first, last = min(first, pixels[i]), max(last, pixels[i])
    _apply(picture, room)
    _draw_ink(picture, room)
    return first // picture.row, last // picture.row + 1


@njit(cache=True, nogil=True, error_model="numpy")
def _walk(k: int, lines: Lines, view: View, picture: Picture, room: Room) -> None:
    """Take what a line says of the pixels that it runs through."""
    flat, through, half = lines.flat[k], lines.through[k], lines.inked[k]
    u0, v0, w0 = lines.numbers[k, 0], lines.numbers[k, 1], lines.numbers[k, 2]
    dv, dw, slope = lines.numbers[k, 3], lines.numbers[k, 4], lines.numbers[k, 5]
    # Of the part of the picture: the first pixel along and across, and from one to the next.
    left, low, along, across = picture.left, picture.below, 1, picture.row
    wide = view.height
    if not flat:
        left, low, along, across, wide = low, left, across, along, view.width
    depth, slot = picture.depth, room.slot
    for i in range(lines.span[k, 0], lines.span[k, 1]):
        t = (i + 0.5 - u0) * slope
        v = v0 + t * dv
        j = int(np.floor(v))
        if j < 1 or j >= wide - 1:
            continue
        part = v - j  # of the pixel, below the line
        aside = across if part > 0.5 else -across
        p = (i - left) * along + (j - low) * across
        if not through:
            z = UNIT * max(depth[p], depth[p + aside])
            if view.a * (w0 + t * dw) < (1.0 - NEARER) * (view.b - z):
                continue
        part = min(part, 1.0 - part)
        held = slot[p] - 1
        smooths = view.smooth and part > (room.part[held] if held >= 0 else 0.0)
        if not smooths and half == 0.0:
            continue
        beyond = j < wide - 2 if aside > 0 else j > 1
        shown = 1.0
        if through:
            step = _breaks(picture, p, aside, beyond)
            if step == 0.0:
                continue
            shown = min(step / FIRM, 1.0)
        if smooths:
            if held < 0:
                held = room.counts[0]
                room.counts[0] += 1
                slot[p], room.pixels[held] = held + 1, p
            room.part[held], room.aside[held] = part, aside
        if half > 0.0 and (through or _parts(picture, p, aside, beyond)):
            first = max(int(np.floor(v - half)), 0)
            for q in range(first, min(int(np.ceil(v + half)), wide)):
                covered = min(q + 1.0, v + half) - max(float(q), v - half)
                _ink(p + (q - j) * across, shown * covered, room)


@njit(cache=True, nogil=True, forceinline=True, error_model="numpy")
def _ink(p: int, part: float, room: Room) -> None:
    """Ink on a part of a pixel, unless there is more."""
    if part > room.ink[p]:
        if room.ink[p] == 0.0:
            room.inked[room.counts[1]] = p
            room.counts[1] += 1
        room.ink[p] = part


@njit(cache=True, nogil=True, error_model="numpy")
def _apply(picture: Picture, room: Room) -> None:
    """Give the pixels that lines run through their new colours, and make the room empty again."""
    color, decoded, encoded = picture.color, picture.decoded, picture.encoded
    for i in range(room.counts[0]):
        p = room.pixels[i]
        q, part = p + room.aside[i], room.part[i]
        for n in range(3):
            own, other = decoded[color[p, n]], decoded[color[q, n]]
            mixed = own + part * (other - own)
            room.colors[i, n] = encoded[int(min(max(mixed, 0.0), 1.0) * STEPS + 0.5)]
    for i in range(room.counts[0]):
        p = room.pixels[i]
        room.slot[p] = 0
        for n in range(3):
            color[p, n] = room.colors[i, n]


@njit(cache=True, nogil=True, error_model="numpy")
def _draw_ink(picture: Picture, room: Room) -> None:
    """Put the ink onto the picture, and make the room empty again."""
    color, decoded, encoded = picture.color, picture.decoded, picture.encoded
    for i in range(room.counts[1]):
        p = room.inked[i]
        part = DARK * min(room.ink[p], np.float32(1.0))
        room.ink[p] = 0.0
        for n in range(3):
            own = decoded[color[p, n]]
            mixed = min(max(own + part * (INK - own), 0.0), 1.0)
            color[p, n] = encoded[int(mixed * STEPS + 0.5)]


@njit(cache=True, nogil=True, forceinline=True)
def _depth(picture: Picture, p: int) -> float:
    """The buffer's number from 0 to 1."""
    return UNIT * picture.depth[p]


@njit(cache=True, nogil=True, forceinline=True)
def _parts(picture: Picture, p: int, aside: int, beyond: bool) -> bool:
    """Whether one surface ends between a pixel and the one `aside`: the buffer's depths, which are
    linear on a plane, jump there, or colours break. Edges that lie within a surface part nothing.
    `beyond`: whether the picture has a pixel beyond that one."""
    here, there = _depth(picture, p), _depth(picture, p + aside)
    before = abs(here - _depth(picture, p - aside))
    after = abs(_depth(picture, p + 2 * aside) - there) if beyond else 0.0
    jump = JUMP * abs(there - here) - FLAT
    return jump > max(before, after) or _breaks(picture, p, aside, beyond) > 0.0


@njit(cache=True, nogil=True, forceinline=True)
def _breaks(picture: Picture, p: int, aside: int, beyond: bool) -> float:
    """By how much colours break between the two pixels, 0 if they break more beside them in that
    direction, or not to be seen."""
    step = _step(picture, p, p + aside)
    if step < LEAST or _step(picture, p, p - aside) > step:
        return 0.0
    return 0.0 if beyond and _step(picture, p + aside, p + 2 * aside) > step else step


@njit(cache=True, nogil=True, forceinline=True)
def _step(picture: Picture, p: int, q: int) -> float:
    """The largest difference of two pixels in a channel."""
    found = 0.0
    for n in range(3):
        own, other = picture.color[p, n], picture.color[q, n]
        found = max(found, abs(picture.decoded[own] - picture.decoded[other]))
    return found
