"""The usual ways to blend without an order: weighted sums, depth peeling, chance."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from renderer.camera import Camera
from renderer.gpu.polygons import Corners, PolygonPainter
from renderer.gpu.programs import program


class WeightedPainter:
    """Weighted blended order-independent transparency (McGuire and Bavoil 2013, equation 10).

    One blend function serves both targets: the first one's alpha holds the revealage.
    """

    def __init__(self, painter: PolygonPainter) -> None:
        self.painter = painter
        context, size = painter.context, painter.size
        self.gather = program(context, "polygon.vert", "polygon.frag", ["WEIGHTED"])
        self.average = program(context, "polygon_screen.vert", "polygon_resolve.frag", ["AVERAGE"])
        self.sums = context.texture(size, 4, dtype="f2")
        self.weights = context.texture(size, 4, dtype="f2")
        self.frame = context.framebuffer([self.sums, self.weights], painter.depth)

    def painted(
        self, corners: Corners, camera: Camera, depths: tuple[float, float]
    ) -> NDArray[np.float32]:
        """(height, width, 4) picture; `depths` are the scene's nearest and farthest."""
        painter, context = self.painter, self.painter.context
        painter.begin(camera)
        self.frame.use()
        context.enable_only(0)
        self.frame.color_mask = (True,) * 4, (True,) * 4
        self.sums.write(
            np.tile(np.array([0, 0, 0, 1], np.float16), painter.size[0] * painter.size[1])
        )
        self.weights.write(np.zeros(4 * painter.size[0] * painter.size[1], np.float16))
        context.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
        context.blend_func = moderngl.ONE, moderngl.ONE, moderngl.ZERO, moderngl.ONE_MINUS_SRC_ALPHA
        self.frame.depth_mask = False
        self.frame.use()
        self.gather.set(range=depths)
        painter.draw(self.gather, corners, camera, None)
        self.frame.depth_mask = True
        self.sums.use(1)
        self.weights.use(2)
        self.average.set(sums=1, weights=2)
        painter.over(self.average)
        return painter.picture()


class PeelingPainter:
    """Depth peeling: the nearest layer first, then the nearest behind it, up to a number."""

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
        """(height, width, 4) picture of the nearest `passes` layers over what is opaque."""
        painter, context = self.painter, self.painter.context
        painter.begin(camera)
        self.total.use()
        self.total.clear(0.0, 0.0, 0.0, 0.0)
        self.layers[1].use()
        self.layers[1].clear(depth=0.0)
        opaque = painter.depth.read()
        for i in range(passes):
            target, last = self.layers[i % 2], self.depths[1 - i % 2]
            target.use()
            target.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
            self.depths[i % 2].write(opaque)
            context.enable_only(moderngl.DEPTH_TEST)
            last.use(1)
            self.peel.set(last=1)
            painter.draw(self.peel, corners, camera, None)
            self._blend(self.layer, self.total, moderngl.ONE_MINUS_DST_ALPHA, moderngl.ONE)
        self._blend(self.sum, painter.frame, moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA)
        return painter.picture()

    def _blend(
        self, picture: moderngl.Texture, target: moderngl.Framebuffer, source: int, below: int
    ) -> None:
        target.use()
        context = self.painter.context
        context.enable_only(moderngl.BLEND)
        context.blend_func = source, below
        picture.use(1)
        self.under.set(layer=1)
        array = context.vertex_array(self.under.program, [])
        array.render(moderngl.TRIANGLES, vertices=3)
        array.release()


class StochasticPainter:
    """Stochastic transparency: fragments kept by chance, opaque, and many pictures averaged."""

    def __init__(self, painter: PolygonPainter) -> None:
        self.painter = painter
        self.keep = program(painter.context, "polygon.vert", "polygon.frag", ["STOCHASTIC"])

    def painted(self, corners: Corners, camera: Camera, draws: int) -> NDArray[np.float32]:
        """(height, width, 4) mean of a number of draws."""
        painter = self.painter
        total = np.zeros((painter.size[1], painter.size[0], 4), np.float32)
        for draw in range(draws):
            painter.begin(camera)
            painter.context.enable_only(moderngl.DEPTH_TEST)
            self.keep.set(draw=draw)
            painter.draw(self.keep, corners, camera, None)
            total += painter.picture()
        return total / draws
