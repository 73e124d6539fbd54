"""Draws targets that reach into one another, two by two, each in its place in the order.

The first one is drawn with what of the last one lies behind it, told by the depth buffer; that has
its share of the light as though it were drawn before, with its mask. Borders of masks lie at the
depth of their target's centre (Elmqvist2009 §V-D, as sorted pixels have it): where the other target
comes before that, the border counts, and only there. What is multiplied into the frame's alpha for
one of the two is divided out again after it, so that nothing else is the wiser.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device import pipeline
from seethrough.renderer.gpu.device.programs import Shader
from seethrough.renderer.gpu.device.scene_table import Run
from seethrough.renderer.gpu.masks.mask_painter import MaskPainter
from seethrough.renderer.plan.frame_plan import FramePlan
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.projection import depth_values
from seethrough.renderer.scene.scene import Scene

_NEVER_BEYOND, _ALWAYS_BEYOND = 0.0, 1.0  # depths: nothing lies nearer, nothing farther


class Ways(NamedTuple):
    """How a frame draws objects: their depth alone, their colours, and with a shader what is
    multiplied into its alpha; `told` is who is drawn, where that matters."""

    depth: Callable[[list[Run]], None]
    lit: Callable[[list[Run]], None]
    multiplied: Callable[[Shader, list[Run]], None]
    told: Callable[[NDArray[np.int64]], None] | None


class CrossingPainter:
    """The pairs of one frame at a time; `opacity` is a program that gives that alone."""

    def __init__(self, context: moderngl.Context, opacity: Shader) -> None:
        self._context, self._opacity = context, opacity

    def begin(
        self, frame: FramePlan, scene: Scene, camera: Camera, alpha: float,
        runs: dict[int, list[Run]], masks: MaskPainter, into: moderngl.Framebuffer,
    ) -> None:  # fmt: skip
        """Take on a frame: masks leave `alpha` on their targets, `runs` draw each of these, and
        `into` is what is drawn into."""
        self._runs, self._masks, self._into, self._alpha = runs, masks, into, alpha
        self._first: dict[int, int] = {}
        self._lasts: dict[int, list[int]] = {}
        for first, last in frame.crossing.tolist():
            self._first[last] = first
            self._lasts.setdefault(first, []).append(last)
        targets = frame.crossing.ravel()
        depths = depth_values(scene.centers[targets], camera)
        self._depths = dict(zip(targets.tolist(), depths.tolist(), strict=True))
        self._telling = _telling(frame, scene, camera)

    def draw(self, target: int, ways: Ways) -> int:
        """Draw one of a pair in its place. Returns how many masks that took."""
        lasts, first = self._lasts.get(target, []), self._first.get(target)
        ways.depth(self._runs[target])
        with self._beyond():
            for last in lasts:
                self._colors(last, ways)
                self._multiply(last, self._alpha, ways)
            bordering = [last for last in lasts if (last, target) in self._telling]
            for last in bordering:
                self._mask(last, _NEVER_BEYOND, divided=False)
        told = [first] if first is not None and (first, target) in self._telling else []
        for other in told:
            self._mask(other, _ALWAYS_BEYOND, divided=True)
        self._colors(target, ways)
        for other in told:
            self._mask(other, _ALWAYS_BEYOND, divided=False)
        with self._beyond():
            for last in bordering:
                self._mask(last, _NEVER_BEYOND, divided=True)
            for last in lasts:
                self._multiply(last, 1 / self._alpha, ways)
        return 2 * (len(bordering) + len(told))

    def _colors(self, target: int, ways: Ways) -> None:
        ways.lit(self._runs[target])
        if ways.told is not None:
            ways.told(np.array([target]))

    def _multiply(self, target: int, opacity: float, ways: Ways) -> None:
        """What a mask does on its target itself, done by drawing that."""
        self._opacity.set(opacity=opacity)
        ways.multiplied(self._opacity, self._runs[target])

    @contextmanager
    def _beyond(self) -> Iterator[None]:
        """Draw only what lies behind what is there, and leave the depths."""
        self._context.depth_func = ">"
        self._into.depth_mask = False
        yield
        self._into.depth_mask = True
        self._context.depth_func = "<="

    def _mask(self, target: int, own: float, divided: bool) -> None:
        """A target's mask, with its border at the depth of its centre."""
        with drawing_masks(self._context, self._into):
            self._masks.draw_at_depth(target, own, self._depths[target], divided)


def _telling(frame: FramePlan, scene: Scene, camera: Camera) -> set[tuple[int, int]]:
    """Whose border changes the pixels of the other of its pair: that of the last one where the
    first comes before it, that of the first one where the last lies behind it."""
    first, last = frame.crossing.T
    over = frame.boxes.near[first] < camera.depth(scene.centers[last])
    under = frame.boxes.far[last] > camera.depth(scene.centers[first])
    found = [*zip(last[over].tolist(), first[over].tolist(), strict=True)]
    return {*found, *zip(first[under].tolist(), last[under].tolist(), strict=True)}


@contextmanager
def drawing_masks(context: moderngl.Context, into: moderngl.Framebuffer) -> Iterator[None]:
    """What is drawn is a mask: it is multiplied into the alpha of a frame and leaves its depth."""
    written = into.depth_mask
    context.disable(moderngl.CULL_FACE)
    context.enable(moderngl.BLEND)
    pipeline.blend(context, pipeline.MASK)
    into.depth_mask = False
    yield
    into.depth_mask = written
    context.enable(moderngl.CULL_FACE)
