"""The exact picture on the GPU, OpenGL 3.3: every pixel sorted by itself.

Objects that overlap nowhere on the screen share a slice: colour and depth of one surface at each
pixel. So a slice holds the front-most fragment of each of its objects, all slices together the
list of fragments of every pixel, and the same goes for the masks. One shader sorts them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import Future
from typing import NamedTuple

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bits, Floats, Floats32, Ints, Real
from seethrough.renderer.gpu.device import pipeline
from seethrough.renderer.gpu.device.programs import program
from seethrough.renderer.gpu.device.reused import kept
from seethrough.renderer.gpu.masks.mask_painter import MaskPainter
from seethrough.renderer.gpu.per_pixel.exact_masks import SLACK, ExactJob, ExactMasks, MaskCells
from seethrough.renderer.gpu.per_pixel.exact_sorter import Filled, PixelSorter
from seethrough.renderer.gpu.per_pixel.few_sorter import too_many
from seethrough.renderer.gpu.per_pixel.pixel_cells import (
    MOST,
    Cells,
    emptied,
    height,
    touched,
    within,
)
from seethrough.renderer.look.shaders import beside_floors
from seethrough.renderer.plan import blocks, coverage, order
from seethrough.renderer.plan.blocks import BLOCK
from seethrough.renderer.plan.planner import impenetrable

TEXELS = 24_000_000  # of all slices of one part: what is larger is drawn in bands
LITTLE = 100_000  # texels of all cells: so few are emptied at once, not where they are drawn into
FEW = 5_000  # triangles: what they cover is found before another thread would have begun
_PER_ROW, _SURFACES_PER_ROW = 1024, 4096


class ExactPainter:
    """Draws parts of a frame pixel by pixel."""

    def __init__(self, context: moderngl.Context, look: Sequence[str] = ()) -> None:
        self._context = context
        self._tallest = context.info["GL_MAX_TEXTURE_SIZE"]
        self._slice = {
            (surfaces, floor): program(
                context,
                "object.vert",
                "slice.frag",
                ["WITH_SURFACES"] * surfaces + [*(look if floor else beside_floors(look))],
            )
            for surfaces in (False, True)
            for floor in (False, True)
        }
        self._masks = ExactMasks(context)
        self._sorter = PixelSorter(context)
        self._slices: Cells | None = None
        self._textures: dict[str, moderngl.Texture] = {}
        self._known: dict[bytes, _Shown] = {}

    def begin(self, job: ExactJob, made: MaskPainter | None = None) -> None:
        """Take on the plan's exact parts, with the masks already `made` for the frame if there are
        any. Fills the cells of what fits into one batch: with the frame's own picture still to
        come, the rasteriser need not leave that half done and take it up again."""
        self._masks.prepare(job, made)
        self._draws = 0
        self._set_parts(job, None)
        whole = job.frame.exact
        if job.technique.granularity != "pixel":
            self._draws += self._select(job, whole)
        self._waiting = list(self._batches(job, whole))
        self._ready = len(self._waiting) == 1
        if self._ready:
            self._draws += self._fill(job, self._waiting[0])

    def finish(self, job: ExactJob, target: moderngl.Framebuffer) -> tuple[int, int]:
        """Draw what was begun over the frame. Returns passes and draw calls."""
        passes, draws = 0, self._draws
        for parts in self._waiting:
            draws += 0 if self._ready else self._fill(job, parts)
            target.use()
            # A point whose middle lies beyond the view is not drawn, whatever of it lies within.
            wide, high = blocks.whole(job.size)
            target.viewport = (0, job.size[1] - high, wide, high)
            filled, every = self._filled(job), len(job.frame.held) > 0
            for k, part in enumerate(parts):
                bits = self._bits[k]
                for place in within(part, job.frame.doubtful) if bits is None else part[None]:
                    pipeline.within(target, _gl(place, job.size))
                    draws += self._sorter.sort(filled, part, k, bits, every)
            pipeline.within(target, None)
            target.viewport = (0, 0, *job.size)
            passes += 2
        return passes, draws

    def layers(self, job: ExactJob) -> list[tuple[NDArray[np.int64], NDArray[np.float32]]]:
        """Objects + 1 and shares (h, w) of the frame, from the front: eight at a time."""
        self._masks.prepare(job)
        self._set_parts(job, None)
        whole = np.array([[0, 0, *job.size]])
        if job.technique.granularity != "pixel":
            self._select(job, whole)
        self._known = {}
        self._fill(job, whole, whole=True)
        textures = [self._context.texture(job.size, 4, dtype="f4") for _ in range(4)]
        framebuffer = self._context.framebuffer(textures)
        found = []
        for first in range(0, self._slice_base[1], 8):
            framebuffer.use()
            self._sorter.whole(self._filled(job), whole[0], 0, "OUTPUT_SHARES", first)
            for k in range(4):
                data = framebuffer.read(components=4, attachment=k, dtype="f4", alignment=1)
                rows = np.frombuffer(data, "f4").reshape(job.size[1], job.size[0], 4)[::-1]
                for c in (0, 2):
                    found.append((rows[..., c].astype(np.int64), rows[..., c + 1]))
        framebuffer.release()
        for texture in textures:
            texture.release()
        return found

    def _batches(self, job: ExactJob, parts: NDArray[np.int64]) -> Iterator[NDArray[np.int64]]:
        """The parts, cut into bands that fit into memory, as many at a time as fit together."""
        rows = []
        self._known = {}
        for part in parts:
            shown = _shown(job, part)
            cells = int(max(shown.which.max(initial=0), shown.mask.max(initial=0))) + 1
            self._known[part.tobytes()] = shown  # what is not cut into bands is asked for again
            rows += [(band, cells) for band in bands(part, cells, self._tallest)]
        batch: list[NDArray[np.int64]] = []
        used, size = 0, np.zeros(2, np.int64)
        for part, cells in rows:
            grown = np.maximum(size, part[2:] - part[:2])
            high = height(used + cells, grown) > self._tallest
            if batch and (high or (used + cells) * grown.prod() > TEXELS):
                yield np.array(batch)
                batch, used, grown = [], 0, part[2:] - part[:2]
            batch.append(part)
            used, size = used + cells, grown
        if batch:
            yield np.array(batch)

    def _fill(self, job: ExactJob, parts: NDArray[np.int64], whole: bool = False) -> int:
        """Draw all slices and masks of some parts of the picture. Returns the draw calls.

        Where nothing is drawn, cells keep what they held, unless the `whole` of them is asked for.
        """
        whole |= job.technique.min_transmittance > 0
        emptied: tuple[list[NDArray[np.float64]], list[NDArray[np.float64]]] = ([], [])
        width, height = (parts[:, 2:] - parts[:, :2]).max(axis=0).tolist()
        slices: list[NDArray[np.int64]] = []
        entries: list[NDArray[np.int64]] = []
        corners: tuple[list[tuple[int, int]], list[tuple[int, int]]] = ([], [])
        self._slice_base, self._mask_base = [0], [0]
        # For each cell of masks: the cells of its targets, the part's first one and how many.
        owners: list[NDArray[np.int64]] = []
        bases: list[tuple[int, int]] = []
        shown: list[_Shown] = []
        for part in parts:
            corner = (int(part[0]), int(job.size[1] - part[3]))
            known = self._known.pop(part.tobytes(), None)
            shown.append(_shown(job, part) if known is None else known)
            objects, which, targets, reach, mask = shown[-1]
            slice_of = np.full(len(job.frame.reach), -1)
            slice_of[objects] = which + self._slice_base[-1]
            count = int(mask.max(initial=-1)) + 1
            owners += [slice_of[targets[mask == k]] for k in range(count)]
            bases += [(self._slice_base[-1], int(which.max(initial=-1)) + 1)] * count
            boxes = job.frame.boxes.extents[objects] + SLACK
            emptied[0].append(touched(boxes, which + self._slice_base[-1], part))
            emptied[1].append(touched(reach, mask + self._mask_base[-1], part))
            for found, cells, numbers, where, base in (
                (objects, slices, which, corners[0], self._slice_base),
                (targets, entries, mask, corners[1], self._mask_base),
            ):
                count = int(numbers.max(initial=-1)) + 1
                cells += [found[numbers == k] for k in range(count)]
                where += [corner] * count
                base.append(base[-1] + count)
        # More than bits can tell apart: there every cell is looked at everywhere.
        many = [max(s.which.max(initial=0), s.mask.max(initial=0)) >= MOST for s in shown]
        whole |= any(many)
        little = width * height * max(len(slices), len(entries)) <= LITTLE
        wiped = [None if whole or little else np.concatenate(rows) for rows in emptied]
        covering = [
            None if m else self._cover(job, part, row.objects, row.which)
            for m, part, row in zip(many, parts, shown, strict=True)
        ]
        size = (width, height)
        draws = self._fill_slices(job, size, slices, corners[0], wiped[0])
        made = self._slices
        assert made is not None
        draws += self._masks.look_up(job)
        self._looked_up = None if whole else self._masks.looked_up(job)
        self._bits = [
            None if begun is None else self._bits_of(job, begun, row.reach, row.mask)
            for begun, row in zip(covering, shown, strict=True)
        ]
        over = any(too_many(b[0], b[1]) for b in self._bits if b is not None)
        if self._looked_up is not None and not over:
            return draws
        into = MaskCells(size, entries, corners[1], owners, bases, wiped[1])
        return draws + self._masks.fill(job, into, made, self._textures["parts"])

    def _cover(
        self, job: ExactJob, part: Ints, objects: Ints, which: Ints
    ) -> tuple[Bits, Future[None] | None]:
        """Find which slices can show in each block of a part; of many triangles, begin to, beside
        the drawing."""
        table, bits = job.table, np.zeros(blocks.shape(job.size), np.uint64)
        every = table.triangles
        turns, moves = table.poses(objects, job.camera)
        spans, boxes = every.spans[objects], job.frame.boxes.extents[objects] + SLACK
        lens = coverage.lens(job.camera, job.size)
        args = (every.points, every.corners, spans, which, turns, moves, lens, boxes, part, bits)
        if int(np.diff(spans[:, 1]).sum()) > FEW:
            return bits, table.outlines.beside(coverage.cover, *args)
        coverage.cover(*args)
        return bits, None

    def _bits_of(
        self, job: ExactJob, covering: tuple[Bits, Future[None] | None], reach: Floats, mask: Ints
    ) -> tuple[Bits, Bits, Bits]:
        """(h, w) of each block: which slices can show in it, which masks by their numbers, and
        which cells of masks."""
        marks = self._masks.marks()
        if len(job.frame.doubtful):
            one = np.zeros(len(job.frame.doubtful), np.int64)
            marks *= blocks.covered(job.frame.doubtful, one, marks.shape)
        slices, begun = covering
        if begun is not None:
            begun.result()
        return slices, marks, blocks.covered(reach, mask, marks.shape) * (marks != 0)

    def _fill_slices(
        self,
        job: ExactJob,
        size: tuple[int, int],
        parts: list[Ints],
        corners: list[tuple[int, int]],
        wiped: Floats | None,
    ) -> int:
        surfaces = job.technique.granularity == "surface"
        # 16-bit floats hold whole numbers up to 2048.
        dtype = "f2" if len(job.table.scene.objects) <= 2048 else "f4"
        kind = (dtype, True, surfaces, 4)
        cells = emptied(self._context, self._slices, size, len(parts), kind, wiped)
        self._slices = cells
        self._context.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        self._context.depth_func = "<"
        base = job.table.first_triangle.astype(float)
        numbers = [base] * len(parts) if surfaces else None
        sequence, runs = job.table.sequence(parts, job.camera, numbers)
        shaders = [self._slice[surfaces, floor] for floor in (False, True)]
        for shader in shaders:
            job.use(shader, sequence)
        floors = job.table.floor_meshes
        for k, part in enumerate(runs):
            cells.select(k, corners[k], job.size)
            for mesh, start, count in part:
                mesh.draw(self._context, shaders[id(mesh) in floors], start, count)
        pipeline.within(cells.framebuffer, None)
        return sum(len(part) for part in runs)

    def _set_parts(self, job: ExactJob, opacity: NDArray[np.float64] | None) -> None:
        """Upload for each object whether it is impenetrable, and its opacity as a whole."""
        n = len(job.table.scene.objects)
        rows = np.zeros((-(-max(n, 1) // _PER_ROW) * _PER_ROW, 2), dtype="f4")
        rows[:n, 0] = impenetrable(job.table.scene, job.camera, job.technique)
        self._hard = bool(rows[:n, 0].any())
        rows[:n, 1] = 1.0 if opacity is None else opacity
        self._upload("parts", rows, _PER_ROW)

    def _upload(self, name: str, rows: Real, per_row: int) -> None:
        size = (per_row, len(rows) // per_row)
        if name not in self._textures or self._textures[name].size != size:
            if name in self._textures:
                self._textures.pop(name).release()
            texture = kept(self._context.texture(size, rows.shape[1], dtype="f4"))
            texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
            self._textures[name] = texture
        self._textures[name].write(rows.astype("f4").tobytes())

    def _select(self, job: ExactJob, whole: NDArray[np.int64]) -> int:
        """Find which surfaces, objects or groups lie before the core of a mask; set their opacity.

        Read back from all slices: an object may lie before a mask at a single pixel.
        """
        scene = job.table.scene
        by_surface = job.technique.granularity == "surface"
        best = np.zeros(job.table.first_triangle[-1] if by_surface else len(scene.objects))
        draws = 0
        for parts in self._batches(job, whole):
            for part in parts:
                draws += self._fill(job, part[None], whole=True)
                light, which = self._lit(job, part)
                lit = light > 0
                # Elsewhere nothing was drawn, and cells hold what they happened to hold.
                np.maximum.at(best, which[lit].astype(np.int64), light[lit])
        hard = impenetrable(scene, job.camera, job.technique)
        if by_surface:
            best[np.repeat(hard, np.diff(job.table.first_triangle))] = 0.0
            opacity = 1 - (1 - job.technique.alpha_target) * best
            rows = np.ones((-(-len(best) // _SURFACES_PER_ROW) * _SURFACES_PER_ROW, 1))
            rows[: len(best), 0] = opacity
            self._upload("surfaces", rows, _SURFACES_PER_ROW)
            return draws
        best[hard] = 0.0
        if job.technique.granularity == "region":
            groups = np.zeros(int(scene.group_of.max(initial=-1)) + 1)
            np.maximum.at(groups, scene.group_of, best)
            best = groups[scene.group_of]
        self._set_parts(job, 1 - (1 - job.technique.alpha_target) * best)
        return draws

    def _lit(self, job: ExactJob, part: Ints) -> tuple[Floats32, Floats32]:
        """Light on the masks behind each fragment of all slices, and its object or surface."""
        assert self._slices is not None
        cells = self._slices
        texture = self._context.texture(cells.whole, 1, dtype="f4")
        framebuffer = self._context.framebuffer([texture])
        framebuffer.use()
        self._sorter.whole(self._filled(job), part, 0, "OUTPUT_LIGHT")
        light = np.frombuffer(framebuffer.read(components=1, dtype="f4", alignment=1), "f4")
        framebuffer.release()
        texture.release()
        part_of = (0, 0, *cells.whole)
        if cells.numbers is not None:
            data = cells.framebuffer.read(part_of, 1, attachment=1, dtype="f4", alignment=1)
            return light, np.frombuffer(data, "f4")
        data = cells.framebuffer.read(part_of, 4, dtype="f4", alignment=1)
        return light, np.frombuffer(data, "f4")[3::4]

    def _filled(self, job: ExactJob) -> Filled:
        assert self._slices is not None
        return Filled(
            *(self._slices, self._masks.entries, self._slice_base, self._mask_base, self._textures),
            *(job.technique, job.table.scene.background, job.size, self._hard, self._looked_up),
        )


class _Shown(NamedTuple):
    """What a part of the picture shows: k `objects` and the slice of `which` each, and t `targets`
    with masks, the `reach` of these (t, 4) and the cell of each `mask` (t,)."""

    objects: Ints
    which: Ints
    targets: Ints
    reach: Floats
    mask: Ints


def _shown(job: ExactJob, part: Ints) -> _Shown:
    boxes = job.frame.boxes
    here = boxes.inside & _overlapping(boxes.extents, part)
    if len(job.frame.doubtful):
        wider = job.frame.doubtful + BLOCK * SLACK
        here &= np.any([_overlapping(boxes.extents, box) for box in wider], axis=0)
    objects = np.nonzero(here)[0]
    grown = np.ascontiguousarray(boxes.extents[objects] + SLACK)
    targets = job.frame.masked[_overlapping(job.frame.reach[job.frame.masked], part)]
    reach = np.ascontiguousarray(job.frame.reach[targets])
    return _Shown(objects, order.apart(grown), targets, reach, order.apart(reach))


def _overlapping(extents: NDArray[np.float64], part: NDArray[np.int64]) -> NDArray[np.bool_]:
    """(n,) which extents reach into a part of the picture."""
    low = np.all(extents[:, :2] <= part[2:], axis=1)
    return low & np.all(extents[:, 2:] >= part[:2], axis=1)


def bands(part: NDArray[np.int64], cells: int, tallest: int) -> list[NDArray[np.int64]]:
    """A part (left, top, right, bottom) cut so that all cells of a band fit into memory, and into
    a texture of no more than `tallest` rows."""
    left, top, right, bottom = part.tolist()
    step = TEXELS // max(1, (right - left) * cells)
    step = max(1, min(step, tallest // height(cells, (right - left, 1))))
    cuts = range(top, bottom, step)
    return [np.array([left, y, right, min(y + step, bottom)]) for y in cuts]


def _gl(part: NDArray[np.int64], size: tuple[int, int]) -> tuple[int, int, int, int]:
    """A part (left, top, right, bottom) as OpenGL's x, y (up), width, height."""
    left, top, right, bottom = part.tolist()
    return (left, size[1] - bottom, right - left, bottom - top)
