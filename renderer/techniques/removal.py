"""What techniques have in common that remove what stands in the way: the hole, and its wall.

A surface is removed where a signed depth or distance of the technique's own is above 0. Only what
is no target and not impenetrable is removed. Where a thing is pierced, what is left of it shows
from inside as well: the first surface left is a back face exactly where the cut runs through its
inside, so that painting it flat fills the cut. An open mesh has no inside, and shows a hole.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from typing_extensions import TypeVar

from seethrough.renderer.declared import key
from seethrough.renderer.techniques import base
from seethrough.renderer.techniques.base import Bools, Floats
from seethrough.renderer.techniques.lines import LINE, on_edges, unsure
from seethrough.renderer.techniques.seen import Look, Surfaces

CAPS = ("none", "inside", "flat")
WALL = (0.36, 0.34, 0.33)
SURE = 1e-4  # of a depth: ten times what float32 may make of one
CREASE = 0.6  # radians between neighbours' normals, from which on there is an edge

# Where a hole is one depth at each pixel, from the eye on: the picture `clip` has it, 0 for none.
CLIPPED = """
uniform sampler2D clip;
bool removed(Surface s) { return s.depth < texelFetch(clip, s.texel, 0).x; }
bool pierced(Surface s) { return texelFetch(clip, s.texel, 0).x > 0.0; }
"""

_GLSL = f"""
uniform int cap;

float opacity(Surface s) {{ return s.number == 1 && removed(s) ? 0.0 : 1.0; }}

bool opened(Surface s) {{
    if (cap == 0 || s.number != 1 || !pierced(s)) return false;
    if (cap == 2) tinted = vec4{(*WALL, 1.0)};
    return true;
}}
"""


@dataclass(frozen=True)
class Removing(base.Parameters):
    """What every technique that removes may vary."""

    cap: str = key(
        "flat", "where a thing is cut: nothing of it, its inside, or a flat wall", choices=CAPS
    )
    edges: float = key(
        0.0, "how strongly lines show along the edges of what is removed nearest to the viewer; "
        "0: none", low=0, high=1,
    )  # fmt: skip


P = TypeVar("P", bound=Removing, default=Removing)


class Removal(base.Plain[P, base.State, base.Known]):
    """A technique that removes. `removes` is its GLSL: `bool removed(Surface s)` for what is
    penetrable, and `bool pierced(Surface s)`, whether the pixel's ray meets the hole at all."""

    painter = base.REMOVAL
    removes: str

    def __init__(self) -> None:
        super().__init__()
        self.glsl = self.removes + _GLSL

    def uniforms(self, p: P, state: base.State, shot: base.Shot) -> Mapping[str, object]:
        """How cuts are shown."""
        return {"cap": CAPS.index(p.cap)}

    def cut(
        self, shot: base.Shot, pictures: Mapping[str, NDArray[np.float32]], among: base.Indices
    ) -> base.Cut:
        """Where a hole is one depth at each pixel, by its least and greatest about each object.
        Only what is known to be convex counts as whole: of others back faces may show."""
        if self.removes is not CLIPPED:
            return base.Cut(among[:0], among, None)
        from seethrough.renderer.techniques.maps import bounds

        near, far = shot.boxes.near[among], shot.boxes.far[among]
        least, most = bounds(pictures["clip"], shot.boxes.extents[among]).T
        gone = far * (1 + SURE) < least
        whole = shot.scene.convex[among] & (near > shot.camera.near) & (near > most * (1 + SURE))
        return base.Cut(among[whole], among[~(whole | gone)], pictures["clip"])

    def sides(self, p: P) -> bool:
        """Where cuts show a wall."""
        return bool(p.cap != "none")

    def edges(self, p: P) -> Mapping[str, object]:
        """The lines of what is removed, as shaders/edges.frag draws them."""
        return {"line": (*LINE, p.edges), "crease": float(np.cos(CREASE))} if p.edges > 0 else {}


def look(
    p: Removing,
    seen: Surfaces,
    signed: Floats,
    pierced: Bools,
    doubt: Bools | float = 0.0,
    opened: Bools | bool = True,
) -> Look:
    """How surfaces show that are removed where `signed` (m,) is above 0. `pierced` (h·w,) are the
    pixels whose ray meets the hole. In `doubt` (m,) are also surfaces nearer to the hole's border
    than float32 can tell. `opened` (m,) are those that may show from inside."""
    open_ = seen.penetrable
    removed = open_ & (signed > 0)
    inside = ~seen.front & open_ & opened & pierced[seen.pixel] & (p.cap != "none")
    tint = np.zeros((len(signed), 4))
    if p.cap == "flat":
        tint[inside] = (*WALL, 1.0)
    near = open_ & (np.abs(signed) <= uncertain(seen))
    kept, opacity = (seen.front | inside) & ~removed, np.ones(len(signed))
    near |= open_ & (doubt > 0)
    if p.edges > 0:
        edge, unclear = _lined(seen, removed & seen.front, kept, near)
        kept, near = kept | edge, near | unclear
        opacity[edge], tint[edge] = p.edges, (*LINE, 1.0)
    return Look(kept, opacity, tint, near)


def _lined(seen: Surfaces, removed: Bools, kept: Bools, doubt: Bools) -> tuple[Bools, Bools]:
    """(m,) the surfaces on the edges of what was removed nearest to the viewer, before anything
    that is kept, and where that is in doubt."""
    gone = np.nonzero(removed & (seen.depth < seen.nearest(kept)[seen.pixel]))[0]
    first = np.unique(seen.pixel[gone], return_index=True)[1]
    rows = gone[first]
    open_ = unsure(seen, np.nonzero(kept | removed)[0], False)
    open_[seen.pixel[doubt]] = True
    return on_edges(seen, rows, np.zeros(len(rows), np.int64), CREASE, open_)


def uncertain(seen: Surfaces) -> Floats:
    """(m,) by how far a surface's place may differ in float32, in world units: 1/256 pixel along
    the surface, and rounding of numbers as large as its distance."""
    lens = seen.shot.camera.lens(seen.shot.size[1])
    along = np.linalg.norm(seen.offset, axis=1) / np.maximum(seen.depth, 1e-300)
    return seen.slack * along + seen.depth * along * (1 / (256 * lens) + 1e-5)
