"""Two targets that no plane separates: which is drawn first, and whether that is good enough.

Drawn first, a target is seen through the other wherever it lies behind it; the other is lost where
it lies behind in turn. How much that is, a coarse picture of the two tells.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numba import njit

from renderer.blending import Blending
from renderer.camera import Camera
from renderer.order import BEHIND, IN_FRONT, LITTLE
from renderer.scene import Scene

CELLS = 24  # of the coarse picture, on each side
LARGE = 4000  # triangles of two targets: more are sorted by pixel without a look


def settled(what: Blending, scene: Scene, camera: Camera, size: tuple[int, int]) -> Blending:
    """The same with such pairs in the better order, and `lost` where that one is not enough."""
    both = what.blended & what.masked
    pairs = np.argwhere(np.triu(what.uncertain & both & both[:, None] & ~what.lost))
    if not len(pairs):
        return what
    relation, lost = what.relation.copy(), what.lost.copy()
    spent = np.zeros(len(lost))  # what each target loses to all that are drawn before it
    scale = 0.5 * size[1] / np.tan(camera.fov_y / 2)
    lens = np.array([scale, size[0] / 2, size[1] / 2, camera.near])
    for i, j in pairs.tolist():
        a, b = what.extents[i], what.extents[j]
        box = np.concatenate([np.minimum(a[:2], b[:2]), np.maximum(a[2:], b[2:])])
        box = np.clip(box, 0, [*size, *size])
        if (np.maximum(a[:2], b[:2]) > np.minimum(a[2:], b[2:])).any() or (
            box[:2] >= box[2:]
        ).any():
            continue
        shapes = [scene.objects[k].mesh for k in (i, j)]
        if sum(len(mesh.triangles) for mesh in shapes) > LARGE:
            lost[i, j] = lost[j, i] = True
            continue
        turns = camera.rotation.T @ scene.transforms[[i, j], :3, :3]
        moves = (scene.transforms[[i, j], :3, 3] - camera.eye) @ camera.rotation
        args = [(m.vertices, m.triangles, turns[k], moves[k]) for k, m in enumerate(shapes)]
        first, second = _behind(*args[0], *args[1], lens, box)
        relation[i, j] = IN_FRONT if first <= second else BEHIND
        relation[j, i] = -relation[i, j]
        loser, share = (i, first) if first <= second else (j, second)
        lost[i, j] = lost[j, i] = spent[loser] + share > LITTLE
        spent[loser] += 0.0 if lost[i, j] else share
    return replace(what, relation=relation, lost=lost)


@njit(cache=True)
def _behind(points, faces, turn, move, others, other_faces, other_turn, other_move, lens, box):  # type: ignore[no-untyped-def]
    """Of each of two meshes, the share of its cells in which it lies behind the other; 1 where the
    near plane cuts one."""
    one, two = np.zeros((CELLS, CELLS)), np.zeros((CELLS, CELLS))
    if not _nearest(points, faces, turn, move, lens, box, one):
        return 1.0, 1.0
    if not _nearest(others, other_faces, other_turn, other_move, lens, box, two):
        return 1.0, 1.0
    count, behind = np.zeros(2), np.zeros(2)
    for row in range(CELLS):
        for column in range(CELLS):
            a, b = one[row, column], two[row, column]
            count[0] += a > 0
            count[1] += b > 0
            behind[0] += 0 < a < b
            behind[1] += 0 < b < a
    return behind[0] / max(count[0], 1.0), behind[1] / max(count[1], 1.0)


@njit(cache=True)
def _nearest(points, faces, turn, move, lens, box, nearness):  # type: ignore[no-untyped-def]
    """Put 1 / depth of a mesh's nearest surface into the cells of a box of the picture, 0 where it
    is not. False if any of it lies before the near plane."""
    place = np.empty((len(points), 3))
    across, down = CELLS / (box[2] - box[0]), CELLS / (box[3] - box[1])
    for p in range(len(points)):
        x, y, z = move[0], move[1], -move[2]
        for c in range(3):
            x += turn[0, c] * points[p, c]
            y += turn[1, c] * points[p, c]
            z -= turn[2, c] * points[p, c]
        if z < lens[3]:
            return False
        place[p, 0] = (lens[1] + lens[0] * x / z - box[0]) * across - 0.5
        place[p, 1] = (lens[2] - lens[0] * y / z - box[1]) * down - 0.5
        place[p, 2] = 1.0 / z
    for t in range(len(faces)):
        a, b, c = place[faces[t, 0]], place[faces[t, 1]], place[faces[t, 2]]
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if area == 0:
            continue
        left, right = min(a[0], b[0], c[0]), max(a[0], b[0], c[0])
        top, bottom = min(a[1], b[1], c[1]), max(a[1], b[1], c[1])
        for row in range(max(int(np.ceil(top)), 0), min(int(np.floor(bottom)) + 1, CELLS)):
            for column in range(max(int(np.ceil(left)), 0), min(int(np.floor(right)) + 1, CELLS)):
                u = ((b[0] - column) * (c[1] - row) - (b[1] - row) * (c[0] - column)) / area
                v = ((c[0] - column) * (a[1] - row) - (c[1] - row) * (a[0] - column)) / area
                if u >= 0 and v >= 0 and u + v <= 1:
                    near = u * a[2] + v * b[2] + (1 - u - v) * c[2]
                    nearness[row, column] = max(nearness[row, column], near)
    return True
