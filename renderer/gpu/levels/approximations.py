"""The usual ways to blend without an order: weighted sums, depth peeling, chance.

Each has `paint`, which draws into the painter's frame, and `painted`, which also reads it back.
"""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device import pipeline
from seethrough.renderer.gpu.device.programs import program
from seethrough.renderer.gpu.device.reused import spoil
from seethrough.renderer.gpu.levels.polygon_painter import Corners, PolygonPainter
from seethrough.renderer.scene.camera import Camera


class WeightedPainter:
    """Weighted blended order-independent transparency (McGuire and Bavoil 2013, equation 10).

    Exact for one layer, and where all layers of a pixel have one colour. One blend function serves
    both targets: the first one's alpha holds the revealage.
    """

    def __init__(self, painter: PolygonPainter) -> None:
        self.painter = painter
        context, size = painter.context, painter.size
        self.gather = program(context, "polygon.vert", "polygon.frag", ["WEIGHTED"])
        self.average = program(context, "polygon_screen.vert", "polygon_resolve.frag", ["AVERAGE"])
        self.sums = context.texture(size, 4, dtype="f2")
        self.weights = context.texture(size, 4, dtype="f2")
        self.frame = context.framebuffer([self.sums, self.weights], painter.depth)
        self._emptied = [context.framebuffer([t]) for t in (self.sums, self.weights)]

    def painted(
        self, corners: Corners, camera: Camera, depths: tuple[float, float]
    ) -> NDArray[np.float32]:
        """(height, width, 4) picture, row 0 on top, of what `paint` draws."""
        self.paint(corners, camera, depths)
        return self.painter.picture()

    def paint(self, corners: Corners, camera: Camera, depths: tuple[float, float]) -> None:
        """Draw into the painter's frame; `depths` are the scene's nearest and farthest."""
        painter, context = self.painter, self.painter.context
        painter.begin(camera)
        spoil(self.sums, self.weights)
        for part, through in zip(self._emptied, (1.0, 0.0), strict=True):
            part.clear(0.0, 0.0, 0.0, through)
        context.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
        pipeline.blend(
            context, (moderngl.ONE, moderngl.ONE, moderngl.ZERO, moderngl.ONE_MINUS_SRC_ALPHA)
        )
        self.frame.depth_mask = False
        self.frame.use()
        self.gather.set(range=depths)
        painter.draw(self.gather, corners, camera, None)
        self.frame.depth_mask = True
        self.sums.use(1)
        self.weights.use(2)
        self.average.set(sums=1, weights=2)
        painter.over(self.average)


class PeelingPainter:
    """Depth peeling: the nearest layer first, then the nearest behind it, up to a number.

    Exact where no pixel has more layers than there are passes, and no two at one depth.
    """

    def __init__(self, painter: PolygonPainter) -> None:
        self.painter = painter
        context, size = painter.context, painter.size
        self.peel = program(context, "polygon.vert", "polygon.frag", ["PEEL"])
        self.under = program(context, "polygon_screen.vert", "polygon_resolve.frag", ["UNDER"])
        self.depths = [context.depth_texture(size) for _ in range(2)]
        for depth in self.depths:
            depth.compare_func = ""
        self.layer = context.texture(size, 4, dtype="f2")
        self.layers = [context.framebuffer([self.layer], depth) for depth in self.depths]
        self.sum = context.texture(size, 4, dtype="f2")
        self.total = context.framebuffer([self.sum])

    def painted(self, corners: Corners, camera: Camera, passes: int) -> NDArray[np.float32]:
        """(height, width, 4) picture, row 0 on top, of what `paint` draws."""
        self.paint(corners, camera, passes)
        return self.painter.picture()

    def paint(self, corners: Corners, camera: Camera, passes: int) -> None:
        """Draw the nearest `passes` layers over what is opaque, into the painter's frame."""
        painter, context = self.painter, self.painter.context
        painter.begin(camera)
        spoil(self.layer, self.sum, *self.depths)
        self.total.use()
        self.total.clear(0.0, 0.0, 0.0, 0.0)
        self.layers[1].use()
        self.layers[1].clear(depth=0.0)
        for i in range(passes):
            target, last = self.layers[i % 2], self.depths[1 - i % 2]
            target.use()
            target.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
            context.enable_only(moderngl.DEPTH_TEST)
            last.use(1)
            painter.depth.use(2)
            self.peel.set(last=1, solid=2)
            painter.draw(self.peel, corners, camera, None)
            self._blend(self.layer, self.total, moderngl.ONE_MINUS_DST_ALPHA, moderngl.ONE)
        self._blend(self.sum, painter.frame, moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA)

    def _blend(
        self, picture: moderngl.Texture, target: moderngl.Framebuffer, source: int, below: int
    ) -> None:
        target.use()
        context = self.painter.context
        context.enable_only(moderngl.BLEND)
        context.blend_func = source, below
        picture.use(1)
        self.under.set(layer=1, share=1.0)
        array = context.vertex_array(self.under.program, [])
        array.render(moderngl.TRIANGLES, vertices=3)
        array.release()


class StochasticPainter:
    """Stochastic transparency (Enderton et al. 2010): each draw keeps a fragment, opaque, with a
    chance of its opacity. The mean of many draws tends to the exact picture.
    """

    def __init__(self, painter: PolygonPainter) -> None:
        self.painter = painter
        context = painter.context
        self.keep = program(context, "polygon.vert", "polygon.frag", ["STOCHASTIC"])
        self.add = program(context, "polygon_screen.vert", "polygon_resolve.frag", ["UNDER"])
        self.sum = context.texture(painter.size, 4, dtype="f4")
        self.total = context.framebuffer([self.sum])

    def painted(
        self, corners: Corners, camera: Camera, draws: int, first: int = 0
    ) -> NDArray[np.float32]:
        """(height, width, 4) picture, row 0 on top, of what `paint` draws."""
        self.paint(corners, camera, draws, first)
        return self.painter.picture()

    def paint(self, corners: Corners, camera: Camera, draws: int, first: int = 0) -> None:
        """Draw the mean of draws number `first` and on into the painter's frame."""
        painter, context = self.painter, self.painter.context
        spoil(self.sum)
        self.total.use()
        self.total.clear(0.0, 0.0, 0.0, 0.0)
        for draw in range(first, first + draws):
            painter.begin(camera)
            context.enable_only(moderngl.DEPTH_TEST)
            self.keep.set(draw=draw)
            painter.draw(self.keep, corners, camera, None)
            self._onto(self.total, painter.color, 1.0 / draws)
        self._onto(painter.frame, self.sum, None)

    def _onto(
        self, target: moderngl.Framebuffer, picture: moderngl.Texture, share: float | None
    ) -> None:
        """Add a share of a picture to the target, or put the picture there (None)."""
        context = self.painter.context
        target.use()
        context.enable_only(moderngl.NOTHING if share is None else moderngl.BLEND)
        context.blend_func = moderngl.ONE, moderngl.ONE
        picture.use(1)
        self.add.set(layer=1, share=1.0 if share is None else share)
        array = context.vertex_array(self.add.program, [])
        array.render(moderngl.TRIANGLES, vertices=3)
        array.release()
