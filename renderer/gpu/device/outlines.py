"""Distances from the outlines of many targets, found beside the drawing.

One kernel goes through all targets that a thread takes: between them it would have to wait for
Python's lock, which a draw call holds.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bits, Floats, Floats32, Ints
from seethrough.renderer.masks import contours
from seethrough.renderer.plan import blocks

if TYPE_CHECKING:
    from seethrough.renderer.gpu.device.meshes import GpuMesh


# Compiled code is kept on disk until this file changes: change it with the kernels of
# contours.py and rims.py.
_CORES = os.cpu_count() or 1
_WORTH = 30_000  # edges to look at for which a second thread is worth waking
_LITTLE = 60_000  # edges and pixels that are looked at before another thread would have begun


class Wanted(NamedTuple):
    """What distances are asked for, with a row for each of k targets.

    Its pose (contours.Pose): eyes (k, 3), turns (k, 3, 3), moves (k, 3). The window it is found for
    (k, 4): left, top, width, height; where that goes (k, 2): left, bottom; the number of its bit
    (k,). For all of them the lens (3,), the masks' width and by how much an outline may be
    straightened.
    """

    eyes: Floats
    turns: Floats
    moves: Floats
    windows: Ints
    corners: Ints
    numbers: Ints
    lens: Floats
    width: float
    straight: float


class Outlines:
    """The edges of meshes one after the other, as far as frames have asked for them."""

    def __init__(self) -> None:
        self._place: dict[int, int] = {}
        self._meshes: list[GpuMesh] = []
        self._threads: ThreadPoolExecutor | None = None

    def _join(self) -> None:
        shapes = [(mesh.topology, mesh.edges) for mesh in self._meshes]
        columns = [
            contours.Solid(s.points, s.planes, e.ends, e.first, e.faces, e.signs) for s, e in shapes
        ]
        self._solids = contours.Solid(*(np.concatenate(c) for c in zip(*columns, strict=True)))
        sizes = np.array([[len(array) for array in row] for row in columns])
        self._starts = np.concatenate([np.zeros((1, 6), np.int64), np.cumsum(sizes, axis=0)])

    def start(
        self, meshes: Sequence[GpuMesh], wanted: Wanted, out: Floats32, shape: tuple[int, int]
    ) -> tuple[list[Future[None]], NDArray[np.uint64]]:
        """Begin to fill `out` (rows upwards), and the bits of the blocks that masks touch: an array
        of that `shape` for each thread. `meshes` are the targets', one each."""
        new = [mesh for mesh in meshes if id(mesh) not in self._place]
        for mesh in new:
            if id(mesh) not in self._place:
                self._place[id(mesh)] = len(self._meshes)
                self._meshes.append(mesh)
        if new:
            self._join()
        count = len(meshes)
        which = np.array([self._place[id(mesh)] for mesh in meshes])
        work = int(np.diff(self._starts[:, 2])[which].sum())  # edges
        threads = min(count, _CORES, 8, 1 + work // _WORTH)
        bits = np.zeros((threads, *shape), np.uint64)
        solids, starts = self._solids, self._starts
        if work + int(wanted.windows[:, 2:].prod(axis=1).sum()) <= _LITTLE:
            _fill(solids, starts, which, wanted, out, bits[0], 0, 1)
            return [], bits[:1]
        jobs = [
            self.beside(_fill, solids, starts, which, wanted, out, bits[k], k, threads)
            for k in range(threads)
        ]
        return jobs, bits

    def beside(self, kernel: Callable[..., None], *args: object) -> Future[None]:
        """Begin a kernel that needs no lock, beside the drawing."""
        if self._threads is None:
            self._threads = ThreadPoolExecutor(max_workers=min(8, _CORES))
        job = self._threads.submit(kernel, *args)
        time.sleep(0)  # let it begin: once in the kernel it needs no lock
        return job


@njit(cache=True, nogil=True)
def _fill(
    solids: contours.Solid,
    starts: Ints,
    which: Ints,
    wanted: Wanted,
    out: Floats32,
    bits: Bits,
    begin: int,
    step: int,
) -> None:
    """What every `step`-th target from `begin` on is asked for; `which` (k,) are their solids, of
    which each begins at the row `starts` (m + 1, 6) of each array."""
    corners, width = wanted.corners, wanted.width
    for t in range(begin, len(which), step):
        a, b = starts[which[t]], starts[which[t] + 1]
        solid = contours.Solid(
            solids.points[a[0] : b[0]],
            solids.planes[a[1] : b[1]],
            solids.ends[a[2] : b[2]],
            solids.first[a[3] : b[3]],
            solids.faces[a[4] : b[4]],
            solids.signs[a[5] : b[5]],
        )
        pose = contours.Pose(wanted.eyes[t], wanted.turns[t], wanted.moves[t])
        window = wanted.windows[t]
        found = contours.outline_distances(solid, pose, wanted.lens, window, width, wanted.straight)
        left, top = corners[t, 0], corners[t, 1] + len(found) - 1
        for row in range(len(found)):
            out[top - row, left : left + found.shape[1]] = found[row]
        blocks.mark(found, window[0], window[1], width, wanted.numbers[t], bits)
