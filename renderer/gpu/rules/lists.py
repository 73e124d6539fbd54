"""Lists of surfaces, one for each pixel, that one pass over the objects of a rule fills.

A surface is WORDS whole numbers: the next one of its list (from 1; 0: it is the last), its depth,
colour times opacity and opacity in two, and its object; in lists that are lined one more, its
normal. This needs OpenGL 4.3, where fragments may write into buffers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device import pipeline
from seethrough.renderer.gpu.device.programs import Shader
from seethrough.renderer.gpu.device.reused import kept
from seethrough.renderer.gpu.device.scene_table import Run
from seethrough.renderer.gpu.device.targets import FrameTarget
from seethrough.renderer.gpu.rules.rule_program import Ruled, RulePrograms, draw, numbers
from seethrough.renderer.gpu.rules.scope import Scope

NEEDED = 430  # of OpenGL
WORDS, LINED_WORDS = 5, 6
FIRST, GROWTH = 2**20, 1.25  # surfaces that there is room for at first, and room left when it grows
LISTS, HEADS, COUNT = 0, 1, 2  # where the buffers are bound

# Whether one surface (its depth, object, place in the lists) lies before another: nearer, or at one
# depth of a later object, or there of one object kept before.
BEFORE = {
    "before": """bool before(uvec3 a, uvec3 b) {
    if (a.x != b.x) return a.x < b.x;
    return a.y != b.y ? a.y > b.y : a.z < b.z;
}"""
}


@dataclass(frozen=True)
class Gathering:
    """What is drawn of a frame, for each part of its picture."""

    ruled: Ruled
    shader: Shader
    sequence: moderngl.Texture
    runs: list[Run]


class Lists:
    """The buffers and programs. `limit`: how many surfaces a buffer of the driver holds."""

    def __init__(
        self, context: moderngl.Context, defines: Sequence[str], lined: bool = False
    ) -> None:
        self._context, self._ids = context, "WITH_IDS" in defines
        self.words = LINED_WORDS if lined else WORDS
        shown = [d for d in defines if d != "WITH_IDS"]
        own = ["LISTED", f"WORDS {self.words}u", *(["LINED"] if lined else []), *shown]
        self._programs = RulePrograms(context, own, NEEDED)
        self.surfaces = kept(context.buffer(reserve=FIRST * self.words * 4))
        self._count = kept(context.buffer(reserve=4))
        self.limit = int(context.info["GL_MAX_SHADER_STORAGE_BLOCK_SIZE"]) // (4 * self.words)
        self._heads: moderngl.Buffer | None = None
        self._opaque: moderngl.Framebuffer | None = None
        self._owned: list[moderngl.Texture | moderngl.Framebuffer] = []

    def begin(self, ruled: Ruled, target: FrameTarget, solid: bool = False) -> Gathering:
        """A frame begins, over what is opaque in the target; `solid`: what the rule keeps opaque is
        there as well."""
        size = target.size
        if self._opaque is None or self._opaque.size != size:
            self._make(size)
        assert self._opaque is not None
        self._context.copy_framebuffer(self._opaque, target.framebuffer)
        shader = self._programs.ready(ruled)
        shader.set(width=size[0], solid=solid)
        numbered = [numbers(ruled.technique, ruled.shot)]
        camera = ruled.shot.camera
        sequence, runs = ruled.table.sequence([ruled.frame.ruled], camera, numbered)
        return Gathering(ruled, shader, sequence, runs[0])

    def gather(self, frame: Gathering, part: Scope) -> int:
        """Let the pixels of a part of the picture gather their lists. Returns how many surfaces
        there are; where those are more than `limit`, none is kept."""
        assert self._heads is not None
        while (count := self._drawn(frame, part)) > self._room:
            self._heads.clear()
            if count > self.limit:
                break
            self.surfaces.orphan(min(int(count * GROWTH), self.limit) * self.words * 4)
        return count

    @property
    def _room(self) -> int:
        return self.surfaces.size // (4 * self.words)

    def _drawn(self, frame: Gathering, part: Scope) -> int:
        context, opaque, ruled = self._context, self._opaque, frame.ruled
        assert opaque is not None and self._heads is not None
        self._count.clear()
        frame.shader.set(room=self._room)
        for place, buffer in ((LISTS, self.surfaces), (HEADS, self._heads), (COUNT, self._count)):
            buffer.bind_to_storage_buffer(place)
        pipeline.within(opaque, part)
        opaque.depth_mask = False  # its colours are nobody's
        opaque.use()
        sides = ruled.technique.technique.sides(ruled.technique)
        context.enable_only(moderngl.DEPTH_TEST | (0 if sides else moderngl.CULL_FACE))
        context.depth_func = "<"
        camera = ruled.shot.camera
        draw(context, frame.shader, ruled.table, frame.sequence, frame.runs, camera, ruled.matrix)
        context.memory_barrier()
        opaque.depth_mask = True
        pipeline.within(opaque, None)
        return int(np.frombuffer(self._count.read(), "u4")[0])

    def _make(self, size: tuple[int, int]) -> None:
        for old in self._owned:
            old.release()
        if self._heads is not None:
            self._heads.release()
        like = [kept(self._context.texture(size, 4, dtype="f2"))]
        like += [kept(self._context.texture(size, 1, dtype="f4"))] * self._ids
        below = kept(self._context.depth_texture(size))
        self._opaque = self._context.framebuffer(like, below)
        self._owned = [self._opaque, *like, below]
        # No list begins anywhere between frames: whoever adds a list up takes it away.
        self._heads = self._context.buffer(bytes(4 * size[0] * size[1]))

    def read(self, count: int) -> NDArray[np.uint32]:
        """(count, words) the surfaces."""
        # Of nothing there is nothing to read, for which a driver has an error.
        data = self.surfaces.read(count * self.words * 4) if count else b""
        return np.frombuffer(data, "u4").reshape(-1, self.words)

    def heads(self) -> NDArray[np.uint32]:
        """(h·w,) where each pixel's list begins, from 1; 0 where there is none; the bottom row
        first."""
        assert self._heads is not None
        return np.frombuffer(self._heads.read(), "u4")
