"""Planes between objects that no plane of the separating-axis test separates.

A pair of convex hulls that do not meet has a plane between them, and the one on the eye's side is
in front at every pixel, wherever the eye is: the plane is found once, and kept with the scene.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats, Ints, Signs
from seethrough.renderer.plan.comparing import BEHIND, IN_FRONT, NEITHER, UNCERTAIN
from seethrough.renderer.scene.scene import Scene

STEPS = 100  # a gap of a hundredth of the objects' size is found in far fewer
SLACK = 1e-7  # of the objects' size: a narrower gap is none


@njit(cache=True)
def separate(a: Floats, b: Floats, slack: float) -> Floats:
    """(5,) a normal, the least of a (n, 3) and the greatest of b (m, 3) along it, if it separates
    them by more than `slack`; else zeros.

    Gilbert's algorithm: walk to the point of a − b that is nearest to 0; any normal on the way
    along which all of a lies beyond all of b is good enough.
    """
    v = np.zeros(3)
    for k in range(3):
        v[k] = a[:, k].mean() - b[:, k].mean()
    out = np.zeros(5)
    for _ in range(STEPS):
        length = np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
        if length <= slack:
            return out
        least, most, i, j = np.inf, -np.inf, 0, 0
        for p in range(len(a)):
            d = v[0] * a[p, 0] + v[1] * a[p, 1] + v[2] * a[p, 2]
            if d < least:
                least, i = d, p
        for p in range(len(b)):
            d = v[0] * b[p, 0] + v[1] * b[p, 1] + v[2] * b[p, 2]
            if d > most:
                most, j = d, p
        if least - most > slack * length:
            out[:3], out[3], out[4] = v / length, least / length, most / length
            return out
        # The point nearest to 0 between v and the corner w: no point of a − b is less far along v
        # than w is, so v·e ≥ 0, and v·w ≤ 0 but for the slack, so v·e ≤ e·e.
        w = a[i] - b[j]
        e = v - w
        square = e[0] * e[0] + e[1] * e[1] + e[2] * e[2]
        if square == 0:
            return out
        t = (v[0] * e[0] + v[1] * e[1] + v[2] * e[2]) / square
        v = v - t * e
    return out


@dataclass(eq=False)
class Separations:
    """What is known of a scene of n objects: `tried` (n, n), the `pairs` (k, 2) between which a
    plane was found, and the `planes` (k, 5) as `separate` gives them."""

    tried: NDArray[np.bool_]
    pairs: NDArray[np.int64] = field(default_factory=lambda: np.zeros((0, 2), np.int64))
    planes: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 5)))

    def relation(self, eye: NDArray[np.float64]) -> NDArray[np.int8]:
        """(n, n) who is in front of whom as seen from `eye`, UNCERTAIN where no plane is known."""
        return _known(len(self.tried), self.pairs, self.planes, eye)

    def learn(self, pairs: NDArray[np.int64], scene: Scene) -> bool:
        """Look for planes between (k, 2) objects not tried yet; whether any was found."""
        found, planes = [], []
        for i, j in pairs.tolist():
            if self.tried[i, j]:
                continue
            self.tried[i, j] = self.tried[j, i] = True
            middle = (scene.centers[i] + scene.centers[j]) / 2
            a, b = (_points(scene, k) - middle for k in (i, j))
            slack = SLACK * float(scene.radii[i] + scene.radii[j])
            plane = separate(np.ascontiguousarray(a), np.ascontiguousarray(b), slack)
            if plane[:3].any():
                plane[3:] += plane[:3] @ middle
                found.append((i, j))
                planes.append(plane)
        if found:
            self.pairs = np.concatenate([self.pairs, found])
            self.planes = np.concatenate([self.planes, planes])
        return bool(found)


@njit(cache=True)
def _known(n: int, pairs: Ints, planes: Floats, eye: Floats) -> Signs:
    """(n, n) as Separations.relation says."""
    known = np.full((n, n), UNCERTAIN, np.int8)
    for k in range(len(pairs)):
        at = planes[k, 0] * eye[0] + planes[k, 1] * eye[1] + planes[k, 2] * eye[2]
        way = IN_FRONT if at >= planes[k, 3] else NEITHER
        if at <= planes[k, 4]:
            way = BEHIND
        known[pairs[k, 0], pairs[k, 1]], known[pairs[k, 1], pairs[k, 0]] = way, -way
    return known


@njit(cache=True)
def away(pairs: Ints, planes: Floats, eye: Floats, i: int, j: int) -> float:
    """How far an eye is from where i begins, or ceases, to be in front of j by a plane between them
    (Separations); infinite where none is known."""
    for k in range(len(pairs)):
        a, b = pairs[k]
        if (a == i and b == j) or (a == j and b == i):
            at = planes[k, 0] * eye[0] + planes[k, 1] * eye[1] + planes[k, 2] * eye[2]
            return abs(at - planes[k, 3 if a == i else 4])
    return np.inf


def _points(scene: Scene, i: int) -> NDArray[np.float64]:
    matrix = scene.objects[i].transform
    return scene.objects[i].mesh.vertices @ matrix[:3, :3].T + matrix[:3, 3]
