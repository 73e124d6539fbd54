"""Draws the distance picture before the objects, and the masks between them."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from renderer.camera import Camera
from renderer.gpu.mask_maker import (
    CHANNELS,
    FAR,
    channels_of,
    hull_targets,
    hull_vertices,
    outline_segments,
    rectangles,
)
from renderer.gpu.programs import program, set_uniform
from renderer.gpu.scene_table import Run, SceneTable
from renderer.plan import FramePlan
from renderer.techniques.dynamic import DynamicTransparency

_QUAD = 4  # vertices of a triangle strip


class MaskPainter:
    """Masks of one frame at a time, for a picture with or without ids."""

    def __init__(self, context: moderngl.Context, ids: bool) -> None:
        self._context = context
        defines = ["WITH_IDS"] if ids else []
        self._mask = program(context, "mask.vert", "mask.frag", defines)
        self.cover = program(context, "object.vert", "cover.frag")
        self._segment = program(context, "segment.vert", "segment.frag")
        self._vertices = context.buffer(reserve=1 << 16, dynamic=True)
        self._segments = context.buffer(reserve=1 << 14, dynamic=True)
        self._mask_array = self._segment_array = None
        self._bind_mask()
        self._bind_segments()
        self._distances: moderngl.Texture | None = None
        self._picture: moderngl.Framebuffer | None = None
        self._runs: dict[int, tuple[int, int]] = {}

    def _bind_mask(self) -> None:
        content = [(self._vertices, "2f 3f", "in_place", "in_data")]
        self._mask_array = self._context.vertex_array(self._mask, content)

    def _bind_segments(self) -> None:
        content = [(self._segments, "4f 1f/i", "in_segment", "in_channel")]
        self._segment_array = self._context.vertex_array(self._segment, content)

    def prepare(
        self,
        table: SceneTable,
        frame: FramePlan,
        camera: Camera,
        technique: DynamicTransparency,
        width: float,
        size: tuple[int, int],
    ) -> tuple[list[NDArray[np.int64]], NDArray[np.float64]]:
        """Make the masks' geometry. Returns what `cover` needs drawn: objects of each distance
        picture, and the (n,) channel of each object."""
        convex = hull_targets(table, frame)
        hulls, others = frame.masked[convex], frame.masked[~convex]
        channel = channels_of(others, frame.boxes.extents, width, len(table.scene.objects))
        vertices, firsts = hull_vertices(table, hulls, camera, size, width)
        flat = rectangles(frame.boxes.extents[others], channel[others], width)
        self._runs = {
            t: (int(firsts[k]), int(firsts[k + 1] - firsts[k]))
            for k, t in enumerate(hulls.tolist())
        }
        base = len(vertices)
        self._runs |= {t: (base + 6 * k, 6) for k, t in enumerate(others.tolist())}
        data = np.concatenate([vertices, flat.reshape(-1, 5)])
        if data.nbytes > self._vertices.size:
            self._vertices = self._context.buffer(reserve=2 * data.nbytes, dynamic=True)
            self._bind_mask()
        if data.nbytes:
            self._vertices.orphan()
            self._vertices.write(data.tobytes())
        self._set(technique, width, size)
        pictures = int(channel.max(initial=-1)) // CHANNELS + 1
        self._others, self._channel = others, channel
        return [others[channel[others] // CHANNELS == p] for p in range(pictures)], channel

    def _set(self, technique: DynamicTransparency, width: float, size: tuple[int, int]) -> None:
        for shader in (self._mask, self._segment):
            set_uniform(shader, "size", size)
        set_uniform(self._mask, "alpha_target", technique.alpha_target)
        set_uniform(self._mask, "alpha_edge", technique.alpha_edge)
        set_uniform(self._mask, "width", width)
        set_uniform(self._mask, "rows", size[1])
        set_uniform(self._segment, "width", width + 1.0)

    def draw_distances(
        self,
        table: SceneTable,
        runs: list[list[Run]],
        camera: Camera,
        clip_from_offset: bytes,
        size: tuple[int, int],
    ) -> int:
        """Draw the distance pictures of the targets without a hull. Returns the draws made."""
        if not runs:
            return 0
        context = self._context
        self._reserve((size[0], size[1] * len(runs)))
        assert self._picture is not None
        self._picture.use()
        self._picture.viewport = (0, 0, size[0], size[1] * len(runs))
        self._picture.clear(FAR, FAR, FAR, FAR)
        context.enable_only(moderngl.BLEND | moderngl.CULL_FACE)
        context.blend_equation = moderngl.MIN
        self.cover["clip_from_offset"].write(clip_from_offset)
        draws = 0
        for p, part in enumerate(runs):
            self._picture.viewport = (0, p * size[1], size[0], size[1])
            for mesh, first, count in part:
                self.cover["first"].value = first
                mesh.array(context, self.cover).render(instances=count)
                draws += 1
            draws += self._draw_segments(table, p, camera, size)
        context.blend_equation = moderngl.FUNC_ADD
        return draws

    def _draw_segments(
        self, table: SceneTable, picture: int, camera: Camera, size: tuple[int, int]
    ) -> int:
        rows = []
        for t in self._others[self._channel[self._others] // CHANNELS == picture].tolist():
            ends = outline_segments(table, t, camera, size)
            rows.append(np.insert(ends, 4, self._channel[t] % CHANNELS, axis=1))
        data = np.concatenate(rows).astype("f4")
        if not len(data):
            return 0
        if data.nbytes > self._segments.size:
            self._segments = self._context.buffer(reserve=2 * data.nbytes, dynamic=True)
            self._bind_segments()
        self._segments.orphan()
        self._segments.write(data.tobytes())
        self._context.disable(moderngl.CULL_FACE)
        self._segment_array.render(moderngl.TRIANGLE_STRIP, _QUAD, instances=len(data))
        self._context.enable(moderngl.CULL_FACE)
        return 1

    def _reserve(self, size: tuple[int, int]) -> None:
        if self._distances is None or self._distances.size != size:
            if self._picture is not None:
                self._picture.release()
                self._distances.release()  # type: ignore[union-attr]
            self._distances = self._context.texture(size, CHANNELS, dtype="f2")
            self._distances.filter = (moderngl.NEAREST, moderngl.NEAREST)
            self._picture = self._context.framebuffer([self._distances])

    def draw(self, masks: NDArray[np.int64]) -> int:
        """Multiply the masks of these targets into the bound frame's alpha. Returns the draws."""
        if self._distances is not None:
            self._distances.use(2)
            set_uniform(self._mask, "distances", 2)
        for t in masks.tolist():
            first, count = self._runs[t]
            self._mask_array.render(moderngl.TRIANGLES, count, first)
        return len(masks)
