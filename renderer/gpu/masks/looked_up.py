"""Masks that the sorter looks up in the pictures of distances by itself, without cells."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device.programs import Shader
from seethrough.renderer.plan.blocks import NONE


@dataclass(frozen=True, eq=False)
class LookedUp:
    """The masks of k `targets`, each with the number of its bit in blocks: `shifts` (k, 2) lead
    from the window's pixels (y up) to the picture of `distances`; `depths` (k,) are where a mask
    lies beside its target. All of the outline's kind, `width` pixels wide.
    """

    distances: moderngl.Texture | None
    targets: NDArray[np.int64]
    shifts: NDArray[np.int64]
    depths: NDArray[np.float64]
    width: float
    alpha_target: float
    alpha_edge: float

    @cached_property
    def words(self) -> NDArray[np.uint32]:
        """(k + 1, 3) what shaders/exact_few.frag wants of each: shift in 16 bits each, target,
        depth; the last for none."""
        rows = np.empty((len(self.targets) + 1, 3), np.uint32)
        shift = self.shifts & 0xFFFF
        rows[:-1, 0] = shift[:, 0] | shift[:, 1] << 16
        rows[:-1, 1] = self.targets
        rows[:-1, 2] = self.depths.astype(np.float32).view(np.uint32)
        rows[-1] = 0, NONE, 0
        return rows

    def set(self, shader: Shader) -> None:
        """Tell a shader of what kind they are."""
        shader.set(width=self.width, alpha_target=self.alpha_target, alpha_edge=self.alpha_edge)
