"""Orders written out before the first frame, between one knot of switches and the next.

Chen1996 searches the feudal priority tree level by level for every view. But what its connecting
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

from seethrough.renderer.arrays import Floats, Ints32, Whole

# Switches of a knot: its order is written out 2^SWITCHES times. `emit` unrolls this number.
SWITCHES = 5
# Entries are copied in blocks; stretches are filled up to whole ones. `emit` unrolls it too.
BLOCK = 4
NONE = -1
# An entry holds what to draw above these bits and its condition in them.
SHIFT = 32

Indices = NDArray[np.uint32]


@dataclass(frozen=True, eq=False, slots=True)
class Stretches:
    """`planes` (k, 4) in columns.

    A condition is c where the eye must be in front of plane c, k + c where behind it, 2 k always,
    2 k + 1 never. `entries` (e,): what to draw, and its condition. `spans` (s, 3): a stretch's
    first entry, the one after its last, and the knot below that follows it (NONE: the order
    ends). `firsts` is the first stretch of each order, `knots` (n,) a knot's first order, and
    `asked` (n, SWITCHES) the conditions that its switches' polygons face the eye. `room` is the
    most that can be drawn, `depth` the longest way down.
    """

    planes: Floats
    entries: NDArray[np.uint64]
    spans: NDArray[np.int32]
    firsts: Indices
    knots: Indices
    asked: Indices
    room: int
    depth: int

    def order(self, point: Floats) -> NDArray[np.int32]:
        """What is drawn, from back to front, seen from a homogeneous point (4,)."""
        out = np.empty(self.room + BLOCK, np.int32)
        return out[: emit(*self.arguments, point, out)]

    @property
    def arguments(
        self,
    ) -> tuple[Floats, NDArray[np.uint64], NDArray[np.int32], Indices, Indices, Indices, int]:
        """What `emit` takes before the point."""
        return (
            self.planes, self.entries, self.spans, self.firsts, self.knots, self.asked, self.depth,
        )  # fmt: skip


@dataclass(frozen=True, eq=False, slots=True)
class Lists:
    """A tree as lists of polygons for each node: see `feudal_list.Program`."""

    entries: Whole
    wanted: NDArray[np.uint8]
    spans: Whole
    children: Whole
    switches: Whole


def knot_roots(children: Whole, switches: Whole, most: int = SWITCHES) -> NDArray[np.bool_]:
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

    def __init__(self, lists: Lists, bounds: Whole, toward: Whole, planes: int) -> None:
        self.spans, self.children, self.switches = lists.spans, lists.children, lists.switches
        self.root = knot_roots(lists.children, lists.switches)
        self.number = np.cumsum(self.root) - 1
        facing = toward[lists.entries]
        away, always = (facing + planes) % (2 * planes), np.full(len(facing), 2 * planes)
        condition = np.choose(lists.wanted, [away, facing, always])
        counts = np.diff(bounds)[lists.entries]
        self.starts = np.concatenate([[0], np.cumsum(counts)])
        step = np.arange(self.starts[-1]) - np.repeat(self.starts[:-1], counts)
        items = np.repeat(bounds[lists.entries], counts) + step
        self.rows = _packed(items, np.repeat(condition, counts))
        self.filler = _packed(np.zeros(1, np.int64), np.array([2 * planes + 1]))
        self.written: list[NDArray[np.uint64]] = []
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
        parts: list[NDArray[np.uint64]] = []
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

    def _stretch(self, parts: list[NDArray[np.uint64]], below: int) -> None:
        rows = np.concatenate([*parts, self.filler[:0]])
        fill = np.repeat(self.filler, -len(rows) % BLOCK)
        self.written += [rows, fill]
        begin = self.length
        self.length += len(rows) + len(fill)
        self.stretches.append((begin, self.length, below))


def _packed(items: Whole, conditions: Whole) -> NDArray[np.uint64]:
    return (items.astype(np.uint64) << np.uint64(SHIFT)) | conditions.astype(np.uint64)


def write_out(lists: Lists, planes: Floats, toward: Whole, bounds: Whole) -> Stretches:
    """Stretches of a tree. `toward` (m,) is the condition that a polygon faces the eye.

    Polygon p is drawn as the items bounds[p] to bounds[p + 1].
    """
    writer = _Writer(lists, bounds, toward, len(planes))
    firsts: list[int] = []
    knots, asked = [], []
    depth = np.ones(len(lists.switches), np.int64)
    for root in np.flatnonzero(writer.root):
        nodes, orders = writer.knot(int(root))
        knots.append(len(firsts))
        firsts += orders
        never = [2 * len(planes) + 1] * (SWITCHES - len(nodes))
        asked.append([int(toward[lists.switches[node]]) for node in nodes] + never)
    for node, children in enumerate(lists.children):
        below = children[children >= 0]
        depth[below] = depth[node] + writer.root[below]
    return Stretches(
        planes=np.asfortranarray(planes),
        entries=np.concatenate([*writer.written, writer.filler]),
        spans=np.array(writer.stretches, np.int32).reshape(-1, 3),
        firsts=np.array(firsts, np.uint32),
        knots=np.array(knots, np.uint32),
        asked=np.array(asked, np.uint32).reshape(-1, SWITCHES),
        room=int(bounds[-1]),
        depth=int(depth.max()),
    )


@numba.njit(cache=True)
def emit(
    planes: Floats,
    entries: NDArray[np.uint64],
    spans: Ints32,
    firsts: Indices,
    knots: Indices,
    asked: Indices,
    depth: int,
    point: Floats,
    out: Ints32,
) -> np.uint64:
    """Write what is drawn into `out`, which has BLOCK places to spare; returns how much.

    Indices are unsigned throughout: numba tests signed ones for counting from the end.
    """
    u = np.uint64
    one, two, three, low = u(1), u(2), u(3), u((1 << SHIFT) - 1)
    m = u(len(planes))
    facing = np.empty(two * m + two, np.uint8)
    nx, ny, nz, offset = planes[:, 0], planes[:, 1], planes[:, 2], planes[:, 3]
    x, y, z, w = point[0], point[1], point[2], point[3]
    for p in range(m):
        facing[p] = nx[p] * x + ny[p] * y + nz[p] * z + offset[p] * w > 0.0
    for p in range(m):
        facing[m + p] = facing[p] ^ np.uint8(1)
    facing[two * m], facing[two * m + one] = 1, 0
    stack = np.empty(depth, np.uint64)
    top, at, length, knot = u(0), u(0), u(0), 0
    while True:
        if knot >= 0:
            k = u(knot)
            code = u(facing[asked[k, 0]]) | (u(facing[asked[k, 1]]) << one)
            code |= (u(facing[asked[k, 2]]) << two) | (u(facing[asked[k, 3]]) << three)
            code |= u(facing[asked[k, 4]]) << u(4)
            at = u(firsts[u(knots[k]) + code])
        elif top == 0:
            return length
        else:
            top -= one
            at = stack[top] + one
        for e in range(u(spans[at, 0]), u(spans[at, 1]), u(4)):
            e0, e1, e2, e3 = entries[e], entries[e + one], entries[e + two], entries[e + three]
            second = length + u(facing[e0 & low])
            third = second + u(facing[e1 & low])
            fourth = third + u(facing[e2 & low])
            out[length] = e0 >> u(SHIFT)
            out[second] = e1 >> u(SHIFT)
            out[third] = e2 >> u(SHIFT)
            out[fourth] = e3 >> u(SHIFT)
            length = fourth + u(facing[e3 & low])
        knot = spans[at, 2]
        if knot >= 0:
            stack[top] = at
            top += one
