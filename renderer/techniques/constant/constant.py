"""Constant transparency, by depth peeling (Everitt 2001): every surface has the same opacity.

It needs no targets. What is lost where only some layers are peeled shows what accuracy in ordering
is worth.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.declared import key
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.base import Look, Own, Shot, Surfaces
from seethrough.renderer.techniques.layered import Layered, Layering

THINGS = ("distractors", "everything")


@dataclass(frozen=True)
class ConstantParameters(Layered):
    """What is transparent, and how much."""

    alpha: float = key(0.3, "opacity of each surface", low=0, high=1)
    things: str = key("distractors", "what is transparent: targets stay opaque, or not",
                      choices=THINGS)  # fmt: skip


class Constant(Layering):
    """One opacity for all."""

    name = "constant"
    title = "Constant transparency"
    instruction = "Whatever could be in the way is equally transparent everywhere."
    source = "Everitt2001"
    Parameters = ConstantParameters
    strength = "uniform float alpha;\nfloat opacity_of(Surface s) { return alpha; }\n"

    def objects(self, p: ConstantParameters, scene: Scene) -> NDArray[np.int64]:
        """1 what is transparent."""
        open_ = ~scene.impenetrable & (~scene.targets | (p.things == "everything"))
        return open_.astype(np.int64)

    def rule(self, p: ConstantParameters, state: Own, seen: Surfaces, known: Own) -> Look:
        """The same for each surface."""
        return self.look(p, seen, np.full(len(seen.depth), p.alpha))

    def uniforms(self, p: ConstantParameters, state: Own, shot: Shot) -> dict[str, object]:
        """The opacity."""
        return {**super().uniforms(p, state, shot), "alpha": p.alpha}


TECHNIQUE = Constant()
