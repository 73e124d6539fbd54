"""Translucent polygons: painted in an order, exactly, or by the usual approximations.

The exact picture is a list of fragments for each pixel, sorted by depth; it needs OpenGL 4.3. All
others run on 3.3. Colours are not lit: what is compared is blending.
"""

from __future__ import annotations

from dataclasses import dataclass

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats
from seethrough.renderer.gpu.device.programs import Shader, program
from seethrough.renderer.gpu.device.reused import spoil
from seethrough.renderer.scene.camera import Camera

# Corner columns: r, g, b, opacity, u, v, textured (0 or 1).
COLUMNS = 7
ENTRY_BYTES = 32


@dataclass(frozen=True, eq=False, slots=True)
class Corners:
    """Three rows for each triangle: x, y, z and the seven columns; (3 t, 10) float32."""

    rows: NDArray[np.float32]

    @classmethod
    def of(cls, vertices: Floats, attributes: Floats, triangles: NDArray[np.integer]) -> Corners:
        """From (n, 3) vertices, (n, 7) attributes and (t, 3) corner rows."""
        flat = np.asarray(triangles).ravel()
        rows = np.column_stack([vertices[flat], attributes[flat]])
        return cls(np.ascontiguousarray(rows, np.float32))


class PolygonPainter:
    """Draws translucent triangles over opaque ones, in pictures of one size."""

    def __init__(
        self,
        context: moderngl.Context,
        size: tuple[int, int],
        background: tuple[float, float, float] = (0.93, 0.94, 0.96),
        texture: Floats | None = None,
    ) -> None:
        """`size` is (width, height); `texture` (h, w, 4) in [0, 1], row 0 at v = 0."""
        self.context, self.size, self.background = context, size, background
        self.depth = context.depth_texture(size)
        self.depth.compare_func = ""
        self.color = context.texture(size, 4, dtype="f2")
        self.frame = context.framebuffer([self.color], self.depth)
        self.textured = texture is not None
        picture = np.ones((1, 1, 4)) if texture is None else texture
        pixels = np.ascontiguousarray(np.round(picture * 255), np.uint8)
        self.surface = context.texture((pixels.shape[1], pixels.shape[0]), 4, pixels.tobytes())
        self.blended = program(context, "polygon.vert", "polygon.frag", ["PAINT"])
        self.opaque: Corners | None = None
        self._buffers: dict[int, tuple[Corners, moderngl.Buffer]] = {}

    def release(self) -> None:
        """Give back what was allocated."""
        for _, buffer in self._buffers.values():
            buffer.release()
        for thing in (self.frame, self.color, self.depth, self.surface):
            thing.release()

    def painted(
        self, corners: Corners, order: NDArray[np.int32] | None, camera: Camera, blend: bool = True
    ) -> NDArray[np.float32]:
        """(height, width, 4) picture, row 0 on top, of what `paint` draws."""
        self.paint(corners, order, camera, blend)
        return self.picture()

    def paint(
        self, corners: Corners, order: NDArray[np.int32] | None, camera: Camera, blend: bool = True
    ) -> None:
        """Draw triangles in `order` (t,), or unsorted, into the frame.

        Depth writes are off: a wrong order shows as a wrong blend. Without `blend` the triangles
        are opaque and hide one another, depth writes on (Kang2008, figure 4).
        """
        self.begin(camera)
        state = moderngl.BLEND | moderngl.DEPTH_TEST if blend else moderngl.DEPTH_TEST
        self.context.enable_only(state)
        self.context.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        self.frame.depth_mask = not blend
        self.frame.use()
        self.blended.set(unblended=not blend)
        self.draw(self.blended, corners, camera, order)
        self.blended.set(unblended=False)
        self.frame.depth_mask = True

    def begin(self, camera: Camera) -> None:
        """Clear the frame and draw the opaque triangles."""
        self.frame.depth_mask = True
        spoil(self.color, self.depth)
        self.frame.use()
        self.frame.clear(*self.background, 1.0, depth=1.0)
        if self.opaque is not None and len(self.opaque.rows):
            self.context.enable_only(moderngl.DEPTH_TEST)
            self.draw(self.blended, self.opaque, camera, None)

    def draw(
        self, shader: Shader, corners: Corners, camera: Camera, order: NDArray[np.int32] | None
    ) -> None:
        """Draw triangles with a shader into the framebuffer in use."""
        self.setup(shader, camera)
        if not len(corners.rows) or (order is not None and not len(order)):
            return
        indices = None
        if order is not None:
            flat = (order[:, None] * np.int32(3) + np.arange(3, dtype=np.int32)).ravel()
            indices = self.context.buffer(flat.tobytes())
        array = self._vertex_array(shader, corners, indices)
        array.render(moderngl.TRIANGLES)
        array.release()
        if indices is not None:
            indices.release()

    def setup(self, shader: Shader, camera: Camera) -> None:
        """Camera and texture of a shader."""
        matrix = camera.projection(self.size[0] / self.size[1]) @ camera.view()
        along = camera.forward
        self.surface.use(0)
        shader.set(
            clip_from_world=tuple(matrix.T.ravel()),
            depth_from_world=(*along, -float(along @ camera.eye)),
            surface=0,
            use_texture=self.textured,
        )

    def picture(self) -> NDArray[np.float32]:
        """(height, width, 4) what the frame holds, row 0 on top."""
        raw = np.frombuffer(self.color.read(), np.float16)
        return raw.reshape(self.size[1], self.size[0], 4)[::-1].astype(np.float32)

    def over(self, shader: Shader) -> None:
        """Blend a full-screen pass, whose colours are premultiplied, over the frame."""
        self.frame.use()
        self.context.enable_only(moderngl.BLEND)
        self.context.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        array = self.context.vertex_array(shader.program, [])
        array.render(moderngl.TRIANGLES, vertices=3)
        array.release()

    def _vertex_array(
        self, shader: Shader, corners: Corners, indices: moderngl.Buffer | None
    ) -> moderngl.VertexArray:
        key = id(corners)
        if key not in self._buffers:
            self._buffers[key] = (corners, self.context.buffer(corners.rows.tobytes()))
        vertices = self._buffers[key][1]
        names = [n for n in ("position", "color", "texturing") if n in shader.members]
        layout = {"position": "3f", "color": "4f", "texturing": "3f"}
        sizes = {"position": 12, "color": 16, "texturing": 12}
        form = " ".join(layout[n] if n in names else f"{sizes[n]}x" for n in layout)
        return self.context.vertex_array(
            shader.program, [(vertices, form, *names)], index_buffer=indices
        )


class ExactPainter:
    """The exact picture: every fragment of a pixel in a list, sorted."""

    def __init__(self, painter: PolygonPainter) -> None:
        if painter.context.version_code < 430:
            raise RuntimeError("the exact picture needs OpenGL 4.3")
        self.painter = painter
        context, (width, height) = painter.context, painter.size
        self.gather = program(context, "polygon.vert", "polygon.frag", ["LIST"], 430)
        self.sort = program(context, "polygon_screen.vert", "polygon_resolve.frag", ["SORTED"], 430)
        self.heads = context.buffer(reserve=4 * (1 + width * height))
        self.room = 4 * width * height
        self.entries = context.buffer(reserve=ENTRY_BYTES * self.room)

    def painted(self, corners: Corners, camera: Camera) -> NDArray[np.float32]:
        """(height, width, 4) picture, row 0 on top, of what `paint` draws."""
        self.paint(corners, camera)
        return self.painter.picture()

    def paint(self, corners: Corners, camera: Camera) -> None:
        """Draw the exact picture into the frame. The list grows until all fragments fit."""
        while (needed := self._gather(corners, camera)) > self.room:
            self.entries.release()
            self.room = needed
            self.entries = self.painter.context.buffer(reserve=ENTRY_BYTES * needed)
        self.sort.set(width=self.painter.size[0])
        self.painter.over(self.sort)

    def _gather(self, corners: Corners, camera: Camera) -> int:
        painter = self.painter
        painter.begin(camera)
        spoil(self.heads, self.entries)
        self.heads.clear()
        self.heads.bind_to_storage_buffer(0)
        self.entries.bind_to_storage_buffer(1)
        # llvmpipe drops shader writes unless blending or a depth attachment keeps the draw alive.
        painter.context.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
        painter.context.blend_func = moderngl.ZERO, moderngl.ONE
        painter.frame.depth_mask = False
        painter.frame.use()
        self.gather.set(width=painter.size[0], room=self.room)
        painter.draw(self.gather, corners, camera, None)
        painter.context.memory_barrier()
        painter.frame.depth_mask = True
        return int(np.frombuffer(self.heads.read(4), np.uint32)[0])
