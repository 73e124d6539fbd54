"""What a frame shows at a place of the view: the thing that a click there means.

Worked out from all surfaces at the place and from the technique's rule, as the exact picture is
(reference.py), so that it is the same on every machine and in a replay, and needs no graphics card.
"""

from __future__ import annotations

import numpy as np

from seethrough.renderer.arrays import Bools, Floats
from seethrough.renderer.reference.reference import exact_shares
from seethrough.renderer.reference.surfaces import surfaces
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.base import Parameters, Plain, Shot

NOTHING = -1
ROUND = 3  # pixels about the place that are looked at: a line is as wide


def pointed(shot: Shot, technique: Parameters, state: object, place: tuple[float, float]) -> int:
    """The index of the object that shows most at a place (x, y in view units), the nearest of
    equal ones; −1 where that is the background, or nothing of the scene.

    What a technique makes of a pixel depends on the targets and on what lies at the pixel (its
    rule), so that nothing else is looked at.
    """
    rules = technique.technique
    shown = rules.shown(technique, state, shot).scene
    width, height = shot.size
    column = min(max(int(place[0] * height), 0), width - 1)
    row = min(max(int(place[1] * height), 0), height - 1)
    near = _on_ray(shown, shot.camera, _direction(shot, column + 0.5, row + 0.5))
    if not near.any():
        return NOTHING
    # Without anything that is not local to a pixel, targets elsewhere are nothing to it.
    local = is_local(technique)
    among = np.nonzero(near if local else near | shown.targets)[0]
    part = Scene(tuple(shown.objects[i] for i in among), shown.background)
    window = [row - ROUND, row + ROUND, column - ROUND, column + ROUND]
    parts = np.tile(
        np.clip(window, 0, [height - 1, height - 1, width - 1, width - 1]), (len(among), 1)
    )
    if not local:
        parts[part.targets] = [0, height - 1, 0, width - 1]
    seen, _ = surfaces(Shot(part, shot.camera, shot.size, shot.scale), parts)
    look = rules.rule(technique, state, seen, rules.known(technique, state, seen))
    objects, shares = exact_shares(seen, look, row * width + column)
    if not len(objects):
        return NOTHING
    total = np.bincount(objects, shares, len(part.objects))
    best = int(objects[np.argmax(total[objects])])  # from the front: the nearest of equal ones
    found = int(among[best])
    hidden = 1.0 - float(shares.sum()) > float(total[best])
    return NOTHING if hidden or found >= len(shot.scene.objects) else found


def is_local(technique: Parameters) -> bool:
    """Whether all that a technique's rule knows of a surface lies at its pixel: then a click costs
    little at any size."""
    return getattr(type(technique.technique), "known", None) is Plain.known


def _direction(shot: Shot, column: float, row: float) -> Floats:
    """(3,) from the eye through a place in pixels, in the world, of length 1."""
    slope = shot.camera.pixel(shot.size[1])
    across, up = column - shot.size[0] / 2, shot.size[1] / 2 - row
    way: Floats = shot.camera.rotation @ np.array([across * slope, up * slope, -1.0])
    return way / float(np.linalg.norm(way))


def _on_ray(scene: Scene, camera: Camera, way: Floats) -> Bools:
    """(n,) objects whose sphere the ray from the eye meets, or holds the eye."""
    to = scene.centers - camera.eye
    along = np.maximum(to @ way, 0.0)
    away = np.linalg.norm(to - along[:, None] * way, axis=1)
    found: Bools = away <= scene.radii * (1 + 1e-9)
    return found
