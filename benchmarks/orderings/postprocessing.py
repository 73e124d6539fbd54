"""What a new view costs once the tree is there: Chen1996's postprocessing phase.

Chen1996, tables 6 and 7, compares the time to get the priority list of a closed volume for a new
view vector, faces that look away culled, from the feudal priority tree and from the BSP tree of
the baseline (fewest splits of five random candidates). So is it here, on stand-ins for its objects,
which are lost (decisions/0007): the ratio can be compared, the times cannot.


- Both give the same kind of list, of the faces that look towards the eye, back to front, for the
  same random view vectors; as polygons, like the paper's, and as the triangles that are drawn.
- Both are compiled kernels on flat arrays, called from one compiled loop over all views: nothing
  of Python is timed. Both find the sides of all planes first, several at a time.
- The BSP tree is not walked: its pass places each node's faces without a branch, for every node
  at once, and culls in a second pass, since culling while walking the tree, as the paper's BSP
  had to, costs more. That walk is measured beside it.
- Feudal priority copies stretches written out beforehand (`renderer.ordering.feudal_stretches`).

Times are processor time, the fastest of several turns, the two taking turns.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numba
import numpy as np

from seethrough.renderer.arrays import Bytes, Floats, Whole
from seethrough.renderer.polygons.bsp import PreparedBsp
from seethrough.renderer.polygons.feudal.feudal import PreparedFeudal
from seethrough.renderer.polygons.feudal.feudal_stretches import BLOCK, Stretches
from seethrough.renderer.polygons.feudal.feudal_stretches import emit as emit_stretches
from seethrough.renderer.polygons.tree import EITHER, Indices, Tree
from seethrough.renderer.polygons.tree import emit as emit_tree

VIEWS, TURNS = 500, 40


def as_polygons(prepared: PreparedBsp) -> Tree:
    """A BSP tree whose items are output polygons instead of triangles."""
    made, bounds = prepared.tree, prepared.drawable.bounds
    items = np.searchsorted(bounds, made.items).astype(np.uint32)
    own = np.append(np.diff(items.astype(np.int64)), 0)
    sizes = own.copy()
    for node in range(len(own) - 2, -1, -1):
        sizes[node] += sizes[made.children[node]].sum()
    facing = made.facing[bounds[:-1]] if len(made.facing) else made.facing
    return Tree(made.planes, made.children, items, sizes.astype(np.uint32), facing, made.depth)


@numba.njit()
def _repeat(
    kernel: Callable[..., np.uint64], arguments: tuple[object, ...], points: Floats, out: Whole
) -> int:
    """A kernel for every view; returns how many faces it listed in all."""
    total = 0
    for i in range(len(points)):
        total += int(kernel(*arguments, points[i], out))
    return total


@numba.njit()
def _walk(
    planes: Floats,
    children: Indices,
    items: Indices,
    sizes: Indices,
    facing: Bytes,
    depth: int,
    points: Floats,
    out: Whole,
) -> int:
    """The BSP tree walked from back to front with a stack, faces culled where they are met."""
    u = np.uint64
    n = u(len(planes))
    front = np.empty(n, np.uint8)
    nx, ny, nz, offset = planes[:, 0], planes[:, 1], planes[:, 2], planes[:, 3]
    stack = np.empty(depth + 1, np.uint64)
    total = 0
    for i in range(len(points)):
        x, y, z, w = points[i]
        for p in range(n):
            front[p] = nx[p] * x + ny[p] * y + nz[p] * z + offset[p] * w > 0.0
        top, length, node = u(0), u(0), u(0)
        while True:
            while node < n:
                stack[top] = node
                top += u(1)
                node = u(children[node, u(front[node])])
            if top == 0:
                break
            top -= u(1)
            node = stack[top]
            for item in range(u(items[node]), u(items[node + u(1)])):
                out[length] = item
                length += u((facing[item] == front[node]) | (facing[item] == np.uint8(EITHER)))
            node = u(children[node, u(1) - u(front[node])])
        total += int(length)
    return total


def microseconds(
    trees: list[PreparedBsp], feudals: list[PreparedFeudal], views: Floats
) -> dict[str, float]:
    """µs of a view: `bsp`, `walk` and `feudal` for lists of polygons, `… triangles` as drawn.

    Means over the trees given: all of closed volumes, prepared with `closed`. `views` (v, 3).
    """
    points = np.column_stack([-views, np.zeros(len(views))])
    ways: dict[str, list[Callable[[], int]]] = {}
    for prepared in trees:
        lists = as_polygons(prepared)
        out = np.empty(int(prepared.tree.items[-1]) + 1, np.int32)
        ways.setdefault("bsp", []).append(_call(emit_tree, lists.arguments, points, out))
        ways.setdefault("walk", []).append(_walking(lists, points, out))
        ways.setdefault("bsp triangles", []).append(
            _call(emit_tree, prepared.tree.arguments, points, out)
        )
    for made in feudals:
        lists_of = made.program.stretches_of(np.arange(made.stats.outputs + 1))
        for name, stretches in (("feudal", lists_of), ("feudal triangles", made.program.stretches)):
            ways.setdefault(name, []).append(_emitting(stretches, points))
    best = {name: np.full(len(calls), np.inf) for name, calls in ways.items()}
    for turn in range(TURNS + 1):
        for name, calls in ways.items():
            for k, call in enumerate(calls):
                start = time.process_time()
                call()
                if turn:
                    best[name][k] = min(best[name][k], time.process_time() - start)
    return {name: float(times.mean()) / len(points) * 1e6 for name, times in best.items()}


def _walking(lists: Tree, points: Floats, out: Whole) -> Callable[[], int]:
    return lambda: int(_walk(*lists.arguments, lists.depth, points, out))


def _emitting(stretches: Stretches, points: Floats) -> Callable[[], int]:
    out = np.empty(stretches.room + BLOCK, np.int32)
    return _call(emit_stretches, stretches.arguments, points, out)


def _call(
    kernel: Callable[..., np.uint64], arguments: tuple[object, ...], points: Floats, out: Whole
) -> Callable[[], int]:
    return lambda: int(_repeat(kernel, arguments, points, out))
