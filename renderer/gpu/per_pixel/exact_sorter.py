"""Goes through the fragments of each pixel: the second half of the exact picture.

Only blocks of pixels that a mask touches are gone through; elsewhere the nearest fragment shows.
"""

from __future__ import annotations

from dataclasses import dataclass

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device.programs import Shader, program
from seethrough.renderer.gpu.device.reused import kept
from seethrough.renderer.gpu.masks.looked_up import LookedUp
from seethrough.renderer.gpu.per_pixel.few_sorter import FewSorter
from seethrough.renderer.gpu.per_pixel.pixel_cells import MOST, Cells
from seethrough.renderer.plan import blocks
from seethrough.renderer.plan.blocks import BLOCK
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

# Texture units.
COLORS, DEPTHS, MASKS, PARTS, NUMBERS, SURFACES, DISTANCES = 5, 6, 7, 8, 9, 10, 11
_ROW = np.dtype([("place", "f4", 2), ("which", "u8", 2)])


@dataclass(frozen=True, eq=False)
class Filled:
    """What a batch of parts is drawn from: cells with fragments and with masks, where each part's
    begin in both, and textures by name."""

    slices: Cells
    entries: Cells | None
    slice_base: list[int]
    mask_base: list[int]
    textures: dict[str, moderngl.Texture]
    technique: DynamicTransparency
    background: tuple[float, float, float]
    size: tuple[int, int]
    hard: bool
    looked_up: LookedUp | None

    @property
    def few(self) -> bool:
        """Whether exact_few.frag knows what the technique asks for."""
        technique = self.technique
        plain = technique.granularity == "pixel" and technique.model == "multiplicative"
        return plain and technique.layers is None

    def bind(self) -> None:
        """Bind what the sorters look up."""
        textures = (
            (COLORS, self.slices.color),
            (DEPTHS, self.slices.depth),
            (DISTANCES, self.looked_up.distances if self.looked_up else None),
            (MASKS, self.entries.color if self.entries else None),
            (PARTS, self.textures["parts"]),
            (NUMBERS, self.slices.numbers),
            (SURFACES, self.textures.get("surfaces")),
        )
        for unit, texture in textures:
            if texture is not None:
                texture.use(unit)

    def look_up(self, shader: Shader) -> None:
        """Tell a shader where to look these up, and how masks add up."""
        shader.set(
            colors=COLORS,
            depths=DEPTHS,
            distances=DISTANCES,
            masks=MASKS,
            parts=PARTS,
            numbers=NUMBERS,
            surfaces=SURFACES,
            cell=self.slices.size,
            background=self.background,
            least=self.technique.combine == "min",
        )
        if self.looked_up is not None:
            self.looked_up.set(shader)


class PixelSorter:
    """The programs of shaders/exact.frag."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._programs: dict[tuple[str, bool, bool], tuple[Shader, moderngl.VertexArray]] = {}
        self._places = kept(context.buffer(reserve=1 << 14, dynamic=True))
        self._few = FewSorter(context)
        self._filled: Filled | None = None

    def sort(
        self,
        filled: Filled,
        part: NDArray[np.int64],
        number: int,
        bits: tuple[NDArray[np.uint64], ...] | None,
        every: bool,
    ) -> int:
        """Draw a part, the batch's `number`th, into the bound framebuffer. `bits` say which slices
        can show in a block, which masks, and which cells of masks; None where they are too many for
        that. With `every`, also where no mask is. Returns the draws."""
        self._bind(filled)
        if bits is None:
            shader, array = self._bound(filled, part, number, "OUTPUT_PICTURE", many=True)
            shader.set(every=every)
            array.render(moderngl.TRIANGLES, 3)
            return 1
        slices, masks, cells = bits
        looked_up = filled.looked_up is not None
        found, which = blocks.shown(slices, masks if looked_up else cells, part)
        by_pixel = filled.technique.granularity == "pixel"
        draws = 0
        if filled.few:
            bases = (filled.slice_base[number], filled.mask_base[number])
            over, draws = self._few.draw(filled, part, bases, found, which, every)
            found, which = found[over], which[over]
            which[:, 1] = cells[found[:, 1] // BLOCK, found[:, 0] // BLOCK]
        masked = (which[:, 1] != 0) | (not by_pixel)
        for output, chosen in (("OUTPUT_PICTURE", masked), ("OUTPUT_NEAREST", ~masked)):
            if chosen.any() and (every or output == "OUTPUT_PICTURE"):
                rows = np.zeros(chosen.sum(), dtype=_ROW)
                rows["place"], rows["which"] = found[chosen], which[chosen]
                if rows.nbytes > self._places.size:
                    self._places.release()
                    self._places = kept(self._context.buffer(reserve=2 * rows.nbytes, dynamic=True))
                    self._programs.clear()
                shader, array = self._bound(filled, part, number, output)
                self._places.orphan()
                self._places.write(rows)
                shader.set(size=blocks.whole(filled.size), every=every)
                self._context.enable_only(moderngl.PROGRAM_POINT_SIZE)
                array.render(moderngl.POINTS, len(rows))
                draws += 1
        return draws

    def whole(
        self, filled: Filled, part: NDArray[np.int64], number: int, output: str, first: int = 0
    ) -> None:
        """Fill the bound framebuffer with the shares from the `first`th on, or with light."""
        self._bind(filled)
        bases = (filled.slice_base, filled.mask_base)
        counts = [base[number + 1] - base[number] for base in bases]
        many = max(counts) > MOST
        shader, array = self._bound(filled, part, number, output, many)
        which = tuple(((1 << n) - 1) >> k & 0xFFFFFFFF for n in counts for k in (0, 32))
        shader.set(which=which, **{"from": first})
        array.render(moderngl.TRIANGLES, 3)

    def _bind(self, filled: Filled) -> None:
        if self._filled is not filled:
            filled.bind()
            self._filled = filled

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
        self._set(filled, shader, output == "OUTPUT_LIGHT")
        a, b = filled.slice_base[number : number + 2]
        c, d = filled.mask_base[number : number + 2]
        origin = (int(part[0]), int(filled.size[1] - part[3]))
        shader.set(slices=b - a, slice_base=a, mask_base=c, mask_count=d - c, origin=origin)
        self._context.enable_only(moderngl.NOTHING)
        return shader, array

    def _set(self, filled: Filled, shader: Shader, light: bool) -> None:
        technique = filled.technique
        filled.look_up(shader)
        values: dict[str, object] = {
            "columns": filled.slices.columns,
            "mask_columns": filled.entries.columns if filled.entries else 1,
            "per_pixel": technique.granularity == "pixel",
            "additive": technique.model == "additive",
            "limit": 1_000_000 if technique.layers is None else technique.layers,
            "tau": technique.min_transmittance,
        }
        if light:
            values["tau"] = max(1.0 - technique.alpha_target, 1e-6)
        shader.set(**values)
