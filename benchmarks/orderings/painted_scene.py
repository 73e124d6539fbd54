"""One scene of translucent polygons on the GPU: its exact picture, and the same in any order."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.levels.polygon_painter import Corners, ExactPainter, PolygonPainter
from seethrough.renderer.models.translucent.scenes import TranslucentScene
from seethrough.renderer.polygons.prepared import Drawable, Prepared, drawable
from seethrough.renderer.scene.camera import Camera, look_at

Picture = NDArray[np.float32]
KEPT = 2**28  # bytes of exact pictures


class PaintedScene:
    """A scene in an OpenGL context of its own, in pictures of (width, height)."""

    def __init__(self, made: TranslucentScene, size: tuple[int, int]) -> None:
        self.made = made
        self.painter = PolygonPainter(standalone(430), size, texture=made.texture)
        self.exact = ExactPainter(self.painter)
        self.plain = corners_of(drawable(made.polygons, np.arange(len(made.polygons))))
        if made.opaque is not None:
            self.painter.opaque = corners_of(drawable(made.opaque, np.arange(len(made.opaque))))
        self._corners: dict[int, tuple[Prepared, Corners]] = {}
        self._exact: dict[bytes, Picture] = {}

    def release(self) -> None:
        """Give the GPU back."""
        self.painter.release()
        self.painter.context.release()

    def camera(self, eye: Floats) -> Camera:
        """Looks at the scene's middle."""
        radius = self.made.radius
        return look_at(eye, self.made.center, near=0.05 * radius, far=6 * radius)

    def truth(self, eye: Floats) -> Picture:
        """The exact picture; the last ones are kept."""
        key = eye.tobytes()
        if key not in self._exact:
            if sum(p.nbytes for p in self._exact.values()) > KEPT:
                self._exact.pop(next(iter(self._exact)))
            self._exact[key] = self.exact.painted(self.plain, self.camera(eye))
        return self._exact[key]

    def paint(self, prepared: Prepared, eye: Floats) -> None:
        """Order, and draw in that order."""
        if id(prepared) not in self._corners:
            self._corners[id(prepared)] = (prepared, corners_of(prepared.drawable))
        camera = self.camera(eye)
        order = prepared.order(eye=eye, view=camera.forward)
        self.painter.paint(self._corners[id(prepared)][1], order, camera)

    def ordered(self, prepared: Prepared, eye: Floats) -> Picture:
        """The picture painted in a method's order."""
        self.paint(prepared, eye)
        return self.painter.picture()

    def wrong(self, picture: Picture, eye: Floats, step: float = 1 / 255) -> NDArray[np.bool_]:
        """(h, w) where a picture is more than a step off the exact one."""
        return np.abs(picture - self.truth(eye))[..., :3].max(axis=-1) > step

    def off(self, prepared: Prepared, eye: Floats) -> float:
        """Share of pixels more than 1/255 off the exact picture."""
        return float(self.wrong(self.ordered(prepared, eye), eye).mean())


def corners_of(drawn: Drawable) -> Corners:
    """Triangles for the GPU."""
    return Corners.of(drawn.polygons.vertices, drawn.polygons.attributes, drawn.triangles)
