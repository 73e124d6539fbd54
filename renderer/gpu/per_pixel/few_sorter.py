"""Sorts pixels where few objects and masks can show: the programs of shaders/exact_few.frag.

A program for each number of objects and of masks, with nothing to loop over: on a software
rasteriser a fraction of the time of the one that takes any number. Blocks are drawn as points:
there, two triangles would have the pixels along their diagonal shaded twice.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device.programs import Shader, program
from seethrough.renderer.gpu.device.reused import kept
from seethrough.renderer.gpu.per_pixel.pixel_cells import MOST, Cells
from seethrough.renderer.plan import blocks

if TYPE_CHECKING:
    from seethrough.renderer.gpu.per_pixel.exact_sorter import Filled

# Numbers that there is a program for: each takes its time to compile, at first use.
SLICES = np.array([1, 2, 3, 4, 6, 8, 12, 16])
MASKS = np.array([0, 1, 2, 4, 8])
TOGETHER = 64  # blocks: to draw so few at once costs less than to shade none of them too long
_SLICE_GROUPS = [f"slices{k}" for k in range(SLICES[-1] // 4)]
_MASK_GROUPS = [f"masks{k}" for k in range(3 * MASKS[-1] // 4)]

Key = tuple[int, int, bool, bool]  # objects, masks, any is impenetrable, masks are looked up


def too_many(slices: NDArray[np.uint64], masks: NDArray[np.uint64]) -> bool:
    """Whether any block with a mask holds more (bits of slices and of masks, each (h, w)) than
    there is a program for."""
    most = blocks.most(slices, masks)
    return bool(most[0] > SLICES[-1] or most[1] > MASKS[-1])


class FewSorter:
    """Draws blocks, those of equal numbers together."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._places = kept(context.buffer(reserve=1 << 18, dynamic=True))
        self._programs: dict[Key, tuple[Shader, moderngl.VertexArray]] = {}

    def draw(
        self,
        filled: Filled,
        part: NDArray[np.int64],
        bases: tuple[int, int],
        found: NDArray[np.int64],
        which: NDArray[np.uint64],
        every: bool,
    ) -> tuple[NDArray[np.bool_], int]:
        """Draw those of the blocks `found` (k, 2) in which few can show. `bases` are the first
        cells of the part. Returns of which there are too many (k,), and the draws."""
        looked_up = filled.looked_up is not None
        if filled.looked_up is not None:
            words = filled.looked_up.words
        else:
            words = _cell_words(filled.entries, bases[1])
        rows, starts, over = blocks.grouped(
            *(found, which, _corners(filled.slices, bases[0]), words, SLICES, MASKS, every),
            TOGETHER,
        )
        self._write(rows)
        self._context.enable_only(moderngl.PROGRAM_POINT_SIZE)
        origin = (int(part[0]), int(filled.size[1] - part[3]))
        used = np.nonzero(np.diff(starts))[0]
        for k, a, b in zip(
            used.tolist(), starts[used].tolist(), starts[used + 1].tolist(), strict=True
        ):
            n, m = int(SLICES[k // len(MASKS)]), int(MASKS[k % len(MASKS)])
            shader, array = self._program((n, m, filled.hard, looked_up and m > 0))
            filled.look_up(shader)
            shader.set(origin=origin, size=blocks.whole(filled.size), every=every)
            array.render(moderngl.POINTS, b - a, first=a)
        return over, len(used)

    def _write(self, rows: NDArray[np.uint32]) -> None:
        if rows.nbytes > self._places.size:
            self._places.release()
            self._places = kept(self._context.buffer(reserve=2 * rows.nbytes, dynamic=True))
            made = {key: shader for key, (shader, _) in self._programs.items()}
            self._programs = {key: (shader, self._array(shader)) for key, shader in made.items()}
        if len(rows):
            self._places.orphan()
            self._places.write(rows)

    def _array(self, shader: Shader) -> moderngl.VertexArray:
        names = [f"in_{group}" for group in (*_SLICE_GROUPS, *_MASK_GROUPS)]
        used = [name if name in shader.members else None for name in names]
        layout = " ".join("4u" if name else "16x" for name in used)
        content = [(self._places, f"2f {layout}", "in_place", *[n for n in used if n])]
        return self._context.vertex_array(shader.program, content)

    def _program(self, key: Key) -> tuple[Shader, moderngl.VertexArray]:
        if key not in self._programs:
            slices, masks, hard, looked_up = key
            words = [
                [f"masks{(row * MASKS[-1] + m) // 4}[{m % 4}]" for m in range(masks)]
                for row in range(3 if looked_up else 1)
            ]
            values = {
                "slices": slices,
                "masks": masks,
                "hard": hard,
                "looked_up": looked_up,
                "groups": _SLICE_GROUPS[: -(-slices // 4)]
                + sorted({word[: word.index("[")] for row in words for word in row}),
                "slice_at": [f"slices{k // 4}[{k % 4}]" for k in range(slices)],
                "words": words,
            }
            shader = program(self._context, "few.vert", "exact_few.frag", values=values)
            self._programs[key] = (shader, self._array(shader))
        return self._programs[key]


def _corners(cells: Cells, base: int) -> NDArray[np.uint32]:
    """(64,) where the cells from `base` on begin, x and y in 16 bits each."""
    row, column = np.divmod(np.arange(MOST) + base, cells.columns)
    return (column * cells.size[0] | row * cells.size[1] << 16).astype(np.uint32)


def _cell_words(entries: Cells | None, base: int) -> NDArray[np.uint32]:
    """(65, 3) where the cells of masks begin, in the first column."""
    words = np.zeros((MOST + 1, 3), np.uint32)
    words[-1, 0] = blocks.NONE
    if entries is not None:
        words[:-1, 0] = _corners(entries, base)
    return words
