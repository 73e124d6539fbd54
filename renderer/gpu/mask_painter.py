"""Draws the pictures of distances before the objects, and the masks between them."""

from __future__ import annotations

from collections.abc import Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from renderer import masks
from renderer.camera import Camera
from renderer.gpu.mask_maker import CHANNELS, MaskGeometry, mask_geometry, outline_segments
from renderer.gpu.programs import program, set_uniform
from renderer.gpu.scene_table import Run, SceneTable
from renderer.plan import FramePlan
from renderer.techniques.dynamic import DynamicTransparency

FAR = 60000.0
_STRIP = 4  # vertices of a rectangle as a triangle strip
_DISTANCES, _RINGS, _COUNTS = 2, 3, 4  # texture units
_FORMAT = ("2f 2f 1f 2f", "in_place", "in_offset", "in_kind", "in_axes")


class MaskPainter:
    """Masks of one frame at a time; `defines` choose what shaders/mask.frag gives."""

    def __init__(self, context: moderngl.Context, defines: Sequence[str] = ()) -> None:
        self._context = context
        self.mask = program(context, "mask.vert", "mask.frag", defines)
        self.cover = program(context, "object.vert", "cover.frag")
        self._segment = program(context, "segment.vert", "segment.frag")
        self._ring = program(context, "present.vert", "ring.frag")
        self._triangle = context.vertex_array(self._ring, [])
        self._vertices = context.buffer(reserve=1 << 16, dynamic=True)
        self._segments = context.buffer(reserve=1 << 14, dynamic=True)
        self._bind()
        self._pictures: dict[str, tuple[moderngl.Texture, moderngl.Framebuffer]] = {}

    def _bind(self) -> None:
        context = self._context
        self._array = context.vertex_array(self.mask, [(self._vertices, *_FORMAT)])
        content = [(self._segments, "4f 1f/i", "in_segment", "in_channel")]
        self._outline = context.vertex_array(self._segment, content)

    def _write(self, buffer: moderngl.Buffer, data: NDArray[np.float32]) -> moderngl.Buffer:
        if data.nbytes > buffer.size:
            buffer.release()
            buffer = self._context.buffer(reserve=2 * data.nbytes, dynamic=True)
        if data.nbytes:
            buffer.orphan()
            buffer.write(data.tobytes())
        return buffer

    def prepare(
        self,
        table: SceneTable,
        frame: FramePlan,
        camera: Camera,
        technique: DynamicTransparency,
        width: float,
        size: tuple[int, int],
    ) -> list[NDArray[np.int64]]:
        """Make the geometry; returns the objects to be drawn into each picture of distances."""
        made = mask_geometry(table, frame, camera, technique, width, size)
        self.geometry: MaskGeometry = made
        self._technique, self._width, self._size = technique, width, size
        self._runs = {
            t: (first, count)
            for t, first, count in zip(
                made.targets.tolist(), made.first.tolist(), made.count.tolist(), strict=True
            )
        }
        old = self._vertices
        self._vertices = self._write(old, made.vertices)
        if self._vertices is not old:
            self._bind()
        pictures = int(made.channel.max(initial=-1)) // CHANNELS + 1
        which = made.channel[made.pictured] // CHANNELS
        return [made.pictured[which == p] for p in range(pictures)]

    def _picture(
        self, name: str, size: tuple[int, int], dtype: str
    ) -> tuple[moderngl.Texture, moderngl.Framebuffer]:
        if name in self._pictures and self._pictures[name][0].size != size:
            for thing in self._pictures.pop(name)[::-1]:
                thing.release()
        if name not in self._pictures:
            texture = self._context.texture(size, CHANNELS, dtype=dtype)
            texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
            self._pictures[name] = (texture, self._context.framebuffer([texture]))
        return self._pictures[name]

    def draw_distances(
        self, table: SceneTable, runs: list[list[Run]], camera: Camera, first: moderngl.Uniform
    ) -> int:
        """Draw what the masks without a hull look up. Returns the draw calls made."""
        if not runs:
            return 0
        width, height = self._size
        draws = self._cover_targets(runs, "distances", self._size, "f4", first)
        if self._technique.mask == "ring":
            return draws + self._draw_rings(runs, first)
        context = self._context
        context.disable(moderngl.CULL_FACE)
        context.blend_equation = moderngl.MIN
        set_uniform(self._segment, "size", self._size)
        set_uniform(self._segment, "width", self._width + 1.0)
        picture = self._pictures["distances"][1]
        for p in range(len(runs)):
            picture.viewport = (0, p * height, width, height)
            draws += self._draw_segments(table, p, camera)
        context.blend_equation = moderngl.FUNC_ADD
        return draws

    def _cover_targets(self, runs, name, size, dtype, first):  # type: ignore[no-untyped-def]
        """Mark the pixels (or cells) that lie on each target."""
        picture = self._picture(name, (size[0], size[1] * len(runs)), dtype)[1]
        picture.use()
        picture.viewport = (0, 0, size[0], size[1] * len(runs))
        picture.clear(FAR, FAR, FAR, FAR)
        self._context.enable_only(moderngl.BLEND | moderngl.CULL_FACE)
        self._context.blend_equation = moderngl.MIN
        draws = 0
        for p, part in enumerate(runs):
            picture.viewport = (0, p * size[1], size[0], size[1])
            for mesh, start, count in part:
                first.value = start
                mesh.array(self._context, self.cover).render(instances=count)
                draws += 1
        self._context.blend_equation = moderngl.FUNC_ADD
        return draws

    def _draw_segments(self, table: SceneTable, picture: int, camera: Camera) -> int:
        made = self.geometry
        rows = []
        for t in made.pictured[made.channel[made.pictured] // CHANNELS == picture].tolist():
            ends = outline_segments(table, t, camera, self._size)
            channel = np.full((len(ends), 1), made.channel[t] % CHANNELS)
            rows.append(np.concatenate([ends, channel], axis=1))
        data = np.concatenate(rows).astype("f4")
        if not len(data):
            return 0
        old = self._segments
        self._segments = self._write(old, data)
        if self._segments is not old:
            self._bind()
        self._outline.render(moderngl.TRIANGLE_STRIP, _STRIP, instances=len(data))
        return 1

    def _draw_rings(self, runs: list[list[Run]], first: moderngl.Uniform) -> int:
        """The paper's masks, on a coarse grid (004 §V-D, algorithm 2)."""
        n, technique = self._technique.ring_size, self._technique
        draws = self._cover_targets(runs, "covers", (n, n), "f2", first)
        picture = self._picture("rings", (n, n * len(runs)), "f4")[1]
        picture.use()
        picture.viewport = (0, 0, n, n * len(runs))
        self._context.enable_only(moderngl.NOTHING)
        self._pictures["covers"][0].use(_RINGS)
        set_uniform(self._ring, "covers", _RINGS)
        scaled = masks.ring_opacities(technique, self._frame_size())
        set_uniform(self._ring, "count", len(scaled))
        set_uniform(self._ring, "ring_size", n)
        set_uniform(self._ring, "alpha_target", technique.alpha_target)
        set_uniform(self._ring, "alpha_edge", technique.alpha_edge)
        self._triangle.render(moderngl.TRIANGLES, 3)
        return draws + 1

    def _frame_size(self) -> tuple[int, int]:
        """The size of the window whose pixels the mask's width counts."""
        scale = self._technique.width / self._width if self._width else 1.0
        return (round(self._size[0] * scale), round(self._size[1] * scale))

    def begin(
        self, counts: moderngl.Texture | None = None, shift: tuple[int, int] = (0, 0)
    ) -> None:
        """Set up the masks of this frame; `counts` are layers in front of the targets."""
        technique, height = self._technique, self._size[1]
        shader = self.mask
        set_uniform(shader, "size", self._size)
        set_uniform(shader, "rows", height)
        set_uniform(shader, "width", self._width)
        set_uniform(shader, "shift", shift)
        set_uniform(shader, "alpha_target", technique.alpha_target)
        set_uniform(shader, "alpha_edge", technique.alpha_edge)
        set_uniform(shader, "tau", 0.0 if counts is None else technique.min_transmittance)
        set_uniform(shader, "ring_size", technique.ring_size if technique.mask == "ring" else 0)
        set_uniform(shader, "searchlight", searchlight(technique, height))
        pictures = {k: v[0] for k, v in self._pictures.items()}
        for unit, name, texture in (
            (_DISTANCES, "distances", pictures.get("distances")),
            (_RINGS, "rings", pictures.get("rings")),
            (_COUNTS, "counts", counts),
        ):
            set_uniform(shader, name, unit)
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
