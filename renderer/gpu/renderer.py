"""Draws scenes into pictures: OpenGL 3.3 core, in a context that somebody else made."""

from __future__ import annotations

from collections.abc import Set

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device.meshes import MeshStore
from seethrough.renderer.gpu.device.programs import program
from seethrough.renderer.gpu.device.scene_table import SceneTable
from seethrough.renderer.gpu.device.targets import FrameTarget, half_values
from seethrough.renderer.gpu.edges.edge_painter import EdgePainter
from seethrough.renderer.gpu.levels.layer import FrameStats, Layer
from seethrough.renderer.look.shaders import defines
from seethrough.renderer.plan.frame_plan import SHORTCUTS, FramePlan
from seethrough.renderer.plan.planner import plan
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.scene.tallies import around, changed
from seethrough.renderer.scene.visibility import Drawn, Visibility, visibility, visibility_of_shares
from seethrough.renderer.techniques.base import Parameters, Shot

SCENES_KEPT = 4  # a trial's own, its inset's, and the last ones of both
ALL_OPAQUE = np.zeros((0, 0, 4), np.uint16)


class Renderer:
    """Draws a scene as a technique shows it. Meshes are uploaded once, a scene when it changes.

    `without` names shortcuts not to take (renderer.plan.SHORTCUTS), for tests and measurements.
    `window`: the height in pixels of the window that a picture is shown in, where it is smaller
    than that: what is counted in the window's pixels keeps its part of the picture.
    """

    def __init__(
        self,
        context: moderngl.Context,
        size: tuple[int, int] = (800, 600),
        samples: int = 0,
        without: Set[str] = frozenset(),
        window: int | None = None,
    ) -> None:
        unknown = set(without) - set(SHORTCUTS)
        if unknown:
            raise ValueError(f"without = {sorted(unknown)}, expected some of {sorted(SHORTCUTS)}")
        self.context = context
        self.window = window
        self.without = frozenset(without)
        self.plan: FramePlan | None = None
        self._store = MeshStore(context)
        self._layers: dict[tuple[bool, tuple[str, ...]], Layer] = {}
        self._layer(False, Scene(()))  # most pictures have no look: its programs are there at once
        self._tables: dict[int, SceneTable] = {}
        self._present = program(context, "present.vert", "present.frag")
        self._triangle = context.vertex_array(self._present.program, [])
        self._samples = samples
        self._targets: dict[int, FrameTarget] = {}
        self._size = _checked(size)
        self._target = self._with_samples(samples)
        self._edges = EdgePainter(context)
        self._small: FrameTarget | None = None
        self._shown: tuple[Scene, Camera, Parameters, object] | None = None

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) of the pictures, in pixels."""
        return self._size

    def resize(self, size: tuple[int, int]) -> None:
        """Draw pictures of another size from now on."""
        if _checked(size) != self._size:
            for target in self._targets.values():
                target.release()
            self._targets, self._size = {}, _checked(size)
            self._target = self._with_samples(self._samples)
            self._shown = None

    def _with_samples(self, samples: int) -> FrameTarget:
        """The picture with so many samples a pixel, or as many as there can be."""
        samples = min(samples, self.context.max_samples)
        if samples not in self._targets:
            self._targets[samples] = FrameTarget(self.context, self._size, samples)
        return self._targets[samples]

    def draw(
        self,
        scene: Scene,
        camera: Camera,
        technique: Parameters,
        target_framebuffer: moderngl.Framebuffer | None = None,
        state: object = None,
    ) -> FrameStats:
        """Draw a frame; it is also put into `target_framebuffer` (a window's), if given.

        A technique is its parameters, and the `state` that events made of it (None: there were no
        events). Nothing is planned or drawn while scene, camera, parameters and state are the same.
        """
        if state is None:
            state = technique.technique.begin(technique)
        if self._unchanged(scene, camera, technique, state):
            stats = FrameStats(0, 0, 0, 0)
        else:
            samples = scene.look.samples(self._samples)
            self._target = self._with_samples(samples)
            # Where pixels have several samples, only the depth buffer's picture has.
            without = self.without | {"held"} if samples else self.without
            scale = self.size[1] / self.window if self.window else 1.0
            shown = _shown(scene, camera, technique, state, self.size)
            drawn = technique.technique.drawn(technique, state)
            self.plan = plan(shown, camera, drawn, self.size, without, scale, state=state)
            args = (self._table(shown), self.plan, camera, drawn, self._target)
            stats = self._layer(False, shown).draw(*args, scale, state=state)
            self._target.resolve()
            smooth, width = scene.look.smooths(self._samples), scene.look.outlines * scale
            if smooth or width > 0:
                self._edges.draw(args[0], self.plan, camera, self._target, smooth, width)
            self._shown = (scene, camera, technique, state)
        if target_framebuffer is not None:
            self._show(target_framebuffer)
        return stats

    def read(self) -> NDArray[np.uint8]:
        """(h, w, 3) the last frame, row 0 on top."""
        return self._target.read()

    def raw(self) -> bytes:
        """The last frame's own numbers: frames with the same ones are the same picture.

        On a software rasteriser `read` takes twenty times as long, to make bytes of them.
        """
        return self._target.raw()

    def look(
        self,
        scene: Scene,
        camera: Camera,
        technique: Parameters,
        size: tuple[int, int] = (200, 150),
        state: object = None,
    ) -> Visibility:
        """What can be seen of each object in the frame as `draw` serves it, found at `size`.

        Masks are as wide, against the picture, as in the frame. The picture drawn last stays.
        """
        if state is None:
            state = technique.technique.begin(technique)
        n = len(scene.objects)
        scene = _shown(scene, camera, technique, state, size)
        technique = technique.technique.drawn(technique, state)
        technique = technique.technique.looked_at(technique)
        frame = self._looked(scene, camera, technique, size, state)
        if len(frame.exact):
            # What a frame sorts by pixel is in none of its layers.
            small, layer = self._looking(size, scene)
            scale = size[1] / self.size[1]
            layer.draw(self._table(scene), frame, camera, technique, small, scale)
            shares = self.shares(scene, camera, technique, size)
            return visibility_of_shares(shares, small.read(), n)
        layers = self._drawn(scene, camera, technique, size, frame, state)
        # What a technique adds to the scene is nobody's.
        return visibility(layers, self._looking(size, scene)[0].read(), n)

    def _looked(
        self,
        scene: Scene,
        camera: Camera,
        technique: Parameters,
        size: tuple[int, int],
        state: object = None,
    ) -> FramePlan:
        """The plan of the frame, found at `size`."""
        technique = technique.technique.looked_at(technique)
        return plan(scene, camera, technique, size, self.without, size[1] / self.size[1], state)

    def shares(
        self, scene: Scene, camera: Camera, technique: Parameters, size: tuple[int, int]
    ) -> list[tuple[NDArray[np.int64], NDArray[np.float32]]]:
        """What each pixel shows when it is sorted by itself: from the front, objects + 1 (h, w),
        0 for none, and their shares of the pixel (h, w)."""
        layer, scale = self._looking(size, scene)[1], size[1] / self.size[1]
        frame = self._looked(scene, camera, technique, size)
        return layer.exact_layers(self._table(scene), frame, camera, technique, size, scale)

    def layers(
        self, scene: Scene, camera: Camera, technique: Parameters, size: tuple[int, int]
    ) -> list[tuple[NDArray[np.int64], NDArray[np.floating]]]:
        """What `look` sees where nothing is sorted by pixel: from back to front, object + 1 (h, w)
        where the layer drew anything, else 0, and the opacity (h, w) with which it did."""
        technique, scale = technique.technique.looked_at(technique), size[1] / self.size[1]
        frame = plan(scene, camera, technique, size, self.without | {"held"}, scale)
        found = []
        for where, numbers, opacity in self._drawn(scene, camera, technique, size, frame):
            ids, alpha = np.zeros(size[::-1], np.int64), np.ones(size[::-1])
            ids.flat[where], alpha.flat[where] = numbers, opacity
            found.append((ids, alpha))
        return found

    def needed(
        self, scene: Scene, camera: Camera, technique: Parameters
    ) -> dict[str, NDArray[np.float32]]:
        """Name → (h, w) of the pictures that a technique's rule needs, of the frame's size."""
        frame = plan(scene, camera, technique, self.size, self.without)
        return self._layer(False, scene).needed(
            self._table(scene), frame, camera, technique, self.size
        )

    def _drawn(
        self,
        scene: Scene,
        camera: Camera,
        technique: Parameters,
        size: tuple[int, int],
        frame: FramePlan,
        state: object = None,
    ) -> list[Drawn]:
        small, layer = self._looking(size, scene)
        found: list[Drawn] = []
        last = np.zeros(size[::-1], dtype=np.float32)

        def keep(objects: NDArray[np.int64] | None) -> None:
            """Find what changed, which is nowhere but in the boxes of the objects drawn."""
            left, top, right, bottom = part = _about(frame.boxes.extents, objects, size)
            if left >= right or top >= bottom:
                return
            ids, before = small.read_ids(part), last[top:bottom, left:right]
            colors = ALL_OPAQUE if objects is None else small.read_colors(part)
            found.append(changed(ids, colors, before, (left, top, size[0]), half_values()))

        scale = size[1] / self.size[1]
        layer.draw(self._table(scene), frame, camera, technique, small, scale, keep, state)
        return [*found, *layer.peeled]

    def _looking(self, size: tuple[int, int], scene: Scene) -> tuple[FrameTarget, Layer]:
        """The picture with ids, and what draws the scene into it."""
        if self._small is None or self._small.size != size:
            if self._small is not None:
                self._small.release()
            self._small = FrameTarget(self.context, _checked(size), ids=True)
        return self._small, self._layer(True, scene)

    def _layer(self, ids: bool, scene: Scene) -> Layer:
        """What draws scenes that look like this one."""
        key = (ids, defines(scene.look, scene.background))
        if key not in self._layers:
            self._layers[key] = Layer(self.context, self._store, *key)
        return self._layers[key]

    def _unchanged(
        self, scene: Scene, camera: Camera, technique: Parameters, state: object
    ) -> bool:
        if self._shown is None or "still" in self.without:
            return False
        old_scene, old, old_technique, old_state = self._shown
        return (
            scene is old_scene
            and technique == old_technique
            and state == old_state
            and (camera.fov_y, camera.near, camera.far) == (old.fov_y, old.near, old.far)
            and np.array_equal(camera.eye, old.eye)
            and np.array_equal(camera.rotation, old.rotation)
        )

    def _show(self, framebuffer: moderngl.Framebuffer) -> None:
        framebuffer.use()
        self.context.enable_only(moderngl.NOTHING)
        self._target.color.use(0)
        self._present["frame"].value = 0
        self._triangle.render(moderngl.TRIANGLES, 3)

    def _table(self, scene: Scene) -> SceneTable:
        key = id(scene)
        if key in self._tables:
            self._tables[key] = self._tables.pop(key)
        else:
            while len(self._tables) >= SCENES_KEPT:
                self._tables.pop(next(iter(self._tables))).release()
            self._tables[key] = SceneTable(self.context, self._store, scene)
        return self._tables[key]


def _about(
    extents: NDArray[np.float64], objects: NDArray[np.int64] | None, size: tuple[int, int]
) -> tuple[int, int, int, int]:
    """Left, top, right, bottom in pixels of what objects can cover; None: the whole picture."""
    return (0, 0, *size) if objects is None else around(extents, objects, *size)


def _shown(
    scene: Scene, camera: Camera, technique: Parameters, state: object, size: tuple[int, int]
) -> Scene:
    """What stands there in this frame: objects may have moved."""
    return technique.technique.shown(technique, state, Shot(scene, camera, size)).scene


def _checked(size: tuple[int, int]) -> tuple[int, int]:
    if not all(isinstance(s, (int, np.integer)) and 1 <= s <= 16384 for s in size):
        raise ValueError(f"size = {size!r}, expected (width, height) from 1 to 16384 pixels")
    return (int(size[0]), int(size[1]))
