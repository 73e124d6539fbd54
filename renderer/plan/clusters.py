"""Objects that really intersect, put together so that their polygons can be put in order.

No order of objects is right where two reach into one another; an order of polygons cut along one
another is. Of a convex object the faces towards the eye are the front-most surface, each pixel
once, so a cluster of convex objects can be drawn face by face with the others culled. Clusters of
other objects, of targets and of what lies both before and behind a third are left to be sorted by
pixel.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from seethrough.renderer.arrays import Bools, Floats, Ints, Signs
from seethrough.renderer.polygons import bsp
from seethrough.renderer.polygons.bsp import PreparedBsp
from seethrough.renderer.polygons.fragments import TooManyPieces
from seethrough.renderer.polygons.polygons import Polygons, triangles_from
from seethrough.renderer.scene.scene import Object, Scene

MOST = 3000  # triangles of a cluster: a tree of as many is built within a second
MOST_PIECES = 30_000  # that they may be cut into: where all cross, 100 triangles make 25,000
_KEPT = 32
_trees: dict[bytes, tuple[list[Object], PreparedBsp | str]] = {}


@dataclass(frozen=True, eq=False)
class United:
    """What `plan` knows of all objects, with each cluster in the place of its first member.

    `members` of each cluster, its first one leading; for n objects, `extents` (n, 8), `relation`
    and `uncertain` (n, n), and `blended` (n,): led objects do not blend by themselves.
    """

    members: tuple[Ints, ...]
    extents: Floats
    relation: Signs
    uncertain: Bools
    blended: Bools

    @property
    def clustered(self) -> Bools:
        """(n,) which objects are part of a cluster."""
        found = np.zeros(len(self.blended), bool)
        for members in self.members:
            found[members] = True
        return found


def fitting(scene: Scene) -> Bools:
    """(n,) what may be part of a cluster: convex, no target, in no group with others."""
    convex = scene.convex
    alone = np.bincount(scene.group_of)[scene.group_of] == 1 if len(convex) else convex
    return convex & alone & ~scene.targets


def unite(
    extents: Floats,
    relation: Signs,
    uncertain: Bools,
    blended: Bools,
    fit: Bools,
    triangles: Ints,
    small: Callable[[Ints], bool] = lambda members: True,
) -> United:
    """Find the clusters: `fit` blended objects whose order is uncertain (see order.decide), and
    whose tree stays `small`."""
    if not fit.any():
        return United((), extents, relation, uncertain, blended)
    found: list[Ints] = []
    united = United((), extents.copy(), relation.copy(), uncertain.copy(), blended.copy())
    able = blended & fit
    for members in _connected(uncertain & able & able[:, None]):
        if triangles[members].sum() <= MOST and small(members) and _lead(united, members):
            found.append(members)
    return United(tuple(found), united.extents, united.relation, united.uncertain, united.blended)


def _connected(pairs: Bools) -> list[Ints]:
    """Sets of two or more that pairs connect, each sorted."""
    left = set(np.nonzero(pairs.any(axis=1))[0].tolist())
    found = []
    while left:
        reached, new = set(), {left.pop()}
        while new:
            reached |= new
            new = set(np.nonzero(pairs[sorted(new)].any(axis=0))[0].tolist()) - reached
        left -= reached
        found.append(np.array(sorted(reached), np.int64))
    return sorted(found, key=lambda members: int(members[0]))


def _lead(united: United, members: Ints) -> bool:
    """Let the first member stand for all, unless something lies both before and behind them."""
    outside = np.ones(len(united.blended), bool)
    outside[members] = False
    rows = united.relation[members]
    front, back = (rows > 0).any(axis=0), (rows < 0).any(axis=0)
    if (outside & ((front & back) | united.uncertain[members].any(axis=0))).any():
        return False
    side = np.where(outside, front.astype(np.int8) - back.astype(np.int8), 0).astype(np.int8)
    leader = members[0]
    united.relation[leader], united.relation[:, leader] = side, -side
    for low in range(0, united.extents.shape[1], 4):  # boxes, then slants
        begin, end = slice(low, low + 2), slice(low + 2, low + 4)
        united.extents[leader, begin] = united.extents[members, begin].min(axis=0)
        united.extents[leader, end] = united.extents[members, end].max(axis=0)
    united.uncertain[np.ix_(members, members)] = False
    united.blended[members[1:]] = False
    return True


def tree_of(scene: Scene, members: Ints) -> PreparedBsp | str:
    """The tree of a cluster, made once; why there is none, where its polygons cross too densely."""
    things = [scene.objects[i] for i in members.tolist()]
    key = b"".join(
        np.array([id(t.mesh), *t.transform.ravel(), *t.color], float).tobytes() for t in things
    )
    if key not in _trees:
        while len(_trees) >= _KEPT:
            _trees.pop(next(iter(_trees)))
        try:
            made: PreparedBsp | str = bsp.prepare(
                polygons_of(scene, members), halves=False, most=MOST_PIECES
            )
        except TooManyPieces as error:
            made = str(error)
        _trees[key] = (things, made)  # with the objects, so that no other mesh takes their number
    return _trees[key][1]


def polygons_of(scene: Scene, members: Ints) -> Polygons:
    """World triangles of a cluster's objects; attributes: normal (x, y, z), then r, g, b."""
    corners, columns, labels = [], [], []
    for i in members.tolist():
        thing = scene.objects[i]
        mesh, linear = thing.mesh, thing.transform[:3, :3]
        mirrored = np.linalg.det(linear) < 0
        rows = (mesh.triangles[:, ::-1] if mirrored else mesh.triangles).ravel()
        corners.append((mesh.vertices @ linear.T + thing.transform[:3, 3])[rows])
        normals = mesh.normals @ np.linalg.inv(linear)  # as long as object.vert makes them
        columns.append(np.hstack([normals, mesh.colors * thing.color])[rows])
        labels.append(np.full(len(mesh.triangles), i))
    flat = np.concatenate(corners)
    triangles = np.arange(len(flat)).reshape(-1, 3)
    return triangles_from(flat, triangles, np.concatenate(columns), np.concatenate(labels))
