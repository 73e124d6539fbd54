"""See-through surfaces (Chittaro and Scagnetto 2001): some things, as walls, are transparent.

Which ones, the study says by their kind; targets and what is impenetrable stay opaque.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.declared import key
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.base import Shot
from seethrough.renderer.techniques.layered import Layered, Layering
from seethrough.renderer.techniques.seen import Look, Surfaces


@dataclass(frozen=True)
class SeeThroughParameters(Layered):
    """Which things are transparent, and how much."""

    alpha: float = key(0.3, "opacity of their surfaces", low=0, high=1)
    kinds: tuple[str, ...] = key(("wall",), "kinds of things that are transparent")


class SeeThrough(Layering[SeeThroughParameters]):
    """One opacity for things of some kinds."""

    name = "see_through"
    title = "See-through surfaces"
    instruction = "Walls are transparent."
    source = "Chittaro2001"
    misses = "misses R2 or R5; R7"
    Parameters = SeeThroughParameters
    strength = "uniform float alpha;\nfloat opacity_of(Surface s) { return alpha; }\n"

    def objects(self, p: SeeThroughParameters, scene: Scene) -> NDArray[np.int64]:
        """1 what is of one of the kinds."""
        kinds = np.array([thing.kind in p.kinds for thing in scene.objects], dtype=bool)
        return (kinds & ~scene.targets & ~scene.impenetrable).astype(np.int64)

    def rule(self, p: SeeThroughParameters, state: object, seen: Surfaces, known: object) -> Look:
        """The same for each surface of the kinds."""
        return self.look(p, seen, np.full(len(seen.depth), p.alpha))

    def uniforms(self, p: SeeThroughParameters, state: object, shot: Shot) -> dict[str, object]:
        """The opacity."""
        return {**super().uniforms(p, state, shot), "alpha": p.alpha}


TECHNIQUE = SeeThrough()
