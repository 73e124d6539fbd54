"""Draws large objects opaque wherever no mask can be: only elsewhere do they have to blend."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import moderngl
import numpy as np

from seethrough.renderer.gpu.device import pipeline
from seethrough.renderer.gpu.device.programs import program
from seethrough.renderer.plan.frame_plan import FramePlan


class OutsidePainter:
    """`defines` as for what draws objects."""

    def __init__(self, context: moderngl.Context, defines: Sequence[str]) -> None:
        self._context = context
        self._flat = program(context, "flat.vert", "depth.frag", defines)

    def draw(self, frame: FramePlan, size: tuple[int, int], lit: Callable[[], None]) -> int:
        """Draw what `lit` does but where masks may be: the nearest depth is put there first, and
        the farthest afterwards. Returns the draw calls beside it."""
        corners = np.array([[0, 1], [2, 1], [2, 3], [0, 1], [2, 3], [0, 3]])
        data = frame.holes[:, corners].astype("f4")
        buffer = self._context.buffer(data.tobytes())
        array = self._context.vertex_array(self._flat.program, [(buffer, "2f", "in_place")])
        self._flat.set(size=size)
        self._put_depth(array, -1.0)
        lit()
        self._put_depth(array, 1.0)
        array.release()
        buffer.release()
        return 2

    def _put_depth(self, array: moderngl.VertexArray, depth: float) -> None:
        context = self._context
        context.disable(moderngl.CULL_FACE)
        context.enable(moderngl.BLEND)
        pipeline.blend(context, pipeline.NOTHING)
        context.depth_func = "1"
        self._flat.set(depth=depth)
        array.render(moderngl.TRIANGLES)
        context.depth_func = "<="
        context.enable(moderngl.CULL_FACE)


def scope(frame: FramePlan, size: tuple[int, int]) -> tuple[int, int, int, int]:
    """The rectangle about all masks as OpenGL's x, y (up), width, height."""
    left, top = frame.holes[:, :2].min(axis=0).tolist()
    right, bottom = frame.holes[:, 2:].max(axis=0).tolist()
    return (left, size[1] - bottom, right - left, bottom - top)
