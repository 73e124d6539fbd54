"""Writes a scene as a GLB file, the same bytes for the same scene: nodes, meshes of one colour a
part, cameras."""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.models.files.part import to_linear
from seethrough.renderer.models.forms.shapes import Shape

STEP = 1e-4  # to which places are rounded, so that equal ones are equal on every machine
FLOAT, SHORT, LONG, BYTE = 5126, 5123, 5125, 5121


@dataclass(frozen=True, eq=False)
class Node:
    """A thing or a camera: `shape` names its mesh, `place` (4, 4) is parent ← node, `extras` are
    its tags; `fov_y` of a camera."""

    name: str
    shape: str = ""
    place: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))
    extras: Mapping[str, object] = field(default_factory=dict)
    children: tuple[Node, ...] = ()
    fov_y: float = 0.0


class _Writer:
    def __init__(self) -> None:
        self.data = bytearray()
        self.json: dict[str, list[dict[str, object]]] = {
            name: []
            for name in ("nodes", "meshes", "cameras", "accessors", "bufferViews", "materials")
        }
        self._materials: dict[tuple[int, ...], int] = {}

    def add(self, kind: str, **row: object) -> int:
        self.json[kind].append(row)
        return len(self.json[kind]) - 1

    def accessor(
        self, values: NDArray[np.generic], component: int, form: str, **more: object
    ) -> int:
        start = len(self.data)
        self.data += values.tobytes()
        length = len(self.data) - start
        self.data += b"\0" * (-len(self.data) % 4)
        view = self.add("bufferViews", buffer=0, byteOffset=start, byteLength=length)
        row = {"bufferView": view, "componentType": component, "count": len(values), "type": form}
        return self.add("accessors", **row, **more)

    def material(self, color: NDArray[np.int64]) -> int:
        """A colour as shown, in 255 steps."""
        key = tuple(int(c) for c in color)
        if key not in self._materials:
            linear = [round(float(c), 5) for c in to_linear(color / 255)]
            pbr = {"baseColorFactor": [*linear, 1.0], "metallicFactor": 0.0}
            self._materials[key] = self.add("materials", pbrMetallicRoughness=pbr)
        return self._materials[key]

    def mesh(self, name: str, shape: Shape) -> int:
        colors = np.round(shape.colors.mean(axis=1) * 255).astype(np.int64)
        places = np.round(shape.vertices / STEP).astype(np.int64)
        primitives = []
        for color in np.unique(colors, axis=0):
            mine = shape.triangles[(colors == color).all(axis=1)]
            points, which = np.unique(places[mine.ravel()], axis=0, return_inverse=True)
            flat = which.reshape(-1, 3)
            whole = (flat[:, 0] != flat[:, 1]) & (flat[:, 1] != flat[:, 2])
            flat = flat[whole & (flat[:, 2] != flat[:, 0])]
            if not len(flat):
                continue
            at = (points * STEP).astype("<f4")
            low, high = at.min(axis=0).tolist(), at.max(axis=0).tolist()
            position = self.accessor(at, FLOAT, "VEC3", min=low, max=high)
            kind, component = _index_kind(len(points))
            indices = self.accessor(flat.astype(kind).ravel(), component, "SCALAR")
            attributes = {"POSITION": position}
            row = {"attributes": attributes, "indices": indices, "material": self.material(color)}
            primitives.append(row)
        return self.add("meshes", name=name, primitives=primitives)

    def node(self, node: Node, meshes: Mapping[str, int]) -> int:
        row: dict[str, object] = {"name": node.name}
        if node.shape:
            row["mesh"] = meshes[node.shape]
        if node.fov_y:
            lens = {"yfov": node.fov_y, "znear": 0.05}
            row["camera"] = self.add(
                "cameras", name=node.name, type="perspective", perspective=lens
            )
        if not np.array_equal(node.place, np.eye(4)):
            row["matrix"] = [round(float(v), 6) + 0.0 for v in node.place.T.ravel()]
        if node.extras:
            row["extras"] = dict(node.extras)
        if node.children:
            row["children"] = [self.node(child, meshes) for child in node.children]
        return self.add("nodes", **row)


def _index_kind(count: int) -> tuple[str, int]:
    """For so many vertices. The largest number of a kind is no index (glTF 2.0 §3.7.2.1): some
    drivers begin a new strip there."""
    if count <= 255:
        return "<u1", BYTE
    return ("<u2", SHORT) if count <= 65535 else ("<u4", LONG)


def glb(nodes: Sequence[Node], shapes: Mapping[str, Shape], said: str) -> bytes:
    """The file's bytes; `said` stands in it as its copyright."""
    writer = _Writer()
    meshes = {name: writer.mesh(name, shape) for name, shape in shapes.items()}
    roots = [writer.node(node, meshes) for node in nodes]
    head = {
        "asset": {"version": "2.0", "generator": "Seethrough", "copyright": said},
        "scene": 0,
        "scenes": [{"nodes": roots}],
        **{name: rows for name, rows in writer.json.items() if rows},
        "buffers": [{"byteLength": len(writer.data)}],
    }
    text = json.dumps(head, separators=(",", ":"), sort_keys=True).encode()
    text += b" " * (-len(text) % 4)
    whole = 12 + 8 + len(text) + 8 + len(writer.data)
    return b"".join(
        (
            struct.pack("<4sII", b"glTF", 2, whole),
            struct.pack("<I4s", len(text), b"JSON"), text,
            struct.pack("<I4s", len(writer.data), b"BIN\0"), bytes(writer.data),
        )
    )  # fmt: skip
