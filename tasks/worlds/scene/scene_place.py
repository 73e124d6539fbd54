"""A scene of a file as a place: what stands in it, tagged, in metres and with y up."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.models import shipped
from seethrough.renderer.models.scene_file import SceneFile, Standpoint, Thing, read_scene
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import rotation_x
from seethrough.tasks.kit.tags import tagged
from seethrough.tasks.worlds.scene.kept_scene import unpacked
from seethrough.tasks.worlds.scene.scene_parameters import SceneParameters, is_shipped

NEAR = 0.002  # of the scene's radius, where a camera of the file stands
LEAST, MOST = 1e-6, 1e9  # m, of a scene's radius: beyond, a card's 32 bits hold no place in it
PLACES_KEPT = 16


@dataclass(frozen=True, eq=False)
class ScenePlace:
    """A scene, what participants call its things (`labels`), and where one may stand.

    An orbit is about the origin; `radius` reaches from there over everything. `cameras` are the
    file's, by name; `start` is the one to begin at, "" for none; `notes` say what is not shown as
    it is in the file.
    """

    scene: Scene
    file: str
    names: tuple[str, ...]
    labels: tuple[str, ...]
    cameras: Mapping[str, Camera]
    radius: float
    start: str = ""
    notes: tuple[str, ...] = ()

    @property
    def targets(self) -> NDArray[np.int64]:
        """Indices of what may be asked for."""
        found: NDArray[np.int64] = np.nonzero(self.scene.targets)[0]
        return found

    def alike(self, thing: int) -> tuple[int, ...]:
        """The things that participants call as they do this one, which is among them."""
        return tuple(i for i, label in enumerate(self.labels) if label == self.labels[thing])


def path_of(p: SceneParameters, file: str) -> Path:
    """Where a scene's file is."""
    if is_shipped(file):
        return Path(shipped.__file__).parent / f"{file}.glb"
    return Path(p.folder) / file


def kept_name(p: SceneParameters, file: str) -> str:
    """What a data folder calls a scene: named by what it was made of."""
    made = f"scene {p.sha256[p.files.index(file)]} {p.detail} {p.reader}"
    return f"{hashlib.sha256(made.encode()).hexdigest()[:24]}.npz"


def read(p: SceneParameters, file: str) -> SceneFile:
    """What a scene's file holds, or what a data folder kept of it.

    Raises ValueError of one line that names the file, also for one that is another now than the
    study began with; OSError.
    """
    if p.sha256 and p.folder and (kept := Path(p.folder) / kept_name(p, file)).is_file():
        return _unpacked(kept)
    path = path_of(p, file)
    about = path.stat() if path.is_file() else None
    found = _read(path, p.detail, (about.st_mtime_ns, about.st_size) if about else ())
    if p.sha256 and p.sha256[p.files.index(file)] != found.digest:
        raise ValueError(f"{path}: is another file now than the study began with")
    return found


@cache
def _read(path: Path, detail: int, state: tuple[int, ...]) -> SceneFile:
    """Kept for as long as the file stays as it is."""
    return read_scene(path, detail)


@cache
def _unpacked(path: Path) -> SceneFile:
    return unpacked(path)


@lru_cache(maxsize=PLACES_KEPT)
def opened(p: SceneParameters, file: str) -> ScenePlace:
    """A file's scene as the study has it. Raises ValueError as `read` does, and for tags that there
    cannot be; OSError."""
    found = read(p, file)
    whole = _metres(p)
    tags = [tagged(t.name, t.extras, p.tags) for t in found.things]
    groups = {
        name: k for k, name in enumerate(dict.fromkeys(str(t.get("group", "")) for t in tags))
    }
    things = tuple(
        _thing(thing, whole, own, groups) for thing, own in zip(found.things, tags, strict=True)
    )
    scene = Scene(things)
    middle = _middle(p, found, scene, whole) if p.move == "orbit" else np.zeros(3)
    moved = np.eye(4)
    moved[:3, 3] = -middle
    scene = Scene(tuple(_moved(thing, moved) for thing in things))
    reach = np.linalg.norm(scene.centers, axis=1) + scene.radii
    radius = float(reach.max())
    if not LEAST <= radius <= MOST:
        raise ValueError(
            f"{2 * radius:.3g} m large: expected from {LEAST:g} to {MOST:g} m; is `unit` right?"
        )
    cameras = {s.name: _camera(s, moved @ whole, p.unit, radius) for s in found.standpoints}
    names = tuple(thing.name for thing in found.things)
    labels = tuple(str(own.get("label") or n) for own, n in zip(tags, names, strict=True))
    return ScenePlace(scene, file, names, labels, cameras, radius, p.start, found.notes)


def _metres(p: SceneParameters) -> NDArray[np.float64]:
    """(4, 4) world ← file."""
    turn = rotation_x(-np.pi / 2) if p.up == "z" else np.eye(4)
    return turn @ np.diag([p.unit, p.unit, p.unit, 1.0])


def _thing(
    thing: Thing, whole: NDArray[np.float64], tags: Mapping[str, object], groups: Mapping[str, int]
) -> Object:
    wall, group = bool(tags.get("wall")), str(tags.get("group", ""))
    importance = tags.get("importance", 0.0)
    assert isinstance(importance, float | int)
    return Object(
        thing.mesh,
        whole @ thing.transform,
        target=bool(tags.get("target")) and not tags.get("occluder"),
        impenetrable=bool(tags.get("impenetrable")),
        group=groups[group] if group else None,
        kind=str(tags.get("kind") or ("wall" if wall else thing.name)),
        importance=float(importance),
    )


def _moved(thing: Object, by: NDArray[np.float64]) -> Object:
    return Object(
        thing.mesh, by @ thing.transform, thing.color, thing.target, thing.impenetrable,
        thing.group, thing.kind, thing.importance,
    )  # fmt: skip


def _middle(
    p: SceneParameters, found: SceneFile, scene: Scene, whole: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(3,) what an orbit is about. Raises ValueError where not one thing has that name."""
    if not p.about:
        corners = scene.corners.reshape(-1, 3)
        middle: NDArray[np.float64] = (corners.min(axis=0) + corners.max(axis=0)) / 2
        return middle
    if p.about in found.spots:
        at: NDArray[np.float64] = whole[:3, :3] @ found.spots[p.about]
        return at
    names = [thing.name for thing in found.things]
    if p.about not in names:
        raise ValueError(f"about = {p.about[:40]!r}: nothing in it has that name")
    if names.count(p.about) > 1:
        raise ValueError(f"about = {p.about[:40]!r}: {names.count(p.about)} things have that name")
    center: NDArray[np.float64] = scene.centers[names.index(p.about)]
    return center


def _camera(stand: Standpoint, whole: NDArray[np.float64], unit: float, radius: float) -> Camera:
    place = whole @ stand.transform
    eye = place[:3, 3]
    far = float(np.linalg.norm(eye)) + 2 * radius
    return Camera(eye, place[:3, :3] / unit, stand.fov_y, NEAR * radius, far)
