"""Affine 4 × 4 matrices for column vectors, float64 (CONVENTIONS.md). Angles in radians."""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.random import Generator
from numpy.typing import ArrayLike, NDArray


def translation(x: float, y: float, z: float) -> NDArray[np.float64]:
    """(4, 4) moves by (x, y, z)."""
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def scaling(x: float, y: float | None = None, z: float | None = None) -> NDArray[np.float64]:
    """(4, 4) stretches along the axes; one number alone stretches all three."""
    return np.diag([x, x if y is None else y, x if z is None else z, 1.0])


def rotation(axis: ArrayLike, angle: float) -> NDArray[np.float64]:
    """(4, 4) turns by `angle` about `axis` (3,), right-handed (Rodrigues' formula)."""
    direction = np.asarray(axis, float)
    length = np.linalg.norm(direction)
    if not (np.isfinite(length) and length > 0):
        raise ValueError(f"axis = {axis!s}, expected a direction of length > 0")
    x, y, z = direction / length
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    matrix = np.eye(4)
    matrix[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return matrix


def rotation_x(angle: float) -> NDArray[np.float64]:
    """(4, 4) turns about +x."""
    return rotation((1, 0, 0), angle)


def rotation_y(angle: float) -> NDArray[np.float64]:
    """(4, 4) turns about +y: a yaw, positive to the left."""
    return rotation((0, 1, 0), angle)


def rotation_z(angle: float) -> NDArray[np.float64]:
    """(4, 4) turns about +z."""
    return rotation((0, 0, 1), angle)


def random_rotation(rng: Generator) -> NDArray[np.float64]:
    """(4, 4) uniform over all orientations (Shoemake 1992, uniform random rotations)."""
    u, v, w = rng.random(3).tolist()  # plain floats: NumPy's cost ten times as much one by one
    a, b = 2 * np.pi * v, 2 * np.pi * w
    s, c = sqrt(1 - u), sqrt(u)
    sin_a, cos_a, sin_b, cos_b = (float(f(angle)) for angle in (a, b) for f in (np.sin, np.cos))
    x, y, z, t = s * sin_a, s * cos_a, c * sin_b, c * cos_b
    matrix = np.eye(4)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * t), 2 * (x * z + y * t)],
        [2 * (x * y + z * t), 1 - 2 * (x * x + z * z), 2 * (y * z - x * t)],
        [2 * (x * z - y * t), 2 * (y * z + x * t), 1 - 2 * (x * x + y * y)],
    ]
    return matrix


def placed(
    position: ArrayLike, turn: NDArray[np.float64] | None = None, scale: ArrayLike = 1.0
) -> NDArray[np.float64]:
    """(4, 4) that first stretches by `scale` (one number or three), then turns, then moves."""
    matrix = np.eye(4) if turn is None else turn.copy()
    matrix[:3, :3] *= np.asarray(scale, float)
    matrix[:3, 3] = position
    return matrix


def moved(points: NDArray[np.float64], matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 3) points under the affine (4, 4) matrix."""
    return points @ matrix[:3, :3].T + matrix[:3, 3]
