"""Goes through the fragments of each pixel: the second half of the exact picture.

Only blocks of pixels that a mask touches are gone through; elsewhere the nearest fragment shows.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from renderer.contours import BLOCK, runs
from renderer.gpu.cells import Cells
from renderer.gpu.programs import Shader, program
from renderer.techniques.dynamic import DynamicTransparency

COLORS, DEPTHS, MASKS, PARTS, NUMBERS, SURFACES = 5, 6, 7, 8, 9, 10  # texture units
_CORNERS = np.array([[0, 1], [2, 1], [2, 3], [0, 1], [2, 3], [0, 3]])


@dataclass(frozen=True, eq=False)
class Filled:
    """What a batch of parts is drawn from: cells with fragments and with masks, where each part's
    begin in both, and textures by name."""

    slices: Cells
    entries: Cells
    slice_base: list[int]
    mask_base: list[int]
    textures: dict[str, moderngl.Texture]
    technique: DynamicTransparency
    background: tuple[float, float, float]
    size: tuple[int, int]


class PixelSorter:
    """The programs of shaders/exact.frag."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._programs: dict[tuple[str, bool], tuple[Shader, moderngl.VertexArray]] = {}
        self._places = context.buffer(reserve=1 << 14, dynamic=True)

    def sort(
        self,
        filled: Filled,
        part: NDArray[np.int64],
        number: int,
        blocks: NDArray[np.bool_],
        every: bool,
    ) -> int:
        """Draw a part, the batch's `number`th, into the bound framebuffer, where `blocks` say that
        a mask is; with `every`, the other objects in it too. Returns the draw calls."""
        draws = 0
        if filled.technique.granularity != "pixel":
            blocks = np.ones_like(blocks)
        low, high = part[:2] // BLOCK, -(-part[2:] // BLOCK)
        inside = blocks[low[1] : high[1], low[0] : high[0]]
        for output, wanted in (("OUTPUT_PICTURE", True), ("OUTPUT_NEAREST", False)):
            if not wanted and not every:
                continue
            found = runs(inside if wanted else ~inside)
            if not len(found):
                continue
            shader, array = self._bound(filled, part, number, output)
            corners = ((found + np.tile(low, 2)) * BLOCK)[:, _CORNERS]
            places = np.ascontiguousarray(corners, dtype="f4")
            if places.nbytes > self._places.size:
                self._places.release()
                self._places = self._context.buffer(reserve=2 * places.nbytes, dynamic=True)
                self._programs.clear()
                shader, array = self._bound(filled, part, number, output)
            self._places.orphan()
            self._places.write(places)
            shader.set(size=filled.size, depth=0.0, every=every)
            array.render(moderngl.TRIANGLES, 6 * len(places))
            draws += 1
        return draws

    def whole(
        self, filled: Filled, part: NDArray[np.int64], number: int, output: str, first: int = 0
    ) -> None:
        """Fill the bound framebuffer with the shares from the `first`th on, or with light."""
        shader, array = self._bound(filled, part, number, output)
        shader.set(**{"from": first})
        array.render(moderngl.TRIANGLES, 3)

    def _bound(
        self, filled: Filled, part: NDArray[np.int64], number: int, output: str
    ) -> tuple[Shader, moderngl.VertexArray]:
        surfaces = filled.technique.granularity == "surface"
        key = (output, surfaces)
        if key not in self._programs:
            defines = [output] + ["WITH_SURFACES"] * surfaces
            placed = output in ("OUTPUT_PICTURE", "OUTPUT_NEAREST")
            vertex = "flat.vert" if placed else "present.vert"
            shader = program(self._context, vertex, "exact.frag", defines)
            content = [(self._places, "2f", "in_place")] if placed else []
            self._programs[key] = (shader, self._context.vertex_array(shader.program, content))
        shader, array = self._programs[key]
        if number == 0:
            self._set(filled, shader, output == "OUTPUT_LIGHT")
        a, b = filled.slice_base[number : number + 2]
        c, d = filled.mask_base[number : number + 2]
        origin = (int(part[0]), int(filled.size[1] - part[3]))
        shader.set(slices=b - a, mask_count=d - c, origin=origin)
        shader.set(first_cell=filled.slices.corner(a), first_mask=filled.entries.corner(c))
        self._context.enable_only(moderngl.NOTHING)
        return shader, array

    def _set(self, filled: Filled, shader: Shader, light: bool) -> None:
        slices, entries, technique = filled.slices, filled.entries, filled.technique
        textures = (
            ("colors", COLORS, slices.color),
            ("depths", DEPTHS, slices.depth),
            ("masks", MASKS, entries.color),
            ("parts", PARTS, filled.textures["parts"]),
            ("numbers", NUMBERS, slices.numbers),
            ("surfaces", SURFACES, filled.textures.get("surfaces")),
        )
        for name, unit, texture in textures:
            if texture is not None:
                texture.use(unit)
            shader.set(**{name: unit})
        values: dict[str, Any] = {
            "cell": slices.size,
            "columns": slices.columns,
            "row_end": slices.columns * slices.size[0],
            "mask_row_end": entries.columns * entries.size[0],
            "background": filled.background,
            "per_pixel": technique.granularity == "pixel",
            "least": technique.combine == "min",
            "additive": technique.model == "additive",
            "limit": 1_000_000 if technique.layers is None else technique.layers,
            "tau": technique.min_transmittance,
        }
        if light:
            values["tau"] = max(1.0 - technique.alpha_target, 1e-6)
        shader.set(**values)
