"""Lines along the edges of layers: where a neighbour in the layer is another object, nothing, or
turned away. Drawn by shaders/edges.frag, of which this is the definition."""

from __future__ import annotations

import numpy as np

from seethrough.renderer.techniques.base import Bools, Indices
from seethrough.renderer.techniques.seen import Surfaces

LINE = (0.12, 0.2, 0.45)
NEIGHBOURS = ((0, 1), (0, -1), (1, 0), (-1, 0))


def on_edges(
    seen: Surfaces, rows: Indices, layer: Indices, crease: float, open_: Bools
) -> tuple[Bools, Bools]:
    """Whether rows, in these layers, are on an edge, and whether that is in doubt (m,): an edge is
    where neighbours' normals are `crease` apart or more, in radians. `open_` (h·w,) are the pixels
    at which float32 may find other layers."""
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
    unsure[1:-1, 1:-1] = open_.reshape(height, width)
    edge, sure, maybe = (np.zeros(len(rows), dtype=bool) for _ in range(3))
    for down, right in NEIGHBOURS:
        there = (layer, row + 1 + down, column + 1 + right)
        turned = (normal[here] * normal[there]).sum(axis=1) - np.cos(crease)
        same = number[here] == number[there]
        within = number[there] >= 0
        differs = within & (~same | (turned < 0))
        maybe_here = within & (unsure[there[1:]] | (same & (np.abs(turned) < 1e-4)))
        edge |= differs
        sure |= differs & ~maybe_here
        maybe |= maybe_here
    found, doubt = np.zeros(len(seen.depth), dtype=bool), np.zeros(len(seen.depth), dtype=bool)
    found[rows] = edge
    # What is in doubt counts only where no other neighbour decides.
    doubt[rows] = (maybe & ~sure) | unsure[here[1:]]
    return found, doubt


def unsure(seen: Surfaces, rows: Indices, back: bool) -> Bools:
    """(h·w,) pixels at which float32 may find other layers of these rows; `back`: whether back
    faces are among them."""
    found = seen.edges.copy() if back else seen.edge.copy()
    pixel, depth, slack = seen.pixel[rows], seen.depth[rows], seen.slack[rows]
    close = (np.diff(pixel) == 0) & (np.diff(depth) <= slack[1:] + slack[:-1])
    found[pixel[1:][close]] = True
    return found
