"""Orders written out before the first frame, between one knot of switches and the next.

Paper 002 searches the feudal priority tree level by level for every view. But what its connecting
nodes list is fixed; only the switches decide, and only which of two parts comes first. So the tree
is taken apart into *knots* of a few switches that hang together. For every answer of a knot's
switches the order of all it holds is written out, as stretches of entries between the knots below.
A view then costs the side of each plane, a look-up for each knot, and a copy of its stretches
without what faces the wrong way: no branch depends on a single polygon.
"""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray

from renderer.ordering.polygons import Floats, Integers

# Switches of a knot: its order is written out 2^SWITCHES times.
SWITCHES = 5
# Entries are copied in blocks; stretches are filled up to whole ones.
BLOCK = 4
NONE = -1

Indices = NDArray[np.uint32]


@dataclass(frozen=True, eq=False, slots=True)
class Stretches:
    """`planes` (m, 4) in columns, one of each output polygon.

    `entries` (e, 2): what to draw, and the condition: p where polygon p must face the eye, m + p
    where it must face away, 2 m always, 2 m + 1 never. `spans` (s, 3): a stretch's first entry, the
    one after its last, and the knot below that follows it (NONE: the order ends). `firsts` is the
    first stretch of each order, `knots` (k + 1, 2) a knot's first order and its first of
    `switches` (polygons). `room` is the most that can be drawn, `depth` the longest way down.
    """

    planes: Floats
    entries: Indices
    spans: NDArray[np.int32]
    firsts: Indices
    knots: Indices
    switches: Indices
    room: int
    depth: int

    def order(self, point: Floats) -> NDArray[np.int32]:
        """What is drawn, from back to front, seen from a homogeneous point (4,)."""
        out = np.empty(self.room + BLOCK, np.int32)
        return out[: emit(*self.arguments, point, out)]

    @property
    def arguments(self) -> tuple:
        """What `emit` takes before the point."""
        return (
            self.planes, self.entries, self.spans, self.firsts, self.knots, self.switches,
            self.depth,
        )  # fmt: skip


def knot_roots(children: Integers, switches: Integers, most: int = SWITCHES) -> NDArray[np.bool_]:
    """(n,) whether a knot begins at a node: as few knots as can be, of `most` switches at most.

    From the leaves up, a node joins its children's knots; where that is too many, the larger
    child is left a knot of its own. Children come after their parents.
    """
    n = len(switches)
    size, root = np.zeros(n, np.int64), np.zeros(n, bool)
    root[0] = True
    for node in range(n - 1, -1, -1):
        if switches[node] < 0:
            continue
        below = sorted((int(c) for c in children[node] if c >= 0), key=lambda c: -size[c])
        size[node] = 1 + sum(size[c] for c in below)
        for child in below:
            if size[node] > most:
                root[child] = True
                size[node] -= size[child]
    return root


class _Writer:
    """Writes out the orders of knots."""

    def __init__(
        self, entries: Integers, wanted: Integers, spans: Integers, children: Integers,
        switches: Integers, bounds: Integers,
    ) -> None:  # fmt: skip
        self.spans, self.children, self.switches = spans, children, switches
        self.root = knot_roots(children, switches)
        self.number = np.cumsum(self.root) - 1
        m = len(bounds) - 1
        condition = np.choose(wanted, [m + entries, entries, np.full(len(entries), 2 * m)])
        counts = np.diff(bounds)[entries]
        self.starts = np.concatenate([[0], np.cumsum(counts)])
        step = np.arange(self.starts[-1]) - np.repeat(self.starts[:-1], counts)
        items = np.repeat(bounds[entries], counts) + step
        self.rows = np.column_stack([items, np.repeat(condition, counts)])
        self.filler = np.array([[0, 2 * m + 1]])
        self.written: list[NDArray] = []
        self.length = 0
        self.stretches: list[tuple[int, int, int]] = []

    def knot(self, root: int) -> tuple[list[int], list[int]]:
        """A knot's switch nodes, and the first stretch of each of its orders."""
        nodes, waiting = [], [root]
        while waiting:
            node = waiting.pop()
            if self.switches[node] >= 0:
                nodes.append(node)
                waiting += [int(c) for c in self.children[node] if c >= 0 and not self.root[c]]
        firsts = []
        for code in range(1 << len(nodes)):
            firsts.append(len(self.stretches))
            self._order(root, {node: code >> k & 1 for k, node in enumerate(nodes)})
        return nodes, firsts

    def _order(self, root: int, front: dict[int, int]) -> None:
        """Each node on the way down, between its children (the far one first), and back up."""
        parts: list[NDArray] = []
        stack = [(root, 0)]
        while stack:
            node, step = stack.pop()
            if step == 0 and node != root and self.root[node]:
                self._stretch(parts, int(self.number[node]))
                parts = []
                continue
            begin, end = self.starts[self.spans[node, step : step + 2]]
            parts.append(self.rows[begin:end])
            if step == 2:
                continue
            stack.append((node, step + 1))
            if node in front:
                child = int(self.children[node, front[node] if step == 0 else 1 - front[node]])
                if child >= 0:
                    stack.append((child, 0))
        self._stretch(parts, NONE)

    def _stretch(self, parts: list[NDArray], below: int) -> None:
        rows = np.concatenate([*parts, self.filler[:0]])
        fill = np.repeat(self.filler, -len(rows) % BLOCK, axis=0)
        self.written += [rows, fill]
        begin = self.length
        self.length += len(rows) + len(fill)
        self.stretches.append((begin, self.length, below))


def write_out(
    planes: Floats, bounds: Integers, entries: Integers, wanted: Integers, spans: Integers,
    children: Integers, switches: Integers,
) -> Stretches:  # fmt: skip
    """Stretches of a tree given as lists for each node (see `feudal_list.Program`).

    Polygon p is drawn as the items bounds[p] to bounds[p + 1].
    """
    writer = _Writer(entries, wanted.astype(np.int64), spans, children, switches, bounds)
    firsts: list[int] = []
    knots, asked = [], []
    depth = np.ones(len(switches), np.int64)
    for root in np.flatnonzero(writer.root):
        nodes, orders = writer.knot(int(root))
        knots.append((len(firsts), len(asked)))
        firsts += orders
        asked += [int(switches[node]) for node in nodes]
    for node, below in enumerate(children):
        depth[below[below >= 0]] = depth[node] + writer.root[below[below >= 0]]
    return Stretches(
        planes=np.asfortranarray(planes),
        entries=np.concatenate([*writer.written, writer.filler]).astype(np.uint32),
        spans=np.array(writer.stretches, np.int32).reshape(-1, 3),
        firsts=np.array(firsts, np.uint32),
        knots=np.array([*knots, (len(firsts), len(asked))], np.uint32),
        switches=np.array(asked, np.uint32),
        room=int(bounds[-1]),
        depth=int(depth.max()),
    )


@numba.njit(cache=True)
def emit(planes, entries, spans, firsts, knots, switches, depth, point, out):
    """Write what is drawn into `out`, which has BLOCK places to spare; returns how much.

    Indices are unsigned throughout: numba tests signed ones for counting from the end.
    """
    u = np.uint64
    m = u(len(planes))
    facing = np.empty(u(2) * m + u(2), np.uint8)
    nx, ny, nz, offset = planes[:, 0], planes[:, 1], planes[:, 2], planes[:, 3]
    x, y, z, w = point[0], point[1], point[2], point[3]
    for p in range(m):
        facing[p] = nx[p] * x + ny[p] * y + nz[p] * z + offset[p] * w > 0.0
    for p in range(m):
        facing[m + p] = facing[p] ^ np.uint8(1)
    facing[u(2) * m], facing[u(2) * m + u(1)] = 1, 0
    stack = np.empty(depth, np.uint64)
    top, at, length = u(0), u(0), u(0)
    knot = 0
    while True:
        if knot >= 0:
            code, bit = u(0), u(0)
            for k in range(u(knots[knot, 1]), u(knots[knot + 1, 1])):
                code |= u(facing[switches[k]]) << bit
                bit += u(1)
            at = u(firsts[u(knots[knot, 0]) + code])
        elif top == 0:
            return length
        else:
            top -= u(1)
            at = stack[top] + u(1)
        for e in range(u(spans[at, 0]), u(spans[at, 1]), u(4)):
            e1, e2, e3 = e + u(1), e + u(2), e + u(3)
            a, b = u(facing[entries[e, 1]]), u(facing[entries[e1, 1]])
            c, d = u(facing[entries[e2, 1]]), u(facing[entries[e3, 1]])
            out[length] = entries[e, 0]
            out[length + a] = entries[e1, 0]
            out[length + a + b] = entries[e2, 0]
            out[length + a + b + c] = entries[e3, 0]
            length += a + b + c + d
        knot = spans[at, 2]
        if knot >= 0:
            stack[top] = at
            top += u(1)
