"""Masks on the GPU: hull and skirt for convex targets, an exact distance picture for the others.

The distance picture has one channel for each set of targets that are too far apart on the screen
to touch each other's masks; it is drawn before the objects, from the outlines' segments with the
minimum as blend equation, so no framebuffer is switched between objects.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from renderer import projection
from renderer.camera import Camera
from renderer.gpu.scene_table import SceneTable
from renderer.masks import hulls_with_skirts
from renderer.plan import FramePlan
from renderer.silhouettes import near_cuts, silhouette

CHANNELS = 4
FAR = 60000.0


def channels_of(
    targets: NDArray[np.int64], extents: NDArray[np.float64], width: float, count: int
) -> NDArray[np.float64]:
    """(n objects,) a channel for each of `targets` so that masks of one channel stay apart.

    Channel 4 p + c is channel c of picture p. Objects that are no such target have −1.
    """
    channel = np.full(count, -1.0)
    members: list[list[int]] = []
    for t in targets.tolist():
        box = extents[t]
        for k, others in enumerate([*members, []]):
            o = extents[others].reshape(-1, 4)
            # Both masks reach out, so twice the width lies between targets of one channel.
            gap = 2 * width + 2
            meets = (box[0] <= o[:, 2] + gap) & (box[2] >= o[:, 0] - gap)
            meets &= (box[1] <= o[:, 3] + gap) & (box[3] >= o[:, 1] - gap)
            if not meets.any():
                if k == len(members):
                    members.append([])
                members[k].append(t)
                channel[t] = k
                break
    return channel


def hull_targets(table: SceneTable, frame: FramePlan) -> NDArray[np.bool_]:
    """(m,) which masked targets show their hull: closed, convex, not cut by the near plane."""
    shapes = [table.meshes[table.slot[t]] for t in frame.masked.tolist()]
    convex = [m.mesh.convex and m.topology.closed for m in shapes]
    return np.array(convex, dtype=bool) & ~frame.boxes.crosses[frame.masked]


def hull_vertices(
    table: SceneTable,
    targets: NDArray[np.int64],
    camera: Camera,
    size: tuple[int, int],
    width: float,
) -> tuple[NDArray[np.float32], NDArray[np.int64]]:
    """Hulls with skirts of convex targets: see masks.hulls_with_skirts."""
    clouds = []
    for t in targets.tolist():
        points = table.meshes[table.slot[t]].topology.points
        matrix = table.scene.transforms[t]
        clouds.append(points @ matrix[:3, :3].T + matrix[:3, 3])
    starts = np.cumsum([0] + [len(c) for c in clouds])
    world = np.concatenate([*clouds, np.zeros((0, 3))])
    pixels = projection.to_pixels(projection.to_camera(world, camera), camera, size)
    return hulls_with_skirts(pixels, starts, width)


def outline_segments(
    table: SceneTable, target: int, camera: Camera, size: tuple[int, int]
) -> NDArray[np.float64]:
    """(k, 4) ends of the segments of a target's outline in pixels, cut at the near plane."""
    shape = table.meshes[table.slot[target]].topology
    matrix = table.scene.transforms[target]
    eye = np.linalg.solve(matrix[:3, :3], camera.eye - matrix[:3, 3])
    world = shape.points @ matrix[:3, :3].T + matrix[:3, 3]
    seen = projection.to_camera(world, camera)
    depth = -seen[:, 2]
    ends = silhouette(shape, eye)
    ends = ends[(depth[ends] >= camera.near).any(axis=1)]
    a, b = seen[ends[:, 0]], seen[ends[:, 1]]
    for here, there in ((a, b), (b, a)):
        behind = -here[:, 2] < camera.near
        t = (camera.near + here[behind, 2]) / (here[behind, 2] - there[behind, 2])
        here[behind] += t[:, None] * (there[behind] - here[behind])
    segments = np.stack([a, b], axis=1)
    if (depth < camera.near).any():
        cuts = near_cuts(shape, eye, depth, camera.near)
        moved = cuts @ matrix[:3, :3].T + matrix[:3, 3]
        segments = np.concatenate([segments, projection.to_camera(moved, camera)])
    return projection.to_pixels(segments, camera, size).reshape(-1, 4)


def rectangles(
    extents: NDArray[np.float64], channels: NDArray[np.float64], width: float
) -> NDArray[np.float32]:
    """(k, 6, 5) two triangles round each extent, `width` larger, that look up a channel."""
    grown = extents + np.array([-1, -1, 1, 1]) * (width + 1)
    corners = grown[:, [[0, 1], [2, 1], [2, 3], [0, 1], [2, 3], [0, 3]]]
    data = np.zeros((len(extents), 6, 3))
    data[:, :, 2] = channels[:, None]
    return np.concatenate([corners, data], axis=2).astype(np.float32)
