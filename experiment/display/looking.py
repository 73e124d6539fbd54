"""How a simulated participant's eyes get at what is drawn: a small id picture of the view."""

from __future__ import annotations

from typing import TYPE_CHECKING

from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.models.simple import simplified
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.scene.visibility import Visibility
from seethrough.tasks.kit.base import View

if TYPE_CHECKING:
    from moderngl import Context

    from seethrough.renderer.techniques.base import Parameters

HEIGHT = 150  # pixels of the id picture


class Looking:
    """Looks at views in a window; a view that did not change is drawn only once.

    The picture is small, but what is counted in pixels of the window (how wide a mask is) keeps its
    part of the picture: `window` is (width, height) of what the person has before the eyes.
    `simple` takes models of few triangles: in so small a picture nobody can tell.
    """

    def __init__(self, context: Context, window: tuple[int, int], simple: bool = False) -> None:
        self.simple = simple
        self._renderer = Renderer(context, window)
        self._seen: tuple[Scene, Camera, Parameters, object, Visibility] | None = None
        self.technique: Parameters | None = None
        self.looks = 0

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) of the id picture."""
        width, height = self._renderer.size
        return (round(HEIGHT * width / height), HEIGHT)

    def resize(self, window: tuple[int, int]) -> None:
        """The window has another size now."""
        if window != self._renderer.size:
            self._renderer.resize(window)
            self._seen = None

    def look(self, view: View) -> Visibility:
        """What can be seen in `view`, drawn with `technique`."""
        seen, technique = self._seen, self.technique
        assert technique is not None
        same = seen and (seen[0] is view.scene and seen[1] is view.camera and seen[2] is technique)
        if seen and same and seen[3] == view.drawn:
            return seen[4]
        scene = simplified(view.scene) if self.simple else view.scene
        visibility = self._renderer.look(scene, view.camera, technique, self.size, view.drawn)
        self._seen = (view.scene, view.camera, technique, view.drawn, visibility)
        self.looks += 1
        return visibility
