"""Importance-driven transparency (Viola, Kanitsar and Gröller 2004): what hides what matters grows
sparse.

Targets matter. A surface in front of one, at the same pixel, keeps only the opacity `least`; in
the style "screen door" it keeps that part of its pixels, in a fixed pattern of 4 × 4, and is opaque
in them. Nothing gradual is about a target: its neighbourhood stays as it is.

The pattern's cells are pixels of the window. In a larger picture of it they are as much larger; in
a smaller one they are that picture's pixels, as nothing finer can be drawn: the part that is left
is the same.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seethrough.renderer.declared import key
from seethrough.renderer.techniques.base import TARGET_DEPTH, Bools, Floats, Shot
from seethrough.renderer.techniques.layered import Layered, Layering
from seethrough.renderer.techniques.reaching import before_targets
from seethrough.renderer.techniques.seen import Look, Surfaces

STYLES = ("opacity", "screen door")
# Bayer's threshold matrix, 0 to 15: the pattern of a screen door of any density.
DOOR = np.array([[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]])
ASIDE = 1 / 1024  # of a cell: where a pixel's middle lies between two, float32 and float64 agree


@dataclass(frozen=True)
class ImportanceParameters(Layered):
    """How sparse what hides a target becomes."""

    least: float = key(0.25, "opacity, or part of the pixels, that is left before a target",
                       low=0, high=1)  # fmt: skip
    style: str = key("opacity", "how a surface grows sparse", choices=STYLES)


class Importance(Layering[ImportanceParameters, None, Floats]):
    """Sparse where a target is behind."""

    name = "importance"
    title = "Importance-driven transparency"
    instruction = "Whatever hides a target grows sparse there."
    source = "Viola2004"
    misses = "misses R4 (volumes), R5"
    needs = frozenset({TARGET_DEPTH})
    Parameters = ImportanceParameters
    strength = f"""
uniform sampler2D target_depth;
uniform float least;
uniform bool door;
uniform float cell;  // pixels
const int pattern[16] = int[16]({", ".join(map(str, DOOR.ravel().tolist()))});
float opacity_of(Surface s) {{
    if (s.depth >= texelFetch(target_depth, s.texel, 0).x) return 1.0;
    if (!door) return least;
    ivec2 at = ivec2(s.place / cell + {ASIDE}) % 4;
    return (float(pattern[at.y * 4 + at.x]) + 0.5) / 16.0 < least ? 1.0 : 0.0;
}}
"""

    def touches(self, p: ImportanceParameters, state: None, shot: Shot) -> Bools:
        """What overlaps a target on the screen and reaches nearer than its end."""
        return before_targets(shot)

    def known(self, p: ImportanceParameters, state: None, seen: Surfaces) -> Floats:
        """(h·w,) depth of the farthest surface of a target that faces the viewer."""
        return seen.farthest(seen.targets & seen.front)

    def rule(self, p: ImportanceParameters, state: None, seen: Surfaces, known: Floats) -> Look:
        """Sparse before the farthest target at the pixel."""
        before = seen.depth < known[seen.pixel]
        strength = np.full(len(before), p.least)
        if p.style == "screen door":
            column, row = (seen.place / _cell(seen.shot) + ASIDE).astype(np.int64).T
            strength = ((DOOR[row % 4, column % 4] + 0.5) / 16 < p.least).astype(float)
        near = np.abs(seen.depth - known[seen.pixel]) <= 2 * seen.slack
        return self.look(p, seen, np.where(before, strength, 1.0), near & seen.penetrable)

    def uniforms(self, p: ImportanceParameters, state: None, shot: Shot) -> dict[str, object]:
        """How sparse."""
        style = {"least": p.least, "door": p.style == "screen door", "cell": _cell(shot)}
        return {**super().uniforms(p, state, shot), **style}


def _cell(shot: Shot) -> float:
    """Pixels along a side of one of the pattern's cells."""
    return max(1.0, shot.scale)


TECHNIQUE = Importance()
