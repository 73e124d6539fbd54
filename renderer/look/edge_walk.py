"""Edges smoothed where they cross pixels, on the CPU: for each pixel row or column that a line runs
through, the pixel that it cuts takes as much of the neighbour beyond as lies on that side. Outlines
are ink on as much of each pixel as a band about the line covers there, after that.

A line counts where it can be seen: one of the two pixels beside it is as far away as the line, or
farther. What shows through something transparent has no depth of its own in the picture; there the
colours have to break at the line, and nowhere more beside it.

Much of what is walked is hidden, and what a processor cannot guess costs it more than all that is
worked out for a pixel: so what can be seen is put together first, and only that is looked at again.
Arrays are taken out of their tuples before loops, which otherwise count references to them.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats32
from seethrough.renderer.look.edge_arrays import STEPS, TOGETHER, Lines, Picture, Room, View

Halves = NDArray[np.uint16]
Whole = NDArray[np.uint32]

NEARER = 0.004  # of its depth, by which a pixel may be nearer than a line on its surface
UNIT = 1.0 / (2**32 - 1)
INK, DARK = 0.12, 0.8  # of outlines: a grey, and how much of it there is
INKED = 0x7FFF  # all of a pixel has ink, as its alpha says meanwhile, which never is below 0
JUMP, FLAT = 0.3, 1e-6  # part of a step of depth that steps beside it have at most, and rounding
LEAST = 2.0 / 255.0  # a step of colour that is worth smoothing
FIRM = 0.1  # the same, from which on an outline through something has all of its ink


@njit(cache=True, nogil=True, error_model="numpy")
def smoothed(lines: Lines, count: int, view: View, picture: Picture, room: Room) -> tuple[int, int]:
    """Smooth the picture's colours by the first `count` lines, as `view` says, and draw outlines.
    Returns the first and the last + 1 of the rows that were changed."""
    taking, inked, k = 0, 0, 0
    while k < count:
        k, steps = _walk(lines, k, count, view, picture, room)
        if view.smooth:
            taking = _take(steps, taking, room)
        if view.half > 0.0:
            inked = _ink(steps, inked, lines, view, picture, room)
    first, last = len(picture.depth), -1
    for pixels, there in ((room.pixels, taking), (room.inked, inked)):
        for i in range(there):
            first, last = min(first, pixels[i]), max(last, pixels[i])
    _apply(taking, picture, room)
    _draw_ink(inked, picture, room)
    return first // picture.row, last // picture.row + 1


@njit(cache=True, nogil=True, error_model="numpy")
def _walk(
    lines: Lines, first: int, count: int, view: View, picture: Picture, room: Room
) -> tuple[int, int]:
    """Find the pixels that lines run through where they can be seen, from the `first` of `count`
    lines on, until there are TOGETHER. Returns the line to go on with, and how many there
    are. Nothing branches there that a processor cannot guess."""
    span, numbers, columns, see_through = lines.span, lines.numbers, lines.flat, lines.through
    depth, color, decoded = picture.depth, picture.color, picture.decoded
    line, at, beside, place, seen = room.line, room.at, room.beside, room.place, room.seen
    steps, k = 0, first
    while k < count and steps < TOGETHER:
        flat, through = columns[k], see_through[k]
        u0, v0, w0 = numbers[k, 0], numbers[k, 1], numbers[k, 2]
        dv, dw, slope = numbers[k, 3], numbers[k, 4], numbers[k, 5]
        # Of the part of the picture: the first pixel along and across; from one to the next.
        left, low, along, across = picture.left, picture.below, 1, picture.row
        wide = view.height
        if not flat:
            left, low, along, across, wide = low, left, across, along, view.width
        for i in range(span[k, 0], span[k, 1]):
            t = (i + 0.5 - u0) * slope
            v = v0 + t * dv
            j = int(np.floor(v))
            if j < 1 or j >= wide - 1:
                continue
            p = (i - left) * along + (j - low) * across
            aside = across if v - j > 0.5 else -across
            line[steps], at[steps], beside[steps], place[steps] = k, p, aside, v
            if through:
                beyond = j < wide - 2 if aside > 0 else j > 1
                step = _breaks(color, decoded, p, aside, beyond)
                seen[steps] = min(step / FIRM, 1.0)
                steps += step > 0.0
            else:
                z = UNIT * max(depth[p], depth[p + aside])
                hidden = view.a * (w0 + t * dw) < (1.0 - NEARER) * (view.b - z)
                steps += not hidden
        k += 1
    return k, steps


@njit(cache=True, nogil=True, error_model="numpy")
def _take(steps: int, count: int, room: Room) -> int:
    """Find what each pixel takes of a neighbour: the largest part of all. Returns of how many, with
    the `count` that there were."""
    at, beside, place, slot = room.at, room.beside, room.place, room.slot
    pixels, parts, takes = room.pixels, room.part, room.takes
    for s in range(steps):
        part = place[s] - np.floor(place[s])
        part, p = min(part, 1.0 - part), at[s]
        held = slot[p] - 1
        if part > (parts[held] if held >= 0 else 0.0):
            if held < 0:
                held = count
                count += 1
                slot[p], pixels[held] = count, p
            parts[held], takes[held] = part, beside[s]
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def _ink(steps: int, count: int, lines: Lines, view: View, picture: Picture, room: Room) -> int:
    """Find how much of each pixel has ink. Returns of how many any has, with the `count` that there
    were."""
    columns, through, width = lines.flat, lines.through, lines.inked
    depth, color, decoded = picture.depth, picture.color, picture.decoded
    line, at, beside, place, seen = room.line, room.at, room.beside, room.place, room.seen
    inked, held = room.inked, room.held
    # As many pixels for all lines, the most that any band reaches into: what a processor can guess.
    reach = int(np.ceil(2.0 * np.sqrt(2.0) * view.half)) + 1
    for s in range(steps):
        k, p, v = line[s], at[s], place[s]
        half, aside, j = width[k], beside[s], int(np.floor(v))
        across, wide = (picture.row, view.height) if columns[k] else (1, view.width)
        if half == 0.0:
            continue
        beyond = j < wide - 2 if aside > 0 else j > 1
        if not (through[k] or _parts(depth, color, decoded, p, aside, beyond)):
            continue
        shown = INKED * (seen[s] if through[k] else 1.0)
        low, high = v - half, v + half
        first = int(np.floor(low))
        last = first + reach
        if first < 0 or last > wide:
            first, last = max(first, 0), min(int(np.ceil(high)), wide)
        for q in range(first, last):
            part = shown * (min(q + 1.0, high) - max(float(q), low))
            r = p + (q - j) * across
            mine, there = np.int32(max(part, 0.0) + 0.5), np.int32(color[r, 3])
            has = there >> 15
            inked[count], held[count] = r, there
            count += int((1 - has) & (mine > 0))
            most = max(mine, has * (there & INKED))
            color[r, 3] = (most | (INKED + 1)) if most > 0 else there
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def _apply(count: int, picture: Picture, room: Room) -> None:
    """Give so many pixels their new colours, and make the room empty again."""
    color, decoded, encoded = picture.color, picture.decoded, picture.encoded
    pixels, takes, parts, colors, slot = room.pixels, room.takes, room.part, room.colors, room.slot
    for i in range(count):
        p = pixels[i]
        q, part = p + takes[i], parts[i]
        for n in range(3):
            own, other = decoded[color[p, n]], decoded[color[q, n]]
            mixed = own + part * (other - own)
            colors[i, n] = encoded[int(min(max(mixed, 0.0), 1.0) * STEPS + 0.5)]
    for i in range(count):
        p = pixels[i]
        slot[p] = 0
        for n in range(3):
            color[p, n] = colors[i, n]


@njit(cache=True, nogil=True, error_model="numpy")
def _draw_ink(count: int, picture: Picture, room: Room) -> None:
    """Put the ink of so many pixels onto the picture, and make the room empty again."""
    color, decoded, encoded = picture.color, picture.decoded, picture.encoded
    inked, held = room.inked, room.held
    for i in range(count):
        p = inked[i]
        part = np.float32(DARK / INKED) * np.float32(color[p, 3] & INKED)
        color[p, 3] = held[i]
        for n in range(3):
            own = decoded[color[p, n]]
            mixed = min(max(own + part * (INK - own), 0.0), 1.0)
            color[p, n] = encoded[int(mixed * STEPS + 0.5)]


@njit(cache=True, nogil=True, forceinline=True)
def _parts(
    depth: Whole, color: Halves, decoded: Floats32, p: int, aside: int, beyond: bool
) -> bool:  # fmt: skip
    """Whether one surface ends between a pixel and the one `aside`: the buffer's depths, which are
    linear on a plane, jump there, or colours break. Edges that lie within a surface part nothing.
    `beyond`: whether the picture has a pixel beyond that one."""
    here, there = UNIT * depth[p], UNIT * depth[p + aside]
    before = abs(here - UNIT * depth[p - aside])
    after = abs(UNIT * depth[p + 2 * aside] - there) if beyond else 0.0
    jump = JUMP * abs(there - here) - FLAT
    return jump > max(before, after) or _breaks(color, decoded, p, aside, beyond) > 0.0


@njit(cache=True, nogil=True, forceinline=True)
def _breaks(color: Halves, decoded: Floats32, p: int, aside: int, beyond: bool) -> float:
    """By how much colours break between the two pixels, 0 if they break more beside them in that
    direction, or not to be seen."""
    step = _step(color, decoded, p, p + aside)
    if step < LEAST or _step(color, decoded, p, p - aside) > step:
        return 0.0
    return 0.0 if beyond and _step(color, decoded, p + aside, p + 2 * aside) > step else step


@njit(cache=True, nogil=True, forceinline=True)
def _step(color: Halves, decoded: Floats32, p: int, q: int) -> float:
    """The largest difference of two pixels in a channel."""
    found = 0.0
    for n in range(3):
        found = max(found, abs(decoded[color[p, n]] - decoded[color[q, n]]))
    return found
