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
        table, technique, shot, matrix = ruled.table, ruled.technique, ruled.shot, ruled.matrix
        shader, pictures = self._programs.prepared(ruled)
        rules, own = technique.technique, numbers(technique, shot)
        among = ruled.frame.ruled
        sorted_out = "removed" not in ruled.frame.without
        parts = list(rules.cut(shot, pictures, among) if sorted_out else (among[:0], among))
        sequence, runs = table.sequence(parts, shot.camera, [own, own])
        target.framebuffer.use()
        self._context.depth_func = "<="
        for part, sides in zip(runs, (False, rules.sides(technique)), strict=True):
            if part:
                self._context.enable_only(
                    moderngl.DEPTH_TEST | (0 if sides else moderngl.CULL_FACE)
                )
                draw(self._context, shader, table, sequence, part, shot.camera, matrix)
        return sum(len(part) for part in runs)
