"""Draws surfaces that show through one another with lines along the edges of each layer: lists of
surfaces at each pixel are gathered in one pass (lists.py), then layers are taken from them, four at
once, and added up with their lines.
"""

from __future__ import annotations

from collections.abc import Sequence

import moderngl

from seethrough.renderer.gpu.device import pipeline
from seethrough.renderer.gpu.device.programs import Shader, program
from seethrough.renderer.gpu.device.reused import kept
from seethrough.renderer.gpu.device.targets import FrameTarget
from seethrough.renderer.gpu.rules.lists import BEFORE, LINED_WORDS, NEEDED, Lists
from seethrough.renderer.gpu.rules.peel_painter import PeelPainter
from seethrough.renderer.gpu.rules.rule_program import Ruled
from seethrough.renderer.gpu.rules.scope import around, scope_of
from seethrough.renderer.scene.visibility import Drawn

AT_ONCE = 4  # layers; the shaders have as many pictures of each kind
LAST = 3  # where the buffer is bound that says each pixel's last layer
SUM = 10  # the first texture unit that no rule's picture has


class _Layers:
    """Pictures of four layers, what all add up to, and each pixel's last layer."""

    def __init__(self, context: moderngl.Context, size: tuple[int, int]) -> None:
        self.size = size
        self.colors = [context.texture(size, 4, dtype="f2") for _ in range(AT_ONCE)]
        self.places = [context.texture(size, 2, dtype="u4") for _ in range(AT_ONCE)]
        self.sum = context.texture(size, 4, dtype="f4")
        for texture in (*self.colors, *self.places, self.sum):
            kept(texture).filter = (moderngl.NEAREST, moderngl.NEAREST)
        self.taken = context.framebuffer([*self.colors, *self.places])
        self.total = context.framebuffer([self.sum])
        self.last = context.buffer(bytes(4 * size[0] * size[1]))  # none is taken yet

    def release(self) -> None:
        """Give the GPU's memory back."""
        self.taken.release()
        self.total.release()
        self.last.release()
        for texture in (*self.colors, *self.places, self.sum):
            texture.release()


class LinedPainter:
    """Keeps programs and buffers. What one buffer cannot hold the lists of is drawn layer by layer
    (PeelPainter), and so is what is looked at: painters.py never makes this one with ids."""

    def __init__(self, context: moderngl.Context, defines: Sequence[str]) -> None:
        self._context = context
        self.found: list[Drawn] = []  # nobody looks
        self._one_by_one = PeelPainter(context, defines)
        self._lists = Lists(context, defines, lined=True)
        assert "WITH_IDS" not in defines
        own = [f"WORDS {LINED_WORDS}u"]
        self._take = program(context, "present.vert", "list_layers.frag", own, NEEDED, BEFORE)
        self._add = program(context, "present.vert", "lined_layers.frag", (), NEEDED)
        self._put = program(context, "present.vert", "layer.frag")
        self._screens = {
            shader: context.vertex_array(shader.program, [])
            for shader in (self._take, self._add, self._put)
        }
        self._layers: _Layers | None = None
        self._query = context.query(samples=True)

    def draw(self, ruled: Ruled, target: FrameTarget) -> int:
        """Draw the plan's ruled objects over those already in the target. Returns the draws."""
        scope = scope_of(ruled.frame, target.size)
        frame = self._lists.begin(ruled, target)
        count = self._lists.gather(frame, scope)
        if count > self._lists.limit:
            return self._one_by_one.draw(ruled, target)
        layers = self._ready(target.size)
        most = ruled.technique.technique.layers(ruled.technique)
        pipeline.within(target.framebuffer, scope)
        # Lines ask the pixels beside, of which some lie beyond, and of pixels with several samples
        # llvmpipe puts some of those: there must be nothing there.
        for framebuffer in (layers.taken, layers.total):
            pipeline.within(framebuffer, around(scope, target.size))
        layers.total.clear()
        self._add.set(**ruled.technique.technique.edges(ruled.technique))
        left = count if most is None else most  # no pixel has more than all together
        while left > 0 and self._taken(layers, min(left, AT_ONCE)):
            self._added(layers)
            left -= AT_ONCE
        self._taken(layers, 0)
        target.framebuffer.use()
        self._show(self._put, pipeline.OVER, layer=SUM)
        pipeline.within(target.framebuffer, None)
        return len(frame.runs)

    def _taken(self, layers: _Layers, count: int) -> bool:
        """Take so many layers from the lists, whether there is any; 0: take the lists away."""
        layers.taken.clear()
        layers.taken.use()
        layers.last.bind_to_storage_buffer(LAST)
        with self._query:
            self._show(self._take, None, width=layers.size[0], most=count)
        return self._query.samples > 0

    def _added(self, layers: _Layers) -> None:
        """Add up the layers, with their lines, under those before."""
        layers.total.use()
        for k, texture in enumerate((*layers.colors, *layers.places), SUM + 1):
            texture.use(k)
        units = tuple(range(SUM + 1, SUM + 1 + 2 * AT_ONCE))
        self._add.set(colors=units[:AT_ONCE], places=units[AT_ONCE:])
        self._show(self._add, pipeline.UNDER)
        layers.sum.use(SUM)

    def _show(self, shader: Shader, factors: pipeline.Factors | None, **values: object) -> None:
        shader.set(**values)
        self._context.enable_only(moderngl.BLEND if factors else moderngl.NOTHING)
        if factors:
            pipeline.blend(self._context, factors)
        self._screens[shader].render(moderngl.TRIANGLES, 3)

    def _ready(self, size: tuple[int, int]) -> _Layers:
        if self._layers is None or self._layers.size != size:
            if self._layers is not None:
                self._layers.release()
            self._layers = _Layers(self._context, size)
        return self._layers
