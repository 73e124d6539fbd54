"""Draws scenes into pictures: OpenGL 3.3 core, in a context that somebody else made."""

from __future__ import annotations

from dataclasses import dataclass

import moderngl
import numpy as np
from numpy.typing import NDArray

from renderer.camera import Camera
from renderer.gpu.mask_painter import MaskPainter
from renderer.gpu.meshes import MeshStore
from renderer.gpu.programs import program
from renderer.gpu.scene_table import Run, SceneTable
from renderer.gpu.targets import FrameTarget
from renderer.plan import FramePlan, Technique, plan
from renderer.scene import Scene
from renderer.techniques.dynamic import DynamicTransparency
from renderer.visibility import Visibility, visibility

OPAQUE = (moderngl.ONE, moderngl.ZERO, moderngl.ONE, moderngl.ZERO)
NOTHING = (moderngl.ZERO, moderngl.ONE, moderngl.ZERO, moderngl.ONE)
OBJECT = (moderngl.DST_ALPHA, moderngl.ONE_MINUS_DST_ALPHA, moderngl.ZERO, moderngl.ONE)
MASK = (moderngl.ZERO, moderngl.ONE, moderngl.ZERO, moderngl.SRC_ALPHA)


@dataclass(frozen=True)
class FrameStats:
    """What a frame took: passes over objects, draw calls, masks made, objects put in order."""

    passes: int
    draws: int
    masks: int
    ordered: int


class Layer:
    """One kind of picture (with or without ids): its programs, and how a plan is drawn into it."""

    def __init__(self, context: moderngl.Context, store: MeshStore, ids: bool) -> None:
        self._context, self._store = context, store
        defines = ["WITH_IDS"] if ids else []
        self._object = program(context, "object.vert", "object.frag", defines)
        self._depth = program(context, "object.vert", "depth.frag", defines)
        self._masks = MaskPainter(context, ids)

    def draw(
        self,
        table: SceneTable,
        frame: FramePlan,
        camera: Camera,
        technique: Technique,
        target: FrameTarget,
        scale: float = 1.0,
        after_level=None,  # type: ignore[no-untyped-def]
    ) -> FrameStats:
        """Draw the plan. `scale` shrinks the masks' width; `after_level()` follows each level."""
        self._passes = self._draws = 0
        camera = _tight(camera, frame)
        size = target.size
        covers: list[NDArray[np.int64]] = []
        channel = np.zeros(len(table.scene.objects))
        if len(frame.masked) and isinstance(technique, DynamicTransparency):
            covers, channel = self._masks.prepare(
                table, frame, camera, technique, technique.width * scale, size
            )
        blended = [level.objects for level in frame.levels]
        parts = [frame.opaque, *blended, *covers]
        sequence, runs = table.sequence(parts, camera, channel)
        table.table.use(0)
        sequence.use(1)
        matrix = _clip_from_offset(camera, size)
        if covers:
            self._passes += 1
            self._bind(self._masks.cover, matrix)
            self._draws += self._masks.draw_distances(
                table, runs[1 + len(blended) :], camera, matrix, size
            )
        self._begin(target, table.scene.background, matrix)
        self._pass(self._object, runs[0], OPAQUE)
        if after_level is not None:
            after_level()
        self._blend_levels(frame, runs[1:], after_level)
        return FrameStats(self._passes, self._draws, len(frame.masked), frame.ordered)

    def _bind(self, shader: moderngl.Program, matrix: bytes) -> None:
        shader["clip_from_offset"].write(matrix)
        for unit, name in enumerate(("table", "sequence")):
            if name in shader:
                shader[name].value = unit

    def _begin(
        self, target: FrameTarget, background: tuple[float, float, float], matrix: bytes
    ) -> None:
        self._context.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE | moderngl.BLEND)
        self._context.depth_func = "<="
        target.framebuffer.use()
        target.clear(background)
        for shader in (self._object, self._depth):
            self._bind(shader, matrix)

    def _pass(
        self, shader: moderngl.Program, runs: list[Run], blend: tuple[int, int, int, int]
    ) -> None:
        if not runs:
            return
        if blend is OPAQUE:
            self._context.disable(moderngl.BLEND)
        else:
            self._context.enable(moderngl.BLEND)
            self._context.blend_func = blend
        first = shader["first"]
        for mesh, start, count in runs:
            first.value = start
            mesh.array(self._context, shader).render(instances=count)
        self._passes += 1
        self._draws += len(runs)

    def _blend_levels(self, frame: FramePlan, runs: list[list[Run]], after_level) -> None:  # type: ignore[no-untyped-def]
        for level, part in zip(frame.levels, runs, strict=False):
            self._pass(self._depth, [run for run in part if not run[0].mesh.convex], NOTHING)
            self._pass(self._object, part, OBJECT)
            if after_level is not None and part:
                after_level()
            if len(level.masks):
                self._context.enable(moderngl.BLEND)
                self._context.disable(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
                self._context.blend_func = MASK
                self._draws += self._masks.draw(level.masks)
                self._context.enable(moderngl.DEPTH_TEST | moderngl.CULL_FACE)


def _clip_from_offset(camera: Camera, size: tuple[int, int]) -> bytes:
    """clip ← (world − eye), for GLSL."""
    turn = np.eye(4)
    turn[:3, :3] = camera.rotation.T
    return (camera.projection(size[0] / size[1]) @ turn).T.astype("f4").tobytes()


def _tight(camera: Camera, frame: FramePlan) -> Camera:
    """The camera with its depth range closed in on what is drawn: more bits for each unit."""
    seen = np.nonzero(frame.boxes.inside)[0]
    if not len(seen):
        return camera
    near = max(camera.near, float(frame.boxes.near[seen].min()) * (1 - 1e-6))
    far = min(camera.far, float(frame.boxes.far[seen].max()) * (1 + 1e-6))
    if near >= far:
        return camera
    return Camera(camera.eye, camera.rotation, camera.fov_y, near, far)


class Renderer:
    """Draws a scene as a technique shows it. Meshes are uploaded once, a scene when it changes."""

    def __init__(
        self, context: moderngl.Context, size: tuple[int, int] = (800, 600), samples: int = 0
    ) -> None:
        self.context = context
        self._store = MeshStore(context)
        self._layer = Layer(context, self._store, ids=False)
        self._id_layer: Layer | None = None
        self._tables: dict[int, SceneTable] = {}
        self._present = program(context, "present.vert", "present.frag")
        self._triangle = context.vertex_array(self._present, [])
        self._samples = min(samples, context.max_samples)
        self._target = FrameTarget(context, _checked(size), self._samples)
        self._small: FrameTarget | None = None

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) of the pictures, in pixels."""
        return self._target.size

    def resize(self, size: tuple[int, int]) -> None:
        """Draw pictures of another size from now on."""
        if _checked(size) != self._target.size:
            self._target.release()
            self._target = FrameTarget(self.context, size, self._samples)

    def draw(
        self,
        scene: Scene,
        camera: Camera,
        technique: Technique,
        target_framebuffer: moderngl.Framebuffer | None = None,
    ) -> FrameStats:
        """Draw a frame; it is also put into `target_framebuffer` (a window's), if given."""
        frame = plan(scene, camera, technique, self.size)
        stats = self._layer.draw(self._table(scene), frame, camera, technique, self._target)
        self._target.resolve()
        if target_framebuffer is not None:
            self._show(target_framebuffer)
        return stats

    def read(self) -> NDArray[np.uint8]:
        """(h, w, 3) the last frame, row 0 on top."""
        return self._target.read()

    def look(
        self,
        scene: Scene,
        camera: Camera,
        technique: Technique,
        size: tuple[int, int] = (200, 150),
    ) -> Visibility:
        """What can be seen of each object in the frame as `draw` serves it, found at `size`.

        Masks are as wide, against the picture, as in the frame. The picture drawn last stays.
        """
        if self._small is None or self._small.size != size:
            if self._small is not None:
                self._small.release()
            self._small = FrameTarget(self.context, _checked(size), ids=True)
        if self._id_layer is None:
            self._id_layer = Layer(self.context, self._store, ids=True)
        small = self._small
        layers: list[tuple[NDArray[np.int64], NDArray[np.floating]]] = []
        last = np.zeros(size[::-1], dtype=np.int64)

        def keep() -> None:
            nonlocal last
            ids = small.read_ids()
            layers.append((np.where(ids != last, ids, 0), small.read_alpha()))
            last = ids

        frame = plan(scene, camera, technique, size)
        scale = size[1] / self.size[1]
        self._id_layer.draw(self._table(scene), frame, camera, technique, small, scale, keep)
        return visibility(layers, small.read(), len(scene.objects))

    def _show(self, framebuffer: moderngl.Framebuffer) -> None:
        framebuffer.use()
        self.context.enable_only(moderngl.NOTHING)
        self._target.color.use(0)
        self._present["frame"].value = 0
        self._triangle.render(moderngl.TRIANGLES, 3)

    def _table(self, scene: Scene) -> SceneTable:
        """The scene's table; the two latest scenes are kept (a trial's own and its inset's)."""
        key = id(scene)
        if key in self._tables:
            self._tables[key] = self._tables.pop(key)
        else:
            while len(self._tables) >= 4:
                self._tables.pop(next(iter(self._tables))).release()
            self._tables[key] = SceneTable(self.context, self._store, scene)
        return self._tables[key]


def _checked(size: tuple[int, int]) -> tuple[int, int]:
    if not all(isinstance(s, (int, np.integer)) and 1 <= s <= 16384 for s in size):
        raise ValueError(f"size = {size!r}, expected (width, height) from 1 to 16384 pixels")
    return (int(size[0]), int(size[1]))
