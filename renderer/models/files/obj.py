"""OBJ: polygons of any shape, colours of materials, of vertices, and of pictures."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.files.mtl import Library, Material, decoded_text, grey_material
from seethrough.renderer.models.files.part import (
    Found,
    Part,
    checked_colors,
    cut_polygons,
    linear_rgba,
    too_many,
)
from seethrough.renderer.models.files.source import Refused, Source

_CURVED = {"curv", "curv2", "surf", "bzp", "bsp"}


@dataclass(eq=False)
class _Faces:
    """The faces of one material: rows of vertices and of texture coordinates (−1: none)."""

    loops: list[list[int]] = field(default_factory=list)
    places: list[list[int]] = field(default_factory=list)


class _Reader:
    """Takes in lines one by one."""

    def __init__(self, source: Source, found: Found) -> None:
        self.found, self.library = found, Library(source, found)
        self.points: list[list[float]] = []
        self.colors: dict[int, list[float]] = {}
        self.uv: list[list[float]] = []
        self.faces: dict[str | None, _Faces] = {}
        self.material: str | None = None
        self.triangles = 0

    def line(self, number: int, line: str) -> None:
        """Raises Refused, naming the line."""
        words = line.split()
        try:
            match words[0]:
                case "v":
                    self._vertex([float(w) for w in words[1:]])
                case "vt":
                    self.uv.append([*(float(w) for w in words[1:3]), 0.0][:2])
                case "f" | "fo":
                    self._face(words[1:])
                case "usemtl":
                    self.material = line.split(None, 1)[1].strip() if len(words) > 1 else ""
                case "mtllib":
                    self._libraries(line, words[1:])
                case "l" | "p":
                    self.found.note("its lines and points are not shown")
                case word if word in _CURVED:
                    self.found.note("its curves and curved surfaces are not shown")
        except Refused as error:
            raise Refused(f"line {number}: {error}") from None
        except (ValueError, IndexError):
            raise Refused(f"line {number}: {line.strip()[:60]!r}: expected numbers") from None

    def _libraries(self, line: str, words: list[str]) -> None:
        """One name with spaces, if there is such a file, else several names."""
        whole = line.split(None, 1)[1].strip() if words else ""
        before = len(self.library.missing)
        self.library.read(whole)
        if len(self.library.missing) > before and len(words) > 1:
            del self.library.missing[before:]
            for word in words:
                self.library.read(word)

    def _vertex(self, values: list[float]) -> None:
        if len(values) < 3:
            raise Refused(f"a vertex of {len(values)} numbers: expected x, y and z")
        if len(values) >= 6:
            # Weight and colour, or colour and perhaps alpha.
            self.colors[len(self.points)] = (
                values[4:7] if len(values) == 7 and values[3] == 1 else values[3:6]
            )
        self.points.append(values[:3])

    def _face(self, words: list[str]) -> None:
        loop: list[int] = []
        places: list[int] = []
        for word in words:
            numbers = word.split("/")
            vertex = _row(numbers[0], len(self.points), "vertex")
            place = -1
            if len(numbers) > 1 and numbers[1]:
                place = _row(numbers[1], len(self.uv), "texture coordinate")
            if not loop or loop[-1] != vertex:
                loop.append(vertex)
                places.append(place)
        while len(loop) > 1 and loop[0] == loop[-1]:
            loop.pop(), places.pop()
        if len(loop) < 3:
            return
        faces = self.faces.setdefault(self.material, _Faces())
        faces.loops.append(loop)
        faces.places.append(places)
        self.triangles += len(loop) - 2
        too_many(self.triangles, at_least=True)


def _row(word: str, count: int, what: str) -> int:
    """Row of a number that counts from 1, or back from the newest."""
    number = int(word)
    row = number - 1 if number > 0 else count + number
    if number == 0 or not 0 <= row < count:
        raise Refused(f"a face names {what} {number} of {count}: expected one the file has")
    return row


def read(source: Source) -> Found:
    """The triangles of an OBJ file. Raises Refused."""
    found = Found()
    reader = _Reader(source, found)
    text = decoded_text(source.main()).replace("\\\r\n", " ").replace("\\\n", " ")
    for number, line in enumerate(text.splitlines(), 1):
        word = line.split(None, 1)[:1]
        if word and word[0] not in ("usemtl", "mtllib"):  # names may hold a #
            line = line.split("#", 1)[0]
        if line and not line.isspace():
            reader.line(number, line)
    if not reader.triangles:
        raise Refused(f"0 triangles: expected a mesh (it has {len(reader.points)} points)")
    points = np.array(reader.points)
    shown = _vertex_colors(reader)
    for name, faces in reader.faces.items():
        material = grey_material() if name is None else reader.library.get(name)
        found.parts.append(_part(points, shown, faces, material, reader, found))
    return found


def _vertex_colors(reader: _Reader) -> Floats | None:
    """(n, 4) linear colours of vertices, None where no vertex has one."""
    if not reader.colors:
        return None
    values = np.ones((len(reader.points), 3))
    values[list(reader.colors)] = list(reader.colors.values())
    checked_colors(values, "vertex")
    return linear_rgba(np.clip(values / (255 if values.max() > 2 else 1), 0, 1))


def _part(
    points: Floats,
    shown: Floats | None,
    faces: _Faces,
    material: Material,
    reader: _Reader,
    found: Found,
) -> Part:
    triangles, _ = cut_polygons(points, faces.loops)
    rows = np.concatenate([np.array(loop) for loop in faces.loops])[triangles]
    color = material.color
    if shown is not None:
        own = shown[rows]
        base = np.array([1, 1, 1, color[3]]) if material.plain else color
        colors = own * base
        found.colors.add("vertices")
    else:
        colors = np.broadcast_to(color, (*rows.shape, 4))
    if not material.plain:
        found.colors.add("materials")
    elif shown is None:
        found.colors.add("none in the file: grey")
    if material.texture is None:
        return Part(points, rows, colors)
    places = np.concatenate([np.array(p) for p in faces.places])[triangles]
    if (places < 0).any():
        found.note("faces without texture coordinates have the texture's lower left corner")
    uv = np.array(reader.uv or [[0.0, 0.0]])[np.maximum(places, 0)]
    uv = np.where((places < 0)[..., None], 0.0, uv)
    found.colors.add("texture")
    return Part(points, rows, colors, uv * material.scale + material.offset, material.texture)
