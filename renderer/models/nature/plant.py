"""A potted palm."""

from __future__ import annotations

import numpy as np

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.forms.shapes import Shape, assemble, join
from seethrough.renderer.models.forms.surfaces import curve, lathe, sweep, tube


def plant() -> Shape:
    """A house plant with long bowed leaves in a clay pot."""
    clay, soil, stem = (0.72, 0.36, 0.20), (0.20, 0.13, 0.08), (0.38, 0.48, 0.20)
    pot = lathe(
        [(0, 0), (0.17, 0), (0.25, 0.38), (0.29, 0.38), (0.30, 0.47), (0.25, 0.47), (0.24, 0.42),
         (0, 0.42)], clay, 40,
    ).painted(soil, lambda p: (np.hypot(p[:, 0], p[:, 2]) < 0.2) & (p[:, 1] > 0.415))  # fmt: skip
    rng = np.random.default_rng(3)
    rings = [_leaf(0.95 - 0.1 * ring, 0.32 + 0.30 * ring) for ring in range(3)]
    leaves = []
    for i in range(22):
        ring, angle = divmod(i, 8)
        turn = 45 * angle + 22 * ring + rng.uniform(-8, 8)
        leaves.append(rings[ring].scaled(rng.uniform(0.9, 1.1)).turned("y", turn).at(y=0.42))
    trunk = sweep(curve([(0, 0.4, 0), (0.01, 0.6, 0), (0, 0.75, 0)], 6), 0.045, stem, 10)
    return assemble(pot, trunk, join(*leaves), size=1.6)


def _leaf(reach: float, rise: float) -> Shape:
    """A bowed blade from the origin out along −z, folded along its middle."""
    green, pale = (0.13, 0.46, 0.16), (0.42, 0.66, 0.26)
    spine = curve(
        [(0, 0.1, -0.02), (0, 0.45 + rise, -0.28 * reach), (0, 0.55 + rise, -0.62 * reach),
         (0, 0.30 + rise * 0.8, -reach)], 28
    )  # fmt: skip
    t = np.linspace(0, 1, 28)
    half = 0.085 * np.sin(np.pi * np.clip(t * 0.97 + 0.03, 0, 1)) ** 0.7 + 0.004
    tangent = np.gradient(spine, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    rings = np.stack([_section(*at) for at in zip(spine, tangent, half, strict=True)])
    return tube(rings, green, sharp=70).tinted(pale, lambda p: 1 - np.abs(p[:, 0]) / 0.03)


def _section(middle: Floats, tangent: Floats, half: float) -> Floats:
    """A flat V across the blade, 6 corners; the blade lies in the plane x = 0."""
    across = np.array([half, 0.0, -half, -half, 0.0, half])
    up = np.array([0.032, 0.01, 0.032, 0.018, -0.004, 0.018]) * min(1.0, half / 0.03)
    normal = np.array([0.0, -tangent[2], tangent[1]])
    return middle + across[::-1, None] * (1, 0, 0) + up[::-1, None] * normal
