"""A file of many things as a scene: each node with a mesh a thing, cameras as places to stand.

glTF keeps its nodes apart; OBJ, STL and PLY hold a single thing. Everything stands where the file
has it, in the file's own units and with its own axis upwards.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain, count
from pathlib import Path

import numpy as np

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.files.gltf import check_drawn, opened, primitives
from seethrough.renderer.models.files.gltf_file import GltfFile
from seethrough.renderer.models.files.gltf_json import CAMERAS, MESHES, NODES
from seethrough.renderer.models.files.gltf_material import Materials
from seethrough.renderer.models.files.gltf_nodes import Node, Nodes
from seethrough.renderer.models.files.part import Found, too_many
from seethrough.renderer.models.files.source import Nothing, Refused, Source
from seethrough.renderer.models.user import KINDS, check_parts, found_in, meshed, told
from seethrough.renderer.scene.geometry import Mesh

MOST_THINGS = 5000
MOST_IN_ALL = 2_000_000  # triangles of a scene: four times the whole walkthrough
DETAIL = 10_000  # triangles that textures may add to a mesh
GLTF = (".glb", ".gltf")

__all__ = ["DETAIL", "KINDS", "SceneFile", "Standpoint", "Thing", "read_scene"]


@dataclass(frozen=True, eq=False)
class Thing:
    """A thing of a file: its name, mesh, where it stands (4, 4), and what the file says of it and
    of the nodes above it (`extras`, of equal names the nearest, in the order of nodes)."""

    name: str
    mesh: Mesh
    transform: Floats
    extras: Mapping[str, object] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Standpoint:
    """A camera of a file: its name, where it stands (4, 4, it looks along its −z), its lens."""

    name: str
    transform: Floats
    fov_y: float


@dataclass(frozen=True, eq=False)
class SceneFile:
    """What a file holds; `spots` are the places of its nodes that have no mesh, by name; `notes`
    what is not shown as it is in the file, `digest` of all its files."""

    things: tuple[Thing, ...]
    standpoints: tuple[Standpoint, ...]
    spots: Mapping[str, Floats]
    triangles: int
    notes: tuple[str, ...]
    digest: str


def read_scene(path: Path, detail: int = DETAIL) -> SceneFile:
    """The things of a glTF, OBJ, STL or PLY file; textures become colours of vertices, for which at
    most `detail` triangles are added to each mesh. Raises ValueError, one line that names the file,
    for whatever cannot be shown; OSError."""
    source = Source(path)
    try:
        if path.suffix.lower() not in GLTF:
            return _single(source, detail)
        return told(source, lambda source: _Reader(source, detail).read())
    except Refused as error:
        raise ValueError(f"{path}: {error}") from None


def _single(source: Source, detail: int) -> SceneFile:
    found = found_in(source)
    mesh = meshed(found.parts, found, detail).mesh
    thing = Thing(source.path.stem, mesh, np.eye(4))
    triangles = len(mesh.triangles)
    return SceneFile((thing,), (), {}, triangles, tuple(found.notes), source.digest())


class _Reader:
    """One glTF file while it is read."""

    def __init__(self, source: Source, detail: int) -> None:
        self._source, self._detail = source, detail
        self._file: GltfFile
        self._found: Found
        self._materials: Materials
        self._file, self._found, self._materials = opened(source)
        self._nodes = Nodes(self._file, self._found)
        self._plain: dict[object, Mesh | None] = {}  # of a mesh by its number, in no pose
        self._known: dict[bytes, Mesh] = {}  # by content: exporters write copies

    def read(self) -> SceneFile:
        things = list(self._things())
        total = sum(len(thing.mesh.triangles) for thing in things)
        check_drawn(total, self._found)
        standpoints, spots = self._standpoints(), self._spots()
        notes, digest = tuple(self._found.notes), self._source.digest()
        return SceneFile(tuple(things), standpoints, spots, total, notes, digest)

    def _things(self) -> Iterator[Thing]:
        number = total = 0
        for index, node in self._nodes.with_meshes():
            mesh = self._mesh(index, node)
            if mesh is None:
                continue
            name, extras = self._name(index), self._extras(index)
            places = [np.eye(4)] if node.joints is not None else self._nodes.places(index)
            for place in places:
                number, total = number + 1, total + len(mesh.triangles)
                if number > MOST_THINGS:
                    raise Refused(f"more than {MOST_THINGS} things: expected at most so many")
                if total > MOST_IN_ALL:
                    raise Refused(f"more than {MOST_IN_ALL} triangles: expected at most so many")
                self._check_place(index, place)
                yield Thing(name, mesh, place, extras)

    def _check_place(self, index: int, place: Floats) -> None:
        size = np.linalg.svd(place[:3, :3], compute_uv=False)
        if not (np.isfinite(place).all() and size[-1] > 1e-9 * max(size[0], 1e-300)):
            raise Refused(f"nodes[{index}]: scaled flat: expected a thing with an extent")

    def _mesh(self, index: int, node: Node) -> Mesh | None:
        """The mesh of a node, None where it has no triangles."""
        number = self._file.row(NODES, index)["mesh"]
        if not node.plain:
            return self._made(number, node)
        if number not in self._plain:
            self._plain[number] = self._made(number, node)
        return self._plain[number]

    def _made(self, number: object, node: Node) -> Mesh | None:
        parts = primitives(self._file, number, node, np.eye(4), self._materials, self._found)
        triangles = sum(len(part.triangles) for part in parts)
        if not triangles:
            if parts or not self._file.row(MESHES, number)["primitives"]:
                self._found.note(f"meshes[{number}] has no triangles, and is left out")
            return None
        too_many(triangles)
        try:
            check_parts(parts)
            mesh = meshed(parts, self._found, self._detail).mesh
        except Nothing:
            self._found.note(f"nothing is to be seen of meshes[{number}], which is left out")
            return None
        except Refused as error:
            raise Refused(f"meshes[{number}]: {error}") from None
        arrays = (mesh.vertices, mesh.normals, mesh.colors, mesh.triangles)
        content = hashlib.sha256(b"".join(a.tobytes() for a in arrays)).digest()
        return self._known.setdefault(content, mesh)

    def _name(self, index: int) -> str:
        raw = self._file.row(NODES, index)
        said = raw.get("name")
        if not said and "mesh" in raw:
            said = self._file.row(MESHES, raw["mesh"]).get("name")
        return _text(said, f"nodes[{index}].name") if said else f"thing {index}"

    def _extras(self, index: int) -> Mapping[str, object]:
        """What is said of a node, its mesh and all above it; the nearest holds."""
        found: dict[str, object] = {}
        way = [index]
        while way[-1] in self._nodes.parents:
            way.append(self._nodes.parents[way[-1]])
        rows = [self._file.row(NODES, i) for i in reversed(way)]
        said = [row.get("extras", {}) for row in rows]
        if "mesh" in rows[-1]:
            said.insert(-1, self._file.row(MESHES, rows[-1]["mesh"]).get("extras", {}))
        for extras in said:
            if isinstance(extras, dict):
                found = {k: v for k, v in found.items() if k not in extras} | extras
        return found

    def _standpoints(self) -> tuple[Standpoint, ...]:
        found: list[Standpoint] = []
        for index, world in self._nodes.world.items():
            raw = self._file.row(NODES, index)
            if "camera" not in raw:
                continue
            camera = self._file.row(CAMERAS, raw["camera"])
            if camera.get("type") != "perspective":
                self._found.note("a camera without perspective is left out")
                continue
            if "perspective" not in camera:
                raise Refused(f"cameras[{raw['camera']}].perspective: missing, expected an object")
            said = camera["perspective"]["yfov"]
            if not 0.05 <= said <= 2.8:
                raise Refused(
                    f"cameras[{raw['camera']}].perspective.yfov = {str(said)[:40]}: expected an "
                    "angle from 0.05 to 2.8 radians"
                )
            name = raw.get("name") or camera.get("name") or f"camera {len(found) + 1}"
            name = _unlike(_text(name, f"nodes[{index}].name"), [s.name for s in found])
            found.append(Standpoint(name, _upright(world, index), float(said)))
        return tuple(found)

    def _spots(self) -> Mapping[str, Floats]:
        return {
            self._name(index): world[:3, 3]
            for index, world in self._nodes.world.items()
            if not {"mesh", "camera"} & self._file.row(NODES, index).keys()
        }


def _unlike(name: str, taken: Sequence[str]) -> str:
    """The name, or with a number behind it where another has it already."""
    more = (f"{name} {k}" for k in count(2))
    return next(n for n in chain([name], more) if n not in taken)


def _text(said: object, what: str) -> str:
    if not isinstance(said, str) or not said.isprintable() or len(said) > 200:
        raise Refused(f"{what} = {str(said)[:40]!r}: expected a printable text of at most 200")
    return said


def _upright(world: Floats, index: int) -> Floats:
    """A camera's place without its scale."""
    place = np.eye(4)
    turn, size, rest = np.linalg.svd(world[:3, :3])
    place[:3, :3], place[:3, 3] = turn @ rest, world[:3, 3]
    if size[-1] <= 1e-9 * max(size[0], 1e-300) or np.linalg.det(place[:3, :3]) < 0:
        raise Refused(f"nodes[{index}]: a mirrored or flat camera: expected a place to stand")
    return place
