"""Many small pictures in one texture, so that drawing into another one switches nothing."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device import pipeline
from seethrough.renderer.gpu.device.programs import program
from seethrough.renderer.gpu.device.reused import kept, spoil
from seethrough.renderer.plan import blocks
from seethrough.renderer.plan.blocks import BLOCK

WIDTH = 2072  # texels; a row of cells is no wider unless one cell is
MOST = 64  # of slices or masks: the bits and arrays in shaders/exact.frag


_CORNERS = np.array([[0, 1], [2, 1], [2, 3], [0, 1], [2, 3], [0, 3]])


class Wiper:
    """Draws rectangles of nothing, at the farthest depth."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._shader = program(context, "flat.vert", "depth.frag")

    def draw(self, places: NDArray[np.float64], size: tuple[int, int]) -> None:
        """Fill (n, 4) rectangles (left, bottom, right, top; y up) of the bound framebuffer."""
        if not len(places):
            return
        data = (places * [1, -1, 1, -1] + [0, size[1], 0, size[1]])[:, _CORNERS]
        buffer = self._context.buffer(np.ascontiguousarray(data, dtype="f4"))
        array = self._context.vertex_array(self._shader.program, [(buffer, "2f", "in_place")])
        self._shader.set(size=size, depth=1.0)
        self._context.enable_only(moderngl.DEPTH_TEST)
        self._context.depth_func = "1"
        array.render(moderngl.TRIANGLES)
        array.release()
        buffer.release()


def height(count: int, size: tuple[int, int] | NDArray[np.int64]) -> int:
    """The rows of texels that `count` cells of `size` take."""
    return -(-count // max(1, WIDTH // int(size[0]))) * int(size[1])


def touched(
    boxes: NDArray[np.float64], cells: NDArray[np.int64], part: NDArray[np.int64]
) -> NDArray[np.float64]:
    """(n, 5) the blocks that (n, 4) boxes of the frame touch, in pixels of a part's cells (y up),
    and the cells."""
    low = np.floor(boxes[:, :2] / BLOCK) * BLOCK
    high = (np.floor(boxes[:, 2:] / BLOCK) + 1) * BLOCK
    low, high = np.maximum(low, part[:2]), np.minimum(high, part[2:])
    rows = [low[:, 0] - part[0], part[3] - high[:, 1], high[:, 0] - part[0], part[3] - low[:, 1]]
    return np.stack([*rows, cells], axis=1)


def within(part: NDArray[np.int64], boxes: NDArray[np.float64]) -> NDArray[np.int64]:
    """(n, 4) pixels, none twice, of the blocks of a part that some boxes touch; all if none do."""
    if not len(boxes):
        return part[None]
    shape = (int(part[3]) // BLOCK + 1, int(part[2]) // BLOCK + 1)
    bits = blocks.covered(boxes, np.zeros(len(boxes), np.int64), shape)
    found = blocks.runs(bits, bits, part)[0]
    low, high = np.maximum(found[:, :2], part[:2]), np.minimum(found[:, 2:], part[2:])
    return np.concatenate([low, high], axis=1)


class Cells:
    """Up to `count` pictures of one size, row by row; `depth` gives each a depth buffer."""

    def __init__(
        self,
        context: moderngl.Context,
        size: tuple[int, int],
        count: int,
        dtype: str,
        depth: bool,
        numbers: bool = False,
        components: int = 4,
    ) -> None:
        self._context = context
        self._wiper: Wiper | None = None
        self._limit = context.info["GL_MAX_TEXTURE_SIZE"]
        self._arrange(size, max(count, 1))
        # Room for a little more of the same, so that the next frame need not make it anew.
        width = max(self.whole[0], min(self._limit, WIDTH))
        self._room = (width, min(self._limit, self.whole[1] + self.whole[1] // 4))
        whole = self._room
        self.color = kept(context.texture(whole, components, dtype=dtype))
        self.depth = kept(context.depth_texture(whole)) if depth else None
        self.numbers = kept(context.texture(whole, 1, dtype="f4")) if numbers else None
        for texture in (self.color, self.depth, self.numbers):
            if texture is not None:
                texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        if self.depth is not None:
            self.depth.compare_func = ""
        pictures = [t for t in (self.color, self.numbers) if t is not None]
        self.framebuffer = context.framebuffer(pictures, self.depth)
        # With depth, colours count only where something was drawn: they need no clearing.
        self._emptied = context.framebuffer([], self.depth) if depth else self.framebuffer

    def _arrange(self, size: tuple[int, int], count: int) -> None:
        # From size and count alone: a cell's place decides how its edges are rounded, and a frame
        # must be the same picture whatever was drawn before it.
        self.size = size
        self.columns = max(1, min(min(self._limit, WIDTH) // size[0], count))
        self.whole = (self.columns * size[0], -(-count // self.columns) * size[1])

    def lay_out(
        self, size: tuple[int, int], count: int, dtype: str, numbers: bool, components: int = 4
    ) -> bool:
        """Arrange cells of another size or number, if they fit."""
        if (self.color.dtype, self.color.components) != (dtype, components):
            return False
        if (self.numbers is not None) != numbers:
            return False
        self._arrange(size, max(count, 1))
        return self.whole[0] <= self._room[0] and self.whole[1] <= self._room[1]

    def clear(self) -> None:
        """Empty all cells and bind them."""
        pipeline.within(self.framebuffer, None)
        self._emptied.clear(0.0, 0.0, 0.0, 0.0, depth=1.0, viewport=(0, 0, *self.whole))
        self.framebuffer.use()

    def wipe(self, cells: NDArray[np.int64], boxes: NDArray[np.float64]) -> None:
        """Empty what of `cells` (n,) lies in these (n, 4) boxes alone, each in pixels of its cell
        (left, bottom, right, top; y up), and bind all."""
        base = np.stack([cells % self.columns, cells // self.columns], axis=1) * self.size
        limit = np.tile(self.size, 2)
        places = np.clip(boxes, 0, limit) + np.tile(base, 2)
        if self._wiper is None:
            self._wiper = Wiper(self._context)
        pipeline.within(self._emptied, None)
        self._emptied.viewport = (0, 0, *self._room)
        self._emptied.use()
        self._wiper.draw(places, self._room)
        self.framebuffer.use()

    def corner(self, k: int) -> tuple[int, int]:
        """The texel x, y (up) where cell k begins."""
        return k % self.columns * self.size[0], k // self.columns * self.size[1]

    def way(self, k: int, corner: tuple[int, int]) -> tuple[int, int]:
        """From the frame's pixels (y up) to those of cell k, which shows it from `corner` on."""
        x, y = self.corner(k)
        return x - corner[0], y - corner[1]

    def select(self, k: int, corner: tuple[int, int], frame: tuple[int, int]) -> None:
        """Draw into cell k what the frame shows from `corner` (x, y up) on."""
        x, y = self.corner(k)
        self.framebuffer.viewport = (x - corner[0], y - corner[1], *frame)
        self.framebuffer.scissor = (x, y, *self.size)

    def release(self) -> None:
        """Give the GPU's memory back."""
        if self._emptied is not self.framebuffer:
            self._emptied.release()
        self.framebuffer.release()
        for texture in (self.color, self.depth, self.numbers):
            if texture is not None:
                texture.release()


def emptied(
    context: moderngl.Context,
    old: Cells | None,
    size: tuple[int, int],
    count: int,
    kind: tuple[str, bool, bool, int],
    wiped: NDArray[np.float64] | None,
) -> Cells:
    """Bound cells, empty where `wiped` (see `touched`) says, None for everywhere: the old ones if
    they serve. Their `kind`: dtype, depth, numbers, components."""
    dtype, depth, numbers, components = kind
    if old is None or not old.lay_out(size, count, dtype, numbers, components):
        if old is not None:
            old.release()
        old = Cells(context, size, count, dtype, depth, numbers, components)
    spoil(old.color, old.depth, old.numbers)  # a frame may fill them more than once
    if wiped is None:
        old.clear()
    else:
        old.wipe(wiped[:, 4].astype(np.int64), wiped[:, :4])
    return old
