"""Draws what a rule removes: one pass over the objects that it touches, from both sides."""

from __future__ import annotations

from collections.abc import Sequence

import moderngl

from seethrough.renderer.gpu.device.targets import FrameTarget
from seethrough.renderer.gpu.rules.rule_program import Ruled, RulePrograms, draw, numbers
from seethrough.renderer.scene.visibility import Drawn


class RemovalPainter:
    """Keeps the programs. A depth buffer is all the order that removal needs."""

    def __init__(self, context: moderngl.Context, defines: Sequence[str]) -> None:
        self._context = context
        self._programs = RulePrograms(context, defines)
        self.found: list[Drawn] = []  # one layer, which is the picture

    def draw(self, ruled: Ruled, target: FrameTarget) -> int:
        """Draw the plan's ruled objects among those already in the target. Returns the draws."""
        table, frame, technique = ruled.table, ruled.frame, ruled.technique
        shot, matrix = ruled.shot, ruled.matrix
        shader = self._programs.ready(ruled)
        sequence, runs = table.sequence([frame.ruled], shot.camera, [numbers(technique, shot)])
        target.framebuffer.use()
        sides = technique.technique.sides(technique)
        self._context.enable_only(moderngl.DEPTH_TEST | (0 if sides else moderngl.CULL_FACE))
        self._context.depth_func = "<="
        draw(self._context, shader, table, sequence, runs[0], shot.camera, matrix)
        return len(runs[0])
