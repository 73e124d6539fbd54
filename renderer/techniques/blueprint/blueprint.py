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
from seethrough.renderer.techniques.base import Bools, Indices, Look, Own, Shot, Surfaces
from seethrough.renderer.techniques.layered import Layered, Layering

LINE = (0.12, 0.2, 0.45)
NEIGHBOURS = ((0, 1), (0, -1), (1, 0), (-1, 0))


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


class Blueprint(Layering):
    """Lines of all layers."""

    name = "blueprint"
    title = "Blueprint"
    instruction = "Things are drawn as lines, with a faint fill, so that lines behind lines show."
    source = "Nienhaus2004"
    Parameters = BlueprintParameters
    strength = "uniform float fill;\nfloat opacity_of(Surface s) { return fill; }\n"

    def known(self, p: BlueprintParameters, state: Own, seen: Surfaces) -> tuple[Bools, Bools]:
        """(m,) which surfaces are on an edge, and for which that is in doubt."""
        ruled = self.objects(p, seen.shot.scene)[seen.object] != 0
        kept = seen.front | (ruled & (p.surfaces == "all"))
        rows = np.nonzero(kept & ruled & (seen.depth < seen.nearest(kept & ~ruled)[seen.pixel]))[0]
        first = np.searchsorted(seen.pixel[rows], seen.pixel[rows])
        layer = np.arange(len(rows)) - first
        if p.layers is not None:
            rows, layer = rows[layer < p.layers], layer[layer < p.layers]
        return _edges(p, seen, rows, layer)

    def rule(
        self, p: BlueprintParameters, state: Own, seen: Surfaces, known: tuple[Bools, Bools]
    ) -> Look:
        """Lines on edges, a faint fill elsewhere."""
        edge, doubt = known
        found = self.look(p, seen, np.where(edge, p.line, p.fill), doubt)
        tint = np.zeros((len(edge), 4))
        tint[edge] = (*LINE, 1.0)
        return Look(found.kept, found.opacity, tint, found.doubt)

    def uniforms(self, p: BlueprintParameters, state: Own, shot: Shot) -> dict[str, object]:
        """The fill."""
        return {**super().uniforms(p, state, shot), "fill": p.fill}

    def edges(self, p: BlueprintParameters) -> dict[str, object]:
        """The lines, as shaders/edges.frag draws them."""
        return {"line": (*LINE, p.line), "crease": float(np.cos(p.crease))}


def _edges(
    p: BlueprintParameters, seen: Surfaces, rows: Indices, layer: Indices
) -> tuple[Bools, Bools]:
    """Whether rows, in these layers, are on an edge, and whether that is in doubt (m,)."""
    width, height = seen.shot.size
    shape = (int(layer.max(initial=-1)) + 1, height + 2, width + 2)
    row, column = np.divmod(seen.pixel[rows], width)
    here = (layer, row + 1, column + 1)
    number = np.zeros(shape, np.int64)
    number[:, 0], number[:, -1], number[:, :, 0], number[:, :, -1] = -1, -1, -1, -1
    number[here] = seen.object[rows] + 1
    normal = np.zeros((*shape, 3))
    length = np.linalg.norm(seen.normal[rows], axis=1, keepdims=True)
    normal[here] = seen.normal[rows] / np.maximum(length, 1e-300)
    unsure = np.zeros((height + 2, width + 2), dtype=bool)
    unsure[1:-1, 1:-1] = _unsure(p, seen, rows).reshape(height, width)
    edge, sure, maybe = (np.zeros(len(rows), dtype=bool) for _ in range(3))
    for down, right in NEIGHBOURS:
        there = (layer, row + 1 + down, column + 1 + right)
        turned = (normal[here] * normal[there]).sum(axis=1) - np.cos(p.crease)
        same = number[here] == number[there]
        within = number[there] >= 0
        differs = within & (~same | (turned < 0))
        open_ = within & (unsure[there[1:]] | (same & (np.abs(turned) < 1e-4)))
        edge |= differs
        sure |= differs & ~open_
        maybe |= open_
    found, doubt = np.zeros(len(seen.depth), dtype=bool), np.zeros(len(seen.depth), dtype=bool)
    found[rows] = edge
    # What is in doubt counts only where no other neighbour decides.
    doubt[rows] = (maybe & ~sure) | unsure[here[1:]]
    return found, doubt


def _unsure(p: BlueprintParameters, seen: Surfaces, rows: Indices) -> Bools:
    """(h·w,) pixels at which float32 may find other layers."""
    found = seen.edge.copy() if p.surfaces == "front" else seen.edges.copy()
    pixel, depth, slack = seen.pixel[rows], seen.depth[rows], seen.slack[rows]
    close = (np.diff(pixel) == 0) & (np.diff(depth) <= slack[1:] + slack[:-1])
    found[pixel[1:][close]] = True
    return found


TECHNIQUE = Blueprint()
