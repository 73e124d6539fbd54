"""Draws clusters of convex objects that intersect, by polygon, in the order of a BSP tree."""

from __future__ import annotations

from dataclasses import dataclass

import moderngl
import numpy as np

from seethrough.renderer.arrays import Ints
from seethrough.renderer.gpu.device.meshes import MeshStore
from seethrough.renderer.gpu.device.programs import Shader
from seethrough.renderer.gpu.device.scene_table import SceneTable
from seethrough.renderer.plan.clusters import tree_of
from seethrough.renderer.polygons.bsp import PreparedBsp
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.geometry import Mesh
from seethrough.renderer.scene.scene import Object, Scene

KEPT = 8  # clusters, the last ones drawn


@dataclass(frozen=True, eq=False)
class _Cluster:
    members: list[Object]  # kept, so that no other mesh takes the number of one of theirs
    prepared: PreparedBsp
    mesh: Mesh
    store: MeshStore
    table: SceneTable


class ClusterPainter:
    """Trees and buffers of clusters, made again only when a member moved."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._clusters: dict[bytes, _Cluster] = {}

    def draw(self, scene: Scene, members: Ints, camera: Camera, shader: Shader) -> int:
        """Draw with the shader as it is set up, but for table and sequence. Returns the draws."""
        cluster = self._cluster(scene, members)
        order = cluster.prepared.order(eye=camera.eye)
        triangles = cluster.prepared.drawable.triangles[order]
        cluster.store.get(cluster.mesh, False).reorder(triangles)
        sequence, runs = cluster.table.sequence([np.zeros(1, np.int64)], camera)
        cluster.table.table.use(0)
        sequence.use(1)
        for mesh, start, count in runs[0]:
            mesh.draw(self._context, shader, start, count)
        return len(runs[0])

    def _cluster(self, scene: Scene, members: Ints) -> _Cluster:
        things = [scene.objects[i] for i in members.tolist()]
        key = b"".join(
            np.array([id(t.mesh), *t.transform.ravel(), *t.color], float).tobytes() for t in things
        )
        if key in self._clusters:
            self._clusters[key] = self._clusters.pop(key)
            return self._clusters[key]
        while len(self._clusters) >= KEPT:
            old = self._clusters.pop(next(iter(self._clusters)))
            old.table.release()
            old.store.release()
        self._clusters[key] = self._built(scene, members)
        return self._clusters[key]

    def _built(self, scene: Scene, members: Ints) -> _Cluster:
        things = [scene.objects[i] for i in members.tolist()]
        prepared = tree_of(scene, members)
        assert isinstance(prepared, PreparedBsp)  # the plan makes no cluster without a tree
        drawn = prepared.drawable
        columns = drawn.polygons.attributes
        mesh = Mesh(drawn.polygons.vertices, columns[:, :3], columns[:, 3:], drawn.triangles)
        store = MeshStore(self._context)
        table = SceneTable(self._context, store, Scene((Object(mesh),)))
        return _Cluster(things, prepared, mesh, store, table)
