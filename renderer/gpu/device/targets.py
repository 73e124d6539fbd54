"""Where a frame is drawn: colour and alpha in 16-bit float, with depth.

Eight bits of alpha drift visibly over many layers: each mask and each layer rounds.
"""

from __future__ import annotations

from functools import cache
from typing import TypeVar

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device.reused import spoil
from seethrough.renderer.scene.tallies import as_bytes

Owned = TypeVar("Owned", moderngl.Texture, moderngl.Renderbuffer, moderngl.Framebuffer)


class FrameTarget:
    """A picture of a fixed size. `samples` > 0 antialiases; `ids` adds a picture of objects."""

    def __init__(
        self, context: moderngl.Context, size: tuple[int, int], samples: int = 0, ids: bool = False
    ) -> None:
        self.size = size
        self._context = context
        self._owned: list[moderngl.Texture | moderngl.Renderbuffer | moderngl.Framebuffer] = []
        self.color = self._keep(context.texture(size, 4, dtype="f2"))
        self.color.filter = (moderngl.NEAREST, moderngl.NEAREST)
        pictures: list[moderngl.Texture | moderngl.Renderbuffer] = [self.color]
        self._ids: moderngl.Framebuffer | None = None
        if ids:
            numbers = self._keep(context.texture(size, 1, dtype="f4"))
            self._ids = self._keep(context.framebuffer([numbers]))
            pictures.append(numbers)
        if samples:
            smooth = self._keep(context.renderbuffer(size, 4, samples=samples, dtype="f2"))
            depth = self._keep(context.depth_renderbuffer(size, samples=samples))
            self.resolved = self._keep(context.framebuffer(pictures))
            self.framebuffer = self._keep(context.framebuffer([smooth], depth))
        else:
            depth = self._keep(context.depth_renderbuffer(size))
            self.framebuffer = self._keep(context.framebuffer(pictures, depth))
            self.resolved = self.framebuffer

    def _keep(self, thing: Owned) -> Owned:
        self._owned.append(thing)
        return thing

    def clear(self, background: tuple[float, float, float]) -> None:
        """Bind the picture and fill it with the background, alpha 1 and the farthest depth."""
        # Not spoiled with all else as a frame begins: another frame's picture may still be shown.
        spoil(*(t for t in self._owned if not isinstance(t, moderngl.Framebuffer)))
        self.framebuffer.clear(*background, 1.0, depth=1.0)
        if self._ids is not None:
            self._ids.clear()  # the line above filled all pictures with the background
        self.framebuffer.use()

    def resolve(self) -> None:
        """Average the samples into `color`."""
        if self.resolved is not self.framebuffer:
            self._context.copy_framebuffer(self.resolved, self.framebuffer)

    def read(self) -> NDArray[np.uint8]:
        """(h, w, 3), row 0 on top."""
        # Software rasterisers take ten times as long to make bytes of the numbers that they hold.
        width, height = self.size
        halves = np.frombuffer(self.raw(), np.uint16).reshape(height, width, 4)
        return as_bytes(halves[::-1], _bytes())

    def raw(self) -> bytes:
        """The picture's numbers as the driver holds them: RGBA half floats, bottom row first."""
        return self.resolved.read(components=4, alignment=1, dtype="f2")

    def read_ids(self, part: tuple[int, int, int, int]) -> NDArray[np.float32]:
        """(h, w) object + 1, 0 where there is only background, of a part of the picture (left, top,
        right, bottom); row 0 on top."""
        viewport = self._viewport(part)
        data = self.framebuffer.read(viewport, 1, attachment=1, alignment=1, dtype="f4")
        return np.frombuffer(data, "f4").reshape(viewport[:1:-1])[::-1]

    def read_colors(self, part: tuple[int, int, int, int]) -> NDArray[np.uint16]:
        """(h, w, 4) bits of the half floats RGBA of a part of the picture. A says how strongly the
        next object would show."""
        viewport = self._viewport(part)
        # As the driver holds it: to make another type of it takes ten times as long.
        data = self.framebuffer.read(viewport, 4, alignment=1, dtype="f2")
        return np.frombuffer(data, np.uint16).reshape(*viewport[:1:-1], 4)[::-1]

    def _viewport(self, part: tuple[int, int, int, int]) -> tuple[int, int, int, int]:
        left, top, right, bottom = part
        return (left, self.size[1] - bottom, right - left, bottom - top)

    def release(self) -> None:
        """Give the GPU's memory back."""
        for thing in self._owned:
            thing.release()


@cache
def half_values() -> NDArray[np.float64]:
    """(65536,) the number that 16 bits of a half float are."""
    return np.arange(1 << 16, dtype=np.uint16).view(np.float16).astype(np.float64)


@cache
def _bytes() -> NDArray[np.uint8]:
    """(65536,) the byte that a driver makes of 16 bits of a half float: the nearest of 0 to 255,
    0 of what is no number."""
    numbers = np.clip(np.nan_to_num(half_values(), nan=0.0), 0.0, 1.0)
    return np.rint(numbers * 255.0).astype(np.uint8)
