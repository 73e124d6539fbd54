"""Draws a plan into a picture, with or without a picture of ids beside it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device import pipeline, reused
from seethrough.renderer.gpu.device.meshes import MeshStore
from seethrough.renderer.gpu.device.pipeline import MASK, NOTHING, OBJECT, OPAQUE
from seethrough.renderer.gpu.device.programs import Shader, program
from seethrough.renderer.gpu.device.scene_table import Run, SceneTable
from seethrough.renderer.gpu.device.targets import FrameTarget
from seethrough.renderer.gpu.levels.crossing_painter import Ways
from seethrough.renderer.gpu.levels.layer_counter import LayerCounter
from seethrough.renderer.gpu.levels.lens import clip_from_offset, tight
from seethrough.renderer.gpu.levels.outside_painter import OutsidePainter, scope
from seethrough.renderer.gpu.levels.single_painter import Alone, SinglePainter
from seethrough.renderer.gpu.masks.mask_painter import MaskPainter
from seethrough.renderer.gpu.per_pixel.exact_masks import ExactJob
from seethrough.renderer.gpu.per_pixel.exact_painter import ExactPainter
from seethrough.renderer.gpu.rules import painters
from seethrough.renderer.gpu.rules.rule_program import Ruled, RulePrograms
from seethrough.renderer.look import floor
from seethrough.renderer.look.shaders import beside_floors
from seethrough.renderer.plan.frame_plan import FramePlan, Level
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.visibility import Drawn
from seethrough.renderer.techniques.base import REMOVAL, Parameters, Shot
from seethrough.renderer.techniques.dynamic.dynamic_transparency import (
    DynamicTransparency,
    by_masks,
)

if TYPE_CHECKING:
    from seethrough.renderer.gpu.levels.cluster_painter import ClusterPainter

AfterLevel = Callable[[NDArray[np.int64] | None], None]


@dataclass(frozen=True)
class FrameStats:
    """What a frame took: passes over objects, draw calls, masks made, and objects put in
    order. All 0 when the last frame was shown again."""

    passes: int
    draws: int
    masks: int
    ordered: int


class Layer:
    """One kind of picture: its programs, and how a plan is drawn into it. `look` are the defines of
    the scene's look (renderer/look/shaders.py)."""

    def __init__(
        self, context: moderngl.Context, store: MeshStore, ids: bool, look: Sequence[str] = ()
    ) -> None:
        self._context, self._store = context, store
        self._look = tuple(look)
        defines = [*(["WITH_IDS"] if ids else []), *look]
        self._defines, self._ruled = defines, dict[str, painters.Painter]()
        self.peeled: list[Drawn] = []  # layers of the last frame with ids, from the back
        bare = beside_floors(defines)
        self._object = program(context, "object.vert", "object.frag", bare)
        self._floors = dict[bool, Shader]()  # where floors are drawn on: flat ones, and others
        self._floor = self._object
        self._drawn_on = len(bare) < len(defines)
        self._depth = program(context, "object.vert", "depth.frag", bare)
        self._outside = OutsidePainter(context, bare)
        self._flush = pipeline.flushing(context)
        self._masks = MaskPainter(context, defines)
        self._counter: LayerCounter | None = None
        self._exact: ExactPainter | None = None
        self._clusters: ClusterPainter | None = None
        self._single: SinglePainter | None = None

    def draw(
        self,
        table: SceneTable,
        frame: FramePlan,
        camera: Camera,
        technique: Parameters,
        target: FrameTarget,
        scale: float = 1.0,
        after_level: AfterLevel | None = None,
        state: object = None,
    ) -> FrameStats:
        """Draw the plan. `scale` shrinks the masks' width; `after_level` follows each level
        and is told its objects, None for the opaque ones. `state` is the technique's."""
        self._passes = self._draws = 0
        self.peeled = []
        reused.begin(self._context)
        camera = tight(camera, frame)
        size = target.size
        self._matrix = clip_from_offset(camera, size)
        runs, rest = self._before(table, frame, camera, technique, scale, size)
        self._set_state()
        self._floor = self._for_floors(table)
        for shader in {self._object, self._depth, self._floor}:
            self._use(shader)
            table.set_look(shader, camera, size[1])
        counts, exact = None, None
        if len(frame.exact) and after_level is None:
            # Before the frame's own picture: on a software rasteriser to leave that half done and
            # come back to it costs more than all the little cells.
            exact = self._job(table, frame, camera, technique, scale, size)
            if frame.levels:
                counts = self._looked_up(table, frame, camera, technique, rest, size)
            self._painter().begin(exact, self._masks if frame.levels else None)
            self._bind(*self._bound)
            self._set_state()
        target.clear(table.scene.background)
        if len(frame.wide):
            lit = partial(self._draw_lit, runs[1], table, OPAQUE)
            self._draws += self._outside.draw(frame, size, lit)
        self._draw_lit(runs[0], table, OPAQUE)
        if after_level is not None:
            after_level(None)
        if frame.levels:
            if not self._masks.pending:  # else they and the rasteriser would share the cores
                self._flush()
            if exact is None:
                counts = self._looked_up(table, frame, camera, technique, rest, size)
                target.framebuffer.use()
            self._set_state()
            self._masks.begin(counts)
            self._blend_levels(table, camera, frame, runs[2:], technique, target, after_level)
        if frame.shot is not None:
            for name in painters.of(technique):
                self._draw_ruled(name, table, frame, technique, state, frame.shot, target)
                if after_level is not None and name == REMOVAL:
                    after_level(frame.ruled)
        if exact is not None:
            passes, draws = self._painter().finish(exact, target.framebuffer)
            self._passes += passes
            self._draws += draws
        return FrameStats(self._passes, self._draws, len(frame.masked), frame.ordered)

    def _draw_lit(self, runs: list[Run], table: SceneTable, blend: pipeline.Factors) -> None:
        """Objects with their colours; what is no floor by a program that asks nothing of it."""
        if not self._drawn_on:
            self._pass(self._object, runs, blend)
            return
        for shader, on_floor in ((self._object, False), (self._floor, True)):
            mine = [run for run in runs if (id(run[0]) in table.floor_meshes) == on_floor]
            self._pass(shader, mine, blend)

    def _for_floors(self, table: SceneTable) -> Shader:
        """What draws the floors of a scene."""
        if not self._drawn_on:
            return self._object
        flat = table.flat_floors
        if flat not in self._floors:
            defines = [*self._defines, *([floor.FLAT] if flat else [])]
            self._floors[flat] = program(self._context, "object.vert", "object.frag", defines)
        return self._floors[flat]

    def _draw_ruled(
        self,
        name: str,
        table: SceneTable,
        frame: FramePlan,
        technique: Parameters,
        state: object,
        shot: Shot,
        target: FrameTarget,
    ) -> None:
        """What the technique's rule is asked about, by a painter."""
        if name not in self._ruled:
            self._ruled[name] = painters.PAINTERS[name](self._context, self._defines)
        painter = self._ruled[name]
        self._draws += painter.draw(
            Ruled(table, frame, technique, state, shot, self._matrix), target
        )
        self._passes += 1
        self.peeled = painter.found[::-1]

    def needed(
        self,
        table: SceneTable,
        frame: FramePlan,
        camera: Camera,
        technique: Parameters,
        size: tuple[int, int],
    ) -> dict[str, NDArray[np.float32]]:
        """Pictures that the technique's rule needs, by name (RulePrograms.needed)."""
        camera = tight(camera, frame)
        programs = RulePrograms(self._context, self._defines)
        shot, matrix = Shot(table.scene, camera, size), clip_from_offset(camera, size)
        return programs.needed(table, technique, shot, matrix)

    def exact_layers(
        self,
        table: SceneTable,
        frame: FramePlan,
        camera: Camera,
        technique: Parameters,
        size: tuple[int, int],
        scale: float,
    ) -> list[tuple[NDArray[np.int64], NDArray[np.float32]]]:
        """Objects + 1 and shares at each pixel, from the front (ExactPainter.layers)."""
        reused.begin(self._context)
        camera = tight(camera, frame)
        frame = replace(frame, doubtful=frame.doubtful[:0])  # all of the picture
        self._matrix = clip_from_offset(camera, size)
        return self._painter().layers(self._job(table, frame, camera, technique, scale, size))

    def _painter(self) -> ExactPainter:
        if self._exact is None:
            self._exact = ExactPainter(self._context, self._look)
        return self._exact

    def _job(
        self, table: SceneTable, frame: FramePlan, camera: Camera, technique: Parameters,
        scale: float, size: tuple[int, int],
    ) -> ExactJob:  # fmt: skip
        own = by_masks(technique)
        return ExactJob(table, frame, camera, own, own.width * scale, size, self._matrix)

    def _set_state(self) -> None:
        self._context.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE | moderngl.BLEND)
        self._context.depth_func = "<="

    def _before(
        self,
        table: SceneTable,
        frame: FramePlan,
        camera: Camera,
        technique: Parameters,
        scale: float,
        size: tuple[int, int],
    ) -> tuple[list[list[Run]], list[list[Run]]]:
        """Put the objects in sequence, begin what the masks look up. Returns the runs of the opaque
        pass and of each level, and those that `_looked_up` draws."""
        wide = np.zeros(len(frame.reasons), dtype=bool)
        wide[frame.wide] = True
        apart = np.zeros(len(frame.reasons), dtype=bool)  # drawn otherwise, in their levels
        apart[frame.single] = True
        if frame.clusters:
            apart[[members[0] for members in frame.clusters]] = True
        parts = [frame.opaque, frame.wide]
        for level in frame.levels:
            alone = level.objects[~apart[level.objects]]
            within = wide[alone]
            parts += [alone[~within], alone[within]]
        levels = len(parts)
        single = list(dict.fromkeys([*frame.single.tolist(), *frame.swapping[:, 1].tolist()]))
        parts += [np.array([i]) for i in single]
        extra = []
        if frame.levels:
            own = by_masks(technique)
            extra = self._masks.prepare(table, frame, camera, own, own.width * scale, size)
            counted = _counted(frame, own)
            if len(counted):
                occluders = np.concatenate([np.zeros(0, np.int64), *parts[2:]])
                extra = [*extra, counted, occluders]
        slope = table.scene.look.detail_error * scale * camera.pixel(size[1])
        sequence, runs = table.sequence([*parts, *extra], camera, slope=slope)
        self._bind(table, sequence)
        self._runs_of = dict(zip(single, runs[levels:], strict=False))
        return runs[:levels], runs[len(parts) :]

    def _looked_up(
        self,
        table: SceneTable,
        frame: FramePlan,
        camera: Camera,
        technique: Parameters,
        runs: list[list[Run]],
        size: tuple[int, int],
    ) -> moderngl.Texture | None:
        """Draw what the masks look up. Returns the picture of counts if one is needed."""
        self._use(self._masks.cover)
        whole = len(self._masks.geometry.covered)
        draws = self._masks.draw_distances(table, runs[:whole], camera)
        self._passes += draws > 0
        self._draws += draws
        if not len(_counted(frame, by_masks(technique))):
            return None
        return self._count(size, runs[-2], runs[-1])

    def _count(
        self, size: tuple[int, int], targets: list[Run], occluders: list[Run]
    ) -> moderngl.Texture:
        if self._counter is None:
            self._counter = LayerCounter(self._context)
        self._use(self._counter.program)
        self._passes += 2
        self._draws += self._counter.draw(size, targets, occluders)
        return self._counter.counts

    def _bind(self, table: SceneTable, sequence: moderngl.Texture) -> None:
        self._bound = table, sequence
        table.table.use(0)
        sequence.use(1)

    def _use(self, shader: Shader) -> None:
        shader["clip_from_offset"].write(self._matrix)
        shader.set(table=0, sequence=1)

    def _pass(self, shader: Shader, runs: list[Run], blend: pipeline.Factors) -> None:
        if not runs:
            return
        if blend is OPAQUE:
            self._context.disable(moderngl.BLEND)
        else:
            self._context.enable(moderngl.BLEND)
            pipeline.blend(self._context, blend)
        for mesh, start, count in runs:
            mesh.draw(self._context, shader, start, count)
        self._passes += 1
        self._draws += len(runs)

    def _draw_clusters(
        self, table: SceneTable, camera: Camera, frame: FramePlan, level: Level
    ) -> None:
        """The level's clusters, polygon by polygon."""
        for members in frame.clusters:
            if members[0] not in level.objects:
                continue
            if self._clusters is None:
                # Most frames have none, and its kernels take a second to load.
                from seethrough.renderer.gpu.levels.cluster_painter import ClusterPainter

                self._clusters = ClusterPainter(self._context)
            self._context.enable(moderngl.BLEND)
            pipeline.blend(self._context, OBJECT)
            self._draws += self._clusters.draw(table.scene, members, camera, self._object)
            self._passes += 1
            self._bind(*self._bound)

    def _blend_levels(
        self,
        table: SceneTable,
        camera: Camera,
        frame: FramePlan,
        runs: list[list[Run]],
        technique: Parameters,
        target: FrameTarget,
        after_level: AfterLevel | None,
    ) -> None:
        every, least = "prepass" in frame.without, by_masks(technique).combine == "min"
        singles = set(frame.single.tolist())
        if singles:
            ways = Ways(
                depth=lambda runs: self._pass(self._depth, runs, NOTHING),
                lit=lambda runs: self._draw_lit(runs, table, OBJECT),
                multiplied=lambda shader, runs: self._pass(shader, runs, MASK),
                told=after_level,
            )
            job = Alone(frame, table.scene, camera, by_masks(technique).alpha_target, ways)
            single = self._single = self._single or SinglePainter(
                self._context, beside_floors(self._defines)
            )
            self._use(single.opacity)
            single.begin(job, self._runs_of, self._masks, target.framebuffer)
        for k, level in enumerate(frame.levels):
            for part, wide in zip(runs[2 * k : 2 * k + 2], (False, True), strict=True):
                if wide and part:
                    pipeline.within(target.framebuffer, scope(frame, target.size))
                solid = [run for run in part if every or not run[0].mesh.convex]
                self._pass(self._depth, solid, NOTHING)
                self._draw_lit(part, table, OBJECT)
                pipeline.within(target.framebuffer, None)
            self._draw_clusters(table, camera, frame, level)
            for i in singles.intersection(level.objects.tolist()):
                self._draws += single.draw(i)
            if after_level is not None and len(level.objects):
                after_level(level.objects)
            if len(level.masks):
                self._draw_masks(level.masks, least)

    def _draw_masks(self, targets: NDArray[np.int64], least: bool) -> None:
        context = self._context
        context.enable(moderngl.BLEND)
        context.disable(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        pipeline.blend(context, MASK)
        if least:
            pipeline.combine(context, moderngl.FUNC_ADD, moderngl.MIN)
        self._draws += self._masks.draw(targets)
        pipeline.combine(context, moderngl.FUNC_ADD)
        context.enable(moderngl.DEPTH_TEST | moderngl.CULL_FACE)


def _counted(frame: FramePlan, technique: DynamicTransparency) -> NDArray[np.int64]:
    """Targets whose layers are counted."""
    all_of_them = "counting" in frame.without and technique.min_transmittance > 0
    return frame.masked if all_of_them else frame.counted
