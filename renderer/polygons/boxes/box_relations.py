"""Which boxes overlap in the picture, and which of two is in front (Kang2008)."""

from __future__ import annotations

import numba
import numpy as np

from seethrough.renderer.arrays import Floats, Whole

# What two boxes are to each other: apart on the screen, i in front, j in front, intersecting.
APART, FIRST, SECOND, INTERSECTING = 0, 1, 2, 3


@numba.njit(cache=True)
def relate(
    centers: Floats,
    axes: Floats,
    halves: Floats,
    corners: Floats,
    point: Floats,
    table: Whole,
    sizes: Whole,
    exact: bool,
) -> tuple[Whole, int]:
    """(b, b) relations of boxes seen from a homogeneous point (4,), and the pairs tested.

    Only i < j is filled in. `exact`: by a plane between the two; otherwise by the paper's rule.
    """
    n = len(centers)
    relations = np.zeros((n, n), np.int8)
    rays = np.empty((n, 6, 3))
    edges = np.empty((n, 6, 4))
    length = np.empty(n, np.int64)
    frame = _picture(centers, point)
    extent = np.empty((n, 8))
    for i in range(n):
        code = face_code(centers[i], axes[i], halves[i], point)
        length[i] = sizes[code]
        contour(corners[i], table[code], length[i], point, rays[i], edges[i])
        _extent(rays[i], length[i], point[3], frame, extent[i])
    tested = 0
    for i in range(n):
        for j in range(i + 1, n):
            apart = False
            for k in range(0, 8, 2):
                if extent[i, k] > extent[j, k + 1] or extent[j, k] > extent[i, k + 1]:
                    apart = True
                    break
            if apart:
                continue
            if length[i] and length[j] and not _overlap(rays, edges, length, i, j):
                continue
            tested += 1
            if exact:
                relations[i, j] = _by_plane(centers, axes, halves, i, j, point)
            else:
                relations[i, j] = _by_paper(centers, axes, halves, corners, i, j, point)
    return relations, tested


@numba.njit()
def face_code(center: Floats, axes: Floats, halves: Floats, point: Floats) -> int:
    """Six bits: which faces the eye sees."""
    code = 0
    for axis in range(3):
        height = 0.0
        for k in range(3):
            height += axes[axis, k] * (point[k] - point[3] * center[k])
        reach = halves[axis] * point[3]
        if height > reach:
            code |= 1 << (2 * axis)
        elif height < -reach:
            code |= 1 << (2 * axis + 1)
    return code


@numba.njit()
def contour(
    corners: Floats, loop: Whole, length: int, point: Floats, rays: Floats, edges: Floats
) -> None:
    """Rays from the eye to the contour's corners, and normals of the planes through its edges.

    For a view vector the rays are the corners themselves, shifted along it: the planes contain
    the view direction.
    """
    for c in range(length):
        for k in range(3):
            rays[c, k] = (
                corners[loop[c], k] * (1.0 if point[3] == 0.0 else point[3]) - point[k] * point[3]
            )
    for c in range(length):
        d = (c + 1) % length
        a, b = rays[c], rays[d]
        if point[3] == 0.0:
            # Seen along a direction, the second vector is that direction.
            edges[c, 0] = (b[1] - a[1]) * -point[2] - (b[2] - a[2]) * -point[1]
            edges[c, 1] = (b[2] - a[2]) * -point[0] - (b[0] - a[0]) * -point[2]
            edges[c, 2] = (b[0] - a[0]) * -point[1] - (b[1] - a[1]) * -point[0]
        else:
            edges[c, 0] = a[1] * b[2] - a[2] * b[1]
            edges[c, 1] = a[2] * b[0] - a[0] * b[2]
            edges[c, 2] = a[0] * b[1] - a[1] * b[0]
        base, inner = 0.0, 0.0
        for k in range(3):
            base += edges[c, k] * a[k]
        for d in range(length):
            height = -base
            for k in range(3):
                height += edges[c, k] * rays[d, k]
            if abs(height) > abs(inner):
                inner = height
        # Turned inwards: the contour's own corners are at or above the edge's offset. An edge of
        # a flat box may be no edge at all, and parts nothing.
        turn = -1.0 if inner < 0.0 else 1.0
        for k in range(3):
            edges[c, k] *= turn
        edges[c, 3] = base * turn if inner != 0.0 else -np.inf


@numba.njit()
def _picture(centers: Floats, point: Floats) -> Floats:
    """Rows: across, up and into a picture that looks at the middle of all boxes."""
    frame = np.zeros((3, 3))
    for k in range(3):
        frame[2, k] = centers[:, k].mean() - point[k] if point[3] else -point[k]
    norm = np.sqrt((frame[2] ** 2).sum())
    if norm > 0.0:
        frame[2] /= norm
    least = 0
    for k in range(3):
        if abs(frame[2, k]) < abs(frame[2, least]):
            least = k
    helper = np.zeros(3)
    helper[least] = 1.0
    frame[0] = np.cross(frame[2], helper)
    frame[1] = np.cross(frame[2], frame[0])
    return frame


@numba.njit()
def _extent(rays: Floats, length: int, w: float, frame: Floats, extent: Floats) -> None:
    """A contour's extent in the picture, along four directions: what may overlap at all.

    Without bounds where the eye is inside, or a corner lies beside or behind the eye.
    """
    for k in range(0, 8, 2):
        extent[k], extent[k + 1] = np.inf, -np.inf
    reach = length > 0
    for c in range(length):
        x, y, depth = 0.0, 0.0, 0.0
        size = 0.0
        for k in range(3):
            x += rays[c, k] * frame[0, k]
            y += rays[c, k] * frame[1, k]
            depth += rays[c, k] * frame[2, k]
            size += abs(rays[c, k])
        if w:
            if depth < 1e-3 * size:
                reach = False
                break
            x, y = x / depth, y / depth
        for k, value in enumerate((x, y, x + y, x - y)):
            extent[2 * k] = min(extent[2 * k], value)
            extent[2 * k + 1] = max(extent[2 * k + 1], value)
    if not reach:
        for k in range(0, 8, 2):
            extent[k], extent[k + 1] = -np.inf, np.inf


@numba.njit()
def _overlap(rays: Floats, edges: Floats, length: Whole, i: int, j: int) -> bool:
    """Whether two convex contours overlap: no edge of either has the other wholly outside."""
    for swap in range(2):
        one, other = (i, j) if swap == 0 else (j, i)
        for e in range(length[one]):
            nx, ny, nz, base = (
                edges[one, e, 0],
                edges[one, e, 1],
                edges[one, e, 2],
                edges[one, e, 3],
            )
            outside = True
            for c in range(length[other]):
                if nx * rays[other, c, 0] + ny * rays[other, c, 1] + nz * rays[other, c, 2] > base:
                    outside = False
                    break
            if outside:
                return False
    return True


@numba.njit()
def _reach(axes: Floats, halves: Floats, i: int, x: float, y: float, z: float) -> float:
    """Half of a box's extent along a direction."""
    total = 0.0
    for axis in range(3):
        total += halves[i, axis] * abs(
            axes[i, axis, 0] * x + axes[i, axis, 1] * y + axes[i, axis, 2] * z
        )
    return total


@numba.njit()
def _by_plane(centers: Floats, axes: Floats, halves: Floats, i: int, j: int, point: Floats) -> int:
    """The exact rule: a plane between the boxes, and the eye's side of it.

    Two convex bodies that don't intersect have a plane between them across a face normal of one,
    or across a common normal of two edges. Any such plane will do.
    """
    best = -np.inf
    result = 3
    for test in range(15):
        if test < 3:
            x, y, z = axes[i, test, 0], axes[i, test, 1], axes[i, test, 2]
        elif test < 6:
            x, y, z = axes[j, test - 3, 0], axes[j, test - 3, 1], axes[j, test - 3, 2]
        else:
            a, b = (test - 6) // 3, (test - 6) % 3
            x = axes[i, a, 1] * axes[j, b, 2] - axes[i, a, 2] * axes[j, b, 1]
            y = axes[i, a, 2] * axes[j, b, 0] - axes[i, a, 0] * axes[j, b, 2]
            z = axes[i, a, 0] * axes[j, b, 1] - axes[i, a, 1] * axes[j, b, 0]
            size = np.sqrt(x * x + y * y + z * z)
            if size < 1e-9:
                continue
            x, y, z = x / size, y / size, z / size
        at_i = centers[i, 0] * x + centers[i, 1] * y + centers[i, 2] * z
        at_j = centers[j, 0] * x + centers[j, 1] * y + centers[j, 2] * z
        low_reach, high_reach = _reach(axes, halves, i, x, y, z), _reach(axes, halves, j, x, y, z)
        gap = abs(at_j - at_i) - low_reach - high_reach
        if gap > best:
            best = gap
            turn = 1.0 if at_j > at_i else -1.0
            middle = (at_i * turn + low_reach + at_j * turn - high_reach) / 2
            eye = (point[0] * x + point[1] * y + point[2] * z) * turn
            result = 2 if eye > middle * point[3] else 1
            if gap > 0.0:
                break
    # Boxes that only touch are parted by the plane they touch in.
    scale = 0.0
    for k in range(3):
        scale += abs(centers[i, k]) + abs(centers[j, k]) + halves[i, k] + halves[j, k]
    return result if best >= -1e-12 * scale else 3


@numba.njit()
def _by_paper(
    centers: Floats, axes: Floats, halves: Floats, corners: Floats, i: int, j: int, point: Floats
) -> int:
    """The paper's rule: count the planes of j that have all of i in front."""
    planes = 0
    result = 0
    for face in range(6):
        axis, sign = face // 2, 1.0 - 2.0 * (face % 2)
        x, y, z = axes[j, axis, 0] * sign, axes[j, axis, 1] * sign, axes[j, axis, 2] * sign
        wall = centers[j, 0] * x + centers[j, 1] * y + centers[j, 2] * z + halves[j, axis]
        nearest = (
            centers[i, 0] * x
            + centers[i, 1] * y
            + centers[i, 2] * z
            - _reach(axes, halves, i, x, y, z)
        )
        if nearest >= wall:
            planes += 1
            eye = point[0] * x + point[1] * y + point[2] * z
            result = 1 if eye > wall * point[3] else 2
    if planes == 1:
        return result
    return 1 if _nearest(corners[i], point) < _nearest(corners[j], point) else 2


@numba.njit()
def _nearest(corners: Floats, point: Floats) -> float:
    """Squared distance of the nearest corner; along the view, its depth."""
    least = np.inf
    for c in range(8):
        total = 0.0
        for k in range(3):
            if point[3] == 0.0:
                total -= corners[c, k] * point[k]
            else:
                total += (corners[c, k] - point[k]) ** 2
        least = min(least, total)
    return least
