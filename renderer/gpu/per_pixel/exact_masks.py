"""The masks of the exact picture: entries in the lists of fragments.

In general each is drawn into a cell of its own: opacity, and the depth at which it lies. Where all
of them are looked up in pictures of distances, the sorter looks them up itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device import pipeline
from seethrough.renderer.gpu.device.programs import Shader
from seethrough.renderer.gpu.device.scene_table import SceneTable
from seethrough.renderer.gpu.masks.looked_up import LookedUp
from seethrough.renderer.gpu.masks.mask_painter import BITS, MaskPainter
from seethrough.renderer.gpu.per_pixel.exact_sorter import COLORS, DEPTHS, PARTS
from seethrough.renderer.gpu.per_pixel.pixel_cells import Cells, emptied
from seethrough.renderer.plan.frame_plan import FramePlan
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.projection import depth_values
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

# Rasterisation may reach a pixel beyond the box of the exact coordinates.
SLACK = np.array([-1.0, -1.0, 1.0, 1.0])


@dataclass(frozen=True, eq=False)
class ExactJob:
    """All that one frame's exact parts need: `clip` is clip ← (world − eye) for GLSL."""

    table: SceneTable
    frame: FramePlan
    camera: Camera
    technique: DynamicTransparency
    width: float
    size: tuple[int, int]
    clip: bytes

    def use(self, shader: Shader, sequence: moderngl.Texture) -> None:
        """Let a shader draw the objects of a sequence."""
        self.table.table.use(0)
        sequence.use(1)
        shader["clip_from_offset"].write(self.clip)
        shader.set(table=0, sequence=1)
        self.table.set_look(shader, self.camera, self.size[1])


@dataclass(frozen=True, eq=False)
class MaskCells:
    """The cells that masks are drawn into, each of `size`: of each cell its targets (`parts`), its
    corner in the picture, the slices of its targets (`owners`, −1: none), and where the part's
    slices begin and how many there are (`bases`). `wiped` (k, 4) is what has to be empty before."""

    size: tuple[int, int]
    parts: list[NDArray[np.int64]]
    corners: list[tuple[int, int]]
    owners: list[NDArray[np.int64]]
    bases: list[tuple[int, int]]
    wiped: NDArray[np.float64] | None


class ExactMasks:
    """The masks of one frame at a time."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._painters: dict[bool, MaskPainter] = {}
        self.entries: Cells | None = None

    def prepare(self, job: ExactJob, made: MaskPainter | None = None) -> None:
        """Make the masks' geometry, and begin the distances that they look up; or take over those
        `made` for the frame already."""
        caps = job.technique.min_transmittance > 0
        if caps not in self._painters:
            defines = ["CELLS"] + ["WITH_CAPS"] * caps
            self._painters[caps] = MaskPainter(self._context, defines)
        self._painter = self._painters[caps]
        self._covers: list[NDArray[np.int64]] | None = None
        if made is not None:
            self._painter.adopt(made)
            return
        self._covers = self._painter.prepare(
            job.table, job.frame, job.camera, job.technique, job.width, job.size
        )

    def look_up(self, job: ExactJob) -> int:
        """Draw the pictures of distances, if that is still to do. Returns the draw calls."""
        if self._covers is None:
            return 0
        sequence, runs = job.table.sequence(self._covers, job.camera)
        self._covers = None
        job.use(self._painter.cover, sequence)
        return self._painter.draw_distances(job.table, runs, job.camera)

    def marks(self) -> NDArray[np.uint64]:
        """(h, w) of each block, the masks that can show in it (MaskPainter.marks)."""
        return self._painter.marks()

    def looked_up(self, job: ExactJob) -> LookedUp | None:
        """What the sorter needs to look all masks up by itself, None where it can not."""
        made, technique = self._painter.geometry, job.technique
        plain = technique.mask == "outline" and technique.mode == "passive"
        if not plain or made.pictured > 0 or technique.min_transmittance > 0:
            return None
        if not 0 < len(made.targets) <= BITS:
            return None
        texture = self._painter.distances
        depths = depth_values(job.table.scene.centers, job.camera)
        return LookedUp(texture, made.targets, made.shift[made.targets], depths[made.targets],
                        job.width, technique.alpha_target, technique.alpha_edge)  # fmt: skip

    def fill(
        self,
        job: ExactJob,
        cells: MaskCells,
        slices: Cells,
        hard: moderngl.Texture,
    ) -> int:
        """Draw the entries of all masks, which look up where their targets show in `slices`, and
        what is `hard`. Returns the draw calls."""
        size, parts, corners = cells.size, cells.parts, cells.corners
        owners, bases = cells.owners, cells.bases
        components = 2 if job.technique.granularity == "pixel" else 4
        kind = ("f4", False, False, components)
        self.entries = emptied(self._context, self.entries, size, len(parts), kind, cells.wiped)
        self._context.enable_only(moderngl.NOTHING)
        painter = self._painter
        depths, extents = (
            depth_values(job.table.scene.centers, job.camera),
            job.frame.boxes.extents + SLACK,
        )
        painter.begin()
        assert slices.depth is not None  # slices have one
        slices.depth.use(DEPTHS)
        slices.color.use(COLORS)
        hard.use(PARTS)
        painter.set(depths=DEPTHS, colors=COLORS, parts=PARTS)
        painter.set(cell=size, row_end=slices.columns * size[0])
        painter.set(per_pixel=components == 2, additive=job.technique.model == "additive")
        for k, targets in enumerate(parts):
            self.entries.select(k, corners[k], job.size)
            x, y = self.entries.framebuffer.scissor[:2]
            painter.set(shift=(corners[k][0] - x, corners[k][1] - y))
            painter.set(first_way=slices.way(bases[k][0], corners[k]), slices=bases[k][1])
            for t, owner in zip(targets.tolist(), owners[k].tolist(), strict=True):
                place = extents[t].tolist() if owner >= 0 else (0.0, 0.0, 0.0, 0.0)
                way = slices.way(max(owner, 0), corners[k])
                shader = painter.shader_of(t)
                shader.set(beside=float(depths[t]), target=t, extents=tuple(place), way=way)
                painter.draw_one(t)
        pipeline.within(self.entries.framebuffer, None)
        return sum(len(targets) for targets in parts)
