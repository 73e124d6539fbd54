"""Visibility tables: what can be seen from a lattice of viewpoints, so that nothing is drawn twice.

A table belongs to one scene drawn with one technique. A look is answered for the nearest viewpoint
of the lattice: exact where the participant stands on it, sampled elsewhere. A viewpoint that no
table holds yet is drawn once, at the lattice's own pose, so that a table's content does not depend
on who came first.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from math import asin, atan2, floor, inf, pi
from pathlib import Path
from typing import Any, BinaryIO
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from experiment.errors import InputError
from experiment.participants.count_red import TILT
from experiment.participants.name_letter import FROM_ABOVE
from experiment.participants.places import AHEAD, CELL, DIRECTIONS, STRIDES
from experiment.participants.sight import Kept, shown
from renderer.camera import Camera
from renderer.scene import Scene
from renderer.visibility import Visibility
from tasks.controls import turned

YAWS = 12  # of the orbit's lattice: every 30°
PITCHES = (-1.25, -0.8, -TILT, 0.0, TILT, 0.8, FROM_ABOVE)

MOST_WHOLE = 1024  # looks of a table kept with what was made of them: some 2 KB each

Key = tuple[int, ...]
Draw = Callable[[Scene, Camera], Visibility]


def orbit_key(camera: Camera) -> Key:
    """The nearest lattice viewpoint of an orbit: number of its yaw, number of its pitch."""
    r = camera.rotation
    yaw = atan2(-r[2, 0], r[0, 0])
    pitch = asin(min(1.0, max(-1.0, r[1, 2])))
    nearest = min(range(len(PITCHES)), key=lambda k: abs(PITCHES[k] - pitch))
    return (round(yaw / (2 * pi / YAWS)) % YAWS, nearest)


def orbit_camera(camera: Camera, key: Key) -> Camera:
    """The lattice's camera at `key`, at the distance and with the lens of `camera`."""
    rotation = turned(key[0] * 2 * pi / YAWS, -PITCHES[key[1]])
    distance = float(np.linalg.norm(camera.eye))
    return Camera(rotation[:, 2] * distance, rotation, camera.fov_y, camera.near, camera.far)


def views_of(task: str, camera: Camera) -> list[Camera]:
    """The lattice viewpoints that the abstract tasks are looked at from."""
    heights = (-TILT, TILT) if task == "count" else (FROM_ABOVE,)
    keys = [(yaw, PITCHES.index(h)) for h in heights for yaw in range(YAWS)]
    return [camera, *(orbit_camera(camera, key) for key in keys)]


def walk_key(camera: Camera) -> Key:
    """The nearest lattice viewpoint of a walk: cell in x, cell in z, heading.

    Headings from 8 on are passed on the way to the next cell: 8 and more after the first of the
    equal parts that a step in that heading is walked in (`STRIDES`), 16 and more after the second.
    """
    yaw = atan2(-camera.rotation.item(2, 0), camera.rotation.item(0, 0))
    heading = round(yaw / (2 * pi / DIRECTIONS)) % DIRECTIONS
    across, along = AHEAD[heading]
    x, _, z = camera.eye.tolist()
    x, z = x / CELL, z / CELL
    key, nearest = (0, 0, 0), inf
    for part in range(STRIDES[heading]):
        share = part / STRIDES[heading]
        i, j = floor(x - share * across), floor(z - share * along)
        way = abs(i + 0.5 + share * across - x) + abs(j + 0.5 + share * along - z)
        if way < nearest:
            key, nearest = (i, j, heading + part * DIRECTIONS), way
    return key


def walk_camera(camera: Camera, key: Key) -> Camera:
    """The lattice's camera at `key`, at the height and with the lens of `camera`."""
    part, heading = divmod(key[2], DIRECTIONS)
    across, along = AHEAD[heading]
    share = part / STRIDES[heading]
    x, z = key[0] + 0.5 + share * across, key[1] + 0.5 + share * along
    eye = np.array([x * CELL, camera.eye[1], z * CELL])
    rotation = turned(heading * 2 * pi / DIRECTIONS)
    return Camera(eye, rotation, camera.fov_y, camera.near, camera.far)


@dataclass(eq=False)
class Table:
    """What can be seen of one scene: rows of its visible objects for each viewpoint."""

    objects: int
    rows: dict[Key, NDArray[np.float64]] = field(default_factory=dict)
    fresh: list[Key] = field(default_factory=list)  # looks kept since somebody last asked
    _whole: dict[Key, Kept] = field(default_factory=dict)  # looks that were wanted lately

    def put(self, key: Key, seen: Visibility) -> None:
        """Keep a look: what `shown` gives of it."""
        self.rows[key] = shown(seen)
        self.fresh.append(key)

    def get(self, key: Key) -> Visibility:
        """The look as it was kept, the same to the last bit."""
        seen = self._whole.get(key)
        if seen is None:
            if len(self._whole) >= MOST_WHOLE:
                self._whole.clear()
            seen = self._whole[key] = Kept(self.objects, self.rows[key])
        return seen


class TableEyes:
    """Looks up, or draws and keeps, what is seen in a scene. Raises KeyError if it can't draw."""

    def __init__(self, table: Table, scenario: str, draw: Draw | None = None) -> None:
        self.table = table
        self.draw = draw
        orbits = scenario == "abstract"
        self._key = orbit_key if orbits else walk_key
        self._camera = orbit_camera if orbits else walk_camera

    def look(self, scene: Scene, camera: Camera) -> Visibility:
        """What is visible from the lattice viewpoint nearest to `camera`."""
        key = self._key(camera)
        if key not in self.table.rows:
            if self.draw is None:
                raise KeyError(f"viewpoint {key} is in no table and nothing can be drawn")
            self.table.put(key, self.draw(scene, self._camera(camera, key)))
        return self.table.get(key)


def save(path: Path, tables: dict[str, Table]) -> None:
    """Write tables by name; a file that is there is replaced as a whole."""
    arrays: dict[str, NDArray[np.generic]] = {}
    for name, table in tables.items():
        keys = sorted(table.rows)
        widths = [table.rows[k].shape[1] for k in keys]
        arrays[f"{name}/keys"] = np.array(keys, dtype=np.int32)
        arrays[f"{name}/widths"] = np.array([table.objects, *widths], dtype=np.int32)
        arrays[f"{name}/rows"] = (
            np.concatenate([table.rows[k] for k in keys], axis=1) if keys else np.zeros((7, 0))
        )
    draft = path.with_name(f".{path.name}.{os.getpid()}.npz")  # two runs may save at once
    try:
        with open(draft, "wb") as file:
            np.savez(file, **arrays)
            file.flush()
            os.fsync(file.fileno())
        draft.replace(path)
    finally:
        draft.unlink(missing_ok=True)


def load(path: Path | BinaryIO) -> dict[str, Table]:
    """Tables by name. Raises InputError for a file that holds something else."""
    try:
        # Opened here: NumPy leaves a file open that turns out to be no archive.
        with open(path, "rb") if isinstance(path, Path) else path as source:
            with np.load(source) as file:
                return _tables(file)
    except (OSError, ValueError, LookupError, TypeError, EOFError, BadZipFile) as error:
        reason = getattr(error, "strerror", None) or "it is none, or not whole"
        raise InputError(f"{path}: expected a file of visibility tables: {reason}") from None


def _tables(file: Any) -> dict[str, Table]:
    tables: dict[str, Table] = {}
    for entry in file.files:
        name, _, part = entry.rpartition("/")
        if part not in ("keys", "widths", "rows"):
            raise ValueError(f"{entry}: expected keys, widths and rows")
        if part != "keys":
            continue
        widths = file[f"{name}/widths"]
        rows, ends = file[f"{name}/rows"], np.cumsum(widths[1:])
        if rows.shape != (7, int(widths[1:].sum())):
            raise ValueError(f"{name}: expected 7 rows of visibility")
        starts = ends - widths[1:]
        keys = [tuple(k) for k in file[entry].tolist()]
        tables[name] = Table(
            int(widths[0]), {k: rows[:, a:b] for k, a, b in zip(keys, starts, ends, strict=True)}
        )
    return tables
