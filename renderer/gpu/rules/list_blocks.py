"""The blocks of pixels that hold lists of surfaces: what lists add up to is drawn there alone.

Blocks are drawn as points, so that no pixel is asked twice: a triangle that covers the picture may
be cut in two, and a pixel with several samples that lies in both halves is drawn by both.
"""

from __future__ import annotations

import moderngl
import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bools, Whole
from seethrough.renderer.gpu.device import pipeline
from seethrough.renderer.gpu.device.programs import Shader, program
from seethrough.renderer.gpu.device.reused import kept
from seethrough.renderer.gpu.rules.lists import BEFORE, NEEDED
from seethrough.renderer.gpu.rules.scope import Scope
from seethrough.renderer.plan import blocks
from seethrough.renderer.plan.blocks import BLOCK


class ListBlocks:
    """The blocks of one frame after the other, and programs that are drawn over them."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._places = kept(context.buffer(reserve=1 << 14, dynamic=True))
        self._arrays: dict[Shader, moderngl.VertexArray] = {}
        self._size, self._count, self._with_beside = (0, 0), 0, 0

    def program(self, fragment: str, words: int) -> Shader:
        """A program over blocks, of lists whose surfaces are so many words."""
        values = {**BEFORE, "groups": []}
        own = [f"WORDS {words}u"]
        return program(self._context, "few.vert", fragment, own, NEEDED, values)

    def find(self, heads: NDArray[np.uint32], size: tuple[int, int], scope: Scope) -> None:
        """Find the blocks of a part of the picture in which a list begins: `heads` (h·w,), the
        bottom row first; and those beside them."""
        held = held_in(heads.reshape(size[1], size[0]), scope)
        first, second = np.argwhere(held), np.argwhere(beside(held) & ~held)
        self._size, self._count = size, len(first)
        self._with_beside = len(first) + len(second)
        places = np.concatenate([first, second])[:, ::-1].astype(np.float32) * BLOCK
        if places.nbytes > self._places.size:
            self._places.release()
            self._places = kept(self._context.buffer(reserve=2 * places.nbytes, dynamic=True))
            self._arrays.clear()
        self._places.orphan()
        if len(places):
            self._places.write(np.ascontiguousarray(places))

    def draw(
        self,
        shader: Shader,
        into: moderngl.Framebuffer,
        factors: pipeline.Factors | None = None,
        with_beside: bool = False,
    ) -> None:
        """Draw a program over the blocks, blended by factors; `with_beside`, over those as well."""
        wide, high = blocks.whole(self._size)
        # A point whose middle lies beyond the view is not drawn, whatever of it lies within.
        into.viewport = (0, self._size[1] - high, wide, high)
        into.use()
        shader.set(size=(wide, high))
        self._context.enable_only(moderngl.PROGRAM_POINT_SIZE | (moderngl.BLEND if factors else 0))
        if factors:
            pipeline.blend(self._context, factors)
        if shader not in self._arrays:
            content = [(self._places, "2f", "in_place")]
            self._arrays[shader] = self._context.vertex_array(shader.program, content)
        count = self._with_beside if with_beside else self._count
        if count:
            self._arrays[shader].render(moderngl.POINTS, count)
        into.viewport = (0, 0, *self._size)


@njit(cache=True)
def held_in(heads: Whole, scope: Scope) -> Bools:
    """Of each block (rows from the top, columns), whether a list begins in it: `heads` (h, w), the
    bottom row first, of which only those within the scope (left, bottom, width, height) count."""
    height, width = heads.shape
    held = np.zeros((-(-height // BLOCK), -(-width // BLOCK)), np.bool_)
    left, bottom, across, up = scope
    for y in range(bottom, bottom + up):
        row = (height - 1 - y) // BLOCK
        for x in range(left, left + across):
            if heads[y, x] != 0:
                held[row, x // BLOCK] = True
    return held


@njit(cache=True)
def beside(held: Bools) -> Bools:
    """Which blocks (rows, columns) are held or have one beside, above or below that is."""
    found = held.copy()
    rows, columns = held.shape
    for row in range(rows):
        for column in range(columns):
            if not held[row, column]:
                continue
            found[max(row - 1, 0), column] = True
            found[min(row + 1, rows - 1), column] = True
            found[row, max(column - 1, 0)] = True
            found[row, min(column + 1, columns - 1)] = True
    return found
