"""Draws the masks of a frame's targets between its objects."""

from __future__ import annotations

from collections.abc import Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device.programs import Shader, program
from seethrough.renderer.gpu.device.reused import kept
from seethrough.renderer.gpu.device.scene_table import Run, SceneTable
from seethrough.renderer.gpu.masks.distance_painter import DistancePainter
from seethrough.renderer.gpu.masks.mask_maker import ELLIPSES, MaskGeometry, mask_geometry
from seethrough.renderer.plan import blocks
from seethrough.renderer.plan.frame_plan import FramePlan
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

_FORMAT = ("2f 2f 1f 2f", "in_place", "in_offset", "in_kind", "in_extra")
_UNITS = {"distances": 2, "rings": 3, "counts": 4}


_PREPARED = (
    *("_boxed", "_distances", "_technique", "_width", "_size", "_first", "_count", "_pictured"),
)
BITS = 64


class MaskPainter:
    """Masks of one frame at a time; `defines` choose what shaders/mask.frag gives."""

    def __init__(self, context: moderngl.Context, defines: Sequence[str] = ()) -> None:
        self._context, self._defines = context, tuple(defines)
        self._distances = DistancePainter(context)
        self._own = self._vertices = kept(context.buffer(reserve=1 << 16, dynamic=True))
        self._variants: dict[tuple[str, ...], Shader] = {}
        self._arrays: dict[tuple[str, ...], moderngl.VertexArray] = {}

    @property
    def cover(self) -> Shader:
        """The program that marks the pixels of a target, for `draw_distances`."""
        return self._distances.cover

    def prepare(
        self,
        table: SceneTable,
        frame: FramePlan,
        camera: Camera,
        technique: DynamicTransparency,
        width: float,
        size: tuple[int, int],
    ) -> list[NDArray[np.int64]]:
        """Make the geometry; returns what `draw_distances` needs drawn, each by itself."""
        made = mask_geometry(table, frame, camera, technique, width, size)
        self.geometry: MaskGeometry = made
        self._technique, self._width, self._size = technique, width, size
        self._first = np.zeros(len(frame.reach), np.int64)
        self._count, self._pictured = self._first.copy(), np.zeros(len(frame.reach), dtype=bool)
        self._first[made.targets], self._count[made.targets] = made.first, made.count
        self._pictured[made.targets[made.pictured :]] = True
        if made.vertices.nbytes > self._own.size:
            self._own.release()
            self._own = kept(self._context.buffer(reserve=2 * made.vertices.nbytes, dynamic=True))
        self._draw_from(self._own)
        if len(made.vertices):
            self._vertices.orphan()
            self._vertices.write(made.vertices)
        self._begin(table, frame, camera)
        return [np.array([t]) for t in made.covered.tolist()]

    def adopt(self, other: MaskPainter) -> None:
        """Take over what another has prepared and drawn for the same frame."""
        for name in ("geometry", "numbers", *_PREPARED):
            setattr(self, name, getattr(other, name))
        self._draw_from(other._vertices)

    def _draw_from(self, vertices: moderngl.Buffer) -> None:
        """Draw from these vertices: its own, or those of another that made them."""
        if self._vertices is not vertices:
            self._vertices = vertices
            self._arrays.clear()

    def _begin(self, table: SceneTable, frame: FramePlan, camera: Camera) -> None:
        """Find the blocks that masks touch, those of outlines beside the drawing that follows."""
        made, size = self.geometry, self._size
        self.numbers = np.zeros(len(frame.reach), np.int64)
        self.numbers[made.targets] = np.arange(len(made.targets)) % BITS
        boxed = np.ones(len(frame.reach), dtype=bool)
        boxed[made.looped] = False
        others = made.targets[boxed[made.targets]]
        self._boxed = blocks.covered(frame.reach[others], self.numbers[others], blocks.shape(size))
        args = (table, made, camera, self._technique, self._width, size, self.numbers)
        self._distances.begin(*args)

    @property
    def pending(self) -> bool:
        """Whether outlines are being found beside the drawing."""
        return self._distances.pending

    @property
    def distances(self) -> moderngl.Texture | None:
        """The picture that masks without a hull look up."""
        return self._distances.texture("distances")

    def marks(self) -> NDArray[np.uint64]:
        """(h, w) of each block, the `numbers` of the masks that can show in it, modulo 64."""
        return self._boxed | self._distances.marks()

    def draw_distances(self, table: SceneTable, runs: list[list[Run]], camera: Camera) -> int:
        """Draw what the masks without a hull look up. Returns the draw calls made."""
        return self._distances.draw(table, runs, camera, self._technique)

    def begin(
        self, counts: moderngl.Texture | None = None, shift: tuple[int, int] = (0, 0)
    ) -> None:
        """Set up the masks of this frame; `counts` are layers in front of the targets."""
        technique, height = self._technique, self._size[1]
        for name, unit in _UNITS.items():
            texture = counts if name == "counts" else self._distances.texture(name)
            if texture is not None:
                texture.use(unit)
        used = {
            "RINGS": technique.mask == "ring",
            "ELLIPSES": technique.mask in ELLIPSES,
            "SEARCHLIGHT": technique.mode == "active",
            "COUNTED": counts is not None,
        }
        common = (*self._defines, *(name for name, wanted in used.items() if wanted))
        self._keys = {False: common, True: (*common, "PICTURED")}
        self._values: dict[str, object] = {
            "size": self._size,
            "width": self._width,
            "shift": shift,
            "alpha_target": technique.alpha_target,
            "alpha_edge": technique.alpha_edge,
            "tau": technique.min_transmittance,
            "ring_size": technique.ring_size,
            "searchlight": searchlight(technique, height),
            **_UNITS,
        }
        self._told: set[tuple[str, ...]] = set()  # programs at depth that know them
        self.set(**self._values)

    def set(self, **values: object) -> None:
        """Set uniforms of the programs that this frame's masks use."""
        plain = self.geometry.pictured > 0
        pictured = self.geometry.pictured < len(self.geometry.targets)
        for kind, wanted in ((False, plain), (True, pictured)):
            if wanted:
                self._shader(self._keys[kind]).set(**values)

    def shader_of(self, target: int) -> Shader:
        """The program that draws a target's mask."""
        return self._shader(self._keys[bool(self._pictured[target])])

    def _shader(self, key: tuple[str, ...]) -> Shader:
        if key not in self._variants:
            self._variants[key] = program(self._context, "mask.vert", "mask.frag", key)
        return self._variants[key]

    def draw_one(self, target: int) -> None:
        """Draw one target's mask."""
        count = int(self._count[target])
        if count:
            array = self._array(self._keys[bool(self._pictured[target])])
            array.render(moderngl.TRIANGLES, count, int(self._first[target]))

    def draw_at_depth(
        self, target: int, own: float, beside: float, divided: bool, strength: float = 1.0
    ) -> None:
        """Draw one target's mask as lying at two depths, on the target and beside it (0 to 1, 0
        nearest), with a `strength` up to 1; `divided`: take out again what it did to the frame's
        alpha."""
        count = int(self._count[target])
        if count:
            key = (*self._keys[bool(self._pictured[target])], "AT_DEPTH")
            shader = self._shader(key)
            if key not in self._told:  # once a frame: to compare them all takes as long as to draw
                shader.set(**self._values)
                self._told.add(key)
            shader.set(own=own, beside=beside, divided=divided, strength=strength)
            self._array(key).render(moderngl.TRIANGLES, count, int(self._first[target]))

    def draw(self, targets: NDArray[np.int64]) -> int:
        """Draw these targets' masks into the bound frame, those side by side in the buffer at
        once. Returns the draw calls."""
        spans: dict[bool, list[list[int]]] = {False: [], True: []}
        rows = (self._first[targets], self._count[targets], self._pictured[targets])
        for first, count, kind in zip(*(row.tolist() for row in rows), strict=True):
            found = spans[kind]
            if found and found[-1][1] == first:
                found[-1][1] += count
            elif count:
                found.append([first, first + count])
        for kind, found in spans.items():
            for begin, end in found:
                self._array(self._keys[kind]).render(moderngl.TRIANGLES, end - begin, begin)
        return len(spans[False]) + len(spans[True])

    def _array(self, key: tuple[str, ...]) -> moderngl.VertexArray:
        if key not in self._arrays:
            shader = self._shader(key)
            used = [a if a in shader.members else None for a in _FORMAT[1:]]
            layout = " ".join(
                part if name else f"{4 * int(part[0])}x"
                for part, name in zip(_FORMAT[0].split(), used, strict=True)
            )
            content = [(self._vertices, layout, *[a for a in used if a])]
            self._arrays[key] = self._context.vertex_array(shader.program, content)
        return self._arrays[key]


def searchlight(technique: DynamicTransparency, height: int) -> tuple[float, float, float, float]:
    """x, y (up), radius and softness in pixels; a radius < 0 lights everything (shaders)."""
    if technique.mode == "passive":
        return (0.0, 0.0, -1.0, 0.0)
    x, y = technique.pointer or (-1e5, -1e5)
    return (x * height, height - y * height, technique.radius * height, technique.softness * height)
