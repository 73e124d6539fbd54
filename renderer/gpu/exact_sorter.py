"""Goes through the fragments of each pixel: the second half of the exact picture.

Only blocks of pixels that a mask touches are gone through; elsewhere the nearest fragment shows.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from renderer import blocks
from renderer.gpu.cells import MOST, Cells
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
        self._programs: dict[tuple[str, bool, bool], tuple[Shader, moderngl.VertexArray]] = {}
        self._set_up: dict[tuple[str, bool, bool], Filled] = {}
        self._places = context.buffer(reserve=1 << 14, dynamic=True)

    def sort(
        self,
        filled: Filled,
        part: NDArray[np.int64],
        number: int,
        bits: tuple[NDArray[np.uint64], NDArray[np.uint64]] | None,
        every: bool,
    ) -> int:
        """Draw a part, the batch's `number`th, into the bound framebuffer; `bits` are which slices
        and masks can show in a block, None where they are too many for that. With `every`, also
        where no mask is. Returns the draws."""
        if bits is None:
            shader, array = self._bound(filled, part, number, "OUTPUT_PICTURE", many=True)
            shader.set(every=every)
            array.render(moderngl.TRIANGLES, 3)
            return 1
        found, which = blocks.runs(*bits, part)
        by_pixel = filled.technique.granularity == "pixel"
        masked = (which[:, 1] != 0) | (not by_pixel)
        draws = 0
        for output, chosen in (("OUTPUT_PICTURE", masked), ("OUTPUT_NEAREST", ~masked)):
            if chosen.any() and (every or output == "OUTPUT_PICTURE"):
                rows = _vertices(found[chosen], which[chosen])
                if rows.nbytes > self._places.size:
                    self._places.release()
                    self._places = self._context.buffer(reserve=2 * rows.nbytes, dynamic=True)
                    self._programs.clear()
                    self._set_up.clear()
                shader, array = self._bound(filled, part, number, output)
                self._places.orphan()
                self._places.write(rows)
                shader.set(size=filled.size, every=every)
                array.render(moderngl.TRIANGLES, len(rows))
                draws += 1
        return draws

    def whole(
        self, filled: Filled, part: NDArray[np.int64], number: int, output: str, first: int = 0
    ) -> None:
        """Fill the bound framebuffer with the shares from the `first`th on, or with light."""
        bases = (filled.slice_base, filled.mask_base)
        counts = [base[number + 1] - base[number] for base in bases]
        many = max(counts) > MOST
        shader, array = self._bound(filled, part, number, output, many)
        which = tuple(((1 << n) - 1) >> k & 0xFFFFFFFF for n in counts for k in (0, 32))
        shader.set(which=which, **{"from": first})
        array.render(moderngl.TRIANGLES, 3)

    def _bound(
        self, filled: Filled, part: NDArray[np.int64], number: int, output: str, many: bool = False
    ) -> tuple[Shader, moderngl.VertexArray]:
        surfaces = filled.technique.granularity == "surface"
        key = (output, surfaces, many)
        if key not in self._programs:
            placed = not many and output in ("OUTPUT_PICTURE", "OUTPUT_NEAREST")
            defines = [output] + ["WITH_SURFACES"] * surfaces + ["PLACED"] * placed
            vertex = "block.vert" if placed else "present.vert"
            fragment = "exact_many.frag" if many else "exact.frag"
            shader = program(self._context, vertex, fragment, defines)
            content = [(self._places, "2f 4u", "in_place", "in_which")] if placed else []
            self._programs[key] = (shader, self._context.vertex_array(shader.program, content))
        shader, array = self._programs[key]
        if self._set_up.get(key) is not filled:  # the first part of a batch to ask for this one
            self._set(filled, shader, output == "OUTPUT_LIGHT")
            self._set_up[key] = filled
        a, b = filled.slice_base[number : number + 2]
        c, d = filled.mask_base[number : number + 2]
        origin = (int(part[0]), int(filled.size[1] - part[3]))
        shader.set(slices=b - a, slice_base=a, mask_base=c, mask_count=d - c, origin=origin)
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
            "mask_columns": entries.columns,
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


def _vertices(found: NDArray[np.int64], which: NDArray[np.uint64]) -> NDArray[np.void]:
    """Two triangles for each rectangle: x, y as float32, and the bits."""
    rows = np.zeros((len(found), 6), dtype=[("place", "f4", 2), ("which", "u8", 2)])
    rows["place"] = found[:, _CORNERS]
    rows["which"] = which[:, None]
    return rows.reshape(-1)
