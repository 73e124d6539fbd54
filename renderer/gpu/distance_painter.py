"""Pictures that masks look up, made before the objects: distances, turns and the paper's rings.

Each target has a tile of its own in one texture. Closed meshes are drawn as the loops of their
outline (contours.py): turns add up to whether a pixel lies on the target, of distances the least
counts. What the near plane cuts, and open meshes, are drawn whole, with every edge as a rectangle.
"""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from renderer import contours, masks
from renderer.camera import Camera
from renderer.gpu import tiles
from renderer.gpu.mask_maker import MaskGeometry, outline_segments
from renderer.gpu.programs import program
from renderer.gpu.scene_table import Run, SceneTable
from renderer.techniques.dynamic import DynamicTransparency

FAR = 60000.0
_STRIP = 4  # vertices of a rectangle as a triangle strip
_LOOKED_UP = 3  # texture unit
_Rows = list[tuple[int, int, int]]  # a target, its first row, how many


class DistancePainter:
    """The pictures of one frame at a time."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self.cover = program(context, "object.vert", "cover.frag")
        self._winding = program(context, "winding.vert", "winding.frag")
        self._skirt = program(context, "skirt.vert", "skirt.frag")
        self._segment = program(context, "segment.vert", "segment.frag")
        self._ring = program(context, "present.vert", "ring.frag")
        self._triangle = context.vertex_array(self._ring.program, [])
        self._buffers: dict[str, moderngl.Buffer] = {}
        self._arrays: dict[str, moderngl.VertexArray] = {}
        self._scratch: dict[str, NDArray[np.float32]] = {}
        self._pictures: dict[str, tuple[moderngl.Texture, moderngl.Framebuffer]] = {}

    def texture(self, name: str) -> moderngl.Texture | None:
        """The picture "distances", "turns" or "rings" of the last frame, if there is one."""
        return self._pictures[name][0] if name in self._pictures else None

    def draw(
        self,
        table: SceneTable,
        made: MaskGeometry,
        runs: list[list[Run]],
        camera: Camera,
        technique: DynamicTransparency,
        width: float,
        size: tuple[int, int],
    ) -> int:
        """Draw what the masks look up; `runs` draw each of the `covered` targets. Returns the draw
        calls made."""
        self._made, self._width, self._size = made, width, size
        if not len(made.looped) and not len(made.covered):
            return 0
        whole = (tiles.WIDTH, made.height)
        whole = (max(whole[0], int(made.tile[:, 2].max())), whole[1])
        fans, skirts = self._outlines(table, camera)
        turns = self._cleared("turns", whole, 0.0)
        self._context.enable_only(moderngl.BLEND)
        self._context.blend_func = (moderngl.ONE, moderngl.ONE)
        self._winding.set(size=size)
        self._in_tiles(turns, "winding", fans)
        draws = len(fans) + self._cover_targets(turns, runs)
        distances = self._cleared("distances", whole, FAR)
        if technique.mask == "ring":
            return draws + self._draw_rings(runs, technique)
        self._context.enable_only(moderngl.BLEND)
        self._context.blend_equation = moderngl.MIN
        self._pictures["turns"][0].use(_LOOKED_UP)
        self._skirt.set(size=size, turns=_LOOKED_UP)
        self._in_tiles(distances, "skirt", skirts)
        segments = self._segments(table, camera)
        self._segment.set(size=size, width=width + 1.0)
        self._in_tiles(distances, "segment", segments)
        self._context.blend_equation = moderngl.FUNC_ADD
        return draws + len(skirts) + len(segments)

    def _upload(self, name: str, shader: Any, layout: str, names: tuple[str, ...], data) -> None:  # type: ignore[no-untyped-def]
        """Put float32 rows into the buffer of that name."""
        if name not in self._buffers or data.nbytes > self._buffers[name].size:
            if name in self._buffers:
                self._buffers[name].release()
            room = max(2 * data.nbytes, 1 << 14)
            self._buffers[name] = self._context.buffer(reserve=room, dynamic=True)
            content = [(self._buffers[name], layout, *names)]
            self._arrays[name] = self._context.vertex_array(shader.program, content)
        if data.nbytes:
            self._buffers[name].orphan()
            self._buffers[name].write(data)

    def _cleared(self, name: str, size: tuple[int, int], value: float) -> moderngl.Framebuffer:
        """The framebuffer of a picture at least of `size`, bound, that part filled with `value`."""
        if name in self._pictures:
            old = self._pictures[name][0].size
            if old[0] < size[0] or old[1] < size[1]:
                for thing in self._pictures.pop(name)[::-1]:
                    thing.release()
        if name not in self._pictures:
            texture = self._context.texture((size[0], size[1] + size[1] // 4), 1, dtype="f2")
            texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
            self._pictures[name] = (texture, self._context.framebuffer([texture]))
        framebuffer = self._pictures[name][1]
        framebuffer.use()
        framebuffer.scissor = None
        framebuffer.clear(value, viewport=(0, 0, *size))
        return framebuffer

    def _select(self, framebuffer: moderngl.Framebuffer, target: int) -> None:
        """Draw the window's pixels into a target's tile."""
        left, bottom, right, top = self._made.tile[target].tolist()
        x, y = self._made.shift[target].tolist()
        framebuffer.viewport = (x, y, *self._size)
        framebuffer.scissor = (left, bottom, right - left, top - bottom)

    def _in_tiles(self, framebuffer: moderngl.Framebuffer, name: str, rows: _Rows) -> None:
        """Draw rows of the buffer of that name, each into its target's tile."""
        for target, first, count in rows:
            self._select(framebuffer, target)
            if name == "skirt":
                self._skirt.set(
                    shift=self._made.shift[target].tolist(), tile=self._made.tile[target].tolist()
                )
            if name == "segment":
                array = self._arrays[name]
                array.render(moderngl.TRIANGLE_STRIP, _STRIP, instances=count)
            else:
                self._arrays[name].render(moderngl.TRIANGLES, count, first)
        framebuffer.scissor = None

    def _cover_targets(self, framebuffer: moderngl.Framebuffer, runs: list[list[Run]]) -> int:
        """Mark the pixels that lie on each target that is drawn whole."""
        self._context.enable_only(moderngl.BLEND | moderngl.CULL_FACE)
        for target, part in zip(self._made.covered.tolist(), runs, strict=True):
            self._select(framebuffer, target)
            for mesh, start, count in part:
                mesh.draw(self._context, self.cover, start, count)
        framebuffer.scissor = None
        return sum(len(part) for part in runs)

    def _outlines(self, table: SceneTable, camera: Camera) -> tuple[_Rows, _Rows]:
        """Upload the triangles of all outlines, and say which rows belong to which target."""
        scale = 0.5 * self._size[1] / np.tan(camera.fov_y / 2)
        lens = (scale, self._size[0] / 2, self._size[1] / 2)
        fans, skirts, a, b = [], [], 0, 0
        for t in self._made.looped.tolist():
            pixels, edges = _loops_of(table, t, camera, lens)
            points, starts, meets = contours.walks(edges, len(pixels))
            fan = self._room("winding", a, 3 * len(points), 2)
            rows = contours.winding(pixels, points, starts, fan[a:])
            fans.append((t, a, rows))
            a += rows
            skirt = self._room("skirt", b, 48 * len(points), contours.VERTEX)
            rows = contours.skirt(pixels, points, starts, meets, self._width + 0.5, skirt[b:])
            skirts.append((t, b, rows))
            b += rows
        data = self._room("winding", a, 0, 2)[:a]
        self._upload("winding", self._winding, "2f", ("in_place",), data)
        data = self._room("skirt", b, 0, contours.VERTEX)[:b]
        names = ("in_place", "in_offset", "in_probes")
        self._upload("skirt", self._skirt, "2f 2f 4f", names, data)
        return fans, skirts

    def _room(self, name: str, used: int, more: int, columns: int) -> NDArray[np.float32]:
        """An array of which `used` rows are kept, with room for `more`."""
        old = self._scratch.get(name)
        if old is None or used + more > len(old):
            bigger = np.empty((2 * (used + more) + 1024, columns), np.float32)
            if old is not None:
                bigger[:used] = old[:used]
            self._scratch[name] = bigger
        return self._scratch[name]

    def _segments(self, table: SceneTable, camera: Camera) -> _Rows:
        """Upload every edge of the outlines of the targets that are drawn whole."""
        found: list[NDArray[np.float64]] = [np.zeros((0, 4))]
        rows, k = [], 0
        for t in self._made.covered.tolist():
            ends = outline_segments(table, t, camera, self._size)
            found.append(ends)
            rows.append((t, k, len(ends)))
            k += len(ends)
        data = np.concatenate(found).astype("f4")
        self._upload("segment", self._segment, "4f/i", ("in_segment",), data)
        return [row for row in rows if row[2]]

    def _draw_rings(self, runs: list[list[Run]], technique: DynamicTransparency) -> int:
        """The paper's masks, on a coarse grid (004 §V-D, algorithm 2)."""
        n = technique.ring_size
        grids = (n, n * len(runs))
        covers = self._cleared("covers", grids, 0.0)
        self._context.enable_only(moderngl.BLEND | moderngl.CULL_FACE)
        for k, part in enumerate(runs):
            covers.viewport = (0, k * n, n, n)
            for mesh, start, count in part:
                mesh.draw(self._context, self.cover, start, count)
        rings = self._cleared("rings", grids, 1.0)
        rings.viewport = (0, 0, *grids)
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


def _loops_of(table: SceneTable, target: int, camera: Camera, lens: tuple[float, float, float]):  # type: ignore[no-untyped-def]
    """Pixels and directed edges of a target's outline (contours.loops)."""
    mesh = table.meshes[table.slot[target]]
    matrix = table.scene.transforms[target]
    eye = table.inverse[target] @ (camera.eye - matrix[:3, 3])
    turn = camera.rotation.T @ matrix[:3, :3]
    move = camera.rotation.T @ (matrix[:3, 3] - camera.eye)
    return contours.loops(mesh.topology, mesh.edges, eye, turn, move, lens)
