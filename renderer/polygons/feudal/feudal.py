"""Feudal priority (Chen1996): who can hide whom, decided before the first frame.

Each polygon's plane is tested against the others. A polygon with all others behind its plane (or
all in front of it) has absolute priority: it is drawn first or last, by the way it faces, whatever
the eye. When none is left, a plane that parts the rest without a cut becomes a switch; only when
there is none, a plane cuts. The order is exact for every eye, up to the rounding of cut points,
and comes as *classes* whose members hide nothing of each other: they may be drawn in any order,
or at once (polygons that lie on one another in one plane excepted: they meet in their input order).

The paper has the static version's list never longer than the dynamic one's. So it is where both
list the same group: there the dynamic version makes a class of every plane, and the static one
puts several into one. Where their switches differ the pieces do too, and nothing keeps it so: it
can be longer then for some eyes (tests/unit/renderer/test_feudal_lists.py has both).

Assumes polygons that stand still. The table takes n² bytes and at least as many tests in the
static version: made for hundreds to a few thousand polygons; beyond, use `bsp`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats, Whole
from seethrough.renderer.polygons.feudal.feudal_list import Program, program
from seethrough.renderer.polygons.feudal.feudal_lookahead import Lookahead
from seethrough.renderer.polygons.feudal.feudal_relations import Relations
from seethrough.renderer.polygons.feudal.feudal_tree import (
    Cheapest,
    Node,
    build_dynamic,
    build_static,
)
from seethrough.renderer.polygons.fragments import MOST_PIECES, Fragments
from seethrough.renderer.polygons.polygons import Polygons
from seethrough.renderer.polygons.prepared import Drawable, Stats, drawable, viewpoint

VERSIONS = ("static", "dynamic")
# Above this the table of relations would take more than 400 MB.
LARGEST = 20_000


@dataclass(frozen=True, eq=False, slots=True)
class PreparedFeudal:
    """A feudal priority tree. `nodes` are its connecting nodes, the root first."""

    drawable: Drawable
    nodes: tuple[Node, ...]
    program: Program
    stats: Stats
    cuts: Fragments

    def order(self, eye: Floats | None = None, view: Floats | None = None) -> NDArray[np.int32]:
        """Triangle indices from back to front; of a closed volume, the faces towards the eye."""
        return self.program.order(viewpoint(eye, view))

    def classes(self, eye: Floats | None = None, view: Floats | None = None) -> list[Whole]:
        """The rendering priority list: output polygons in classes, from back to front."""
        return self.program.classes(viewpoint(eye, view))


def prepare(
    polygons: Polygons,
    version: str = "static",
    closed: bool = False,
    rng: np.random.Generator | None = None,
    tolerance: float = 0.0,
    balance: float = 0.0,
    lookahead: int = 0,
    most: int = MOST_PIECES,
) -> PreparedFeudal:
    """Build the tree.

    `closed` culls the faces that look away (the paper's "forward" ones): right for opaque closed
    volumes; translucent ones show their far walls and are prepared open. `rng` shuffles the input
    of the dynamic version; without one a fixed stream does. A splitting plane is the one with the
    fewest cuts less `balance` times the binary logarithm of its smaller side's polygons, and the
    most balanced of these; 0 is the paper's rule, more cuts less where many polygons intersect.
    With `lookahead`, so many candidates of several such rules are tried out at every cut (see
    `feudal_lookahead`): it takes seconds for hundreds of polygons, and pays where one object is
    drawn for long.

    Raises ValueError for polygons that `polygons.check` refuses, for an unknown version, for a
    negative balance or lookahead, and for more than 20,000 polygons; TooManyPieces where polygons
    cross so densely that cuts make more than `most`.
    """
    if version not in VERSIONS:
        raise ValueError(f"version = {version!r}, expected one of {', '.join(VERSIONS)}")
    if len(polygons) > LARGEST:
        raise ValueError(f"{len(polygons)} polygons, expected {LARGEST} or fewer: use bsp")
    if not 0.0 <= balance < np.inf:
        raise ValueError(f"balance = {balance}, expected a finite number, 0 or larger")
    if lookahead < 0:
        raise ValueError(f"lookahead = {lookahead}, expected 0 candidates or more")
    fragments = Fragments(polygons, tolerance, most=most)
    relations = Relations(fragments)
    rule = Lookahead(balance, lookahead) if lookahead else Cheapest(balance)
    group = np.flatnonzero(fragments.solid)
    if version == "static":
        nodes = build_static(relations, group, rule)
    else:
        generator = rng or np.random.default_rng(np.random.SeedSequence(3))
        nodes = build_dynamic(relations, generator.permutation(group), rule)
    return _assemble(relations, nodes, closed)


def _assemble(relations: Relations, nodes: list[Node], closed: bool) -> PreparedFeudal:
    """Output polygons numbered by fragment; those without area come first in every order."""
    fragments = relations.fragments
    whole = np.ones(int(fragments.used[1]), bool)
    parents = fragments.parent[: len(whole)]
    whole[parents[parents >= 0]] = False
    kept = np.flatnonzero(whole)
    number = np.full(len(whole), -1, np.int64)
    number[kept] = np.arange(len(kept))
    for node in nodes:
        node.coplanar = np.sort(number[node.coplanar])
        node.levels = [(np.sort(number[f]), np.sort(number[b])) for f, b in node.levels]
        if node.switch >= 0:
            node.switch = int(number[node.switch])
    source = fragments.source[kept]
    drawn = drawable(fragments.polygons(kept), source, fragments.planes)
    shared, plane = np.unique(relations.row_of[kept], return_inverse=True)
    toward = np.where(relations.flipped[kept], plane + len(shared), plane)
    rows = fragments.planes[shared]
    planes = np.column_stack([rows[:, 3:6], -(rows[:, 3:6] * rows[:, :3]).sum(axis=1)])
    flat = np.flatnonzero(~fragments.solid[source])
    made = program(nodes, planes, toward, drawn.bounds, flat, closed)
    stats = Stats(
        inputs=int((parents < 0).sum()),
        outputs=len(kept),
        splits=int((~whole).sum()),
        relations=relations.tested,
        depth=made.depth,
        nodes={
            "connecting": len(nodes),
            "switch": sum(n.switch >= 0 for n in nodes),
        },
    )
    return PreparedFeudal(drawn, tuple(nodes), made, stats, fragments)
