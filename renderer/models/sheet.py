"""A contact sheet: every model once, in rows, as a scene of its own."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.models import MODELS
from seethrough.renderer.models.forms.outline import view_axes
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Object, Scene

YAW, PITCH = 0.61, 0.31
"""Radians: seen from the right of the front and from above, so that front, side and top show."""


def contact_sheet_scene(
    aspect: float = 1.0,
    names: Sequence[str] | None = None,
    yaw: float = YAW,
    pitch: float = PITCH,
) -> tuple[Scene, Camera]:
    """Models in rows from the upper left, each as large as its cell of the picture allows.

    `aspect` is the picture's width / height; `names` are keys of MODELS, by default all of them.
    The viewer of each model is `yaw` right of its front and `pitch` above it, in radians.
    """
    names = list(MODELS) if names is None else list(names)
    columns, rows = grid(len(names), aspect)
    turn = view_axes(yaw, pitch)
    objects = []
    for i, name in enumerate(names):
        mesh = MODELS[name]()
        place = np.array([i % columns - (columns - 1) / 2, (rows - 1) / 2 - i // columns, 0.0])
        objects.append(Object(mesh, _fitted(turn, mesh.vertices, place), kind=name))
    return Scene(tuple(objects)), _camera(max(rows, columns / aspect), max(rows, columns))


def grid(count: int, aspect: float) -> tuple[int, int]:
    """Columns and rows of square cells that hold `count` models in a picture of that aspect."""
    columns = max(1, int(np.ceil(np.sqrt(count * aspect) - 1e-9)))
    return columns, -(-count // columns)


def _fitted(
    turn: NDArray[np.float64], vertices: NDArray[np.float64], place: NDArray[np.float64]
) -> NDArray[np.float64]:
    """World ← mesh for a model whose picture fills the cell of width 1 about `place`."""
    seen = vertices @ turn.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    scale = 0.92 / (high - low)[:2].max()
    transform = np.eye(4)
    transform[:3, :3] = scale * turn
    transform[:3, 3] = place - scale * (low + high) / 2
    return transform


def _camera(height: float, extent: float) -> Camera:
    """Far off on the +z side, so that cells at the border look like those in the middle."""
    distance = 12.0 * extent
    fov = 2 * np.arctan(height / 2 / distance)
    eye = np.array([0.0, 0.0, distance])
    return Camera(eye, np.eye(3), fov, near=distance - 2.0, far=distance + 2.0)
