"""The container of glTF 2.0: JSON, buffers, and accessors as arrays."""

from __future__ import annotations

import base64
import binascii
import json
import struct
from typing import Any
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Numbers
from seethrough.renderer.models.files.gltf_json import (
    ACCESSORS,
    BUFFERS,
    IMAGES,
    VIEWS,
    Kind,
    Row,
    Sparse,
    View,
)
from seethrough.renderer.models.files.part import MOST_TRIANGLES
from seethrough.renderer.models.files.source import Refused, Source

_KINDS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_MOST_ROWS = 6 * MOST_TRIANGLES  # of an accessor
COMPRESSED = {
    "KHR_draco_mesh_compression": "Draco",
    "EXT_meshopt_compression": "meshopt",
    "KHR_meshopt_compression": "meshopt",
}


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
        except (UnicodeDecodeError, json.JSONDecodeError, RecursionError) as error:
            reason = " ".join(str(error).split())[:80]
            raise Refused(f"expected a {self._kind} file, it cannot be read: {reason}") from None
        if not isinstance(found, dict):
            raise Refused(f"expected a {self._kind} file, it cannot be read: no JSON object")
        # What the file says has no type but as it is asked for: see gltf_json.
        self.json: dict[str, Any] = found
        version = str(found.get("asset", {}).get("version", "none"))
        if not version.startswith("2."):
            raise Refused(f"glTF of version {version[:20]}: expected 2.0")
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

    def accessor(self, index: object) -> Numbers:
        """(n, width) as stored. Raises Refused."""
        made = self.row(ACCESSORS, index)
        what = f"accessors[{index}]"
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

    def numbers(self, index: object) -> NDArray[np.float64]:
        """(n, width) float64, whole numbers as shares where the file says that they are."""
        values = self.accessor(index)
        if not self.row(ACCESSORS, index).get("normalized", False):
            return values.astype(float)
        most = np.iinfo(values.dtype.str).max
        return np.maximum(values.astype(float) / most, -1.0)

    def image(self, index: object) -> tuple[bytes, str]:
        """A picture's bytes, and what to call it. Raises Refused."""
        made = self.row(IMAGES, index)
        if "bufferView" in made:
            view = self.row(VIEWS, made["bufferView"])
            data, start = self._buffer(view["buffer"]), view.get("byteOffset", 0)
            return data[start : start + view["byteLength"]], f"texture {index}"
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
        kind = np.dtype(_KINDS[where["componentType"]])
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
