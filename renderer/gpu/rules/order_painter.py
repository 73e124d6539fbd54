"""Draws what is transparent polygon by polygon, from back to front, in the order that one of the
methods of renderer/polygons gives: as right, and as wrong, as that order is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import moderngl
import numpy as np

from seethrough.renderer.arrays import Ints
from seethrough.renderer.errors import CannotDraw
from seethrough.renderer.gpu.device import pipeline
from seethrough.renderer.gpu.device.meshes import MeshStore
from seethrough.renderer.gpu.device.scene_table import SceneTable
from seethrough.renderer.gpu.device.targets import FrameTarget
from seethrough.renderer.gpu.rules.rule_program import Ruled, RulePrograms, draw
from seethrough.renderer.plan.clusters import polygons_of
from seethrough.renderer.polygons.fragments import TooManyPieces
from seethrough.renderer.polygons.methods import prepare
from seethrough.renderer.polygons.prepared import Prepared
from seethrough.renderer.scene.geometry import Mesh
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.visibility import Drawn

MOST = 40_000  # triangles of a scene: a tree of as many takes seconds
MOST_PIECES = 200_000  # that they may be cut into


@dataclass(frozen=True, eq=False)
class _Ordered:
    things: list[Object]  # kept, so that no other mesh takes the number of one of theirs
    prepared: Prepared
    mesh: Mesh
    store: MeshStore
    table: SceneTable


class OrderPainter:
    """Keeps what was prepared of the last scene; `found` is nothing, for polygons have no ids."""

    def __init__(self, context: moderngl.Context, defines: Sequence[str]) -> None:
        self._context = context
        shown = [d for d in defines if d != "WITH_IDS"]
        self._programs = RulePrograms(context, ["BLENDED", *shown])
        self._kept: dict[bytes, _Ordered] = {}
        self.found: list[Drawn] = []

    def draw(self, asked: Ruled, target: FrameTarget) -> int:
        """Draw the plan's ruled objects over those already in the target. Returns the draws.

        Raises CannotDraw where there are too many polygons to put in order, or cross too densely.
        """
        technique, shot = asked.technique, asked.shot
        method = technique.technique.order(technique)
        assert method is not None, "painters.of asks for this painter where there is an order"
        every = np.nonzero(technique.technique.touches(technique, asked.state, shot))[0]
        made = self._ordered(shot.scene, every, method)
        order = made.prepared.order(eye=shot.camera.eye, view=shot.camera.forward)
        made.store.get(made.mesh, False).reorder(made.prepared.drawable.triangles[order])
        shader = self._programs.ready(asked)
        ruled = np.ones(1)  # the technique's number of what is transparent
        sequence, runs = made.table.sequence([np.zeros(1, np.int64)], shot.camera, [ruled])
        target.framebuffer.depth_mask = False
        target.framebuffer.use()  # after the mask: a bound framebuffer would keep its own
        sides = technique.technique.sides(technique)
        context = self._context
        context.enable_only(
            moderngl.DEPTH_TEST | moderngl.BLEND | (0 if sides else moderngl.CULL_FACE)
        )
        context.depth_func = "<="
        pipeline.blend(context, pipeline.OVER)
        draw(context, shader, made.table, sequence, runs[0], shot.camera, asked.matrix)
        target.framebuffer.depth_mask = True
        target.framebuffer.use()
        return len(runs[0])

    def _ordered(self, scene: Scene, members: Ints, method: str) -> _Ordered:
        things = [scene.objects[i] for i in members.tolist()]
        key = method.encode() + b"".join(
            np.array([id(t.mesh), *t.transform.ravel(), *t.color], float).tobytes() for t in things
        )
        if key not in self._kept:
            for old in self._kept.values():
                old.table.release()
                old.store.release()
            self._kept = {key: self._made(scene, members, method, things)}
        return self._kept[key]

    def _made(self, scene: Scene, members: Ints, method: str, things: list[Object]) -> _Ordered:
        count = sum(len(thing.mesh.triangles) for thing in things)
        said = f'order = "{method}", expected "pixel" where'
        if count > MOST:
            raise CannotDraw(f"{said} {count} triangles are transparent, more than {MOST}")
        try:
            prepared = prepare(method, polygons_of(scene, members), MOST_PIECES)
        except TooManyPieces as error:
            raise CannotDraw(f"{said} {error}") from error
        drawn = prepared.drawable
        columns = drawn.polygons.attributes
        mesh = Mesh(drawn.polygons.vertices, columns[:, :3], columns[:, 3:], drawn.triangles)
        store = MeshStore(self._context)
        table = SceneTable(self._context, store, Scene((Object(mesh),)))
        return _Ordered(things, prepared, mesh, store, table)
