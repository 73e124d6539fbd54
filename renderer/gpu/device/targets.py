"""Where a frame is drawn: colour and alpha in 16-bit float, with depth.

Eight bits of alpha drift visibly over many layers: each mask and each layer rounds.
"""

from __future__ import annotations

from typing import TypeVar

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device.reused import spoil

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
        width, height = self.size
        data = self.resolved.read(components=3, alignment=1, dtype="f1")
        return np.frombuffer(data, np.uint8).reshape(height, width, 3)[::-1].copy()

    def raw(self) -> bytes:
        """The picture's numbers as the driver holds them: RGBA half floats, bottom row first."""
        return self.resolved.read(components=4, alignment=1, dtype="f2")

    def read_ids(self, part: tuple[int, int, int, int]) -> NDArray[np.float32]:
        """(h, w) object + 1, 0 where there is only background, of a part of the picture (left, top,
        right, bottom); row 0 on top."""
        viewport = self._viewport(part)
        data = self.framebuffer.read(viewport, 1, attachment=1, alignment=1, dtype="f4")
        return np.frombuffer(data, "f4").reshape(viewport[:1:-1])[::-1]

    def read_alpha(self, part: tuple[int, int, int, int]) -> NDArray[np.float16]:
        """(h, w) a part of the frame's own alpha: how strongly the next object would show."""
        viewport = self._viewport(part)
        # As the driver holds it: to make another type of it takes ten times as long.
        data = self.framebuffer.read(viewport, 4, alignment=1, dtype="f2")
        return np.frombuffer(data, "f2").reshape(*viewport[:1:-1], 4)[::-1, :, 3]

    def _viewport(self, part: tuple[int, int, int, int]) -> tuple[int, int, int, int]:
        left, top, right, bottom = part
        return (left, self.size[1] - bottom, right - left, bottom - top)

    def release(self) -> None:
        """Give the GPU's memory back."""
        for thing in self._owned:
            thing.release()
