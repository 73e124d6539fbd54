"""Draws surfaces that show through one another with lines along the edges of each layer: lists of
surfaces at each pixel are gathered in one pass (lists.py), then layers are taken from them, four at
once, and added up with their lines.
"""

from __future__ import annotations

from collections.abc import Sequence

import moderngl

from seethrough.renderer.gpu.device import pipeline
from seethrough.renderer.gpu.device.reused import kept
from seethrough.renderer.gpu.device.targets import FrameTarget
from seethrough.renderer.gpu.rules.list_blocks import ListBlocks
from seethrough.renderer.gpu.rules.lists import LINED_WORDS, Lists
from seethrough.renderer.gpu.rules.peel_painter import PeelPainter
from seethrough.renderer.gpu.rules.rule_program import Ruled
from seethrough.renderer.gpu.rules.scope import scope_of
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
        self._blocks = ListBlocks(context)
        self._take = self._blocks.program("list_layers.frag", LINED_WORDS)
        self._add = self._blocks.program("lined_layers.frag", LINED_WORDS)
        self._put = self._blocks.program("layer.frag", LINED_WORDS)
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
        self._blocks.find(self._lists.heads(), target.size, scope)
        self._add.set(**ruled.technique.technique.edges(ruled.technique))
        if most is not None and most <= AT_ONCE:
            self._taken(layers, most, last=True)
            self._added(layers, target.framebuffer, pipeline.OVER)
            return len(frame.runs)
        layers.total.clear()
        left = count if most is None else most  # no pixel has more than all together
        more = True
        while left > 0 and more:
            self._taken(layers, min(left, AT_ONCE), last=left <= AT_ONCE)
            with self._query:
                self._added(layers, layers.total, pipeline.UNDER)
            more = self._query.samples > 0
            left -= AT_ONCE
        layers.sum.use(SUM)
        self._put.set(layer=SUM)
        self._blocks.draw(self._put, target.framebuffer, pipeline.OVER)
        return len(frame.runs)

    def _taken(self, layers: _Layers, count: int, last: bool) -> None:
        """Take so many layers from the lists; `last`: and the lists away."""
        layers.last.bind_to_storage_buffer(LAST)
        self._take.set(width=layers.size[0], most=count, last=last)
        # Lines ask the pixels beside, of which some lie in blocks without a list.
        self._blocks.draw(self._take, layers.taken, with_beside=True)

    def _added(
        self, layers: _Layers, into: moderngl.Framebuffer, factors: pipeline.Factors
    ) -> None:
        """Add up the layers that were taken, with their lines, into a picture."""
        for k, texture in enumerate((*layers.colors, *layers.places), SUM + 1):
            texture.use(k)
        units = tuple(range(SUM + 1, SUM + 1 + 2 * AT_ONCE))
        self._add.set(colors=units[:AT_ONCE], places=units[AT_ONCE:])
        self._blocks.draw(self._add, into, factors)

    def _ready(self, size: tuple[int, int]) -> _Layers:
        if self._layers is None or self._layers.size != size:
            if self._layers is not None:
                self._layers.release()
            self._layers = _Layers(self._context, size)
        return self._layers
