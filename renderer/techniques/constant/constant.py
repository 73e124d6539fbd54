"""Constant transparency, by depth peeling (Everitt 2001): every surface has the same opacity.

It needs no targets. What is lost where only some layers are peeled shows what accuracy in ordering
is worth.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.declared import key
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.base import Shot
from seethrough.renderer.techniques.layered import Layered, Layering
from seethrough.renderer.techniques.seen import Look, Surfaces

THINGS = ("distractors", "everything")
PIXEL = "pixel"
# How surfaces are put in order: by pixel, which is right, or their polygons by a method of
# renderer/polygons: cut where that is needed (bsp, feudal), or as they are.
ORDERS = (PIXEL, "boxes", "bsp", "feudal", "distance", "axis_tree")


@dataclass(frozen=True)
class ConstantParameters(Layered):
    """What is transparent, how much, and by what its surfaces are put in order."""

    alpha: float = key(0.3, "opacity of each surface", low=0, high=1)
    things: str = key("distractors", "what is transparent: targets stay opaque, or not",
                      choices=THINGS)  # fmt: skip
    order: str = key(
        PIXEL, "by what surfaces are put in order: pixel by pixel, or polygon by polygon by a "
        "method that may be wrong", choices=ORDERS,
    )  # fmt: skip

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.order != PIXEL and self.layers is not None:
            raise ValueError(
                f"constant transparency: layers = {self.layers}, expected none with "
                f'order = "{self.order}", which peels nothing'
            )


class Constant(Layering[ConstantParameters]):
    """One opacity for all."""

    name = "constant"
    title = "Constant transparency"
    instruction = "Whatever could be in the way is equally transparent everywhere."
    source = "Everitt2001"
    misses = "misses R2 or R5; R7"
    Parameters = ConstantParameters
    strength = "uniform float alpha;\nfloat opacity_of(Surface s) { return alpha; }\n"

    def objects(self, p: ConstantParameters, scene: Scene) -> NDArray[np.int64]:
        """1 what is transparent."""
        open_ = ~scene.impenetrable & (~scene.targets | (p.things == "everything"))
        return open_.astype(np.int64)

    def rule(self, p: ConstantParameters, state: object, seen: Surfaces, known: object) -> Look:
        """The same for each surface."""
        return self.look(p, seen, np.full(len(seen.depth), p.alpha))

    def order(self, p: ConstantParameters) -> str | None:
        """As the study has it."""
        return None if p.order == PIXEL else p.order

    def looked_at(self, p: ConstantParameters) -> ConstantParameters:
        """Polygons have no numbers of their objects: what they show is looked for by pixel."""
        return self.exactly(p)

    def exactly(self, p: ConstantParameters) -> ConstantParameters:
        """Pixel by pixel."""
        return replace(p, order=PIXEL)

    def uniforms(self, p: ConstantParameters, state: object, shot: Shot) -> dict[str, object]:
        """The opacity."""
        return {**super().uniforms(p, state, shot), "alpha": p.alpha}


TECHNIQUE = Constant()
