"""Simplified models for outlines: a few hundred triangles with nearly the same silhouette.

Quadric edge collapse (Garland and Heckbert 1997, as in libigl) takes a tenth of a second a model,
too long for the start of a session, so proxies.npz holds its results. After a change to a model run
`python -m seethrough.renderer.models.proxies`, which writes the file anew and prints what it costs
in outline.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache, lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.models.forms.outline import outline, square, view_axes
from seethrough.renderer.models.forms.shapes import Shape, shade, shape
from seethrough.renderer.scene.geometry import Mesh

FILE = Path(__file__).with_name("proxies.npz")
BUDGETS = (300, 400, 600, 900)
TOLERANCE = 0.005
VIEWS = tuple((yaw, pitch) for pitch in (-0.2, 0.1, 0.5) for yaw in np.arange(0.2, 6.28, 0.9))
"""Yaws and pitches in radians from which outlines are compared."""


@lru_cache(maxsize=1)
def _stored() -> dict[str, NDArray[np.number]]:
    with np.load(FILE) as file:
        return dict(file)


@cache
def proxy(name: str) -> Mesh:
    """A closed mesh of 300 to 900 triangles in the place of `MODELS[name]`, in its colour.

    Raises KeyError for a name that is no model.
    """
    stored = _stored()
    vertices = stored[f"{name}/vertices"].astype(float)
    triangles = stored[f"{name}/triangles"].astype(np.int64)
    return shade(shape(vertices, triangles, stored[f"{name}/color"].astype(float), sharp=60))


def outline_error(
    mesh: Mesh, other: Mesh, size: int = 128, views: Sequence[tuple[float, float]] = VIEWS
) -> float:
    """Share of the outline's pixels that one mesh covers and the other nowhere within a pixel.

    The picture is the square of size × size pixels about the first mesh.
    """
    wrong = total = 0
    for yaw, pitch in views:
        frame = square((mesh.vertices @ view_axes(yaw, pitch).T)[:, :2])
        one = outline(mesh, yaw, pitch, size, frame).covered
        two = outline(other, yaw, pitch, size, frame).covered
        wrong += int((one & ~_grown(two)).sum() + (two & ~_grown(one)).sum())
        total += int(one.sum())
    return wrong / total


def _grown(covered: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """With all eight neighbours of each pixel."""
    wide = np.pad(covered, 1)
    rows = wide[:-2] | wide[1:-1] | wide[2:]
    return rows[:, :-2] | rows[:, 1:-1] | rows[:, 2:]


def simplified(whole: Shape) -> Shape:
    """The parts of a model that show in its outline, with 300 to 900 triangles.

    The least of BUDGETS that keeps the outline's error within TOLERANCE, or the largest.
    """
    import igl

    kept = _outline_parts(whole)
    mesh = shade(whole)
    color = whole.colors.mean(axis=(0, 1))
    for triangles in BUDGETS:
        vertices, faces, *_ = igl.qslim(
            np.ascontiguousarray(kept.vertices), np.ascontiguousarray(kept.triangles), triangles
        )
        small = shape(vertices, faces.astype(np.int64), color, sharp=60)
        if outline_error(mesh, shade(small)) <= TOLERANCE:
            break
    return small


def _outline_parts(whole: Shape, share: float = 0.0015) -> Shape:
    """Without the connected parts that add less than `share` to the area of the outlines.

    Parts are taken from the largest picture to the smallest, each judged by what it adds.
    """
    part_of = connected_parts(whole)
    parts = np.unique(part_of)
    pictures = np.stack([_pictures(_only(whole, part_of == part)) for part in parts])
    total = pictures.any(axis=0).sum()
    seen = np.zeros(pictures.shape[1:], bool)
    kept = []
    for i in np.argsort(-pictures.sum(axis=(1, 2)), kind="stable"):
        if (pictures[i] & ~seen).sum() >= share * total:
            kept.append(parts[i])
            seen |= pictures[i]
    return _only(whole, np.isin(part_of, kept))


def _pictures(part: Shape) -> NDArray[np.bool_]:
    """(views, pixels) outlines of a part, all in the frame of 3 × 3 units about (0, 1, 0)."""
    mesh = Mesh(
        part.vertices - (0, 0.75, 0), part.vertices, part.vertices, part.triangles.astype(np.int32)
    )
    frame = np.array([[-1.5, -1.5], [1.5, 1.5]])
    views = [outline(mesh, yaw, pitch, 160, frame).covered.ravel() for yaw, pitch in VIEWS[::2]]
    return np.stack(views)


def connected_parts(whole: Shape) -> NDArray[np.int64]:
    """(m,) for each triangle the lowest vertex it is connected to."""
    label = np.arange(len(whole.vertices))
    while True:
        lowest = label.copy()
        np.minimum.at(lowest, whole.triangles.ravel(), label[whole.triangles].min(1).repeat(3))
        lowest = lowest[lowest]
        if (lowest == label).all():
            return label[whole.triangles[:, 0]]
        label = lowest


def _only(whole: Shape, chosen: NDArray[np.bool_]) -> Shape:
    """The chosen triangles, with the vertices they use."""
    used, triangles = np.unique(whole.triangles[chosen], return_inverse=True)
    return Shape(
        whole.vertices[used], triangles.reshape(-1, 3), whole.colors[chosen], whole.crease[chosen]
    )


def main() -> None:
    """Write the proxies of all models and print the error of each."""
    from seethrough.renderer.models import BUILDERS

    arrays = {}
    for build in BUILDERS:
        whole = build()
        small = simplified(whole)
        name = build.__name__
        arrays[f"{name}/vertices"] = small.vertices.astype(np.float32)
        arrays[f"{name}/triangles"] = small.triangles.astype(np.int16)
        arrays[f"{name}/color"] = small.colors[0, 0].astype(np.float32)
        error = outline_error(shade(whole), shade(small))
        print(f"{name:16s} {len(whole.triangles):6d} → {len(small.triangles):4d}  {error:6.2%}")
    np.savez_compressed(FILE, allow_pickle=False, **arrays)


if __name__ == "__main__":
    main()
