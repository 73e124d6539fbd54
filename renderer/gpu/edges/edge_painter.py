"""Smooths the edges of a finished frame, and draws outlines (renderer/look/edge_arrays.py)."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bools, Floats
from seethrough.renderer.gpu.device.scene_table import SceneTable
from seethrough.renderer.gpu.device.targets import FrameTarget
from seethrough.renderer.gpu.levels.lens import tight
from seethrough.renderer.look import edge_arrays
from seethrough.renderer.look.edge_set import EdgeSet, edge_set
from seethrough.renderer.look.edge_walk import smoothed
from seethrough.renderer.plan.planner import FramePlan
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.geometry import Mesh


class EdgePainter:
    """Keeps the edges of meshes, and room for a frame."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._sets: dict[int, tuple[Mesh, EdgeSet]] = {}
        self._lines: dict[tuple[int, ...], edge_arrays.Lines] = {}
        self._tables = edge_arrays.tables()
        self._room = edge_arrays.room((1, 1))
        self._color = self._depth = bytearray()

    def draw(
        self,
        table: SceneTable,
        frame: FramePlan,
        camera: Camera,
        target: FrameTarget,
        smooth: bool,
        width: float,
    ) -> int:
        """Smooth what was drawn into the target, or draw outlines so many pixels wide into it, or
        both. Returns how many pixels were changed."""
        objects = np.nonzero(frame.boxes.inside)[0]
        if not len(objects):
            return 0
        left, below, wide, high = box = _about(frame.boxes.extents[objects], target.size)
        if self._room.best.shape != (high, wide):
            self._room = edge_arrays.room((wide, high))
            self._color, self._depth = bytearray(8 * wide * high), bytearray(4 * wide * high)
        read = target.framebuffer.read_into
        read(self._color, box, components=4, alignment=1, dtype="f2")
        # As whole numbers: to make others of them takes twice as long.
        read(self._depth, box, components=1, alignment=1, attachment=-1, dtype="u4")
        picture = edge_arrays.Picture(
            np.frombuffer(self._color, np.uint16).reshape(high, wide, 4),
            np.frombuffer(self._depth, np.uint32).reshape(high, wide), *self._tables,
        )  # fmt: skip
        through = _through(frame)
        poses = edge_arrays.Poses(
            table.slot[objects], *self._poses(table, objects, camera), through[objects]
        )
        lens = tight(camera, frame)
        near, deep = lens.near, lens.far - lens.near
        view = edge_arrays.View(
            1 / camera.pixel(target.size[1]), 0.5 * target.size[0] - left,
            0.5 * target.size[1] - below, near, near * lens.far / deep, lens.far / deep,
            smooth, width / 2,
        )  # fmt: skip
        changed = smoothed(self._joined(table), poses, view, picture, self._room)
        if changed:
            target.color.write(self._color, viewport=box)
        return changed

    def _poses(
        self, table: SceneTable, objects: NDArray[np.int64], camera: Camera
    ) -> tuple[Floats, Floats, Floats]:
        """Where the eye is in mesh space, and turns and moves: camera ← mesh."""
        turns, moves = table.turned(objects, camera)
        matrix = table.scene.transforms[objects]
        eyes = np.einsum("kij,kj->ki", table.inverse[objects], camera.eye - matrix[:, :3, 3])
        return eyes, turns, moves

    def _joined(self, table: SceneTable) -> edge_arrays.Lines:
        """The edges of a scene's meshes."""
        key = tuple(id(mesh.mesh) for mesh in table.meshes)
        if key not in self._lines:
            sets = []
            for mesh in table.meshes:
                if id(mesh.mesh) not in self._sets:
                    self._sets[id(mesh.mesh)] = mesh.mesh, edge_set(mesh.mesh)
                sets.append(self._sets[id(mesh.mesh)][1])
            sizes = np.array([[len(s.ends), len(s.planes)] for s in sets])
            self._lines = {key: edge_arrays.Lines(
                np.concatenate([s.ends for s in sets]), np.concatenate([s.sides for s in sets]),
                np.concatenate([s.crease for s in sets]), np.concatenate([s.planes for s in sets]),
                np.concatenate([np.zeros((1, 2), np.int64), np.cumsum(sizes, axis=0)]),
            )}  # fmt: skip
        return self._lines[key]


def _through(frame: FramePlan) -> Bools:
    """(n,) which objects may show through others, or behind what is not in the depth buffer: of
    what is sorted by pixel nothing is there."""
    through = np.zeros(len(frame.boxes.inside), dtype=bool)
    for found in (frame.masked, frame.ruled, frame.held):
        through[found] = True
    if len(frame.held):
        low, high = frame.boxes.extents[:, None, :2], frame.boxes.extents[:, None, 2:]
        meets = np.all((low <= frame.exact[:, 2:]) & (high >= frame.exact[:, :2]), axis=2)
        through |= np.any(meets, axis=1)
    return through


def _about(extents: Floats, size: tuple[int, int]) -> tuple[int, int, int, int]:
    """Left, lower side, width and height of what is about all extents. Widths are multiples of 64:
    room of another size has to be made anew."""
    low = np.clip(np.floor(extents[:, :2].min(axis=0)) - 2, 0, size)
    high = np.clip(np.ceil(extents[:, 2:].max(axis=0)) + 2, 0, size)
    left, top = (int(v) // 64 * 64 for v in low)
    right, bottom = (min(-(-int(v) // 64) * 64, s) for v, s in zip(high, size, strict=True))
    return left, size[1] - bottom, right - left, bottom - top
