"""What there is to draw, as frozen values: no GPU, no files, no task."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.scene.geometry import CORNERS, Mesh
from seethrough.renderer.scene.look import PLAIN, Look

if TYPE_CHECKING:
    from seethrough.renderer.plan.separation import Separations
    from seethrough.renderer.scene.rooms import Rooms

Color = tuple[float, float, float]


def _identity() -> NDArray[np.float64]:
    return np.eye(4)


@dataclass(frozen=True, eq=False)
class Object:
    """One thing in the world: a mesh, where it stands, and what it means to the task.

    `transform` is a 4 × 4 affine matrix (world ← mesh). `color` multiplies the mesh's own colours.
    A `target` carries information for the task; every other object is a distractor, and an
    occluder wherever it lies in front of a target (Elmqvist2009 §III-A). An `impenetrable` object
    never turns transparent (§III-C.3). Objects with the same `group` are drawn, where no plane
    separates them, in their order in the scene, targets before others (§V-B, nested dolls); `None`
    makes the object its own group. `importance`, 0 to 1, is what a study says of it, for techniques
    that ask.
    """

    mesh: Mesh
    transform: NDArray[np.float64] = field(default_factory=_identity)
    color: Color = (1.0, 1.0, 1.0)
    target: bool = False
    impenetrable: bool = False
    group: int | None = None
    kind: str = ""
    importance: float = 0.0

    def __post_init__(self) -> None:
        if self.transform.shape != (4, 4):
            raise ValueError(f"transform has shape {self.transform.shape}, expected (4, 4)")
        if not np.isfinite(self.transform).all():
            raise ValueError(f"transform of {self.kind or 'object'} has a value that is not finite")


@dataclass(frozen=True, eq=False)
class Scene:
    """Objects in a fixed order: an object's index is its identity.

    Id pictures hold index + 1, and 0 where there is only background. `look` is how the picture
    looks besides; a scene that was given one (renderer/look/dressed.py) keeps the `bare` one that
    it is of. `rooms` are those that its walls make, where somebody knows of any.
    """

    objects: tuple[Object, ...]
    background: Color = (0.93, 0.94, 0.96)
    look: Look = PLAIN
    bare: Scene | None = None
    rooms: Rooms | None = None

    @cached_property
    def dresses(self) -> dict[Look, Scene]:
        """This scene with other looks, as they were asked for."""
        return {}

    @cached_property
    def transforms(self) -> NDArray[np.float64]:
        """(n, 4, 4) world ← mesh."""
        return np.array([o.transform for o in self.objects]).reshape(-1, 4, 4)

    @cached_property
    def targets(self) -> NDArray[np.bool_]:
        """(n,) which objects are targets."""
        return np.array([o.target for o in self.objects], dtype=bool)

    @cached_property
    def impenetrable(self) -> NDArray[np.bool_]:
        """(n,) which objects never turn transparent."""
        return np.array([o.impenetrable for o in self.objects], dtype=bool)

    @cached_property
    def centers(self) -> NDArray[np.float64]:
        """(n, 3) world positions of the mesh bounds' centres (the paper's sort key, §V-B)."""
        local = np.array([o.mesh.center for o in self.objects]).reshape(-1, 3)
        moved = np.einsum("nij,nj->ni", self.transforms[:, :3, :3], local)
        return moved + self.transforms[:, :3, 3]

    @cached_property
    def corners(self) -> NDArray[np.float64]:
        """(n, 8, 3) world corners of the mesh bounds; corner k is high in x if k & 4, y 2, z 1."""
        bounds = np.array([o.mesh.bounds for o in self.objects]).reshape(-1, 2, 3)
        local = bounds[:, CORNERS, np.arange(3)]
        moved = np.einsum("nij,nkj->nki", self.transforms[:, :3, :3], local)
        return moved + self.transforms[:, None, :3, 3]

    @cached_property
    def around(self) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """(p, 3) world points that hold each object between them (Mesh.around), and where each
        object's begin (n + 1,)."""
        from seethrough.renderer.scene.placing import all_moved

        firsts = np.unique(self.mesh_of, return_index=True)[1]
        local = [self.objects[k].mesh.around for k in firsts.tolist()]
        sizes = np.array([len(points) for points in local], np.int64)
        starts = np.cumsum(np.concatenate([np.zeros(1, np.int64), sizes[self.mesh_of]]))
        first = (np.cumsum(sizes) - sizes)[self.mesh_of]
        points = np.concatenate([np.zeros((0, 3)), *local])
        return all_moved(points, first, starts, self.transforms), starts

    @cached_property
    def group_of(self) -> NDArray[np.int64]:
        """(n,) number of each object's group, counted from 0 in the order of first appearance."""
        keys = [
            ("alone", i) if o.group is None else ("group", o.group)
            for i, o in enumerate(self.objects)
        ]
        numbers: dict[tuple[str, int], int] = {}
        return np.array([numbers.setdefault(k, len(numbers)) for k in keys], dtype=np.int64)

    @cached_property
    def settled(self) -> NDArray[np.bool_]:
        """(n, n) pairs of one group, whose order in the scene counts; not those of two targets."""
        both = self.targets & self.targets[:, None]
        return (self.group_of == self.group_of[:, None]) & ~both

    @cached_property
    def group_centers(self) -> NDArray[np.float64]:
        """(n, 3) centre of each object's group: of the box about its members' bounds (§V-B)."""
        count = int(self.group_of.max(initial=-1)) + 1
        low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
        np.minimum.at(low, self.group_of, self.corners.min(axis=1))
        np.maximum.at(high, self.group_of, self.corners.max(axis=1))
        alone = np.bincount(self.group_of, minlength=count)[self.group_of] == 1
        return np.where(alone[:, None], self.centers, ((low + high) / 2)[self.group_of])

    @cached_property
    def box_sides(self) -> NDArray[np.float64]:
        """(n, 3, 3) half the sides of each object's box, as world vectors in the rows."""
        bounds = np.array([o.mesh.bounds for o in self.objects]).reshape(-1, 2, 3)
        half = (bounds[:, 1] - bounds[:, 0]) / 2
        return np.swapaxes(self.transforms[:, :3, :3] * half[:, None, :], 1, 2).copy()

    @cached_property
    def radii(self) -> NDArray[np.float64]:
        """(n,) radius of the sphere about `centers` that holds each object, in world units."""
        own = np.array([o.mesh.radius for o in self.objects], dtype=float)
        stretch = np.linalg.svd(self.transforms[:, :3, :3], compute_uv=False)
        return own * stretch.max(axis=1, initial=0.0)

    @cached_property
    def target_hulls(self) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """(m, 3) world corners of the hulls of all targets' meshes, one target's after the other's,
        and where each target's begin (targets + 1,)."""
        things = [self.objects[t] for t in np.nonzero(self.targets)[0].tolist()]
        points = [t.mesh.hull @ t.transform[:3, :3].T + t.transform[:3, 3] for t in things]
        starts = np.cumsum([0, *(len(p) for p in points)])
        return np.concatenate([np.zeros((0, 3)), *points]), starts

    @cached_property
    def hulls(self) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
        """(m, 3) world corners of the hulls of all objects' meshes, thinned out, (e, 2) their edges
        as rows of the object's own, and where each object's begin in both (n + 1, 2)."""
        points = [o.mesh.thin_hull[0] @ o.transform[:3, :3].T + o.transform[:3, 3]
                  for o in self.objects]  # fmt: skip
        edges = [o.mesh.thin_hull[1] for o in self.objects]
        sizes = [(len(p), len(e)) for p, e in zip(points, edges, strict=True)]
        return (
            np.concatenate([np.zeros((0, 3)), *points]),
            np.concatenate([np.zeros((0, 2), np.int64), *edges]),
            np.cumsum([(0, 0), *sizes], axis=0),
        )

    @cached_property
    def triangle_counts(self) -> NDArray[np.int64]:
        """(n,) triangles of each object."""
        return np.array([len(o.mesh.triangles) for o in self.objects], dtype=np.int64)

    @cached_property
    def mesh_of(self) -> NDArray[np.int64]:
        """(n,) which mesh each object has, by number."""
        numbers: dict[int, int] = {}
        found = [numbers.setdefault(id(o.mesh), len(numbers)) for o in self.objects]
        return np.array(found, dtype=np.int64)

    @cached_property
    def convex(self) -> NDArray[np.bool_]:
        """(n,) which objects are known to be convex."""
        return np.array([o.mesh.convex for o in self.objects], dtype=bool)

    @cached_property
    def in_room(self) -> NDArray[np.bool_] | None:
        """(n, r) which of the rooms each object may be in; None: no walls stand about any."""
        if self.rooms is None or not self.rooms.stand(self.transforms):
            return None
        return self.rooms.holding(self.corners)

    @cached_property
    def separations(self) -> Separations:
        """Planes between objects, found as frames ask for them."""
        from seethrough.renderer.plan.separation import Separations

        n = len(self.objects)
        return Separations(np.eye(n, dtype=bool))
