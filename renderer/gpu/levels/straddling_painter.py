"""Draws what reaches to both sides of the borders of masks, each in its place in the order.

After its depth, before its colours, the border of a mask that was drawn already is divided out
where it lies nearer than that; one that is yet to come is multiplied in where it lies farther. Then
that is undone, so that nothing else is the wiser (plan/straddling.py).
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, floor
from typing import NamedTuple

import moderngl
import numpy as np

from seethrough.renderer.arrays import Floats
from seethrough.renderer.gpu.device import pipeline
from seethrough.renderer.gpu.device.programs import Shader
from seethrough.renderer.gpu.device.scene_table import Run
from seethrough.renderer.gpu.levels.crossing_painter import Ways, drawing_masks
from seethrough.renderer.gpu.masks.mask_painter import MaskPainter
from seethrough.renderer.plan.frame_plan import FramePlan
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.projection import depth_values
from seethrough.renderer.scene.scene import Scene

_NEVER = {True: 1.0, False: 0.0}  # depths of a target's own mask at which it does not show


class Border(NamedTuple):
    """Of which target, whether its mask was drawn already, and how strongly it is to be told."""

    target: int
    after: bool
    strength: float


class StraddlingPainter:
    """The objects of one frame at a time; `opacity` is a program that gives that alone."""

    def __init__(self, context: moderngl.Context, opacity: Shader) -> None:
        self._context, self._opacity = context, opacity

    def begin(
        self, frame: FramePlan, scene: Scene, camera: Camera, runs: dict[int, list[Run]],
        masks: MaskPainter, into: moderngl.Framebuffer,
    ) -> None:  # fmt: skip
        """Take on a frame: `runs` draw each of its objects, and `into` is what is drawn into."""
        self._runs, self._masks, self._into = runs, masks, into
        self._extents = frame.boxes.extents
        self._borders: dict[int, list[Border]] = {}
        for (i, *border), strength in zip(
            frame.straddling.tolist(), frame.strength.tolist(), strict=True
        ):
            self._borders.setdefault(i, []).append(Border(border[0], bool(border[1]), strength))
        targets = frame.straddling[:, 1]
        depths = depth_values(scene.centers[targets], camera)
        self._depths = dict(zip(targets.tolist(), depths.tolist(), strict=True))
        self._beyond: dict[int, list[tuple[int, float]]] = {}
        for (first, last), beyond in zip(
            frame.swapping.tolist(), frame.beyond.tolist(), strict=True
        ):
            self._beyond.setdefault(first, []).append((last, beyond))

    def draw(self, i: int, ways: Ways) -> int:
        """Draw an object in its place. Returns how many masks that took."""
        borders = self._borders.get(i, [])
        left, top, right, bottom = _around(self._extents[i], self._into.size)
        pipeline.within(self._into, (left, self._into.height - bottom, right - left, bottom - top))
        ways.depth(self._runs[i])
        self._show_beyond(self._beyond.get(i, []), ways)
        self._tell(borders, True)
        ways.lit(self._runs[i])
        if ways.told is not None:
            ways.told(np.array([i]))
        self._tell(borders, False)
        pipeline.within(self._into, None)
        return 2 * len(borders)

    def _show_beyond(self, others: Sequence[tuple[int, float]], ways: Ways) -> None:
        """Draw of others what lies behind what is there, and leave the depths."""
        self._context.depth_func = ">"
        self._into.depth_mask = False
        for other, strength in others:
            self._multiply(other, strength, ways)
            ways.lit(self._runs[other])
            if ways.told is not None:
                ways.told(np.array([other]))
            self._multiply(other, 1 / strength, ways)
        self._into.depth_mask = True
        self._context.depth_func = "<="

    def _multiply(self, i: int, opacity: float, ways: Ways) -> None:
        """Let what comes show less, wherever the object is."""
        if opacity != 1.0:
            self._opacity.set(opacity=opacity)
            ways.multiplied(self._opacity, self._runs[i])

    def _tell(self, borders: Sequence[Border], first: bool) -> None:
        """Divide or multiply what is not to be as the order has it; or undo that."""
        with drawing_masks(self._context, self._into):
            for target, after, strength in borders:
                self._context.depth_func = "<=" if after else ">"
                self._masks.draw_at_depth(
                    *(target, _NEVER[after], self._depths[target]),
                    *(after == first, strength),
                )
        self._context.depth_func = "<="


def _around(box: Floats, size: tuple[int, int]) -> tuple[int, int, int, int]:
    """Left, top, right, bottom of the whole pixels about a box (4,), and one more on each side."""
    (left, top, right, bottom), (width, height) = box.tolist(), size
    left, top = floor(min(max(left, 1.0), width)) - 1, floor(min(max(top, 1.0), height)) - 1
    right, bottom = ceil(min(max(right, 0.0), width)) + 1, ceil(min(max(bottom, 0.0), height)) + 1
    return left, top, min(right, width), min(bottom, height)
