"""Binary space partition by the polygons' own planes (papers LabBSP2010 and Chen1996).

The order is exact, for every eye, up to the rounding of cut points: whatever lies on the eye's
side of a plane cannot be hidden by what lies on the other. Polygons of one plane stay together
in a node and are drawn in their input order. The price is paid before the first frame: polygons
that reach through a plane are cut, and nothing may move afterwards.

Splitters: `first` takes the first polygon of the list (LabBSP2010); `fewest` the one of k random
candidates that cuts fewest (Chen1996's baseline, k = 5); `sampled`, ours, weighs cuts against
balance on a small sample, which gives lower trees of fewer pieces in a fraction of the time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats, Whole
from seethrough.renderer.polygons.bsp_kernels import choose, deal
from seethrough.renderer.polygons.fragments import CUT, MOST_PIECES, Fragments
from seethrough.renderer.polygons.polygons import Polygons
from seethrough.renderer.polygons.prepared import Drawable, Stats, drawable, viewpoint
from seethrough.renderer.polygons.tree import AGAINST, ALONG, EITHER, EVERYTHING, Tree, tree

SPLITTERS = ("first", "fewest", "sampled")
CANDIDATES = 5
# What the sampled rule looks at: fragments for each candidate, and what one polygon of imbalance
# is worth in cuts. Found on soups of 10³ to 10⁵ triangles (seethrough bench ordering).
SAMPLE, BALANCE = 16, 0.25


@dataclass(frozen=True, eq=False, slots=True)
class PreparedBsp:
    """A BSP tree. `cuts` keeps every fragment there ever was, so that cuts can be redone."""

    drawable: Drawable
    tree: Tree
    stats: Stats
    cuts: Fragments

    def order(self, eye: Floats | None = None, view: Floats | None = None) -> NDArray[np.int32]:
        """Triangle indices from back to front (see `prepared.Prepared`)."""
        return self.tree.order(viewpoint(eye, view))


def prepare(
    polygons: Polygons,
    splitter: str = "sampled",
    candidates: int = CANDIDATES,
    rng: np.random.Generator | None = None,
    tolerance: float = 0.0,
    halves: bool | None = None,
    closed: bool = False,
    most: int = MOST_PIECES,
) -> PreparedBsp:
    """Build the tree.

    `rng` draws the candidates; without one a fixed stream is used. `tolerance` is the distance
    (world units) within which a corner counts as on the plane: 0 is exact, LabBSP2010 uses 10⁻³.
    `halves` cuts triangles into triangles only (LabBSP2010); by default if all polygons are
    triangles. `closed` leaves out the faces that look away from the eye: for opaque closed volumes
    (Chen1996). `most` bounds the pieces that cutting may make: where everything crosses everything,
    100 triangles fall into 25,000. Raises ValueError for polygons that `polygons.check` refuses and
    for an unknown splitter, TooManyPieces beyond that bound.
    """
    if splitter not in SPLITTERS:
        raise ValueError(f"splitter = {splitter!r}, expected one of {', '.join(SPLITTERS)}")
    if candidates < 1:
        raise ValueError(f"candidates = {candidates}, expected 1 or more")
    if halves is None:
        halves = bool((polygons.counts == 3).all())
    fragments = Fragments(polygons, tolerance, halves, most)
    rule = _Rule(splitter, candidates, rng or np.random.default_rng(np.random.SeedSequence(3)))
    levels = _grow(fragments, rule)
    return _assemble(fragments, levels, rule.relations, closed)


class _Rule:
    """Chooses splitters, and counts what that cost."""

    def __init__(self, name: str, candidates: int, rng: np.random.Generator) -> None:
        self.name, self.candidates, self.rng = name, candidates, rng
        self.relations = 0

    def __call__(self, fragments: Fragments, active: Whole, bounds: Whole) -> Whole:
        """Positions in `active` of the splitter of each group."""
        if self.name == "first":
            self.relations += len(active) - (len(bounds) - 1)
            return bounds[:-1]
        draws = self.rng.random((len(bounds) - 1, self.candidates))
        sample, balance = (SAMPLE, BALANCE) if self.name == "sampled" else (0, 0.0)
        f = fragments
        best, tested = choose(active, bounds, draws, sample, balance, f.pieces(), f.plane_table)
        # `fewest` has seen every polygon already; `sampled` has the splitter's row still to test.
        self.relations += tested
        if self.name == "sampled":
            self.relations += len(active) - (len(bounds) - 1)
        return best


@dataclass(frozen=True, eq=False, slots=True)
class _Level:
    splitters: Whole
    own: Whole
    own_bounds: Whole
    children: Whole


def _grow(fragments: Fragments, rule: _Rule) -> list[_Level]:
    """All nodes of a depth at once: no recursion, and few calls however many nodes there are."""
    active: Whole = np.flatnonzero(fragments.solid).astype(np.int32)
    bounds = np.array([0, len(active)])
    levels = []
    while len(active):
        splitters = fragments.source[active[rule(fragments, active, bounds)]]
        each = np.repeat(splitters, np.diff(bounds))
        code = fragments.classify(active, each)
        through = np.flatnonzero(code == CUT)
        pieces, parent, side = fragments.cut(active[through], each[through])
        own, own_bounds, following, next_bounds, children = deal(
            active, bounds, code, pieces, through[parent], side
        )
        levels.append(_Level(splitters, own, own_bounds, children))
        active, bounds = following, next_bounds
    return levels


def _assemble(
    fragments: Fragments, levels: list[_Level], relations: int, closed: bool
) -> PreparedBsp:
    """One array of nodes, and the fragments in the order of their nodes.

    Polygons without area define no plane and are never seen: they are kept in a node of their
    own, before the root, so that nothing is lost.
    """
    flat = np.flatnonzero(~fragments.solid)
    counts = [np.diff(level.own_bounds) for level in levels]
    firsts = np.cumsum([1 + 0, *(len(c) for c in counts)])
    children = [
        np.where(level.children >= 0, level.children + after, -1)
        for level, after in zip(levels, firsts[1:], strict=True)
    ]
    root = [[1 if levels else -1, -1]]
    children_all = np.concatenate([np.array(root), *children]).astype(np.int64)
    own = np.concatenate([flat, *(level.own for level in levels)])
    own_counts = np.concatenate([[len(flat)], *counts]).astype(np.int64)
    node_of = np.repeat(np.arange(len(own_counts)), own_counts)
    # By node, and within one in input order: few nodes hold more than one fragment.
    crowded = np.flatnonzero((own_counts > 1)[node_of])
    some = own[crowded]
    own[crowded] = some[np.lexsort((some, fragments.source[some], node_of[crowded]))]
    drawn = drawable(fragments.polygons(own), fragments.source[own], fragments.planes)
    items = drawn.bounds[np.concatenate([[0], np.cumsum(own_counts)])]
    planes = _node_planes(fragments, [level.splitters for level in levels])
    facing = EVERYTHING
    if closed:
        ways = _ways(fragments, own, planes[node_of])
        facing = np.repeat(ways, np.diff(drawn.bounds))
    cut_parents = fragments.parent[: fragments.used[1]]
    stats = Stats(
        inputs=int((fragments.parent[: fragments.used[1]] < 0).sum()),
        outputs=len(own),
        splits=int(np.count_nonzero(_marked(cut_parents))),
        relations=int(relations),
        depth=len(levels),
        nodes={"switch": len(own_counts) - 1},
    )
    return PreparedBsp(
        drawn, tree(planes, children_all, items, facing, len(levels)), stats, fragments
    )


def _ways(fragments: Fragments, own: Whole, planes: Floats) -> NDArray[np.uint8]:
    """(m,) which way fragments face, against the planes (m, 4) of their nodes."""
    normals = fragments.planes[fragments.source[own], 3:6]
    along = (normals * planes[:, :3]).sum(axis=1)
    ways = np.where(along > 0, ALONG, AGAINST).astype(np.uint8)
    ways[~fragments.solid[fragments.source[own]]] = EITHER
    return ways


def _marked(parents: NDArray[np.int32]) -> NDArray[np.bool_]:
    """(fragments,) whether each was cut."""
    cut = np.zeros(len(parents), bool)
    cut[parents[parents >= 0]] = True
    return cut


def _node_planes(fragments: Fragments, splitters: list[Whole]) -> Floats:
    """(nodes, 4) planes as rows for a homogeneous eye; the first has nothing to decide."""
    rows = fragments.planes
    offsets = (rows[:, 3:6] * rows[:, :3]).sum(axis=1)
    planes = np.column_stack([rows[:, 3:6], -offsets])
    nowhere = np.zeros((1, 4))
    return np.concatenate([nowhere, *(planes[s] for s in splitters)])
