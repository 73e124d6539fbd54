"""Where the scene is seen from."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Camera:
    """A perspective camera. `eye` (3,) in world units; `rotation` (3, 3) world ← camera.

    The columns of `rotation` are the camera's right, up and backward axes: it looks along its
    own −z (CONVENTIONS.md). `fov_y` is the full vertical angle in radians; `near` and `far` are
    positive distances along the view direction.
    """

    eye: NDArray[np.float64]
    rotation: NDArray[np.float64]
    fov_y: float = np.pi / 3
    near: float = 0.1
    far: float = 1000.0

    def __post_init__(self) -> None:
        values = [*self.eye.tolist(), *self.rotation.ravel().tolist()]
        if not all(map(isfinite, values)):
            raise ValueError("camera has a value that is not finite")
        if not 0 < self.near < self.far:
            raise ValueError(f"near = {self.near}, far = {self.far}, expected 0 < near < far")
        if not 0 < self.fov_y < np.pi:
            raise ValueError(f"fov_y = {self.fov_y}, expected an angle in (0, π) radians")

    @property
    def forward(self) -> NDArray[np.float64]:
        """(3,) unit vector into the picture."""
        return -self.rotation[:, 2]

    def view(self) -> NDArray[np.float64]:
        """(4, 4) camera ← world."""
        matrix = np.eye(4)
        matrix[:3, :3] = self.rotation.T
        matrix[:3, 3] = -self.rotation.T @ self.eye
        return matrix

    def projection(self, aspect: float) -> NDArray[np.float64]:
        """(4, 4) clip ← camera, OpenGL's clip space. `aspect` is width / height."""
        f = 1.0 / np.tan(self.fov_y / 2)
        n, fa = self.near, self.far
        return np.array(
            [
                [f / aspect, 0, 0, 0],
                [0, f, 0, 0],
                [0, 0, (fa + n) / (n - fa), 2 * fa * n / (n - fa)],
                [0, 0, -1, 0],
            ]
        )

    def pixel(self, height: int) -> float:
        """The slope that one pixel of a picture so high spans in its middle."""
        return float(2 * np.tan(self.fov_y / 2) / height)

    def lens(self, height: float) -> float:
        """Pixels for a slope of 1, in a picture so many pixels high."""
        return float(0.5 * height / np.tan(self.fov_y / 2))

    def places(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n, 2) where points (n, 3) show, in half-heights of the picture from its middle, y up;
        of what is not before the eye it says nothing."""
        seen = (points - self.eye) @ self.rotation
        with np.errstate(divide="ignore", invalid="ignore"):
            return seen[:, :2] / -seen[:, 2:] / np.tan(self.fov_y / 2)

    def depth(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) signed distance of (n, 3) points from the eye along the view vector (Elmqvist2009
        §V-B)."""
        return (points - self.eye) @ self.forward


def look_at(
    eye: NDArray[np.float64],
    center: NDArray[np.float64],
    up: tuple[float, float, float] = (0.0, 1.0, 0.0),
    **lens: float,
) -> Camera:
    """A camera at `eye` that sees `center` in the middle; `lens` takes fov_y, near and far."""
    back = np.asarray(eye, float) - np.asarray(center, float)
    length = np.linalg.norm(back)
    right = np.cross(up, back)
    if length == 0 or np.linalg.norm(right) <= 1e-12 * length:
        raise ValueError(
            f"eye {eye} and center {center} leave no direction to look in under up {up}"
        )
    back = back / length
    right = right / np.linalg.norm(right)
    rotation = np.stack([right, np.cross(back, right), back], axis=1)
    return Camera(np.asarray(eye, float), rotation, **lens)
