"""Meshes on the GPU: each uploaded once, for all objects and scenes that share it."""

from __future__ import annotations

import struct

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device.outlines import Outlines
from seethrough.renderer.gpu.device.programs import Shader
from seethrough.renderer.look.detail import levels
from seethrough.renderer.masks.contours import HalfEdges, half_edges
from seethrough.renderer.masks.silhouettes import Topology, topology
from seethrough.renderer.scene.geometry import Mesh

FORMAT = "3f 3f 3f"
ATTRIBUTES = ("in_position", "in_normal", "in_color")
_INT = struct.Struct("i").pack


class MeshPart:
    """MeshPart of a mesh on the GPU: all of them, or those of a level of detail."""

    def __init__(
        self, context: moderngl.Context, mesh: Mesh, vertices: moderngl.Buffer,
        triangles: NDArray[np.integer],
    ) -> None:  # fmt: skip
        self.mesh, self._vertices = mesh, vertices
        self._indices = context.buffer(np.ascontiguousarray(triangles, dtype="i4").tobytes())
        self._arrays: dict[int, moderngl.VertexArray] = {}
        self._some: dict[tuple[int, int], moderngl.VertexArray] = {}

    def reorder(self, triangles: NDArray[np.int32]) -> None:
        """The same triangles (m, 3) in another order."""
        self._indices.write(np.ascontiguousarray(triangles, dtype="i4").tobytes())

    def release(self) -> None:
        """Give the GPU's memory back."""
        for array in (*self._arrays.values(), *self._some.values()):
            array.release()
        self._indices.release()

    def draw(self, context: moderngl.Context, shader: Shader, first: int, count: int) -> None:
        """Draw `count` instances, from row `first` of the sequence on."""
        key = shader.program.glo
        if key not in self._arrays:
            content = self._content(shader)
            self._arrays[key] = context.vertex_array(shader.program, content, self._indices)
        shader["first"].write(_INT(first))  # half the time of setting its value
        self._arrays[key].render(instances=count)

    def draw_some(
        self,
        context: moderngl.Context,
        shader: Shader,
        row: int,
        indices: moderngl.Buffer,
        part: tuple[int, int],
    ) -> None:
        """Draw one instance, of that `row` of the sequence, of the triangles alone whose corners
        stand in a `part` (first, count) of other `indices`."""
        key = shader.program.glo, indices.glo
        if key not in self._some:
            self._some[key] = context.vertex_array(shader.program, self._content(shader), indices)
        shader["first"].write(_INT(row))
        self._some[key].render(vertices=3 * part[1], first=3 * part[0])

    def _content(self, shader: Shader) -> list[tuple[object, ...]]:
        used = [a if a in shader.members else None for a in ATTRIBUTES]
        layout = " ".join("3f" if a else "12x" for a in used)
        return [(self._vertices, layout, *[a for a in used if a])]


class GpuMesh(MeshPart):
    """One mesh's buffers and, where asked for, its edges. `mirrored` turns its triangles round.

    Positions are relative to the centre of the mesh's bounds: an object far from the origin
    keeps its details in 32 bits.
    """

    def __init__(self, context: moderngl.Context, mesh: Mesh, mirrored: bool) -> None:
        arrays = (mesh.vertices - mesh.center, mesh.normals, mesh.colors)
        vertices = context.buffer(np.concatenate(arrays, axis=1).astype("f4").tobytes())
        turn = -1 if mirrored else 1
        super().__init__(context, mesh, vertices, mesh.triangles[:, ::turn])
        self._context, self._turn = context, turn
        self._topology: Topology | None = None
        self._edges: HalfEdges | None = None
        self._details: tuple[list[MeshPart], NDArray[np.float64]] | None = None

    @property
    def topology(self) -> Topology:
        """The mesh's edges, found when first asked for."""
        if self._topology is None:
            self._topology = topology(self.mesh)
        return self._topology

    @property
    def edges(self) -> HalfEdges:
        """The same for outlines that are drawn as loops."""
        if self._edges is None:
            self._edges = half_edges(self.topology)
        return self._edges

    @property
    def details(self) -> tuple[list[MeshPart], NDArray[np.float64]]:
        """Its levels of detail from fine to coarse, found when first asked for, and how far each is
        off, in the mesh's units."""
        if self._details is None:
            found = levels(self.mesh)
            parts = [
                MeshPart(self._context, self.mesh, self._vertices, part[:, :: self._turn])
                for part in found.triangles
            ]
            self._details = parts, found.errors
        return self._details

    def release(self) -> None:
        """Give the GPU's memory back."""
        super().release()
        for part in self._details[0] if self._details else ():
            part.release()
        self._vertices.release()


class MeshStore:
    """Every mesh that this context has seen, by identity."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._meshes: dict[tuple[int, bool], GpuMesh] = {}
        self.outlines = Outlines()

    def get(self, mesh: Mesh, mirrored: bool) -> GpuMesh:
        """The mesh's buffers, uploaded at its first use."""
        key = (id(mesh), mirrored)
        if key not in self._meshes:
            self._meshes[key] = GpuMesh(self._context, mesh, mirrored)
        return self._meshes[key]

    def release(self) -> None:
        """Give the GPU's memory back."""
        for mesh in self._meshes.values():
            mesh.release()
