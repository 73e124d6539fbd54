"""Looks made by chance, for tests of what keeps them."""

import numpy as np

from seethrough.renderer.scene.visibility import Visibility

ARRAYS = ("pixels", "weight", "position", "contrast", "area")


def same_look(a, b):
    """Whether two looks are the same to the last bit."""
    return all(np.array_equal(getattr(a, n), getattr(b, n), equal_nan=True) for n in ARRAYS)


def random_look(seed, n=12):
    """A look at n objects, of which some two fifths are hidden."""
    rng = np.random.default_rng(seed)
    pixels = rng.integers(0, 50, n) * (rng.random(n) < 0.6)
    seen = pixels > 0
    position = np.where(seen[:, None], rng.random((n, 2)), np.nan)
    return Visibility(pixels, rng.random(n) * seen, position, rng.random(n) * seen,
                      rng.random(n) * seen)  # fmt: skip
