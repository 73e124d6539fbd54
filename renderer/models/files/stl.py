"""STL, binary and text, with the two ways in which programs put colours into it."""

from __future__ import annotations

import struct

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.files.part import GREY, Found, Part, grey, linear_rgba, too_many
from seethrough.renderer.models.files.source import Refused, Source

_RECORD = np.dtype([("normal", "<f4", 3), ("points", "<f4", (3, 3)), ("more", "<u2")])
_HEAD = 84


def read(source: Source) -> Found:
    """The triangles of an STL file. Raises Refused."""
    data = source.main()
    found = Found()
    count = struct.unpack_from("<I", data, 80)[0] if len(data) >= _HEAD else -1
    rest = len(data) - _HEAD
    if rest == count * _RECORD.itemsize or not data.lstrip()[:5].lower() == b"solid":
        if count < 0 or rest < count * _RECORD.itemsize:
            raise Refused(f"{len(data)} bytes for {max(count, 0)} triangles: the file is cut off")
        too_many(count)
        rows = np.frombuffer(data, _RECORD, count, _HEAD)
        points = rows["points"].astype(float).reshape(-1, 3)
        colors = _colors(data[:80], rows["more"], found)
    else:
        points = _text(data)
        colors = grey(len(points) // 3)
    found.colors.add("none in the file: grey")
    if len(found.colors) > 1:
        found.colors.discard("none in the file: grey")
    found.parts.append(Part(points, np.arange(len(points)).reshape(-1, 3), colors))
    return found


def _colors(head: bytes, more: NDArray[np.uint16], found: Found) -> Floats:
    """(m, 3, 4) of the 16 bits behind each triangle.

    Magics names a colour of the whole in the header; a set uppermost bit says that the triangle
    has that one, otherwise red is lowest. VisCAM has no such header: a set uppermost bit says
    that the triangle has a colour of its own, and blue is lowest.
    """
    fives = np.stack([more & 31, (more >> 5) & 31, (more >> 10) & 31], axis=1) / 31.0
    marked = (more >> 15).astype(bool)[:, None]
    place = head.find(b"COLOR=")
    if place >= 0 and len(head) >= place + 10:
        whole = np.frombuffer(head, np.uint8, 3, place + 6) / 255
        shown = np.where(marked, whole, fives)
    elif marked.any():
        shown = np.where(marked, fives[:, ::-1], GREY)
    else:
        return grey(len(more))
    found.colors.add("triangles")
    return np.repeat(linear_rgba(shown)[:, None], 3, axis=1)


def _text(data: bytes) -> Floats:
    """(3 m, 3) corners of a text file."""
    words = data.decode("utf-8", "replace").lower().split()
    places = [i for i, word in enumerate(words) if word == "vertex"]
    if len(places) % 3:
        raise Refused(f"{len(places)} corners: expected three for each triangle")
    too_many(len(places) // 3)
    try:
        rows = [[float(words[i + k]) for k in (1, 2, 3)] for i in places]
    except (ValueError, IndexError):
        raise Refused("a vertex without three numbers: expected x, y and z") from None
    return np.array(rows, float).reshape(-1, 3)
