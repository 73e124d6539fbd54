"""Pictures that masks look up, made before the objects: distances and the paper's rings.

Each target has a tile of its own in one texture. The outlines of closed meshes are found on the
CPU (outlines.py). What the near plane cuts, and open meshes, are drawn whole,
with every edge as a rectangle; the least distance counts.
"""

from __future__ import annotations

from concurrent.futures import Future

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats, Floats32, Ints
from seethrough.renderer.gpu.device import pipeline, tiles
from seethrough.renderer.gpu.device.outlines import Wanted
from seethrough.renderer.gpu.device.programs import Shader, program
from seethrough.renderer.gpu.device.reused import kept
from seethrough.renderer.gpu.device.scene_table import Run, SceneTable
from seethrough.renderer.gpu.masks.mask_maker import MaskGeometry, outline_segments
from seethrough.renderer.masks import contours, masks
from seethrough.renderer.plan import blocks
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

_STRIP = 4  # vertices of a rectangle as a triangle strip
_LOOKED_UP = 3  # texture unit
# Of distances: the driver would have to wait for what is drawn from one before it is written again.
# Not where outlines are still being found: there drawing waits for them anyway.
_TURNS = 3


class DistancePainter:
    """The pictures of one frame at a time."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self.cover = program(context, "object.vert", "cover.frag")
        self._segment = program(context, "segment.vert", "segment.frag")
        self._ring = program(context, "present.vert", "ring.frag")
        self._triangle = context.vertex_array(self._ring.program, [])
        self._buffers: dict[str, moderngl.Buffer] = {}
        self._arrays: dict[str, moderngl.VertexArray] = {}
        self._pictures: dict[str, tuple[moderngl.Texture, moderngl.Framebuffer]] = {}
        self._turn = 0

    def texture(self, name: str) -> moderngl.Texture | None:
        """The picture "distances" or "rings" of the last frame, if there is one."""
        place = self._place(name)
        return self._pictures[place][0] if place in self._pictures else None

    @property
    def pending(self) -> bool:
        """Whether outlines are found beside the drawing; those of little things are there."""
        return bool(self._jobs)

    def _place(self, name: str) -> str:
        """Where the picture of that name is, in this frame."""
        return f"{name} {self._turn}" if name == "distances" else name

    def begin(
        self,
        table: SceneTable,
        made: MaskGeometry,
        camera: Camera,
        technique: DynamicTransparency,
        width: float,
        size: tuple[int, int],
        numbers: NDArray[np.int64],
    ) -> None:
        """Begin to find the outlines of closed meshes, beside whatever is drawn meanwhile.

        `numbers` (n objects,) are the bits that `marks` will have in the blocks that they touch.
        """
        self._made, self._width, self._size = made, width, size
        self._jobs: list[Future[None]] = []
        shape = blocks.shape(size)
        self._bits = np.zeros((0, *shape), np.uint64)
        whole = (max(tiles.WIDTH, int(made.tile[:, 2].max(initial=0))), made.height)
        self._whole, used = whole, int(made.tile[:, 2].max(initial=1))
        if not len(made.looped) and not len(made.covered):
            return
        self._found = np.full((whole[1], used), contours.FAR, np.float32)
        if not len(made.looped):
            return
        tile, shift = made.tile[made.looped], made.shift[made.looped]
        windows = np.concatenate([tile[:, :2] - shift, tile[:, 2:] - tile[:, :2]], axis=1)
        windows[:, 1] = size[1] - windows[:, 1] - windows[:, 3]
        targets = made.looped.tolist()
        eyes, turns, moves = _poses(table, made.looped, camera)
        wanted = Wanted(
            eyes=eyes,
            turns=turns,
            moves=moves,
            windows=windows,
            corners=tile[:, :2].copy(),
            numbers=numbers[made.looped],
            lens=np.array([camera.lens(size[1]), size[0] / 2, size[1] / 2]),
            width=width,
            straight=0.0 if technique.per_pixel_only else contours.STRAIGHT,
        )
        meshes = [table.meshes[table.slot[t]] for t in targets]
        self._jobs, self._bits = table.outlines.start(meshes, wanted, self._found, shape)

    def marks(self) -> NDArray[np.uint64]:
        """(h, w) bits of the blocks that outlines touch."""
        for job in self._jobs:
            job.result()
        return np.bitwise_or.reduce(self._bits, axis=0)

    def draw(
        self,
        table: SceneTable,
        runs: list[list[Run]],
        camera: Camera,
        technique: DynamicTransparency,
    ) -> int:
        """Draw what the masks look up; `runs` draw each of the `covered` targets. Returns the draw
        calls made."""
        made, width, size = self._made, self._width, self._size
        if not len(made.looped) and not len(made.covered):
            return 0
        framebuffer = self._outlines()
        draws = self._cover_targets(framebuffer, runs)
        if technique.mask == "ring":
            return draws + self._draw_rings(runs, technique)
        self._segment.set(size=size, width=width + 1.0)
        self._context.enable_only(moderngl.BLEND)
        pipeline.combine(self._context, moderngl.MIN)
        for target in made.covered.tolist():
            ends = outline_segments(table, target, camera, size).astype("f4")
            if len(ends):
                self._select(framebuffer, target)
                self._upload("segment", self._segment, "4f/i", ("in_segment",), ends)
                self._arrays["segment"].render(moderngl.TRIANGLE_STRIP, _STRIP, instances=len(ends))
        pipeline.within(framebuffer, None)
        pipeline.combine(self._context, moderngl.FUNC_ADD)
        return draws + len(made.covered)

    def _upload(
        self, name: str, shader: Shader, layout: str, names: tuple[str, ...], data: Floats32
    ) -> None:
        """Put float32 rows into the buffer of that name."""
        if name not in self._buffers or data.nbytes > self._buffers[name].size:
            if name in self._buffers:
                self._buffers[name].release()
            room = max(2 * data.nbytes, 1 << 14)
            self._buffers[name] = kept(self._context.buffer(reserve=room, dynamic=True))
            content = [(self._buffers[name], layout, *names)]
            self._arrays[name] = self._context.vertex_array(shader.program, content)
        if data.nbytes:
            self._buffers[name].orphan()
            self._buffers[name].write(data)

    def _bound(self, name: str, size: tuple[int, int], dtype: str) -> moderngl.Framebuffer:
        """The framebuffer of a picture at least of `size`, bound."""
        name = self._place(name)
        if name in self._pictures:
            old = self._pictures[name][0].size
            if old[0] < size[0] or old[1] < size[1]:
                for thing in self._pictures.pop(name)[::-1]:
                    thing.release()
        if name not in self._pictures:
            texture = kept(self._context.texture((size[0], size[1] + size[1] // 4), 1, dtype=dtype))
            texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
            self._pictures[name] = (texture, self._context.framebuffer([texture]))
        framebuffer = self._pictures[name][1]
        framebuffer.use()
        pipeline.within(framebuffer, None)
        return framebuffer

    def _select(self, framebuffer: moderngl.Framebuffer, target: int) -> None:
        """Draw the window's pixels into a target's tile."""
        left, bottom, right, top = self._made.tile[target].tolist()
        x, y = self._made.shift[target].tolist()
        framebuffer.viewport = (x, y, *self._size)
        pipeline.within(framebuffer, (left, bottom, right - left, top - bottom))

    def _cover_targets(self, framebuffer: moderngl.Framebuffer, runs: list[list[Run]]) -> int:
        """Mark the pixels that lie on each target that is drawn whole."""
        self._context.enable_only(moderngl.CULL_FACE)
        for target, part in zip(self._made.covered.tolist(), runs, strict=True):
            self._select(framebuffer, target)
            for mesh, start, count in part:
                mesh.draw(self._context, self.cover, start, count)
        pipeline.within(framebuffer, None)
        return sum(len(part) for part in runs)

    def _outlines(self) -> moderngl.Framebuffer:
        """Upload the distances from the outlines of closed meshes."""
        for job in self._jobs:
            job.result()
        if not self.pending:
            self._turn = (self._turn + 1) % _TURNS
        framebuffer = self._bound("distances", self._whole, "f4")
        rows, used = self._found.shape
        self._pictures[self._place("distances")][0].write(self._found, viewport=(0, 0, used, rows))
        return framebuffer

    def _draw_rings(self, runs: list[list[Run]], technique: DynamicTransparency) -> int:
        """The paper's masks, on a coarse grid (Elmqvist2009 §V-D, algorithm 2)."""
        n = technique.ring_size
        columns = max(1, tiles.WIDTH // n)
        grids = (columns * n, n * -(-len(runs) // columns))
        covers = self._bound("covers", grids, "f2")
        columns = self._pictures["covers"][0].width // n  # as the shaders find it
        covers.clear(viewport=(0, 0, columns * n, grids[1]))
        self._context.blend_func = (moderngl.ONE, moderngl.ZERO)
        self._context.enable_only(moderngl.BLEND | moderngl.CULL_FACE)
        for k, part in enumerate(runs):
            covers.viewport = (k % columns * n, k // columns * n, n, n)
            for mesh, start, count in part:
                mesh.draw(self._context, self.cover, start, count)
        rings = self._bound("rings", grids, "f4")
        rings.viewport = (0, 0, columns * n, grids[1])
        self._context.enable_only(moderngl.NOTHING)
        self._pictures["covers"][0].use(_LOOKED_UP)
        scale = technique.width / self._width if self._width else 1.0
        window = (round(self._size[0] * scale), round(self._size[1] * scale))
        self._ring.set(
            covers=_LOOKED_UP,
            count=len(masks.ring_opacities(technique, window)),
            ring_size=n,
            alpha_target=technique.alpha_target,
            alpha_edge=technique.alpha_edge,
        )
        self._triangle.render(moderngl.TRIANGLES, 3)
        return sum(len(part) for part in runs) + 1


def _poses(table: SceneTable, targets: Ints, camera: Camera) -> tuple[Floats, Floats, Floats]:
    """The eye in mesh space (k, 3), and turns (k, 3, 3) and moves (k, 3): camera ← mesh."""
    away = camera.eye - table.scene.transforms[targets, :3, 3]
    eyes = np.einsum("kij,kj->ki", table.inverse[targets], away)
    return eyes, *table.turned(targets, camera)
