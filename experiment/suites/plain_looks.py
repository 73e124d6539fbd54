"""Eyes for suites: whatever lies in the view is seen, large and clear, and nothing hides it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.scene.visibility import Visibility
from seethrough.tasks.kit.base import View

NEAREST = 0.5  # world units: what is nearer is not looked at
PIXELS, PICTURE = 400, 30_000  # that show each thing, of the id picture's
CONTRAST = 0.6


def plain_look(view: View, aspect: float, shown: NDArray[np.bool_] | None = None) -> Visibility:
    """What is in the view; `shown` (n,) leaves some of it out. Walls are seen wherever they are."""
    camera, scene = view.camera, view.scene
    local = (scene.centers - camera.eye) @ camera.rotation
    depth = -local[:, 2]
    half = np.tan(camera.fov_y / 2)
    with np.errstate(divide="ignore", invalid="ignore"):
        x = aspect / 2 + local[:, 0] / depth / half / 2
        y = 0.5 - local[:, 1] / depth / half / 2
    inside = (depth > NEAREST) & (np.abs(x - aspect / 2) < aspect / 2) & (np.abs(y - 0.5) < 0.5)
    seen: NDArray[np.bool_] = inside | _walls(view)
    if shown is not None:
        seen &= shown
    position = np.where(seen[:, None], np.stack([x, y], axis=1), np.nan)
    on = seen.astype(float)
    area = PIXELS / PICTURE * on
    return Visibility(np.where(seen, PIXELS, 0), on, position, CONTRAST * on, area)


def _walls(view: View) -> NDArray[np.bool_]:
    kinds = [thing.kind for thing in view.scene.objects]
    return np.array([kind in ("wall", "outer wall") for kind in kinds], dtype=bool)
