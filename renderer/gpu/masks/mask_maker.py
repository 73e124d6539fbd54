"""The geometry of masks, made on the CPU for each frame.

Hulls with skirts for convex outlines, quads for circles and ellipses; every other outline is
drawn into a picture of distances beforehand, and a rectangle looks it up.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats32, Ints
from seethrough.renderer.gpu.device.scene_table import SceneTable
from seethrough.renderer.gpu.masks.rectangles import VERTEX, rectangles, tiled
from seethrough.renderer.masks import masks
from seethrough.renderer.masks.silhouettes import near_cuts, silhouette
from seethrough.renderer.masks.skirts import hulls_with_skirts
from seethrough.renderer.plan.frame_plan import FramePlan
from seethrough.renderer.scene import projection
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

ELLIPSES = ("circle", "ellipse", "oriented-ellipse")

_SIGNS = np.array([[-1, -1], [1, -1], [1, 1], [-1, -1], [1, 1], [-1, 1]])


@dataclass(frozen=True, eq=False)
class MaskGeometry:
    """The masks of a frame.

    vertices (k, 7) float32, see shaders/mask.vert; first (m,) and count (m,) for each of the m
    `targets`, which from number `pictured` on are looked up; `looped` and `covered` are those that
    need a picture of distances: closed ones by the loops of their outline, the others drawn whole.
    `tile` (n objects, 4) is where their picture lies in the texture: left, bottom, right, top;
    `shift` (n objects, 2) leads there from the window's pixels (y up); `height` is the texture's.
    """

    vertices: NDArray[np.float32]
    targets: NDArray[np.int64]
    first: NDArray[np.int64]
    count: NDArray[np.int64]
    pictured: int
    looped: NDArray[np.int64]
    covered: NDArray[np.int64]
    tile: NDArray[np.int64]
    shift: NDArray[np.int64]
    height: int


def mask_geometry(
    table: SceneTable,
    frame: FramePlan,
    camera: Camera,
    technique: DynamicTransparency,
    width: float,
    size: tuple[int, int],
) -> MaskGeometry:
    """The masks of a frame's targets, `width` pixels wide."""
    # In the order of the levels, so that the masks of a level lie side by side.
    levels = [level.masks for level in frame.levels]
    masked = np.concatenate(levels) if levels else frame.masked
    convex, closed = table.shapes(masked).T
    hulled = _hulled(frame, masked, technique, convex & closed)
    ellipses = technique.mask in ELLIPSES
    shaped = np.ones_like(hulled) if ellipses else hulled
    plain, pictured = masked[shaped], masked[~shaped]
    if ellipses:
        vertices, firsts = _ellipses(table, plain, frame, camera, technique.mask, width, size)
    else:
        vertices, firsts = _hulls(table, plain, frame, camera, width, size)
    tile, shift, height, empty = tiled(frame.reach, pictured, size)
    flat = rectangles(frame.reach, pictured, empty, shift, size)
    base = len(vertices) + 6 * np.arange(len(pictured))
    loops = closed[~shaped] & ~frame.boxes.crosses[pictured]
    loops &= technique.mask == "outline"
    return MaskGeometry(
        vertices=np.concatenate([vertices, flat]),
        targets=np.concatenate([plain, pictured]),
        first=np.concatenate([firsts[:-1], base]),
        count=np.concatenate([np.diff(firsts), np.where(empty, 0, 6)]),
        pictured=len(plain),
        looped=pictured[loops & ~empty],
        covered=pictured[~loops & ~empty],
        tile=tile,
        shift=shift,
        height=height,
    )


def _hulled(
    frame: FramePlan,
    masked: NDArray[np.int64],
    technique: DynamicTransparency,
    solid: NDArray[np.bool_],
) -> NDArray[np.bool_]:
    """(m,) which masked targets show a hull: all if asked for, else closed convex uncut ones."""
    if technique.mask == "hull":
        return np.ones(len(masked), dtype=bool)
    if technique.mask == "ring" or "hulls" in frame.without:
        return np.zeros(len(masked), dtype=bool)
    return solid & ~frame.boxes.crosses[masked]


def _outline_points(
    table: SceneTable, target: int, frame: FramePlan, camera: Camera, size: tuple[int, int]
) -> NDArray[np.float64]:
    """(v, 2) pixels among which are all corners of the target's hull."""
    if frame.boxes.crosses[target]:
        return outline_segments(table, target, camera, size).reshape(-1, 2)
    points = table.meshes[table.slot[target]].topology.points
    matrix = table.scene.transforms[target]
    turn = camera.rotation.T @ matrix[:3, :3]
    move = camera.rotation.T @ (matrix[:3, 3] - camera.eye)
    return projection.to_pixels(points @ turn.T + move, camera, size)


def _hulls(
    table: SceneTable,
    targets: Ints,
    frame: FramePlan,
    camera: Camera,
    width: float,
    size: tuple[int, int],
) -> tuple[Floats32, Ints]:
    points, spans = table.points(targets)
    scale = camera.lens(size[1])
    lens = np.array([scale, size[0] / 2, size[1] / 2])
    cut = frame.boxes.crosses[targets]
    pixels, starts = projection.clouds(points, spans, *table.turned(targets, camera), lens)
    if cut.any():
        clouds = [pixels[a:b] for a, b in pairwise(starts.tolist())]
        for k in np.nonzero(cut)[0].tolist():
            cloud = _outline_points(table, int(targets[k]), frame, camera, size)
            clouds[k] = cloud if len(cloud) else np.full((1, 2), -1e6)
        starts = np.cumsum([0] + [len(c) for c in clouds])
        pixels = np.concatenate(clouds)
    return hulls_with_skirts(pixels, starts, width)


def _ellipses(
    table: SceneTable,
    targets: Ints,
    frame: FramePlan,
    camera: Camera,
    shape: str,
    width: float,
    size: tuple[int, int],
) -> tuple[Floats32, Ints]:
    rows = np.zeros((len(targets), 6, VERTEX), np.float32)
    for k, t in enumerate(targets.tolist()):
        points = _outline_points(table, t, frame, camera, size)
        if not len(points):
            continue
        along = masks.long_axis(table.scene.objects[t], camera)
        x, y, ux, uy, a, b = masks.bounding_ellipse(points, shape, along)
        offset = _SIGNS * (np.array([a, b]) + width + 1)
        rows[k, :, 0] = x + offset[:, 0] * ux - offset[:, 1] * uy
        rows[k, :, 1] = y + offset[:, 0] * uy + offset[:, 1] * ux
        rows[k, :, 2:4] = offset
        rows[k, :, 4] = -1
        rows[k, :, 5:7] = a, b
    return rows.reshape(-1, VERTEX), 6 * np.arange(len(targets) + 1)


def outline_segments(
    table: SceneTable, target: int, camera: Camera, size: tuple[int, int]
) -> NDArray[np.float64]:
    """(k, 4) ends of the segments of a target's outline in pixels, cut at the near plane."""
    shape = table.meshes[table.slot[target]].topology
    matrix = table.scene.transforms[target]
    eye = table.inverse[target] @ (camera.eye - matrix[:3, 3])
    turn = camera.rotation.T @ matrix[:3, :3]
    move = camera.rotation.T @ (matrix[:3, 3] - camera.eye)
    ends = silhouette(shape, eye)
    seen = shape.points @ turn.T + move
    depth = -seen[:, 2]
    cut = bool((depth < camera.near).any())
    if not cut:
        return projection.to_pixels(seen[ends], camera, size).reshape(-1, 4)
    ends = ends[(depth[ends] >= camera.near).any(axis=1)]
    a, b = seen[ends[:, 0]], seen[ends[:, 1]]
    for here, there in ((a, b), (b, a)):
        behind = -here[:, 2] < camera.near
        t = (camera.near + here[behind, 2]) / (here[behind, 2] - there[behind, 2])
        here[behind] += t[:, None] * (there[behind] - here[behind])
    cuts = near_cuts(shape, eye, depth, camera.near) @ turn.T + move
    segments = np.concatenate([np.stack([a, b], axis=1), cuts])
    segments[..., 2] = np.minimum(segments[..., 2], -camera.near)
    return projection.to_pixels(segments, camera, size).reshape(-1, 4)
