"""Draws flat, textured, clipped triangles over a picture: text, buttons, small pictures."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device import pipeline
from seethrough.renderer.gpu.device.reused import spoil

_VERTEX = """
#version 330 core
uniform vec2 u_size;
in vec2 in_position;
in vec2 in_uv;
in vec4 in_color;
out vec2 uv;
out vec4 color;
void main() {
    uv = in_uv;
    color = in_color;
    gl_Position = vec4(in_position / u_size * vec2(2, -2) + vec2(-1, 1), 0, 1);
}
"""

_FRAGMENT = """
#version 330 core
uniform sampler2D u_texture;
in vec2 uv;
in vec4 color;
out vec4 out_color;
void main() { out_color = color * texture(u_texture, uv); }
"""

STRIDE = 20  # bytes a vertex: position 2 × f4, uv 2 × f4, color 4 × u1

# Straight alpha in, the alpha of what is there added up.
OVER = (
    moderngl.SRC_ALPHA,
    moderngl.ONE_MINUS_SRC_ALPHA,
    moderngl.ONE,
    moderngl.ONE_MINUS_SRC_ALPHA,
)


@dataclass(frozen=True)
class Batch:
    """Triangles of one texture: `count` indices from `first`; clip: (left, top, right, bottom)."""

    texture: int
    first: int
    count: int
    base_vertex: int
    clip: tuple[float, float, float, float]


class Overlay:
    """Keeps the program, buffers and textures. Positions are pixels from the upper left corner."""

    def __init__(self, context: moderngl.Context) -> None:
        self.context = context
        self._program = context.program(vertex_shader=_VERTEX, fragment_shader=_FRAGMENT)
        self._textures: dict[int, moderngl.Texture] = {}
        self._vertices = context.buffer(reserve=1 << 16, dynamic=True)
        self._array: moderngl.VertexArray | None = None

    def create_texture(self, name: int, size: tuple[int, int], data: bytes | None = None) -> None:
        """A texture of RGBA bytes under a name of the caller's; replaces one of that name."""
        self.delete_texture(name)
        texture = self.context.texture(size, 4, data)
        texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        self._textures[name] = texture

    def adopt_texture(self, name: int, texture: moderngl.Texture) -> None:
        """Make a texture that somebody else owns known under a name."""
        self._textures[name] = texture

    def update_texture(self, name: int, pixels: NDArray[np.uint8], corner: tuple[int, int]) -> None:
        """Replace the rectangle of (h, w, 4) pixels whose upper left corner is `corner`."""
        height, width = pixels.shape[:2]
        self._textures[name].write(pixels.tobytes(), (*corner, width, height), alignment=1)

    def delete_texture(self, name: int) -> None:
        """Forget a texture; an unknown name is fine."""
        texture = self._textures.pop(name, None)
        if texture is not None:
            texture.release()

    def draw(
        self,
        target: moderngl.Framebuffer,
        vertices: bytes,
        indices: NDArray[np.uint32],
        batches: Iterable[Batch],
    ) -> None:
        """Draw indexed triangles into `target`; `indices` are relative to each batch's base."""
        context, (width, height) = self.context, target.size
        target.use()
        target.viewport = (0, 0, width, height)
        context.disable(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        context.enable(moderngl.BLEND)
        pipeline.blend(context, OVER)
        self._program["u_size"] = (width, height)
        points = np.frombuffer(vertices, np.uint8).reshape(-1, STRIDE)
        for batch in batches:
            left, top, right, bottom = (round(v) for v in batch.clip)
            left, top = max(left, 0), max(top, 0)
            if right <= left or bottom <= top or batch.count == 0:
                continue
            pipeline.within(target, (left, height - bottom, right - left, bottom - top))
            self._textures[batch.texture].use(0)
            chosen = indices[batch.first : batch.first + batch.count] + batch.base_vertex
            self._draw_points(points[chosen].tobytes(), batch.count)
        pipeline.within(target, None)

    def _draw_points(self, data: bytes, count: int) -> None:
        # Expanded to plain triangles: a HUD is a few thousand vertices, one buffer is simplest.
        if self._array is None or len(data) > self._vertices.size:
            self._vertices.orphan(max(len(data), self._vertices.size))
            self._array = self.context.vertex_array(
                self._program,
                [(self._vertices, "2f 2f 4f1", "in_position", "in_uv", "in_color")],
            )
        self._vertices.orphan()
        spoil(self._vertices)
        self._vertices.write(data)
        self._array.render(moderngl.TRIANGLES, vertices=count)
