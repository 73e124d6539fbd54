"""Draws surfaces that show through one another in one pass: each pixel gathers a list of what the
rule keeps there, then its list is put in order and added up from the front.

Layer by layer (peel_painter.py) all is drawn again for each layer. This needs OpenGL 4.3, where
fragments may write into buffers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device import pipeline
from seethrough.renderer.gpu.device.programs import Shader, program
from seethrough.renderer.gpu.device.reused import kept
from seethrough.renderer.gpu.device.scene_table import Run
from seethrough.renderer.gpu.device.targets import FrameTarget
from seethrough.renderer.gpu.rules.rule_program import Ruled, RulePrograms, draw, numbers
from seethrough.renderer.gpu.rules.scope import Scope, halves, scope_of
from seethrough.renderer.scene.visibility import Drawn

NEEDED = 430  # of OpenGL
WORDS = 5  # of a surface in a list: the next one, depth, colour and opacity in two, the object
FIRST, GROWTH = 2**20, 1.25  # surfaces that there is room for at first, and room left when it grows
MOST = 10_000  # layers that count, where a technique has no limit
LISTS, HEADS, COUNT = 0, 1, 2  # where the buffers are bound
BELOW = 11  # texture unit, beyond those of a rule's pictures
OPAQUE = 0.9999  # what lies behind so much opacity is not seen
OVER = (moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA, moderngl.ZERO, moderngl.ONE)


@dataclass(frozen=True)
class _Run:
    """What is drawn for each part of a frame."""

    ruled: Ruled
    shader: Shader
    sequence: moderngl.Texture
    runs: list[list[Run]]


class ListPainter:
    """Keeps programs and buffers. `found` are the layers of the last frame drawn with ids."""

    def __init__(self, context: moderngl.Context, defines: Sequence[str]) -> None:
        self._context, self._ids = context, "WITH_IDS" in defines
        shown = [d for d in defines if d != "WITH_IDS"]
        self._programs = RulePrograms(context, ["LISTED", *shown], NEEDED)
        self._sum = program(context, "present.vert", "lists.frag", version=NEEDED)
        self._screen = context.vertex_array(self._sum.program, [])
        self._lists = kept(context.buffer(reserve=FIRST * WORDS * 4))
        self._count = context.buffer(reserve=4)
        self._limit = int(context.info["GL_MAX_SHADER_STORAGE_BLOCK_SIZE"]) // (4 * WORDS)
        self._heads: moderngl.Buffer | None = None
        self._opaque: moderngl.Framebuffer | None = None
        self._owned: list[moderngl.Texture | moderngl.Framebuffer] = []
        self.found: list[Drawn] = []

    def draw(self, ruled: Ruled, target: FrameTarget) -> int:
        """Draw the plan's ruled objects over those already in the target. Returns the draws."""
        rules, technique = ruled.technique.technique, ruled.technique
        opaque, heads = self._buffers(target.size)
        self._context.copy_framebuffer(opaque, target.framebuffer)
        shader = self._programs.ready(ruled)
        shader.set(width=target.size[0])
        numbered = [numbers(technique, ruled.shot)]
        run = _Run(
            ruled, shader, *ruled.table.sequence([ruled.frame.ruled], ruled.shot.camera, numbered)
        )
        limit, most = self._limit, rules.layers(technique)
        parts, draws, found = [scope_of(ruled.frame, target.size)], 0, list[list[Drawn]]()
        while parts:
            part = parts.pop()
            count = self._gather(run, part, opaque, heads)
            draws += len(run.runs[0])
            if count > self._room:
                heads.clear()
            if self._room < count <= limit:
                self._lists.orphan(min(int(count * GROWTH), limit) * WORDS * 4)
                parts.append(part)
            elif count > limit:
                parts += halves(part)  # what one buffer cannot hold is drawn in two parts
            else:
                if self._ids:
                    found.append(_layers(*self._read(count, heads), target.size, most))
                self._add_up(part, target, MOST if most is None else most)
        self.found = [_joined(layers) for layers in zip_longest(*found)]
        return draws

    @property
    def _room(self) -> int:
        return self._lists.size // (4 * WORDS)

    def _gather(
        self, run: _Run, part: Scope, opaque: moderngl.Framebuffer, heads: moderngl.Buffer
    ) -> int:
        """Let the pixels of a part gather their lists. Returns how many surfaces there are: only
        those that there is room for are kept."""
        context, ruled = self._context, run.ruled
        self._count.clear()
        run.shader.set(room=self._room)
        for place, buffer in ((LISTS, self._lists), (HEADS, heads), (COUNT, self._count)):
            buffer.bind_to_storage_buffer(place)
        pipeline.within(opaque, part)
        opaque.depth_mask = False  # its colours are nobody's
        opaque.use()
        sides = ruled.technique.technique.sides(ruled.technique)
        context.enable_only(moderngl.DEPTH_TEST | (0 if sides else moderngl.CULL_FACE))
        context.depth_func = "<"
        camera = ruled.shot.camera
        draw(context, run.shader, ruled.table, run.sequence, run.runs[0], camera, ruled.matrix)
        context.memory_barrier()
        opaque.depth_mask = True
        pipeline.within(opaque, None)
        return int(np.frombuffer(self._count.read(), "u4")[0])

    def _buffers(self, size: tuple[int, int]) -> tuple[moderngl.Framebuffer, moderngl.Buffer]:
        """What is opaque, with its depth, and where each pixel's list begins."""
        if self._opaque is None or self._heads is None or self._opaque.size != size:
            for old in self._owned:
                old.release()
            if self._heads is not None:
                self._heads.release()
            like = [self._context.texture(size, 4, dtype="f2")]
            like += [self._context.texture(size, 1, dtype="f4")] * self._ids
            below = self._context.depth_texture(size)
            self._opaque = self._context.framebuffer(like, below)
            self._owned = [self._opaque, *like, below]
            # No list begins anywhere between frames: whoever adds a list up takes it away.
            self._heads = self._context.buffer(bytes(4 * size[0] * size[1]))
        return self._opaque, self._heads

    def _add_up(self, scope: Scope, target: FrameTarget, most: int) -> None:
        pipeline.within(target.framebuffer, scope)
        target.framebuffer.use()
        self._sum.set(width=target.size[0], most=most, enough=OPAQUE)
        self._context.enable_only(moderngl.BLEND)
        pipeline.blend(self._context, OVER)
        self._screen.render(moderngl.TRIANGLES, 3)
        pipeline.within(target.framebuffer, None)

    def _read(
        self, count: int, heads: moderngl.Buffer
    ) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
        """(count, WORDS) the surfaces, and (h·w,) where each pixel's list begins, from 1."""
        lists = np.frombuffer(self._lists.read(count * WORDS * 4), "u4").reshape(-1, WORDS)
        return lists, np.frombuffer(heads.read(), "u4")


def _layers(
    lists: NDArray[np.uint32],
    heads: NDArray[np.uint32],
    size: tuple[int, int],
    most: int | None,
) -> list[Drawn]:
    """From the front: where each layer shows something, what, and how strongly."""
    pixel = np.zeros(len(lists), np.int64)
    here = np.nonzero(heads)[0]
    at = heads[here].astype(np.int64) - 1
    while len(at):
        pixel[at] = here
        following = lists[at, 0].astype(np.int64)
        here, at = here[following > 0], following[following > 0] - 1
    depth, thing = lists[:, 1], lists[:, 4].astype(np.int64)
    opacity = np.ascontiguousarray(lists[:, 3]).view(np.float16).reshape(-1, 2)[:, 1]
    order = np.lexsort((-thing, depth, pixel))
    pixel, thing, opacity = pixel[order], thing[order], opacity[order].astype(np.float32)
    starts = np.searchsorted(pixel, pixel)
    rank = np.arange(len(pixel)) - starts
    across, up = pixel % size[0], pixel // size[0]
    pixel = (size[1] - 1 - up) * size[0] + across
    shown = np.zeros(size[0] * size[1])
    found = []
    for k in range(int(rank.max(initial=-1)) + 1):
        if most is not None and k >= most:
            break
        rows = np.nonzero((rank == k) & (shown[pixel] < OPAQUE))[0]
        where = np.argsort(pixel[rows], kind="stable")
        rows = rows[where]
        shown[pixel[rows]] += (1 - shown[pixel[rows]]) * opacity[rows]
        found.append((pixel[rows], thing[rows] + 1, opacity[rows]))
    return found


def _joined(layers: Sequence[Drawn | None]) -> Drawn:
    """One layer of the parts of a picture."""
    there = [layer for layer in layers if layer is not None]
    where, things, opacity = (np.concatenate(column) for column in zip(*there, strict=True))
    return where, things, opacity
