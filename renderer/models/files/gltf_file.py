"""The container of glTF 2.0: JSON, buffers, and accessors as arrays."""

from __future__ import annotations

import base64
import binascii
import json
import struct
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Numbers
from seethrough.renderer.models.files.gltf_check import check_json
from seethrough.renderer.models.files.gltf_json import (
    ACCESSORS,
    BUFFERS,
    IMAGES,
    VIEWS,
    Accessor,
    Kind,
    Row,
    Sparse,
    View,
)
from seethrough.renderer.models.files.part import MOST_TRIANGLES
from seethrough.renderer.models.files.source import Refused, Source

_KINDS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
FLOAT = 5126
_UNSIGNED = (5121, 5123, 5125)
_SMALL = (5121, 5123)
_MOST_ROWS = 6 * MOST_TRIANGLES  # of an accessor
COMPRESSED = {
    "KHR_draco_mesh_compression": "Draco",
    "EXT_meshopt_compression": "meshopt",
    "KHR_meshopt_compression": "meshopt",
}


@dataclass(frozen=True)
class Use:
    """What an array is used as (`of`), and what it then may be: its shapes, what its numbers are
    stored as, and whether whole numbers have to be `shares` of the largest one."""

    of: str
    shapes: tuple[str, ...]
    kinds: tuple[int, ...] = (FLOAT,)
    shares: bool = False


INDICES = Use("indices", ("SCALAR",), _UNSIGNED)
POSITIONS = Use("POSITION", ("VEC3",), tuple(_KINDS))
TEXTURE_PLACES = Use("TEXCOORD", ("VEC2",), tuple(_KINDS))
COLORS = Use("COLOR", ("VEC3", "VEC4"), (FLOAT, *_SMALL), shares=True)
JOINTS = Use("JOINTS", ("VEC4",), _SMALL)
WEIGHTS = Use("WEIGHTS", ("VEC4",), (FLOAT, *_SMALL), shares=True)
BINDINGS = Use("inverseBindMatrices", ("MAT4",))
PLACES = Use("TRANSLATION", ("VEC3",), tuple(_KINDS))
SCALES = Use("SCALE", ("VEC3",), tuple(_KINDS))
TURNS = Use("ROTATION", ("VEC4",), (FLOAT, 5120, 5122), shares=True)


class GltfFile:
    """One file: `json`, and what its accessors and images hold."""

    def __init__(self, source: Source) -> None:
        self._source, self._kind = source, source.path.suffix[1:].upper()
        data = source.main()
        self._chunk: bytes | None = None
        if data[:4] == b"glTF":
            data = self._binary(data)
        try:
            found = json.loads(data.decode("utf-8-sig"))
        except RecursionError:
            reason = "too many brackets in each other"
            raise Refused(f"expected a {self._kind} file, it cannot be read: {reason}") from None
        except ValueError as error:  # no UTF-8, no JSON, or a number of thousands of digits
            digits = isinstance(error, json.JSONDecodeError | UnicodeDecodeError)
            reason = " ".join(str(error).split())[:80] if digits else "a number of too many digits"
            raise Refused(f"expected a {self._kind} file, it cannot be read: {reason}") from None
        if not isinstance(found, dict):
            raise Refused(f"expected a {self._kind} file, it cannot be read: no JSON object")
        _demand_version(found)  # first: another version has another specification
        check_json(found)
        # What the file says has no type but as it is asked for: see gltf_json, gltf_check.
        self.json: dict[str, Any] = found
        self._buffers: dict[int, bytes] = {}

    def rows(self, kind: Kind[Row]) -> list[Row]:
        """The top-level list of that kind."""
        found: list[Row] = self.json.get(kind.name, [])
        return found

    def row(self, kind: Kind[Row], index: object) -> Row:
        """One of them. Raises Refused for a number that is not there."""
        rows = self.rows(kind)
        if not isinstance(index, int) or isinstance(index, bool) or not 0 <= index < len(rows):
            raise Refused(f"{kind.name}[{index}] of {len(rows)}: expected one the file has")
        return rows[index]

    def accessor(self, index: object, use: Use) -> Numbers:
        """(n, width) as stored. Raises Refused, also for what cannot be used so."""
        made = self.row(ACCESSORS, index)
        what = f"accessors[{index}]"
        self._check_use(made, use, what)
        kind, width = np.dtype(_KINDS[made["componentType"]]), _WIDTHS[made["type"]]
        count = made["count"]
        if not 0 <= count <= _MOST_ROWS:
            raise Refused(f"{what}: {count} entries: expected at most {_MOST_ROWS}")
        if "bufferView" in made:
            start = made.get("byteOffset", 0)
            values = self._view(made["bufferView"], kind, width, count, start, what)
        else:
            values = np.zeros((count, width), kind)
        if "sparse" in made:
            values = self._sparse(values, made["sparse"], what)
        return values

    def numbers(self, index: object, use: Use) -> NDArray[np.float64]:
        """(n, width) float64, whole numbers as shares where the file says that they are."""
        values = self.accessor(index, use)
        if not self.row(ACCESSORS, index).get("normalized", False):
            return values.astype(float)
        most = np.iinfo(values.dtype.str).max
        return np.maximum(values.astype(float) / most, -1.0)

    def _check_use(self, made: Accessor, use: Use, what: str) -> None:
        """Raises Refused for an array that is not what it is to be used as."""
        kind, shape = made["componentType"], made["type"]
        if kind not in _KINDS:
            raise Refused(f"{what}.componentType = {kind}: expected {_listed(_KINDS)}")
        if shape not in use.shapes:
            raise Refused(
                f"{what}.type = {shape[:40]!r}: expected {_listed(use.shapes)} of {use.of}"
            )
        whole = kind != FLOAT
        if made.get("normalized", False) and (not whole or kind == 5125):
            raise Refused(f"{what}.normalized = true: expected small whole numbers to be shares")
        shares = made.get("normalized", False)
        if kind not in use.kinds or (whole and use.shares and not shares):
            more = ", shares where they are whole numbers" if use.shares else ""
            said = f"{what}.componentType = {kind}"
            raise Refused(f"{said}: expected {_listed(use.kinds)} of {use.of}{more}")

    def image(self, index: object) -> tuple[bytes, str]:
        """A picture's bytes, and what to call it. Raises Refused."""
        made = self.row(IMAGES, index)
        if "bufferView" in made:
            view = self.row(VIEWS, made["bufferView"])
            data, start = self._buffer(view["buffer"]), view.get("byteOffset", 0)
            end = start + view["byteLength"]
            if end > len(data):
                said = f"reaches beyond buffers[{view['buffer']}]: the file is cut off"
                raise Refused(f"bufferViews[{made['bufferView']}]: {said}")
            return data[start:end], f"texture {index}"
        if "uri" not in made:
            raise Refused(f"images[{index}]: no picture: expected a file or data")
        uri = made["uri"]
        if uri.startswith("data:"):
            return _inline(uri, f"texture {index}"), f"texture {index}"
        return self._source.beside(unquote(uri), "texture"), f"texture {unquote(uri)[:80]!r}"

    def _binary(self, data: bytes) -> bytes:
        """The JSON chunk of a GLB; keeps the binary one."""
        if len(data) < 20:
            raise Refused(f"expected a GLB file, it cannot be read: {len(data)} bytes")
        _, version, length = struct.unpack_from("<III", data)
        if version != 2:
            raise Refused(f"expected a GLB file, it cannot be read: version {version}, not 2")
        if length > len(data):
            raise Refused(f"{len(data)} bytes of {length}: the file is cut off")
        chunks: dict[int, bytes] = {}
        place = 12
        while place + 8 <= length:
            size, kind = struct.unpack_from("<II", data, place)
            if place + 8 + size > length:
                raise Refused(f"{len(data)} bytes: the file is cut off")
            chunks.setdefault(kind, data[place + 8 : place + 8 + size])
            place += 8 + size
        self._chunk = chunks.get(0x004E4942)
        if 0x4E4F534A not in chunks:
            raise Refused("a GLB file without JSON: expected a mesh")
        return chunks[0x4E4F534A]

    def _buffer(self, index: int) -> bytes:
        if index not in self._buffers:
            made = self.row(BUFFERS, index)
            uri = made.get("uri")
            if uri is None and index == 0 and self._chunk is not None:
                data = self._chunk
            elif uri is None:
                raise Refused(f"buffers[{index}]: no data: expected a file or data")
            elif uri.startswith("data:"):
                data = _inline(uri, f"buffers[{index}]")
            else:
                data = self._source.beside(unquote(uri), f"buffers[{index}]")
            if len(data) < made["byteLength"]:
                raise Refused(
                    f"buffers[{index}]: {len(data)} bytes of {made['byteLength']}: it is cut off"
                )
            self._buffers[index] = data
        return self._buffers[index]

    def _view(
        self, view: object, kind: np.dtype[np.number], width: int, count: int, start: int, what: str
    ) -> Numbers:
        """(count, width), also where rows stand apart."""
        made = self.row(VIEWS, view)
        for name, said in COMPRESSED.items():
            if name in made.get("extensions", {}) and self._is_fallback(made):
                raise compressed(said, name)
        data, size = self._buffer(made["buffer"]), kind.itemsize * width
        step = made.get("byteStride") or size
        first = made.get("byteOffset", 0) + start
        end = first + step * (count - 1) + size if count else first
        if min(first, start) < 0 or step < size or end > len(data):
            raise Refused(f"{what}: reaches beyond its buffer: the file is cut off")
        within = start + step * (count - 1) + size if count else 0
        if within > made["byteLength"]:
            raise Refused(f"{what}: reaches beyond bufferViews[{view}]: the file is cut off")
        rows = np.ndarray((count, size), np.uint8, data, first, (step, 1))
        return np.ascontiguousarray(rows).view(kind).reshape(count, width)

    def _is_fallback(self, view: View) -> bool:
        """Whether the uncompressed data were left out."""
        buffer = self.row(BUFFERS, view["buffer"])
        return "uri" not in buffer and not (view["buffer"] == 0 and self._chunk is not None)

    def _sparse(self, values: Numbers, sparse: Sparse, what: str) -> Numbers:
        """The values with some of them replaced."""
        count = sparse["count"]
        where, made = sparse["indices"], sparse["values"]
        if not 0 <= count <= len(values):
            raise Refused(f"{what}: {count} sparse entries of {len(values)}: expected no more")
        number = where.get("componentType")
        if number not in _UNSIGNED:
            said = f"{what}.sparse.indices.componentType = {number}"
            raise Refused(f"{said}: expected {_listed(_UNSIGNED)}")
        kind = np.dtype(_KINDS[number])
        start = where.get("byteOffset", 0)
        rows = self._view(where["bufferView"], kind, 1, count, start, what)[:, 0].astype(np.int64)
        start, width = made.get("byteOffset", 0), values.shape[1]
        new = self._view(made["bufferView"], values.dtype, width, count, start, what)
        if len(rows) and rows.max() >= len(values):
            raise Refused(
                f"{what}: sparse entry {rows.max()} of {len(values)}: expected one it has"
            )
        values = values.copy()
        values[rows] = new
        return values


def _listed(values: Iterable[object]) -> str:
    *most, last = (str(value) for value in values)
    return f"{', '.join(most)} or {last}" if most else last


def compressed(said: str, name: str) -> Refused:
    """What is told about a file that was squeezed."""
    return Refused(f"compressed with {said} ({name}): save it without compression")


def _inline(uri: str, what: str) -> bytes:
    """The bytes of a data: address."""
    head, comma, body = uri.partition(",")
    if not comma or not head.endswith(";base64"):
        raise Refused(f"{what}: {uri[:40]!r}: expected base64 data")
    try:
        return base64.b64decode("".join(unquote(body).split()), validate=True)
    except (binascii.Error, ValueError):
        raise Refused(f"{what}: expected base64 data, they cannot be read") from None


def _demand_version(found: dict[str, Any]) -> None:
    """Raises Refused for a file that says another version than 2, or none."""
    asset = found.get("asset", {})
    version = asset.get("version", "none") if isinstance(asset, dict) else "2."
    if isinstance(version, str) and not version.startswith("2."):
        raise Refused(f"glTF of version {version[:20]}: expected 2.0")
