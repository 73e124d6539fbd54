"""Blueprints (Nienhaus and Döllner 2004): the edges of every layer over a faint fill.

The layers of what may be penetrated are peeled from the front. A pixel of a layer is on an edge
where one of its four neighbours in the layer shows another object, nothing, or a surface turned
away by more than an angle; there it is the line's colour, elsewhere a faint fill. Targets are drawn
as ever, beneath. Where many layers lie behind one another, their lines clutter the picture.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seethrough.renderer.declared import key
from seethrough.renderer.techniques.base import Bools, Shot
from seethrough.renderer.techniques.layered import Layered, Layering
from seethrough.renderer.techniques.lines import LINE, on_edges, unsure
from seethrough.renderer.techniques.seen import Look, Surfaces


@dataclass(frozen=True)
class BlueprintParameters(Layered):
    """How strong lines and fill are, and what an edge is."""

    layers: int | None = key(
        4, "layers that are drawn at a pixel, from the front: what lies behind them and is not "
        "opaque is lost", low=1, high=10_000,
    )  # fmt: skip
    fill: float = key(0.08, "opacity of a surface between its edges", low=0.01, high=0.99)
    line: float = key(0.75, "opacity of an edge", low=0.01, high=0.99)
    crease: float = key(
        0.6, "between the normals of neighbours, from which on there is an edge", "radians",
        low=0.1, high=1.5,
    )  # fmt: skip


class Blueprint(Layering[BlueprintParameters, None, tuple[Bools, Bools]]):
    """Lines of all layers."""

    name = "blueprint"
    title = "Blueprint"
    instruction = "Things are drawn as lines, with a faint fill, so that lines behind lines show."
    source = "Nienhaus2004"
    misses = "misses R2 or R5; R7"
    Parameters = BlueprintParameters
    strength = "uniform float fill;\nfloat opacity_of(Surface s) { return fill; }\n"

    def known(self, p: BlueprintParameters, state: None, seen: Surfaces) -> tuple[Bools, Bools]:
        """(m,) which surfaces are on an edge, and for which that is in doubt."""
        ruled = self.objects(p, seen.shot.scene)[seen.object] != 0
        kept = seen.front | (ruled & (p.surfaces == "all"))
        rows = np.nonzero(kept & ruled & (seen.depth < seen.nearest(kept & ~ruled)[seen.pixel]))[0]
        first = np.searchsorted(seen.pixel[rows], seen.pixel[rows])
        layer = np.arange(len(rows)) - first
        if p.layers is not None:
            rows, layer = rows[layer < p.layers], layer[layer < p.layers]
        return on_edges(seen, rows, layer, p.crease, unsure(seen, rows, p.surfaces == "all"))

    def rule(
        self, p: BlueprintParameters, state: None, seen: Surfaces, known: tuple[Bools, Bools]
    ) -> Look:
        """Lines on edges, a faint fill elsewhere."""
        edge, doubt = known
        found = self.look(p, seen, np.where(edge, p.line, p.fill), doubt)
        tint = np.zeros((len(edge), 4))
        tint[edge] = (*LINE, 1.0)
        return Look(found.kept, found.opacity, tint, found.doubt)

    def uniforms(self, p: BlueprintParameters, state: None, shot: Shot) -> dict[str, object]:
        """The fill."""
        return {**super().uniforms(p, state, shot), "fill": p.fill}

    def edges(self, p: BlueprintParameters) -> dict[str, object]:
        """The lines, as shaders/edges.frag draws them."""
        return {"line": (*LINE, p.line), "crease": float(np.cos(p.crease))}


TECHNIQUE = Blueprint()
