"""Small model files, made from descriptions: OBJ, PLY, STL and glTF, byte by byte."""

from __future__ import annotations

import base64
import io
import json
import struct

import numpy as np
from PIL import Image

RED, GREEN, BLUE, SAND = (0.8, 0.1, 0.1), (0.1, 0.6, 0.2), (0.15, 0.2, 0.9), (0.9, 0.8, 0.5)
SIDES = (RED, GREEN, BLUE, SAND, (0.2, 0.7, 0.8), (0.6, 0.2, 0.6))
CUBE = [(x, y, z) for x in (0.0, 2.0) for y in (0.0, 1.0) for z in (0.0, 1.5)]
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
SQUARE = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]


def prism(outline, depth=1.0):
    """Points and polygons of an outline (counter-clockwise in x, y) drawn out along z."""
    n = len(outline)
    points = [(x, y, 0.0) for x, y in outline] + [(x, y, depth) for x, y in outline]
    sides = [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
    return points, [tuple(range(n))[::-1], tuple(range(n, 2 * n)), *sides]


ELL = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 2), (0, 2)]
STAR = [
    (r * np.cos(a), r * np.sin(a))
    for r, a in zip([2.0, 0.6] * 6, np.arange(12) * np.pi / 6 + 0.1, strict=True)
]


def triangles_of(polygons):
    """Fans: right for convex polygons."""
    return [(p[0], p[i], p[i + 1]) for p in polygons for i in range(1, len(p) - 1)]


def logo(size=32):
    """(size, size, 3) bytes: a disc, a bar and a frame, nothing of it symmetric."""
    y, x = np.mgrid[:size, :size] / size
    picture = np.full((size, size, 3), (250, 245, 235), np.uint8)
    picture[(x - 0.55) ** 2 + (y - 0.4) ** 2 < 0.06] = (20, 60, 170)
    picture[(y > 0.72) & (y < 0.82) & (x > 0.2) & (x < 0.7)] = (200, 30, 20)
    picture[(x < 0.08) | (y < 0.05)] = (30, 120, 60)
    return picture


def png(picture, kind="PNG", **options):
    """A picture's file."""
    file = io.BytesIO()
    Image.fromarray(np.asarray(picture, np.uint8)).save(file, kind, **options)
    return file.getvalue()


def obj(points, groups, head="", uv=(), ends="\n"):
    """Text of groups [(lines before, [face words])]."""
    lines = [head] if head else []
    lines += ["v " + " ".join(f"{v:.9g}" for v in p) for p in points]
    lines += ["vt " + " ".join(f"{v:.9g}" for v in p) for p in uv]
    for before, faces in groups:
        lines += [before] if before else []
        lines += ["f " + " ".join(str(w) for w in face) for face in faces]
    return (ends.join(lines) + ends).encode()


def ply(elements, form="ascii", comments=()):
    """elements: [(name, [(type or (count type, type), property)], rows)]."""
    kinds = {"uchar": "B", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d"}
    head = ["ply", f"format {form} 1.0", *(f"comment {c}" for c in comments)]
    body = b""
    order = ">" if "big" in form else "<"
    for name, properties, rows in elements:
        head.append(f"element {name} {len(rows)}")
        for kind, label in properties:
            said = kind if isinstance(kind, str) else f"list {kind[0]} {kind[1]}"
            head.append(f"property {said} {label}")
        for row in rows:
            words = []
            for (kind, _), value in zip(properties, row, strict=True):
                if isinstance(kind, str):
                    words.append((kind, value))
                else:
                    words += [(kind[0], len(value)), *((kind[1], v) for v in value)]
            if form == "ascii":
                body += (" ".join(f"{v:.9g}" for _, v in words) + "\n").encode()
            else:
                body += b"".join(struct.pack(order + kinds[k], v) for k, v in words)
    return ("\n".join([*head, "end_header"]) + "\n").encode() + body


def stl(points, triangles, more=None, head=b""):
    """Binary."""
    out = head.ljust(80, b"\0") + struct.pack("<I", len(triangles))
    for i, t in enumerate(triangles):
        out += struct.pack("<3f", 0, 0, 0)
        out += b"".join(struct.pack("<3f", *points[v]) for v in t)
        out += struct.pack("<H", 0 if more is None else more[i])
    return out


class Gltf:
    """A glTF file that is put together piece by piece; `text()` or `binary()` gives its bytes."""

    def __init__(self):
        self.data = b""
        self.json = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}], "meshes": [{"primitives": []}],
            "bufferViews": [], "accessors": [], "materials": [],
        }  # fmt: skip

    def view(self, data, **more):
        """Number of a new view of bytes."""
        self.data += b"\0" * (-len(self.data) % 4)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **more}
        self.json["bufferViews"].append(view)
        self.data += data
        return len(self.json["bufferViews"]) - 1

    def array(self, values, kind="f4", **more):
        """Number of a new accessor."""
        values = np.asarray(values, "<" + kind)
        values = values.reshape(len(values), -1)
        numbers = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
        widths = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
        step = {}
        if values.itemsize * values.shape[1] % 4 and values.shape[1] > 1:
            padded = np.zeros((len(values), -(-values.shape[1] * values.itemsize // 4) * 4), "u1")
            padded[:, : values.shape[1] * values.itemsize] = values.view("u1")
            data, step = padded.tobytes(), {"byteStride": padded.shape[1]}
        else:
            data = values.tobytes()
        made = {
            "bufferView": self.view(data, **step), "componentType": numbers[kind],
            "count": len(values), "type": widths[values.shape[1]], **more,
        }  # fmt: skip
        self.json["accessors"].append(made)
        return len(self.json["accessors"]) - 1

    def primitive(self, points, triangles=None, mode=4, mesh=0, material=None, **attributes):
        """A primitive of a mesh; `material` is its JSON."""
        made = {"attributes": {"POSITION": self.array(points), **attributes}, "mode": mode}
        if triangles is not None:
            made["indices"] = self.array(np.ravel(triangles), "u2")
        if material is not None:
            self.json["materials"].append(material)
            made["material"] = len(self.json["materials"]) - 1
        self.json["meshes"][mesh]["primitives"].append(made)
        return made

    def texture(self, data=None, uri=None, sampler=None):
        """Number of a new texture, of bytes in the buffer or of an address."""
        images = self.json.setdefault("images", [])
        if uri is None:
            images.append({"bufferView": self.view(data), "mimeType": "image/png"})
        else:
            images.append({"uri": uri})
        made = {"source": len(images) - 1}
        if sampler is not None:
            self.json.setdefault("samplers", []).append(sampler)
            made["sampler"] = len(self.json["samplers"]) - 1
        self.json.setdefault("textures", []).append(made)
        return len(self.json["textures"]) - 1

    def text(self):
        """As .gltf with its data inside."""
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        made = {**self.json, "buffers": [{"uri": uri, "byteLength": len(self.data)}]}
        return json.dumps(made).encode()

    def binary(self):
        """As .glb."""
        made = json.dumps({**self.json, "buffers": [{"byteLength": len(self.data)}]}).encode()
        made += b" " * (-len(made) % 4)
        data = self.data + b"\0" * (-len(self.data) % 4)
        body = struct.pack("<II", len(made), 0x4E4F534A) + made
        body += struct.pack("<II", len(data), 0x004E4942) + data
        return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body
