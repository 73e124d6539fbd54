"""Draws what levels hold but no instanced draw can: each by itself, in its place in the order."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import moderngl

from seethrough.renderer.gpu.device.programs import Shader, program
from seethrough.renderer.gpu.device.scene_table import Run
from seethrough.renderer.gpu.levels.crossing_painter import CrossingPainter, Ways
from seethrough.renderer.gpu.levels.straddling_painter import StraddlingPainter
from seethrough.renderer.gpu.masks.mask_painter import MaskPainter
from seethrough.renderer.plan.frame_plan import FramePlan
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene


class Alone(NamedTuple):
    """What a frame draws by itself, of which scene and from where; what masks leave of the light on
    their targets, and how the frame draws objects."""

    frame: FramePlan
    scene: Scene
    camera: Camera
    alpha: float
    ways: Ways


class SinglePainter:
    """The targets that cross and what straddles borders, of one frame at a time; `defines` as for
    what draws objects."""

    def __init__(self, context: moderngl.Context, defines: Sequence[str]) -> None:
        self.opacity: Shader = program(context, "object.vert", "opacity.frag", defines)
        self._crossing = CrossingPainter(context, self.opacity)
        self._straddling = StraddlingPainter(context, self.opacity)

    def begin(
        self,
        job: Alone,
        runs: dict[int, list[Run]],
        masks: MaskPainter,
        into: moderngl.Framebuffer,
    ) -> None:
        """Take on a frame: `runs` draw each of its objects, and `into` is what is drawn into."""
        frame, scene, camera, alpha, self._ways = job
        self._crossing.begin(frame, scene, camera, alpha, runs, masks, into)
        self._straddling.begin(frame, scene, camera, runs, masks, into)
        self._told = {*frame.straddling[:, 0].tolist(), *frame.swapping[:, 0].tolist()}

    def draw(self, i: int) -> int:
        """Draw an object in its place. Returns how many masks that took."""
        painter = self._straddling if i in self._told else self._crossing
        return painter.draw(i, self._ways)
