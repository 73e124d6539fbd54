"""Many small pictures in one texture, so that drawing into another one switches nothing."""

from __future__ import annotations

import moderngl

MOST = 64  # of slices or masks: the arrays in shaders/exact.frag


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
    ) -> None:
        self.size, self.count = size, max(count, 1)
        limit = context.info["GL_MAX_TEXTURE_SIZE"]
        self.columns = min(max(1, limit // size[0]), self.count)
        rows = -(-self.count // self.columns)
        whole = (self.columns * size[0], rows * size[1])
        self.whole = whole
        self.color = context.texture(whole, 4, dtype=dtype)
        self.depth = context.depth_texture(whole) if depth else None
        self.numbers = context.texture(whole, 1, dtype="f4") if numbers else None
        for texture in (self.color, self.depth, self.numbers):
            if texture is not None:
                texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        if self.depth is not None:
            self.depth.compare_func = ""
        pictures = [t for t in (self.color, self.numbers) if t is not None]
        self.framebuffer = context.framebuffer(pictures, self.depth)

    def fits(self, size: tuple[int, int], count: int, dtype: str, numbers: bool) -> bool:
        """Whether these cells can serve a part of the picture of that size."""
        same = self.color.dtype == dtype and (self.numbers is not None) == numbers
        return same and self.size == size and self.count >= count

    def clear(self) -> None:
        """Empty all cells and bind them."""
        self.framebuffer.use()
        self.framebuffer.scissor = None
        self.framebuffer.viewport = (0, 0, *self.whole)
        self.framebuffer.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)

    def select(self, k: int, corner: tuple[int, int], frame: tuple[int, int]) -> None:
        """Draw into cell k what the frame shows from `corner` (x, y up) on."""
        x, y = k % self.columns * self.size[0], k // self.columns * self.size[1]
        self.framebuffer.viewport = (x - corner[0], y - corner[1], *frame)
        self.framebuffer.scissor = (x, y, *self.size)

    def release(self) -> None:
        """Give the GPU's memory back."""
        self.framebuffer.release()
        for texture in (self.color, self.depth, self.numbers):
            if texture is not None:
                texture.release()
