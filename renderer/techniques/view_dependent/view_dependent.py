"""View-dependent transparency (Diepstraten and others 2002): what faces the viewer is clear.

A surface's opacity rises from `least`, where its normal points at the eye, to `most` at its
silhouette, by 1 − |cos|^falloff: outlines stay, what lies within them is seen through. The front
`layers` are drawn; what is deeper and not opaque stays hidden. A flat wall that faces the viewer
has nothing left of it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seethrough.renderer.declared import key
from seethrough.renderer.techniques.base import Shot
from seethrough.renderer.techniques.layered import Layered, Layering
from seethrough.renderer.techniques.seen import Look, Surfaces


@dataclass(frozen=True)
class ViewDependentParameters(Layered):
    """How opacity falls from the silhouette."""

    layers: int | None = key(
        2, "layers that are drawn at a pixel, from the front: what lies behind them and is not "
        "opaque is lost", low=1, high=10_000,
    )  # fmt: skip
    least: float = key(0.1, "opacity where a surface faces the viewer", low=0, high=1)
    most: float = key(0.9, "opacity at its silhouette", low=0, high=1)
    falloff: float = key(1.0, "how soon opacity falls from the silhouette", low=0.05, high=50)


class ViewDependent(Layering[ViewDependentParameters]):
    """Clear within, opaque along silhouettes."""

    name = "view_dependent"
    title = "View-dependent transparency"
    instruction = "Things are transparent where they face you, and opaque along their outlines."
    source = "Diepstraten2002"
    misses = "misses R2 or R5; R7"
    Parameters = ViewDependentParameters
    strength = """
uniform float least;
uniform float most;
uniform float falloff;
float opacity_of(Surface s) {
    float facing = abs(dot(normalize(s.normal), normalize(s.offset)));
    return mix(least, most, 1.0 - pow(facing, falloff));
}
"""

    def rule(
        self, p: ViewDependentParameters, state: object, seen: Surfaces, known: object
    ) -> Look:
        """By the angle between normal and line of sight."""
        lengths = np.linalg.norm(seen.normal, axis=1) * np.linalg.norm(seen.offset, axis=1)
        facing = np.abs((seen.normal * seen.offset).sum(axis=1)) / np.maximum(lengths, 1e-300)
        alpha = p.least + (p.most - p.least) * (1 - np.minimum(facing, 1.0) ** p.falloff)
        return self.look(p, seen, alpha)

    def uniforms(self, p: ViewDependentParameters, state: object, shot: Shot) -> dict[str, object]:
        """The curve."""
        curve = {"least": p.least, "most": p.most, "falloff": p.falloff}
        return {**super().uniforms(p, state, shot), **curve}


TECHNIQUE = ViewDependent()
