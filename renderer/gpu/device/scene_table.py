"""A scene on the GPU: one row of a texture for each object, uploaded when the scene changes."""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device.meshes import GpuMesh, MeshPart, MeshStore
from seethrough.renderer.gpu.device.programs import Shader
from seethrough.renderer.gpu.device.reused import kept
from seethrough.renderer.look import floor
from seethrough.renderer.look.detail import DETAILS
from seethrough.renderer.look.shadows import floor_map
from seethrough.renderer.plan.coverage import Triangles, triangles
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene

Run = tuple[MeshPart, int, int]  # a mesh, its first row in the sequence, how many instances

SHADOWS = 15  # the texture unit of the floor's shadows: the last that every driver has
# Of one frame: the driver would have to wait for what is drawn from one before it is written again.
_SEQUENCES = 4


class SceneTable:
    """The objects of one scene, and the sequence in which a frame draws them."""

    def __init__(self, context: moderngl.Context, store: MeshStore, scene: Scene) -> None:
        self.scene, self.outlines = scene, store.outlines
        n = len(scene.objects)
        linear = scene.transforms[:, :3, :3]
        mirrored = np.linalg.det(linear) < 0
        slots: dict[int, int] = {}
        self.meshes: list[GpuMesh] = []
        self.slot = np.zeros(n, dtype=np.int64)
        for i, thing in enumerate(scene.objects):
            mesh = store.get(thing.mesh, bool(mirrored[i]))
            if id(mesh) not in slots:
                slots[id(mesh)] = len(self.meshes)
                self.meshes.append(mesh)
            self.slot[i] = slots[id(mesh)]
        sizes = [len(o.mesh.triangles) for o in scene.objects]
        self.first_triangle = np.cumsum([0, *sizes])
        rows = np.zeros((max(n, 1), 4, 4), dtype="f4")
        rows[:n, :3, :3] = linear
        rows[:n, 3, :3] = np.array([o.color for o in scene.objects]).reshape(n, 3)
        self.floors = floor.floors(tuple(o.kind for o in scene.objects))
        rows[:n, 3, 3] = self.floors
        self.table = _texture(context, (4, max(n, 1)))
        self.table.write(rows.tobytes())
        self._points: dict[tuple[int, ...], tuple[NDArray[np.float64], NDArray[np.int64]]] = {}
        self._shapes = np.zeros((len(self.meshes), 2), np.bool_)
        self._shaped = np.zeros(len(self.meshes), np.bool_)  # of which they have been asked for
        self._context = context
        self._sequences = [kept(_texture(context, (2, max(n, 1)))) for _ in range(_SEQUENCES)]

    @cached_property
    def inverse(self) -> NDArray[np.float64]:
        """(n, 3, 3) mesh ← world, but for where objects stand."""
        return np.asarray(np.linalg.inv(self.scene.transforms[:, :3, :3]), np.float64)

    def set_look(self, shader: Shader, camera: Camera, height: int) -> None:
        """Tell a shader what it has to know for the scene's look, in a picture so high."""
        if "eye" in shader.members:
            x, y, z = camera.eye.tolist()
            shader.set(eye=(x, y, z), pixel=camera.pixel(height))
        if "shadows" in shader.members:
            picture, place = self._shadows
            picture.use(SHADOWS)
            shader.set(shadows=SHADOWS, shadows_place=place)

    @cached_property
    def _shadows(self) -> tuple[moderngl.TextureArray, tuple[float, ...]]:
        """The map of the floor's shadows in strips, and where it lies (renderer/look/floor.py)."""
        found = floor_map(self.scene)
        high, wide = found.light.shape
        count, step = -(-wide // (floor.STRIP - 1)) + 1, floor.STRIP - 1
        light = np.pad(found.light, ((0, 0), (1, step * count + 1 - wide)), mode="edge")
        strips = np.stack([light[:, k * step : (k + 1) * step + 1] for k in range(count)])
        # Whole numbers: 16-bit floats are coarser here, and take a software rasteriser longer.
        texels = np.round(65535 * strips.clip(0, 1)).astype("u2").tobytes()
        picture = self._context.texture_array(
            (floor.STRIP, high, count), 1, texels, alignment=1, dtype="nu2"
        )
        picture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        picture.repeat_x = picture.repeat_y = False
        (x, z), (width, depth) = found.corner, found.size
        return picture, (x - width / wide / 2, z, wide / width, 1 / depth)

    @cached_property
    def floor_meshes(self) -> frozenset[int]:
        """The ids of the meshes that floors have."""
        return frozenset(id(self.meshes[slot]) for slot in self.slot[self.floors].tolist())

    @cached_property
    def flat_floors(self) -> bool:
        """Whether each triangle of the meshes that floors have has one normal and one colour."""
        for slot in set(self.slot[self.floors].tolist()):
            mesh = self.meshes[slot].mesh
            for values in (mesh.normals[mesh.triangles], mesh.colors[mesh.triangles]):
                if (values != values[:, :1]).any():
                    return False
        return True

    @cached_property
    def triangles(self) -> Triangles:
        """All triangles of the scene."""
        return triangles(self.scene)

    def points(self, objects: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """(p, 3) the points of the objects' meshes, and which rows are each object's (k, 2)."""
        slots = self.slot[objects]
        key = tuple(np.unique(slots).tolist())
        if key not in self._points:
            parts = [self.meshes[slot].topology.points for slot in key]
            ends = np.cumsum([0, *(len(p) for p in parts)])
            rows = np.zeros((len(self.meshes), 2), np.int64)
            rows[list(key)] = np.stack([ends[:-1], ends[1:]], axis=1)
            self._points[key] = np.concatenate([*parts, np.zeros((0, 3))]), rows
        points, rows = self._points[key]
        return points, rows[slots]

    def shapes(self, objects: NDArray[np.int64]) -> NDArray[np.bool_]:
        """(k, 2) which objects' meshes are convex, and which are closed."""
        slots = self.slot[objects]
        if not self._shaped[slots].all():
            for slot in set(slots[~self._shaped[slots]].tolist()):
                mesh = self.meshes[slot]
                self._shapes[slot] = mesh.mesh.convex, mesh.topology.closed
                self._shaped[slot] = True
        return self._shapes[slots]

    def turned(
        self, objects: NDArray[np.int64], camera: Camera
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Turns (k, 3, 3) and moves (k, 3) of objects: camera ← mesh."""
        matrix = self.scene.transforms[objects]
        turns = camera.rotation.T @ matrix[:, :3, :3]
        return turns, (matrix[:, :3, 3] - camera.eye) @ camera.rotation

    def poses(
        self, objects: NDArray[np.int64], camera: Camera
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Turns (k, 3, 3) and moves (k, 3) of objects: camera ← mesh about its centre."""
        turns = camera.rotation.T @ self.scene.transforms[objects, :3, :3]
        return turns, (self.scene.centers[objects] - camera.eye) @ camera.rotation

    def sequence(
        self,
        parts: list[NDArray[np.int64]],
        camera: Camera,
        numbers: list[NDArray[np.float64]] | None = None,
        slope: float = 0.0,
    ) -> tuple[moderngl.Texture, list[list[Run]]]:
        """Upload the objects of all `parts`, and say which instanced draws make up each part.

        Objects of one part are put together by mesh. `numbers` has for each part a number to go
        with every object of the scene (n,). Models may be off by a `slope` of their distance, as
        levels of detail are; 0: all are whole. The texture holds them until as many sequences as
        there are textures were made after it.
        """
        number = np.repeat(np.arange(len(parts)), [len(p) for p in parts])
        objects = np.concatenate([*parts, np.zeros(0, np.int64)])
        level = self._level(objects, camera, slope)
        by_mesh = np.lexsort((objects, level, self.slot[objects], number))
        objects, number, level = objects[by_mesh], number[by_mesh], level[by_mesh]
        extra = np.zeros(len(objects))
        for k, values in enumerate(numbers or []):
            extra[number == k] = values[objects[number == k]]
        sequence = self._upload(objects, camera, extra)
        slots = self.slot[objects]
        another = (number[1:] != number[:-1]) | (slots[1:] != slots[:-1])
        another |= level[1:] != level[:-1]
        cuts = [0, *(np.nonzero(another)[0] + 1).tolist(), len(objects)]
        runs: list[list[Run]] = [[] for _ in parts]
        for a, b in pairwise(cuts if len(objects) else []):
            mesh: MeshPart = self.meshes[slots[a]]
            if level[a]:
                mesh = self.meshes[slots[a]].details[0][level[a] - 1]
            runs[number[a]].append((mesh, a, b - a))
        return sequence, runs

    def _level(self, objects: NDArray[np.int64], camera: Camera, slope: float) -> NDArray[np.int64]:
        """(k,) in which level of detail to draw each object, 0 for whole: the coarsest that is off
        by no more than a slope of its distance wherever the object is nearest."""
        if slope <= 0 or not len(objects):
            return np.zeros(len(objects), np.int64)
        away = self.scene.centers[objects] - camera.eye
        depth = away @ camera.forward
        near = depth - self.scene.radii[objects]
        # What lies aside shows larger than at its depth, by the slope of the ray to it.
        aside = np.linalg.norm(away, axis=1) / np.maximum(depth, camera.near)
        most = slope * near / aside
        most[near <= camera.near] = 0.0
        found: NDArray[np.int64] = (self._errors[objects] <= most[:, None]).sum(axis=1)
        return found

    @cached_property
    def _errors(self) -> NDArray[np.float64]:
        """(n, levels) how far each object's levels are off, in world units; infinite for none."""
        errors = np.full((len(self.meshes), DETAILS), np.inf)
        for row, mesh in zip(errors, self.meshes, strict=True):
            row[: len(mesh.details[1])] = mesh.details[1]
        own = np.array([o.mesh.radius for o in self.scene.objects])
        stretch: NDArray[np.float64] = self.scene.radii / own
        return errors[self.slot] * stretch[:, None]

    def _upload(
        self, objects: NDArray[np.int64], camera: Camera, extra: NDArray[np.float64]
    ) -> moderngl.Texture:
        texture = self._sequences.pop(0)
        if len(objects) > texture.height:
            texture.release()
            texture = kept(_texture(self._context, (2, 2 * len(objects))))
        self._sequences.append(texture)
        rows = np.zeros((len(objects), 2, 4), dtype="f4")
        rows[:, 0, :3] = self.scene.centers[objects] - camera.eye
        rows[:, 0, 3] = objects
        rows[:, 1, 0] = extra
        if len(objects):
            texture.write(rows.tobytes(), viewport=(0, 0, 2, len(objects)))
        return texture

    def release(self) -> None:
        """Give the GPU's memory back."""
        self.table.release()
        if "_shadows" in self.__dict__:
            self._shadows[0].release()
        for texture in self._sequences:
            texture.release()


def _texture(context: moderngl.Context, size: tuple[int, int]) -> moderngl.Texture:
    texture = context.texture(size, 4, dtype="f4")
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    return texture
