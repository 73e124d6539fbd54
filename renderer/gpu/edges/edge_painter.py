"""Smooths the edges of a finished frame (renderer/look/edge_walk.py)."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats
from seethrough.renderer.gpu.device.scene_table import SceneTable
from seethrough.renderer.gpu.device.targets import FrameTarget
from seethrough.renderer.gpu.levels.lens import tight
from seethrough.renderer.look import edge_walk
from seethrough.renderer.look.edge_set import EdgeSet, edge_set
from seethrough.renderer.plan.planner import FramePlan
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.geometry import Mesh


class EdgePainter:
    """Keeps the edges of meshes, and room for a frame."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._sets: dict[int, tuple[Mesh, EdgeSet]] = {}
        self._lines: dict[tuple[int, ...], edge_walk.Lines] = {}
        self._tables = edge_walk.tables()
        self._room = edge_walk.room((1, 1))
        self._color = self._depth = bytearray()

    def smooth(
        self, table: SceneTable, frame: FramePlan, camera: Camera, target: FrameTarget
    ) -> int:
        """Smooth what was drawn into the target. Returns how many pixels were changed."""
        objects = np.nonzero(frame.boxes.inside)[0]
        if not len(objects):
            return 0
        width, height = target.size
        if len(self._color) != 8 * width * height:
            self._color, self._depth = bytearray(8 * width * height), bytearray(4 * width * height)
        if self._room.best.shape != (height, width):
            self._room = edge_walk.room(target.size)
        target.framebuffer.read_into(self._color, components=4, alignment=1, dtype="f2")
        target.framebuffer.read_into(
            self._depth, components=1, alignment=1, attachment=-1, dtype="f4"
        )
        color = np.frombuffer(self._color, np.uint16).reshape(height, width, 4)
        depth = np.frombuffer(self._depth, np.float32).reshape(height, width)
        through = np.zeros(len(table.slot), dtype=bool)
        for found in (frame.masked, frame.ruled, frame.held):
            through[found] = True
        poses = edge_walk.Poses(
            table.slot[objects], *self._poses(table, objects, camera), through[objects]
        )
        lines = self._joined(table)
        lens = tight(camera, frame)
        near, far = lens.near, lens.far
        view = edge_walk.View(
            0.5 * height / np.tan(camera.fov_y / 2), 0.5 * width, 0.5 * height, near,
            near * far / (far - near), far / (far - near),
        )  # fmt: skip
        picture = edge_walk.Picture(color, depth, *self._tables)
        changed = edge_walk.smoothed(lines, poses, view, picture, self._room)
        if changed:
            target.color.write(self._color)
        return changed

    def _poses(
        self, table: SceneTable, objects: NDArray[np.int64], camera: Camera
    ) -> tuple[Floats, Floats, Floats]:
        """Where the eye is in mesh space, and turns and moves: camera ← mesh."""
        turns, moves = table.turned(objects, camera)
        matrix = table.scene.transforms[objects]
        eyes = np.einsum("kij,kj->ki", table.inverse[objects], camera.eye - matrix[:, :3, 3])
        return eyes, turns, moves

    def _joined(self, table: SceneTable) -> edge_walk.Lines:
        """The edges of a scene's meshes."""
        key = tuple(id(mesh.mesh) for mesh in table.meshes)
        if key not in self._lines:
            sets = []
            for mesh in table.meshes:
                if id(mesh.mesh) not in self._sets:
                    self._sets[id(mesh.mesh)] = mesh.mesh, edge_set(mesh.mesh)
                sets.append(self._sets[id(mesh.mesh)][1])
            sizes = np.array([[len(s.ends), len(s.planes)] for s in sets])
            self._lines = {key: edge_walk.Lines(
                np.concatenate([s.ends for s in sets]), np.concatenate([s.sides for s in sets]),
                np.concatenate([s.crease for s in sets]), np.concatenate([s.planes for s in sets]),
                np.concatenate([np.zeros((1, 2), np.int64), np.cumsum(sizes, axis=0)]),
            )}  # fmt: skip
        return self._lines[key]
