"""What techniques have in common that let things show through one another: opacity and layers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from typing_extensions import TypeVar

from seethrough.renderer.declared import key
from seethrough.renderer.techniques import base
from seethrough.renderer.techniques.base import Bools, Floats, Shot
from seethrough.renderer.techniques.seen import Look, Surfaces

SURFACES = ("front", "all")

_GLSL = """
uniform bool inside;
float opacity(Surface s) { return s.number == 0 ? 1.0 : opacity_of(s); }
bool opened(Surface s) { return inside && s.number != 0; }
"""


@dataclass(frozen=True)
class Layered(base.Parameters):
    """What every technique may vary that lets things show through one another."""

    surfaces: str = key(
        "front", "front: surfaces that face the viewer; all: the far sides of things as well",
        choices=SURFACES,
    )  # fmt: skip
    layers: int | None = key(
        None, "layers that are drawn at a pixel, from the front: what lies behind them and is not "
        "opaque is lost", low=1, high=10_000,
    )  # fmt: skip


P = TypeVar("P", bound=Layered, default=Layered)


class Layering(base.Plain[P, base.State, base.Known]):
    """A technique of opacities. `strength` is its GLSL: `float opacity_of(Surface s)` for what is
    penetrable."""

    painter = base.PEELS
    strength: str

    def __init__(self) -> None:
        super().__init__()
        self.glsl = self.strength + _GLSL

    def touches(self, p: P, state: base.State, shot: Shot) -> Bools:
        """Whatever may be penetrated."""
        return self.objects(p, shot.scene) != 0

    def uniforms(self, p: P, state: base.State, shot: Shot) -> dict[str, object]:
        """Whether far sides show."""
        return {"inside": p.surfaces == "all"}

    def sides(self, p: P) -> bool:
        """Where far sides show."""
        return bool(p.surfaces == "all")

    def layers(self, p: P) -> int | None:
        """As the study has it."""
        found: int | None = p.layers
        return found

    def look(self, p: P, seen: Surfaces, opacity: Floats, doubt: Bools | None = None) -> Look:
        """How surfaces show with these opacities (m,), where they may be penetrated."""
        ruled = self.objects(p, seen.shot.scene)[seen.object] != 0
        kept = seen.front | (ruled & (p.surfaces == "all"))
        alpha = np.where(ruled, opacity, 1.0)
        if p.layers is not None:
            rank = np.cumsum(kept & ruled & (alpha > 0))
            before = np.concatenate([[0], rank])[seen.starts[seen.pixel]]
            kept &= ~ruled | (rank - before <= p.layers)
        return Look(kept, alpha, doubt=doubt)
