"""What the frames of a trial add up to."""

from __future__ import annotations

from math import acos, dist

from seethrough.renderer.scene.camera import Camera
from seethrough.tasks.kit.base import View

# A frame that took this many display periods was missed (issue: over 1.5 periods).
MISSED = 1.5


class Watch:
    """Counts frames and what the viewer's movement adds up to."""

    def __init__(self, period: float) -> None:
        self.period = period
        self.frames = 0
        self.missed = 0
        self.worst = 0.0
        self.path = 0.0
        self.turned = 0.0
        self._time: float | None = None
        self._camera: Camera | None = None
        self._eye: list[float] = []
        self._back: list[float] = []  # the camera's third axis: it looks the other way

    def frame(self, time: float, view: View) -> None:
        self.frames += 1
        if self._time is not None:
            took = time - self._time
            self.worst = max(self.worst, took)
            self.missed += took > MISSED * self.period
        camera = view.camera
        if camera is not self._camera:
            eye, back = camera.eye.tolist(), camera.rotation[:, 2].tolist()
            if self._camera is not None:
                (a, b, c), (d, e, f) = back, self._back
                self.path += dist(eye, self._eye)
                self.turned += acos(min(1.0, max(-1.0, a * d + b * e + c * f)))
            self._camera, self._eye, self._back = camera, eye, back
        self._time = time

    @property
    def seen(self) -> bool:
        """Whether a frame is on the screen: not before the first one, nor after a page."""
        return self._time is not None

    def pause(self) -> None:
        """The next frame comes after a page: its distance to the last one is not a missed frame."""
        self._time = None
