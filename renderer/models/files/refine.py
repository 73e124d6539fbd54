"""Textures as colours of vertices: triangles are cut where the picture on them is not straight.

Whatever draws meshes (the window, the exact picture on the CPU, what simulated participants see,
a replay of what a data folder kept) knows vertices with colours and nothing else, so that is what
a texture becomes. Longest sides are halved, on both sides of a side at once, so that nothing tears
apart (Rivara 1984), first where most is wrong, until every point of the picture is right to a
few steps of 255, or as many triangles were added as may be. What then is still wrong is measured.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats, Ints
from seethrough.renderer.models.files.comparing import BINS, SHOWN, compared, sides_of
from seethrough.renderer.models.files.part import to_shown
from seethrough.renderer.models.files.surface import Surface
from seethrough.renderer.models.files.texture import Texture

TOLERANCE = 4 / 255  # of a colour as shown: less is not seen on a shaded surface
ROUNDS = 80
EAGER = 8  # a round takes what is wrong by this part of the worst or more
TEXELS = 16  # shown for each triangle that may be added: of finer pictures a smaller copy is used
FINEST_SIDES = (1.0, 0.5, 0.25)  # of a texel: first all of them, then what is between them
FINEST = 64  # samples along a side at most
_NORMAL, _UV, _RGBA = slice(0, 3), slice(3, 5), slice(5, 9)


@dataclass(frozen=True)
class Carried:
    """How textures came through: triangles added, and how far colours are off, in steps of 255:
    the mean over the textured surface, and what 99 % of it keeps to."""

    added: int
    mean: float
    most: float
    limited: bool


@dataclass(eq=False)
class _Cut:
    """Triangles while they are cut: values (m, 3, 9) are the corners' normals, uv and RGBA."""

    points: Floats
    triangles: NDArray[np.int64]
    values: Floats
    texture: NDArray[np.int64]
    cutoff: Floats
    wrong: Floats  # (m,) the picture's error summed over the area, NaN: not known yet
    worst: Floats  # (m,) the largest error; 2 where a part is seen and a part is not


def refined(
    surface: Surface, normals: Floats, detail: int
) -> tuple[Surface, Floats, Carried | None]:
    """The surface in more triangles, each corner's colour (m, 3, 4) that of the texture there, and
    normals (m, 3, 3) to them. What alpha hides is left out. At most `detail` triangles are added.
    """
    unknown = np.full(len(surface.triangles), np.nan)
    values = np.concatenate([normals, surface.uv, surface.colors], axis=2)
    made = _Cut(
        surface.vertices,
        surface.triangles,
        values,
        surface.texture,
        surface.cutoff,
        unknown,
        unknown,
    )
    begun = len(made.triangles)
    if not (made.texture >= 0).any():
        return surface, normals, None
    coarse = replace(surface, textures=_carried_by(made, surface, detail))
    limited = False
    for part in FINEST_SIDES:
        limited = limited or _refine(made, coarse, begun + detail, part)
    colors, left = _colored(made, coarse)
    mean, most, seen = _off(made, surface, colors)
    whole = Surface(
        made.points, made.triangles, colors, made.values[..., _UV], made.texture, made.cutoff, ()
    ).take(seen)
    added = len(made.triangles) - begun
    return whole, made.values[..., _NORMAL][seen], Carried(added, mean, most, limited and left)


def _carried_by(made: _Cut, surface: Surface, detail: int) -> tuple[Texture, ...]:
    """The textures, smaller where the model shows more of their texels than can be carried."""
    rows = np.flatnonzero(made.texture >= 0)
    uv = made.values[rows][..., _UV]
    u, v = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    sizes = np.array([t.size for t in surface.textures], float)[made.texture[rows]]
    texels = float((np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2 * sizes.prod(axis=1)).sum())
    skip = 0
    while texels > max(TEXELS * detail, 1) * 4**skip:
        skip += 1
    return tuple(
        replace(t, levels=t.levels[min(skip, len(t.levels) - 1) :]) for t in surface.textures
    )


def _refine(made: _Cut, surface: Surface, limit: int, part: float) -> bool:
    """Cut until all is right, or sides are this part of a texel, or there are `limit` triangles;
    whether those were too few."""
    for _ in range(ROUNDS):
        _measure(made, surface)
        active = np.flatnonzero(_unfinished(made, surface, part))
        if not len(active):
            return False
        room = (limit - len(made.triangles)) // 3
        if room < 1:
            return True
        wrong = made.wrong[active]
        order = np.argsort(-wrong, kind="stable")
        eager = int((wrong >= wrong.max() / EAGER).sum())
        chosen = active[order[: min(eager, room)]]
        if not _split(made, chosen, limit):
            return True
    return True


def _unfinished(made: _Cut, surface: Surface, part: float) -> NDArray[np.bool_]:
    """(m,) what is wrong somewhere, and still larger than this part of a texel."""
    large = _texels(made, surface).max(axis=1) > part
    return (made.texture >= 0) & (made.worst > TOLERANCE) & large


def _texels(made: _Cut, surface: Surface) -> Floats:
    """(m, 3) lengths of the sides on the texture, in texels; 0 without one."""
    sizes = np.array([t.size for t in surface.textures], float)[made.texture]
    uv = made.values[..., _UV] * sizes[:, None]
    lengths = np.linalg.norm(np.roll(uv, -1, axis=1) - uv, axis=2)
    return np.where((made.texture >= 0)[:, None], lengths, 0.0)


def _compare(
    made: _Cut, surface: Surface, rows: NDArray[np.int64], colors: Floats
) -> tuple[Floats, Floats]:
    """(k, 3) mean error, largest error and share that is seen of textured triangles `rows`, whose
    corners have `colors` (k, 3, 3); the areas by error."""
    found, bins = np.zeros((len(rows), 3)), np.zeros(BINS)
    sides = sides_of(_texels(made, surface)[rows].max(axis=1), FINEST)
    areas = _areas(made, rows)
    for number, texture in enumerate(surface.textures):
        own = np.flatnonzero(made.texture[rows] == number)
        found[own] = compared(
            np.ascontiguousarray(made.values[rows[own]][..., 3:]), colors[own], sides[own],
            made.cutoff[rows[own]], areas[own], texture.levels[0], np.array(texture.wrap),
            texture.nearest, SHOWN, bins,
        )  # fmt: skip
    return found, bins


def _measure(made: _Cut, surface: Surface) -> None:
    """Find what is wrong with triangles that are new."""
    rows = np.flatnonzero(np.isnan(made.wrong))
    textured = made.texture[rows] >= 0
    made.wrong[rows], made.worst[rows] = 0.0, 0.0
    rows = rows[textured]
    corner = _at_corners(made, surface, rows, np.zeros((len(rows), 3), int))
    found, _ = _compare(made, surface, rows, corner)
    mean, worst, share = found.T
    made.wrong[rows] = (mean + np.minimum(share, 1 - share)) * _areas(made, rows)
    made.worst[rows] = np.where((share > 0) & (share < 1), 2.0, worst)


def _areas(made: _Cut, rows: NDArray[np.int64]) -> Floats:
    a, b, c = np.moveaxis(made.points[made.triangles[rows]], 1, 0)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def _at_corners(
    made: _Cut, surface: Surface, rows: NDArray[np.int64], level: NDArray[np.int64]
) -> Floats:
    """(k, 3, 3) colours as shown at the corners of triangles, each looked up at its level."""
    values = made.values[rows]
    rgba = values[..., _RGBA].copy()
    texture = np.repeat(made.texture[rows][:, None], 3, axis=1)
    for number, picture in enumerate(surface.textures):
        for k in np.unique(level[texture == number]).tolist():
            where = (texture == number) & (level == k)
            rgba[where] *= picture.sample(values[where][:, _UV], k)
    return to_shown(rgba[..., :3])


def _split(made: _Cut, chosen: NDArray[np.int64], limit: int) -> bool:
    """Cut these triangles, and what hangs on them, unless that makes too many."""
    corners = made.triangles
    ends = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
    ends.sort(axis=1)
    key = ends[:, 0] * len(made.points) + ends[:, 1]
    _, first, edge = np.unique(key, return_index=True, return_inverse=True)
    edge, ends = edge.reshape(-1, 3), ends[first]
    length = np.linalg.norm(made.points[ends[:, 0]] - made.points[ends[:, 1]], axis=1)
    rank = np.empty(len(length), np.int64)
    rank[np.lexsort((np.arange(len(length)), length))] = np.arange(len(length))
    longest = rank[edge].argmax(axis=1)
    own = np.take_along_axis(edge, longest[:, None], 1)[:, 0]
    marked = np.zeros(len(length), bool)
    marked[own[chosen]] = True
    while True:
        need = own[marked[edge].any(axis=1)]
        if marked[need].all():
            break
        marked[need] = True
    if len(corners) + int(marked[edge].sum()) > limit:
        return False
    middle = np.full(len(length), -1)
    middle[marked] = len(made.points) + np.arange(marked.sum())
    made.points = np.concatenate([made.points, made.points[ends[marked]].mean(axis=1)])
    _replace(made, np.flatnonzero(marked[edge].any(axis=1)), edge, longest, middle)
    return True


def _replace(made: _Cut, rows: Ints, edge: Ints, longest: Ints, middle: Ints) -> None:
    """Put two, three or four triangles in the place of each of `rows`."""
    turn = (longest[rows][:, None] + np.arange(3)) % 3
    corner = np.take_along_axis(made.triangles[rows], turn, 1)
    value = np.take_along_axis(made.values[rows], turn[..., None], 1)
    # a, b, c, then the middles of ab (the longest side), bc and ca.
    points = np.concatenate([corner, middle[np.take_along_axis(edge[rows], turn, 1)]], axis=1)
    values = np.concatenate([value, (value + np.roll(value, -1, axis=1)) / 2], axis=1)
    bc, ca = points[:, 4] >= 0, points[:, 5] >= 0
    pieces = (
        ((0, 3, 5), ca), ((5, 3, 2), ca), ((0, 3, 2), ~ca),
        ((3, 1, 4), bc), ((3, 4, 2), bc), ((3, 1, 2), ~bc),
    )  # fmt: skip
    kept = np.ones(len(made.triangles), bool)
    kept[rows] = False
    new = [(points[m][:, list(p)], values[m][:, list(p)], rows[m]) for p, m in pieces]
    parent = np.concatenate([n[2] for n in new])
    made.triangles = np.concatenate([made.triangles[kept], *(n[0] for n in new)])
    made.values = np.concatenate([made.values[kept], *(n[1] for n in new)])
    for name in ("texture", "cutoff"):
        old = getattr(made, name)
        setattr(made, name, np.concatenate([old[kept], old[parent]]))
    unknown = np.full(len(parent), np.nan)
    made.wrong = np.concatenate([made.wrong[kept], unknown])
    made.worst = np.concatenate([made.worst[kept], unknown])


def _colored(made: _Cut, surface: Surface) -> tuple[Floats, bool]:
    """(m, 3, 4) shown colours of corners; whether some triangles had to stay too large.

    Where all triangles about a vertex are too large for the picture, it has the mean of its
    surroundings, as a viewer's smaller copies of a texture do: single texels would be chance.
    """
    _measure(made, surface)
    large = _unfinished(made, surface, 1.0)
    texels = _texels(made, surface)
    about = np.minimum(texels, np.roll(texels, 1, axis=1))  # of the two sides at a corner
    about = np.where(large[:, None], about, 1.0)
    least = np.full(len(made.points), np.inf)
    np.minimum.at(least, made.triangles[made.texture >= 0], about[made.texture >= 0])
    reach = np.where(np.isfinite(least), least, 1.0)[made.triangles]
    level = np.floor(np.log2(np.maximum(reach, 1.0))).astype(int)
    shown = to_shown(made.values[..., _RGBA][..., :3])
    rows = np.flatnonzero(made.texture >= 0)
    shown[rows] = _at_corners(made, surface, rows, level[rows])
    return np.concatenate([shown, np.ones((*shown.shape[:2], 1))], axis=2), bool(large.any())


def _off(made: _Cut, surface: Surface, colors: Floats) -> tuple[float, float, NDArray[np.bool_]]:
    """The mean error in steps of 255, what 99 % of the surface keeps to, and (m,) what is seen."""
    seen = np.ones(len(made.triangles), bool)
    rows = np.flatnonzero(made.texture >= 0)
    found, bins = _compare(made, surface, rows, colors[rows][..., :3])
    seen[rows] = found[:, 2] >= 0.5
    areas = _areas(made, rows)
    total = float((areas * found[:, 2]).sum())
    if total <= 0:
        return 0.0, 0.0, seen
    most = (int(np.searchsorted(np.cumsum(bins), 0.99 * total)) + 1) / 4
    return 255 * float((areas * found[:, 0]).sum()) / total, most, seen
