"""Draws surfaces that show through one another: layer by layer, from the front.

Each pass keeps the nearest surface behind the layer before, with the colour and opacity that the
rule gives it, and puts it under what is there already, until no pass finds one (depth peeling).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device import pipeline
from seethrough.renderer.gpu.device.programs import program
from seethrough.renderer.gpu.device.reused import kept
from seethrough.renderer.gpu.device.targets import FrameTarget
from seethrough.renderer.gpu.rules.rule_program import Ruled, RulePrograms, draw, numbers
from seethrough.renderer.gpu.rules.scope import around, scope_of
from seethrough.renderer.scene.visibility import Drawn

# Texture units, beyond those of a rule's pictures.
ABOVE, BELOW, COVERED, LAYER = 10, 11, 12, 13


class _Buffers:
    """Two layers in turn, what they add up to, and the depth of what is opaque."""

    def __init__(
        self, context: moderngl.Context, size: tuple[int, int], ids: bool, lined: bool
    ) -> None:
        self.key = (size, lined)
        self.owned: list[moderngl.Texture | moderngl.Renderbuffer | moderngl.Framebuffer] = []

        def texture(components: int, dtype: str) -> moderngl.Texture:
            made = kept(context.texture(size, components, dtype=dtype))
            made.filter = (moderngl.NEAREST, moderngl.NEAREST)
            self.owned.append(made)
            return made

        def framebuffer(
            *colors: moderngl.Texture, depth: moderngl.Renderbuffer | moderngl.Texture | None
        ) -> moderngl.Framebuffer:
            made = context.framebuffer(list(colors), depth)
            self.owned.append(made)
            return made

        self.colors = [texture(4, "f2") for _ in range(2)]
        self.places = [texture(4 if lined else 2, "f4") for _ in range(2)]
        depths = [kept(context.depth_renderbuffer(size)) for _ in range(2)]
        self.layers = [
            framebuffer(color, place, depth=depth)
            for color, place, depth in zip(self.colors, self.places, depths, strict=True)
        ]
        self.sum = texture(4, "f4")
        self.total = framebuffer(self.sum, depth=None)
        self.ruled = texture(4, "f2")
        self.lines = framebuffer(self.ruled, depth=None)
        self.below = kept(context.depth_texture(size))
        self.below.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self.below.compare_func = ""
        like = [texture(4, "f2"), *([texture(1, "f4")] * ids)]
        self.opaque = framebuffer(*like, depth=self.below)
        self.owned += [*depths, self.below]

    def release(self) -> None:
        for thing in self.owned:
            thing.release()


class PeelPainter:
    """Keeps programs and buffers. `found` are the layers of the last frame drawn with ids.
    `ghosts`: of what is removed the nearest layer alone, for its lines."""

    def __init__(
        self, context: moderngl.Context, defines: Sequence[str], ghosts: bool = False
    ) -> None:
        self._context, self._ids, self._ghosts = context, "WITH_IDS" in defines, ghosts
        shown = [d for d in defines if d != "WITH_IDS"]
        self._programs = RulePrograms(context, ["PEELED", *(["GHOSTS"] if ghosts else []), *shown])
        self._put = program(context, "present.vert", "layer.frag")
        self._screen = context.vertex_array(self._put.program, [])
        self._edges = program(context, "present.vert", "edges.frag")
        self._outlined = context.vertex_array(self._edges.program, [])
        self._buffers: _Buffers | None = None
        self._query = context.query(samples=True)
        self.found: list[Drawn] = []

    def draw(self, ruled: Ruled, target: FrameTarget) -> int:
        """Draw the plan's ruled objects over those already in the target. Returns the draws."""
        table, frame, technique = ruled.table, ruled.frame, ruled.technique
        shot, matrix = ruled.shot, ruled.matrix
        context, size = self._context, target.size
        lines = technique.technique.edges(technique)
        if self._buffers is None or self._buffers.key != (size, bool(lines)):
            if self._buffers is not None:
                self._buffers.release()
            self._buffers = _Buffers(context, size, self._ids, bool(lines))
        buffers = self._buffers
        context.copy_framebuffer(buffers.opaque, target.framebuffer)
        for layer in buffers.layers if self._ids else ():
            pipeline.within(layer, None)
            layer.clear()  # all of it is read, though only the scope is drawn
        scope = scope_of(frame, size)
        pipeline.within(target.framebuffer, scope)
        # Lines ask the pixels beside, of which some lie beyond, and of pixels with several samples
        # llvmpipe puts some of those: there must be nothing there.
        for framebuffer in (*buffers.layers, buffers.total, buffers.lines):
            pipeline.within(framebuffer, around(scope, size))
        shader = self._programs.ready(ruled)
        sequence, runs = table.sequence([frame.ruled], shot.camera, [numbers(technique, shot)])
        buffers.total.clear()
        shader.set(above=ABOVE, below=BELOW, covered=COVERED, lined=bool(lines))
        self.found, draws = [], 0
        most = 1 if self._ghosts else technique.technique.layers(technique)
        sides = technique.technique.sides(technique) and not self._ghosts
        for k in range(most if most is not None else 10_000):
            layer = buffers.layers[k % 2]
            layer.clear(depth=1.0)
            layer.use()
            self._bind(buffers, k)
            shader.set(nearest=k == 0)
            context.enable_only(moderngl.DEPTH_TEST | (0 if sides else moderngl.CULL_FACE))
            context.depth_func = "<"
            with self._query:
                draw(context, shader, table, sequence, runs[0], shot.camera, matrix)
            draws += len(runs[0])
            if self._query.samples == 0:
                break
            color = buffers.colors[k % 2]
            if lines:
                self._line(buffers, k, lines)
                color = buffers.ruled
            if self._ids:
                self.found.append(_drawn(layer, buffers.lines if lines else layer, size))
            self._compose(color, buffers.total, pipeline.UNDER)
        self._compose(buffers.sum, target.framebuffer, pipeline.OVER)
        pipeline.within(target.framebuffer, None)
        return draws

    def _bind(self, buffers: _Buffers, k: int) -> None:
        buffers.places[(k + 1) % 2].use(ABOVE)
        buffers.below.use(BELOW)
        buffers.sum.use(COVERED)

    def _line(self, buffers: _Buffers, k: int, lines: Mapping[str, object]) -> None:
        """Draw lines along a layer's edges."""
        buffers.lines.use()
        buffers.colors[k % 2].use(LAYER)
        buffers.places[k % 2].use(ABOVE)
        self._edges.set(layer=LAYER, place=ABOVE, **lines)
        self._context.enable_only(moderngl.NOTHING)
        self._outlined.render(moderngl.TRIANGLES, 3)

    def _compose(
        self, layer: moderngl.Texture, into: moderngl.Framebuffer, how: pipeline.Factors
    ) -> None:
        into.use()
        layer.use(LAYER)
        self._put.set(layer=LAYER)
        self._context.enable_only(moderngl.BLEND)
        pipeline.blend(self._context, how)
        self._screen.render(moderngl.TRIANGLES, 3)


def _drawn(
    layer: moderngl.Framebuffer, colors: moderngl.Framebuffer, size: tuple[int, int]
) -> Drawn:
    """Where a layer shows something, what, and how strongly."""
    width, height = size

    def read(source: moderngl.Framebuffer, attachment: int, components: int) -> NDArray[np.float32]:
        data = source.read(components=components, attachment=attachment, dtype="f4", alignment=1)
        return np.frombuffer(data, "f4").reshape(height, width, components)[::-1]

    numbers_, opacity = read(layer, 1, 2)[..., 1].ravel(), read(colors, 0, 4)[..., 3].ravel()
    where = np.nonzero(numbers_ > 0)[0]
    return where, numbers_[where].astype(np.int64), opacity[where]
