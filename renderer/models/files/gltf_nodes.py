"""The nodes of a glTF scene: where meshes stand, skins and morphs in the pose of the file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.files.gltf_file import (
    BINDINGS,
    JOINTS,
    PLACES,
    POSITIONS,
    SCALES,
    TURNS,
    WEIGHTS,
    GltfFile,
)
from seethrough.renderer.models.files.gltf_json import (
    MESHES,
    NODES,
    SCENES,
    SKINS,
    NodeRow,
    Primitive,
)
from seethrough.renderer.models.files.part import Found
from seethrough.renderer.models.files.source import Refused

_INSTANCED: Final = "EXT_mesh_gpu_instancing"
_COUNTS = {"matrix": 16, "rotation": 4, "scale": 3, "translation": 3}
_INSTANCE = {"TRANSLATION": PLACES, "ROTATION": TURNS, "SCALE": SCALES}
_MOST_INSTANCES = 10_000


class Node:
    """A node with a mesh: `joints` (k, 4, 4) of its skin, world ← mesh, None without one.
    `plain`: the mesh as the file has it, in no pose."""

    def __init__(self, file: GltfFile, weights: list[float], joints: Floats | None) -> None:
        self._file, self._weights, self.joints = file, weights, joints
        self.plain = joints is None and not any(weights)

    def posed(self, points: Floats, primitive: Primitive) -> Floats:
        """Points (n, 3) moved by the morph targets as the file weights them."""
        for weight, target in zip(self._weights, primitive.get("targets", []), strict=False):
            if weight and "POSITION" in target:
                moved = self._file.numbers(target["POSITION"], POSITIONS)
                if len(moved) != len(points):
                    said = f"a shape to blend of {len(moved)} vertices"
                    raise Refused(f"{said}: expected {len(points)}, as its mesh has")
                points = points + weight * moved
        return points

    def skinned(self, points: Floats, attributes: Mapping[str, int]) -> Floats:
        """Points (n, 3) where the skin's joints hold them, in the world."""
        assert self.joints is not None
        moved, total = np.zeros_like(points), np.zeros((len(points), 1))
        for k in range(8):
            if f"JOINTS_{k}" not in attributes or f"WEIGHTS_{k}" not in attributes:
                break
            joints = self._file.accessor(attributes[f"JOINTS_{k}"], JOINTS).astype(np.int64)
            weights = self._file.numbers(attributes[f"WEIGHTS_{k}"], WEIGHTS)
            used = weights != 0
            if joints[used].max(initial=0) >= len(self.joints):
                raise Refused(
                    f"joint {joints[used].max()} of {len(self.joints)}: expected one it has"
                )
            for i in range(joints.shape[1]):
                matrix = self.joints[np.where(used[:, i], joints[:, i], 0)]
                at = np.einsum("nij,nj->ni", matrix[:, :3, :3], points) + matrix[:, :3, 3]
                moved += weights[:, i : i + 1] * at
                total += weights[:, i : i + 1]
        return np.divide(moved, total, out=points.copy(), where=total > 0)


class Nodes:
    """Every node of the scene: its matrix (`world` ← node), and the `parents` of those that have
    one."""

    def __init__(self, file: GltfFile, found: Found) -> None:
        self._file, self._found = file, found
        self.parents: dict[int, int] = {}
        self.world = self._walked()

    def meshes(self) -> Iterator[tuple[int, Node, Floats]]:
        """Mesh number, node and matrix (world ← mesh), as often as the scene has a mesh."""
        for index, node in self.with_meshes():
            for matrix in self.places(index):
                yield self._file.row(NODES, index)["mesh"], node, matrix

    def with_meshes(self) -> Iterator[tuple[int, Node]]:
        """Number and node, of every node with a mesh."""
        for index in self.world:
            raw = self._file.row(NODES, index)
            if "mesh" not in raw:
                continue
            mesh = self._file.row(MESHES, raw["mesh"])
            weights = raw.get("weights", mesh.get("weights", []))
            joints = None
            if "skin" in raw:
                joints = self._joints(raw["skin"])
                self._found.note("it has joints: shown in the pose of the file")
            if any(weights):
                self._found.note("it has shapes to blend: shown as the file weights them")
            yield index, Node(self._file, weights, joints)

    def places(self, index: int) -> Iterator[Floats]:
        """World ← mesh of every instance of a node."""
        for own in self._instances(self._file.row(NODES, index)):
            yield self.world[index] @ own

    def _walked(self) -> dict[int, Floats]:
        """World ← node for every node of the scene that is shown."""
        rows = self._file.rows(NODES)
        scenes = self._file.rows(SCENES)
        if scenes:
            roots = self._file.row(SCENES, self._file.json.get("scene", 0)).get("nodes", [])
        else:
            below = {c for row in rows for c in row.get("children", [])}
            roots = [i for i in range(len(rows)) if i not in below]
        if len(scenes) > 1:
            self._found.note(f"1 of its {len(scenes)} scenes is shown")
        world: dict[int, Floats] = {}
        waiting = [(index, np.eye(4)) for index in reversed(roots)]
        while waiting:
            index, parent = waiting.pop()
            raw = self._file.row(NODES, index)
            if index in world:
                raise Refused(f"nodes[{index}]: is part of the scene twice: expected a tree")
            world[index] = parent @ _matrix(raw, f"nodes[{index}]")
            children = raw.get("children", [])
            self.parents |= dict.fromkeys(children, index)
            waiting += [(child, world[index]) for child in reversed(children)]
        return world

    def _joints(self, index: object) -> Floats:
        skin = self._file.row(SKINS, index)
        names = skin["joints"]
        missing = [j for j in names if j not in self.world]
        if missing:
            raise Refused(f"nodes[{missing[0]}]: a joint that is not in the scene")
        world = np.array([self.world[j] for j in names]).reshape(-1, 4, 4)
        if "inverseBindMatrices" not in skin:
            return world
        inverse = self._file.numbers(skin["inverseBindMatrices"], BINDINGS).reshape(-1, 4, 4)
        if len(inverse) < len(names):
            raise Refused(f"skins[{index}]: {len(inverse)} matrices of {len(names)} joints")
        return world @ np.swapaxes(inverse[: len(names)], 1, 2)

    def _instances(self, raw: NodeRow) -> Iterator[Floats]:
        made = raw.get("extensions", {}).get(_INSTANCED)
        if made is None:
            yield np.eye(4)
            return
        columns = {
            key.lower(): self._file.numbers(number, _INSTANCE[key])
            for key, number in made["attributes"].items()
            if key in _INSTANCE
        }
        counts = {len(values) for values in columns.values()}
        if len(counts) != 1 or max(counts) > _MOST_INSTANCES:
            raise Refused(f"{_INSTANCED}: {sorted(counts)} entries: expected one number of them")
        for row in range(counts.pop()):
            yield _matrix({key: values[row] for key, values in columns.items()}, _INSTANCED)


def _matrix(raw: NodeRow | Mapping[str, Floats], what: str) -> Floats:
    """(4, 4) parent ← node. Raises Refused."""
    said: Mapping[str, object] = raw
    for name, count in _COUNTS.items():
        if name in said and np.shape(np.asarray(said[name])) != (count,):
            raise Refused(f"{what}.{name} = {str(said[name])[:40]}: expected {count} numbers")
    if "matrix" in raw:
        matrix = np.array(raw["matrix"], float).reshape(4, 4).T
    else:
        x, y, z, w = np.array(raw.get("rotation", (0, 0, 0, 1)), float)
        length = np.sqrt(x * x + y * y + z * z + w * w)
        x, y, z, w = (x, y, z, w) / length if length > 0 else (0.0, 0.0, 0.0, 1.0)
        turn = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
        matrix = np.eye(4)
        matrix[:3, :3] = np.array(turn) * np.array(raw.get("scale", (1, 1, 1)), float)
        matrix[:3, 3] = raw.get("translation", (0, 0, 0))
    if not np.isfinite(matrix).all():
        raise Refused(f"{what}: a place that is not finite: expected numbers")
    if not np.allclose(matrix[3], (0, 0, 0, 1), rtol=0, atol=1e-6):  # as 32 bits round
        shown = ", ".join(f"{value:g}" for value in matrix[3])
        raise Refused(f"{what}.matrix: its last row is {shown}: expected 0, 0, 0, 1")
    matrix[3] = 0, 0, 0, 1
    return matrix
