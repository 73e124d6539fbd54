"""The tables of a PLY file: what its header declares, read from text or binary."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Numbers
from seethrough.renderer.models.files.source import Refused

TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1",
    "short": "i2", "int16": "i2", "ushort": "u2", "uint16": "u2",
    "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4",
    "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip
ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass(frozen=True, eq=False)
class Table:
    """One element: `columns` (n,) by name; `lists` by name, the lengths (n,) and all values."""

    count: int
    columns: dict[str, Numbers]
    lists: dict[str, tuple[NDArray[np.int64], Numbers]]

    def __len__(self) -> int:
        return self.count


Entry = TypeVar("Entry", bound=np.generic)


@dataclass(frozen=True)
class _Property:
    name: str
    kind: str
    length: str = ""  # the type of the number of values, of a list


@dataclass(frozen=True)
class _Element:
    name: str
    count: int
    properties: list[_Property]


def tables(data: bytes) -> tuple[dict[str, Table], list[str]]:
    """The tables by their elements' names, and the names of the textures. Raises Refused."""
    order, elements, pictures, start = _header(data)
    found: dict[str, Table] = {}
    if order == "":
        words, place = data[start:].split(), 0
        for element in elements:
            found[element.name], place = _text(words, place, element)
    else:
        for element in elements:
            found[element.name], start = _binary(data, start, element, order)
    return found, pictures


def _header(data: bytes) -> tuple[str, list[_Element], list[str], int]:
    end = data.find(b"end_header")
    if not data.startswith(b"ply") or end < 0:
        raise Refused("expected a PLY file, it cannot be read: no header of one")
    stop = data.find(b"\n", end)
    if stop < 0 or (data[end + 10 : end + 11] == b"\r" and data[end + 11 : end + 12] != b"\n"):
        stop = end + 10
    elements: list[_Element] = []
    pictures, order = [], None
    for line in data[:end].decode("utf-8", "replace").splitlines():
        words = line.split()
        try:
            if words[:1] == ["format"]:
                order = ORDERS[words[1]]
            elif words[:1] == ["element"]:
                elements.append(_Element(words[1], int(words[2]), []))
            elif words[:2] == ["property", "list"]:
                made = _Property(words[4], TYPES[words[3]], TYPES[words[2]])
                elements[-1].properties.append(made)
            elif words[:1] == ["property"]:
                elements[-1].properties.append(_Property(words[2], TYPES[words[1]]))
            elif words[:1] == ["comment"] and words[1:2] and words[1].lower() == "texturefile":
                pictures.append(line.split(None, 2)[2].strip())
        except (IndexError, KeyError, ValueError):
            raise Refused(f"header {line[:60]!r}: expected a line of a PLY header") from None
    if order is None:
        raise Refused("no format in the header: expected a PLY file")
    for element in elements:
        if not 0 <= element.count <= len(data):
            raise Refused(f"{element.count} {element.name} entries in {len(data)} bytes")
    return order, elements, pictures, stop + 1


def _binary(data: bytes, start: int, element: _Element, order: str) -> tuple[Table, int]:
    """Read at once where all rows are as long as the first one, else row by row."""
    kinds = [order + p.kind for p in element.properties]
    if not element.count or not kinds:
        return _made(element, [np.zeros(0, k) for k in kinds], []), start
    if not any(p.length for p in element.properties):
        plain = np.dtype([(f"p{i}", kind) for i, kind in enumerate(kinds)])
        rows = _taken(data, start, plain, element.count, element)
        columns = [rows[f"p{i}"] for i in range(len(kinds))]
        return _made(element, columns, []), start + rows.nbytes
    lengths = _lengths(data, start, element, order)
    layout: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    for i, (p, kind) in enumerate(zip(element.properties, kinds, strict=True)):
        if p.length:
            layout.append((f"n{i}", order + p.length))
        layout.append((f"p{i}", kind, (lengths[i],)) if p.length else (f"p{i}", kind))
    fields = np.dtype(layout)
    if start + fields.itemsize * element.count <= len(data):
        table = _taken(data, start, fields, element.count, element)
        same = all((table[f"n{i}"] == n).all() for i, n in lengths.items())
        if same:
            columns = [table[f"p{i}"] for i in range(len(kinds))]
            counts = [np.full(element.count, n) for n in lengths.values()]
            return _made(element, columns, counts), start + table.nbytes
    return _row_by_row(data, start, element, order)


def _lengths(data: bytes, start: int, element: _Element, order: str) -> dict[int, int]:
    """How many values the lists of the first row have, by the number of the property."""
    place, found = start, {}
    for i, p in enumerate(element.properties):
        n = 1
        if p.length:
            n = found[i] = int(_taken(data, place, np.dtype(order + p.length), 1, element)[0])
            place += np.dtype(p.length).itemsize
        if n < 0 or place + n > len(data):
            raise _cut_off(element)
        place += n * np.dtype(p.kind).itemsize
    return found


def _row_by_row(data: bytes, start: int, element: _Element, order: str) -> tuple[Table, int]:
    columns: list[list[Numbers]] = [[] for _ in element.properties]
    counts: list[list[int]] = [[] for p in element.properties if p.length]
    place = start
    kinds = [
        (np.dtype(order + p.kind), np.dtype(order + p.length) if p.length else None)
        for p in element.properties
    ]
    for _ in range(element.count):
        lists = iter(counts)
        for column, (kind, length) in zip(columns, kinds, strict=True):
            n = 1
            if length is not None:
                n = int(_taken(data, place, length, 1, element)[0])
                place += length.itemsize
                next(lists).append(n)
            if n:
                column.append(_taken(data, place, kind, n, element))
            place += n * kind.itemsize
    joined = [
        np.concatenate(column) if column else np.zeros(0, kind)
        for column, (kind, _) in zip(columns, kinds, strict=True)
    ]
    return _made(element, joined, [np.array(n, np.int64) for n in counts]), place


def _taken(
    data: bytes, start: int, kind: np.dtype[Entry], count: int, element: _Element
) -> NDArray[Entry]:
    if count < 0 or start + kind.itemsize * count > len(data):
        raise _cut_off(element)
    return np.frombuffer(data, kind, count, start)


def _text(words: list[bytes], place: int, element: _Element) -> tuple[Table, int]:
    try:
        if not any(p.length for p in element.properties):
            width = len(element.properties)
            chosen = words[place : place + width * element.count]
            if len(chosen) < width * element.count:
                raise _cut_off(element)
            rows = np.array([float(word) for word in chosen]).reshape(element.count, width)
            columns = [_as(rows[:, i], p.kind) for i, p in enumerate(element.properties)]
            return _made(element, columns, []), place + len(chosen)
        values: list[list[float]] = [[] for _ in element.properties]
        counts: list[list[int]] = [[] for p in element.properties if p.length]
        for _ in range(element.count):
            lists = iter(counts)
            for p, column in zip(element.properties, values, strict=True):
                n = 1
                if p.length:
                    n, place = int(words[place]), place + 1
                    next(lists).append(n)
                if n < 0 or place + n > len(words):
                    raise _cut_off(element)
                column.extend(map(float, words[place : place + n]))
                place += n
    except IndexError:
        raise _cut_off(element) from None
    except ValueError as error:
        if isinstance(error, Refused):
            raise
        raise Refused(f"{element.name}: expected numbers, {str(error)[:80]}") from None
    columns = [_as(np.array(c), p.kind) for c, p in zip(values, element.properties, strict=True)]
    return _made(element, columns, [np.array(n, np.int64) for n in counts]), place


def _as(values: NDArray[np.float64], kind: str) -> Numbers:
    """Numbers of a text file as the header's type has them, if they are such."""
    if kind[0] == "f":
        return values
    limits = np.iinfo(kind)
    with np.errstate(invalid="ignore"):
        fits = (values >= limits.min) & (values <= limits.max) & (values == np.floor(values))
    return values.astype(kind) if fits.all() else values


def _made(element: _Element, columns: list[Numbers], counts: list[NDArray[np.int64]]) -> Table:
    lengths = iter(counts)
    single, lists = {}, {}
    for p, column in zip(element.properties, columns, strict=True):
        if p.length:
            own = next(lengths, np.zeros(0, np.int64)).astype(np.int64)
            values = column.reshape(-1)
            lists[p.name.lower()] = (own, values.astype(np.int64) if p.kind[0] != "f" else values)
        else:
            single[p.name.lower()] = column
    return Table(element.count, single, lists)


def _cut_off(element: _Element) -> Refused:
    return Refused(f"fewer than {element.count} {element.name} entries: the file is cut off")
