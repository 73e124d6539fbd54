"""Draws the masks of a frame's targets between its objects."""

from __future__ import annotations

from collections.abc import Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from renderer.blocks import BLOCK
from renderer.camera import Camera
from renderer.gpu.distance_painter import DistancePainter
from renderer.gpu.mask_maker import MaskGeometry, mask_geometry
from renderer.gpu.programs import Shader, program
from renderer.gpu.scene_table import Run, SceneTable
from renderer.plan import FramePlan
from renderer.techniques.dynamic import DynamicTransparency

_FORMAT = ("2f 2f 1f 2f", "in_place", "in_offset", "in_kind", "in_extra")
_UNITS = {"distances": 2, "rings": 3, "counts": 4}


class MaskPainter:
    """Masks of one frame at a time; `defines` choose what shaders/mask.frag gives."""

    def __init__(self, context: moderngl.Context, defines: Sequence[str] = ()) -> None:
        self._context, self._cells = context, "CELLS" in defines
        self.mask = program(context, "mask.vert", "mask.frag", defines)
        self._distances = DistancePainter(context)
        self._vertices = context.buffer(reserve=1 << 16, dynamic=True)
        self._array = self._bound()

    def _bound(self) -> moderngl.VertexArray:
        return self._context.vertex_array(self.mask.program, [(self._vertices, *_FORMAT)])

    @property
    def cover(self) -> Shader:
        """The program that marks the pixels of a target, for `draw_distances`."""
        return self._distances.cover

    def prepare(
        self,
        table: SceneTable,
        frame: FramePlan,
        camera: Camera,
        technique: DynamicTransparency,
        width: float,
        size: tuple[int, int],
    ) -> list[NDArray[np.int64]]:
        """Make the geometry; returns what `draw_distances` needs drawn, each by itself."""
        made = mask_geometry(table, frame, camera, technique, width, size)
        self.geometry: MaskGeometry = made
        self._technique, self._width, self._size = technique, width, size
        self._boxes = np.clip(frame.reach, 0, [*size, *size]) / BLOCK
        rows = zip(made.targets.tolist(), made.first.tolist(), made.count.tolist(), strict=True)
        self._runs = {t: (first, count) for t, first, count in rows}
        if made.vertices.nbytes > self._vertices.size:
            self._vertices.release()
            self._vertices = self._context.buffer(reserve=2 * made.vertices.nbytes, dynamic=True)
            self._array = self._bound()
        if len(made.vertices):
            self._vertices.orphan()
            self._vertices.write(made.vertices)
        return [np.array([t]) for t in made.covered.tolist()]

    def draw_distances(self, table: SceneTable, runs: list[list[Run]], camera: Camera) -> int:
        """Draw what the masks without a hull look up. Returns the draw calls made."""
        made = self.geometry
        self.blocks = np.zeros([-(-s // BLOCK) for s in self._size[::-1]], dtype=bool)
        for t in np.setdiff1d(made.targets, made.looped).tolist():
            left, top = np.floor(self._boxes[t, :2]).astype(int).tolist()
            right, bottom = np.ceil(self._boxes[t, 2:]).astype(int).tolist()
            self.blocks[top:bottom, left:right] = True
        marked = self.blocks if self._cells else None
        return self._distances.draw(
            table, made, runs, camera, self._technique, self._width, self._size, marked
        )

    def begin(
        self, counts: moderngl.Texture | None = None, shift: tuple[int, int] = (0, 0)
    ) -> None:
        """Set up the masks of this frame; `counts` are layers in front of the targets."""
        technique, height = self._technique, self._size[1]
        self.mask.set(
            size=self._size,
            width=self._width,
            shift=shift,
            alpha_target=technique.alpha_target,
            alpha_edge=technique.alpha_edge,
            tau=0.0 if counts is None else technique.min_transmittance,
            ring_size=technique.ring_size if technique.mask == "ring" else 0,
            searchlight=searchlight(technique, height),
            **_UNITS,
        )
        for name, unit in _UNITS.items():
            texture = counts if name == "counts" else self._distances.texture(name)
            if texture is not None:
                texture.use(unit)

    def draw(self, targets: NDArray[np.int64]) -> int:
        """Multiply the masks of these targets into the bound frame's alpha. Returns the draws."""
        for t in targets.tolist():
            self.draw_one(t)
        return len(targets)

    def draw_one(self, target: int) -> None:
        """Draw one target's mask."""
        first, count = self._runs[target]
        if count:
            self._array.render(moderngl.TRIANGLES, count, first)


def searchlight(technique: DynamicTransparency, height: int) -> tuple[float, float, float, float]:
    """x, y (up), radius and softness in pixels; a radius < 0 lights everything (shaders)."""
    if technique.mode == "passive":
        return (0.0, 0.0, -1.0, 0.0)
    x, y = technique.pointer or (-1e5, -1e5)
    return (x * height, height - y * height, technique.radius * height, technique.softness * height)
