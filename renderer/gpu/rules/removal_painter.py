"""Draws what a rule removes: one pass over the objects that it touches, from both sides."""

from __future__ import annotations

from collections.abc import Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device.programs import Shader
from seethrough.renderer.gpu.device.reused import kept
from seethrough.renderer.gpu.device.scene_table import Run
from seethrough.renderer.gpu.device.targets import FrameTarget
from seethrough.renderer.gpu.rules.rule_program import Ruled, RulePrograms, draw, numbers, use
from seethrough.renderer.plan import coverage
from seethrough.renderer.scene.visibility import Drawn
from seethrough.renderer.techniques.base import Cut
from seethrough.renderer.techniques.maps import block_bounds

MANY = 1000  # triangles of an object: of one that has fewer, to look at each costs more


class RemovalPainter:
    """Keeps the programs. A depth buffer is all the order that removal needs."""

    def __init__(self, context: moderngl.Context, defines: Sequence[str]) -> None:
        self._context = context
        self._programs = RulePrograms(context, defines)
        self._remaining = _Remaining(context)
        self.found: list[Drawn] = []  # one layer, which is the picture

    def draw(self, ruled: Ruled, target: FrameTarget) -> int:
        """Draw the plan's ruled objects among those already in the target. Returns the draws."""
        table, technique, shot, matrix = ruled.table, ruled.technique, ruled.shot, ruled.matrix
        shader, pictures = self._programs.prepared(ruled)
        rules, own = technique.technique, numbers(technique, shot)
        among = ruled.frame.ruled
        cut = Cut(among[:0], among, None)
        if "removed" not in ruled.frame.without:
            cut = rules.cut(shot, pictures, among)
        large, small = cut.partly[:0], cut.partly
        if cut.hole is not None:
            many = table.scene.triangle_counts[cut.partly] >= MANY
            large, small = cut.partly[many], cut.partly[~many]
        parts = [cut.whole, small, *large[:, None]]  # each large one by itself
        sequence, runs = table.sequence(parts, shot.camera, [own] * len(parts))
        target.framebuffer.use()
        self._context.depth_func = "<="
        faces = (False, *[rules.sides(technique)] * (len(runs) - 1))
        for k, part in enumerate(runs[:2]):
            if part:
                self._show(faces[k])
                draw(self._context, shader, table, sequence, part, shot.camera, matrix)
        if cut.hole is not None and len(large):
            self._show(faces[-1])
            table.table.use(0)
            sequence.use(1)
            self._remaining.draw(shader, ruled, cut.hole, large, runs[2:])
        return sum(len(part) for part in runs)

    def _show(self, both_sides: bool) -> None:
        culling = 0 if both_sides else moderngl.CULL_FACE
        self._context.enable_only(moderngl.DEPTH_TEST | culling)


class _Remaining:
    """Draws of large meshes only the triangles that a hole may leave something of."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._corners = kept(context.buffer(reserve=1 << 16, dynamic=True))

    def draw(
        self,
        shader: Shader,
        ruled: Ruled,
        hole: NDArray[np.float32],
        objects: NDArray[np.int64],
        runs: list[list[Run]],
    ) -> None:
        """Draw objects (k,), each the one instance of its run, by the bound sequence."""
        from seethrough.renderer.plan.remaining import remaining

        table, shot, every = ruled.table, ruled.shot, ruled.table.triangles
        linear = table.scene.transforms[objects, :3, :3]
        left = np.empty((int(table.scene.triangle_counts[objects].sum()), 3), np.int32)
        starts = remaining(
            *(every.points, every.corners, every.spans[objects]),
            *table.poses(objects, shot.camera),
            np.linalg.det(linear) < 0,
            coverage.lens(shot.camera, shot.size),
            *block_bounds(hole, shot.boxes.extents[objects]),
            left,
        ).tolist()
        data = left[: starts[-1]]
        self._corners.orphan(max(data.nbytes, self._corners.size))
        if len(data):
            self._corners.write(data)
        use(shader, shot.camera, ruled.matrix)
        for (run,), first, end in zip(runs, starts[:-1], starts[1:], strict=True):
            if first < end:
                mesh, row, _ = run
                mesh.draw_some(self._context, shader, row, self._corners, (first, end - first))
