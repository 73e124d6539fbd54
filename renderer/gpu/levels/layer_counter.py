"""Counts the penetrable layers in front of the farthest target, for the least transmittance."""

from __future__ import annotations

import moderngl

from seethrough.renderer.gpu.device.programs import program
from seethrough.renderer.gpu.device.reused import kept
from seethrough.renderer.gpu.device.scene_table import Run


class LayerCounter:
    """A picture of counts. An upper bound: a concave object may count more than once, and every
    target takes the count of the farthest, so that no target keeps less than it should."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self.program = program(context, "object.vert", "count.frag")
        self._size = (0, 0)
        self.counts: moderngl.Texture
        self._depth: moderngl.Renderbuffer
        self._marking: moderngl.Framebuffer
        self._counting: moderngl.Framebuffer

    def _reserve(self, size: tuple[int, int]) -> None:
        if size == self._size:
            return
        if self._size != (0, 0):
            self._marking.release()
            self._counting.release()
            self.counts.release()
            self._depth.release()
        self._size = size
        self.counts = kept(self._context.texture(size, 4, dtype="f2"))
        self.counts.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self._depth = kept(self._context.depth_renderbuffer(size))
        # Two framebuffers of the same pictures: whether depth is written is part of one.
        self._marking = self._context.framebuffer([self.counts], self._depth)
        self._counting = self._context.framebuffer([self.counts], self._depth)
        self._counting.depth_mask = False

    def draw(self, size: tuple[int, int], targets: list[Run], occluders: list[Run]) -> int:
        """Fill `counts`; the program's uniforms are set. Returns the draw calls."""
        self._reserve(size)
        context = self._context
        self._marking.use()
        self._marking.clear(depth=0.0)
        context.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE | moderngl.BLEND)
        context.blend_func = (moderngl.ZERO, moderngl.ONE)
        context.depth_func = ">"
        for mesh, start, count in targets:
            mesh.draw(context, self.program, start, count)
        self._counting.use()
        context.blend_func = (moderngl.ONE, moderngl.ONE)
        context.depth_func = "<"
        for mesh, start, count in occluders:
            mesh.draw(context, self.program, start, count)
        context.depth_func = "<="
        return len(targets) + len(occluders)
