"""A scene as a data folder keeps it: what was read of a file, as arrays, so that a replay shows the
same whatever becomes of the file and of its reader."""

from __future__ import annotations

import io
import json
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from seethrough.renderer.models.scene_file import SceneFile, Standpoint, Thing
from seethrough.renderer.scene.geometry import Mesh

ARRAYS = ("vertices", "normals", "colors", "triangles")


def packed(found: SceneFile) -> bytes:
    """The scene as a file of NumPy's: each mesh once, and a table of things as JSON."""
    meshes = list({id(t.mesh): t.mesh for t in found.things}.values())
    number = {id(mesh): i for i, mesh in enumerate(meshes)}
    arrays = {f"{i} {a}": getattr(mesh, a) for i, mesh in enumerate(meshes) for a in ARRAYS}
    about = {
        "things": [(t.name, number[id(t.mesh)], dict(t.extras)) for t in found.things],
        "cameras": [(s.name, s.fov_y) for s in found.standpoints],
        "spots": {name: list(map(float, at)) for name, at in found.spots.items()},
        "digest": found.digest,
    }
    places = np.array([t.transform for t in found.things]).reshape(-1, 4, 4)
    stands = np.array([s.transform for s in found.standpoints]).reshape(-1, 4, 4)
    text = np.frombuffer(json.dumps(about).encode(), np.uint8)
    file = io.BytesIO()
    np.savez_compressed(file, about=text, places=places, stands=stands, **arrays)
    return file.getvalue()


def unpacked(path: Path) -> SceneFile:
    """The scene that was packed. Raises ValueError, OSError."""
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as arrays:
            about = json.loads(bytes(arrays["about"]))
            count = sum(name.endswith(" triangles") for name in arrays.files)
            meshes = [Mesh(*(arrays[f"{i} {a}"] for a in ARRAYS)) for i in range(count)]
            things = tuple(
                Thing(name, meshes[mesh], place, extras)
                for (name, mesh, extras), place in zip(
                    about["things"], arrays["places"], strict=True
                )
            )
            stands = tuple(
                Standpoint(name, place, fov_y)
                for (name, fov_y), place in zip(about["cameras"], arrays["stands"], strict=True)
            )
            spots = {name: np.array(at) for name, at in about["spots"].items()}
            total = sum(len(t.mesh.triangles) for t in things)
            return SceneFile(things, stands, spots, total, (), about["digest"])
    except (ValueError, KeyError, TypeError, IndexError, EOFError, BadZipFile) as error:
        raise ValueError(f"{path}: not a kept scene: {' '.join(str(error).split())}") from None
