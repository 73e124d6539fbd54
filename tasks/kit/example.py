"""Cameras for the picture on a task's instruction page, from which the best is chosen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import atan, atan2, pi

import numpy as np

from seethrough.renderer.scene.camera import Camera
from seethrough.tasks.kit.controls import Orbit, changed
from seethrough.tasks.kit.visit import Visit

YAWS = 8  # of an orbit
AWAY, DIRECTIONS = (7.5, 10.0), 6  # world units from a thing in the building, and sides of it
MOST_THINGS = 2  # of those asked for in a building, to stand before
ROOM = 0.5  # world units between the camera and any thing


def around(orbit: Orbit, pitches: Sequence[float], aspect: float) -> tuple[Camera, ...]:
    """Cameras all around the cube, which fills a picture of that width / height."""
    half = orbit.reach / 3**0.5
    corners = half * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    found = []
    for pitch in pitches:
        for k in range(YAWS):
            camera = changed(orbit, yaw=2 * pi * k / YAWS, pitch=pitch).camera()
            seen = (corners - camera.eye) @ camera.rotation
            across = np.abs(seen[:, :2]) / -seen[:, 2:] / [aspect, 1.0]
            found.append(replace(camera, fov_y=2 * atan(float(across.max()))))
    return tuple(found)


def before(visit: Visit) -> tuple[Camera, ...]:
    """Cameras at eye height that look at a thing asked for, from every side."""
    scene, p, found = visit.building.scene, visit.building.parameters, []
    movable = [i for i, o in enumerate(scene.objects) if o.target]
    things, sizes = scene.centers[movable][:, [0, 2]], scene.radii[movable]
    for thing in visit.building.asked_objects[:MOST_THINGS]:
        x, _, z = scene.centers[thing]
        for distance in AWAY:
            for k in range(DIRECTIONS):
                angle = 2 * pi * k / DIRECTIONS
                at = np.array([x + distance * np.cos(angle), z + distance * np.sin(angle)])
                free = (np.hypot(*(things - at).T) > sizes + ROOM).all()
                if free and (np.abs(at) < p.side / 2 - ROOM).all():
                    yaw = atan2(at[0] - x, at[1] - z)
                    walk = changed(visit.walk, x=float(at[0]), z=float(at[1]), yaw=yaw)
                    found.append(walk.camera())
    return (*found, visit.walk.camera())
