"""What the viewer shows, without a window: a scene of polygons under a method's order."""

from __future__ import annotations

from dataclasses import dataclass, replace

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device.programs import program
from seethrough.renderer.gpu.levels.polygon_painter import Corners, PolygonPainter
from seethrough.renderer.models.translucent.scenes import TranslucentScene
from seethrough.renderer.polygons.prepared import Drawable, Prepared, drawable
from seethrough.renderer.scene.camera import Camera, look_at

STEP = 0.08  # radians a key press turns the view
STEEPEST = 1.5


@dataclass(frozen=True, slots=True)
class ViewState:
    """Where the scene is seen from and how it is drawn. Angles in radians, distance in radii."""

    yaw: float = 0.77
    pitch: float = 0.47
    distance: float = 2.3
    texturing: bool = True
    opaque: bool = True
    lines: bool = False

    def pressed(self, key: str) -> ViewState:
        """After a key: LabBSP2010's t, o, l and p; arrows turn, page up and down move."""
        match key:
            case "t":
                return replace(self, texturing=not self.texturing)
            case "o":
                return replace(self, opaque=not self.opaque)
            case "l":
                return replace(self, lines=True)
            case "p":
                return replace(self, lines=False)
            case "left" | "right":
                return self.dragged(-STEP if key == "left" else STEP, 0.0)
            case "up" | "down":
                return self.dragged(0.0, STEP if key == "up" else -STEP)
            case "pageup" | "pagedown":
                return self.moved(0.9 if key == "pageup" else 1 / 0.9)
        return self

    def dragged(self, yaw: float, pitch: float) -> ViewState:
        """Turned about the scene's middle."""
        steep = float(np.clip(self.pitch + pitch, -STEEPEST, STEEPEST))
        return replace(self, yaw=self.yaw + yaw, pitch=steep)

    def moved(self, factor: float) -> ViewState:
        """Nearer or farther."""
        return replace(self, distance=float(np.clip(self.distance * factor, 0.05, 20.0)))


class Viewer:
    """Draws the scene into a frame of its own."""

    def __init__(
        self,
        context: moderngl.Context,
        size: tuple[int, int],
        scene: TranslucentScene,
        prepared: Prepared,
    ) -> None:
        self.scene, self.prepared = scene, prepared
        self.painter = PolygonPainter(context, size, texture=scene.texture)
        self._present = program(context, "polygon_screen.vert", "polygon_resolve.frag", ["UNDER"])
        self._screen = context.vertex_array(self._present.program, [])
        self._corners = _corners(prepared.drawable)
        solid = scene.opaque
        self._opaque = None if solid is None else _corners(drawable(solid, np.arange(len(solid))))

    def camera(self, state: ViewState) -> Camera:
        """Looks at the scene's middle."""
        radius = max(self.scene.radius, 1e-9)
        level = np.cos(state.pitch)
        way = np.array([level * np.sin(state.yaw), np.sin(state.pitch), level * np.cos(state.yaw)])
        eye = self.scene.center + state.distance * radius * way
        return look_at(eye, self.scene.center, near=0.01 * radius, far=40 * radius)

    def picture(self, state: ViewState) -> NDArray[np.float32]:
        """(height, width, 4) what `draw` draws, row 0 on top."""
        self.draw(state)
        return self.painter.picture()

    def draw(self, state: ViewState) -> None:
        """Draw the scene into the frame."""
        camera = self.camera(state)
        self.painter.opaque = self._opaque if state.opaque else None
        self.painter.textured = state.texturing and self.scene.texture is not None
        order = self.prepared.order(eye=camera.eye, view=camera.forward)
        self.painter.context.wireframe = state.lines
        try:
            self.painter.paint(self._corners, order, camera)
        finally:
            self.painter.context.wireframe = False

    def present(self, target: moderngl.Framebuffer) -> None:
        """Put what was drawn on a screen."""
        target.use()
        self.painter.context.enable_only(moderngl.NOTHING)
        self.painter.color.use(0)
        self._present.set(layer=0, share=1.0)
        self._screen.render(moderngl.TRIANGLES, vertices=3)

    def summary(self, method: str) -> list[str]:
        """The order's stats, as lines of text."""
        stats = self.prepared.stats
        nodes = ", ".join(f"{count} {kind}" for kind, count in stats.nodes.items()) or "none"
        return [
            f"{self.scene.name}, order {method}",
            f"polygons {stats.inputs} in, {stats.outputs} out, {stats.splits} splits",
            f"relations tested {stats.relations}, nodes {nodes}, depth {stats.depth}",
            *([stats.dense] if stats.dense else []),
        ]


def _corners(drawn: Drawable) -> Corners:
    return Corners.of(drawn.polygons.vertices, drawn.polygons.attributes, drawn.triangles)
