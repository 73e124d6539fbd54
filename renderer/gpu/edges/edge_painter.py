"""Smooths the edges of a finished frame, and draws outlines (renderer/look/edge_arrays.py)."""

from __future__ import annotations

import math

import moderngl
import numpy as np

from seethrough.renderer.arrays import Bools
from seethrough.renderer.gpu.device.scene_table import SceneTable
from seethrough.renderer.gpu.device.targets import FrameTarget
from seethrough.renderer.gpu.levels.lens import tight
from seethrough.renderer.look import edge_arrays
from seethrough.renderer.look.edge_arrays import TOGETHER, Box
from seethrough.renderer.look.edge_lines import lines_of
from seethrough.renderer.look.edge_set import EdgeSet, edge_set
from seethrough.renderer.look.edge_walk import smoothed
from seethrough.renderer.plan.frame_plan import UNSEEN, FramePlan
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.geometry import Mesh


class EdgePainter:
    """Keeps the edges of meshes, and room for a frame."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._sets: dict[int, tuple[Mesh, EdgeSet]] = {}
        self._edges: dict[tuple[int, ...], edge_arrays.Edges] = {}
        self._tables = edge_arrays.tables()
        self._lines, self._room = edge_arrays.lines(0), edge_arrays.room(0, 0)
        self._color, self._depth = memoryview(bytearray()), memoryview(bytearray())

    def draw(
        self,
        table: SceneTable,
        frame: FramePlan,
        camera: Camera,
        target: FrameTarget,
        smooth: bool,
        width: float,
    ) -> None:
        """Smooth what was drawn into the target, or draw outlines so many pixels wide into it, or
        both."""
        # What no doorway shows can have no line that is seen, and is most of a building.
        drawn = frame.boxes.inside & (frame.reasons != UNSEEN)
        if not drawn.any():
            return
        lens = tight(camera, frame)
        near, deep = lens.near, lens.far - lens.near
        view = edge_arrays.View(
            1 / camera.pixel(target.size[1]), *target.size, near, near * lens.far / deep,
            lens.far / deep, smooth, width / 2,
        )  # fmt: skip
        poses = edge_arrays.Poses(
            drawn, table.slot, table.scene.transforms, table.inverse, _through(frame),
            camera.eye, camera.rotation,
        )  # fmt: skip
        edges = self._joined(table)
        count, around = lines_of(edges, poses, view, self._lines)
        if count > len(self._lines.flat):
            self._lines = edge_arrays.lines(count)
            count, around = lines_of(edges, poses, view, self._lines)
        if count:
            box = about(around, view)
            self._make_room(TOGETHER + max(box[2:]), box[2] * box[3])
            self._draw(count, view, target, box)

    def _draw(self, count: int, view: edge_arrays.View, target: FrameTarget, box: Box) -> None:
        """Draw the first so many lines, which look at a part of the picture alone (left, lower
        side, width, height)."""
        left, below, wide = box[:3]
        read = target.framebuffer.read_into
        read(self._color, box, components=4, alignment=1, dtype="f2")
        # As whole numbers: to make others of them takes twice as long.
        read(self._depth, box, components=1, alignment=1, attachment=-1, dtype="u4")
        picture = edge_arrays.Picture(
            np.frombuffer(self._color, np.uint16).reshape(-1, 4),
            np.frombuffer(self._depth, np.uint32), left, below, wide, *self._tables,
        )  # fmt: skip
        first, last = smoothed(self._lines, count, view, picture, self._room)
        if first < last:
            rows = self._color[8 * wide * first : 8 * wide * last]
            target.color.write(rows, viewport=(left, below + first, wide, last - first))

    def _make_room(self, steps: int, pixels: int) -> None:
        """For so many pixels of lines at once, and a part of the picture of so many."""
        had = len(self._room.line) - 1, len(self._room.slot)
        if steps > had[0] or pixels > had[1]:
            steps, pixels = max(steps, had[0]), max(pixels, had[1])
            self._room = edge_arrays.room(steps, pixels)
            self._color = memoryview(bytearray(8 * pixels))
            self._depth = memoryview(bytearray(4 * pixels))

    def _joined(self, table: SceneTable) -> edge_arrays.Edges:
        """The edges of a scene's meshes."""
        key = tuple(id(mesh.mesh) for mesh in table.meshes)
        if key not in self._edges:
            sets = []
            for mesh in table.meshes:
                if id(mesh.mesh) not in self._sets:
                    self._sets[id(mesh.mesh)] = mesh.mesh, edge_set(mesh.mesh)
                sets.append(self._sets[id(mesh.mesh)][1])
            sizes = np.array([[len(s.ends), len(s.planes)] for s in sets])
            self._edges = {key: edge_arrays.Edges(
                np.concatenate([s.ends for s in sets]),
                np.concatenate([s.sides for s in sets]).astype(np.uint32),
                np.concatenate([s.crease for s in sets]).astype(np.uint8),
                np.concatenate([s.planes for s in sets]),
                np.concatenate([np.zeros((1, 2), np.int64), np.cumsum(sizes, axis=0)]),
            )}  # fmt: skip
        return self._edges[key]


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


def about(around: Box, view: edge_arrays.View) -> Box:
    """Left, lower side, width and height of what lines that run within `around` change or look at:
    two pixels beside them, and what has ink."""
    margin = 2 + math.ceil(math.sqrt(2) * view.half)
    left, below, right, above = around
    left, below = max(left - margin, 0), max(below - margin, 0)
    right, above = min(right + margin, view.width), min(above + margin, view.height)
    return left, below, right - left, above - below
