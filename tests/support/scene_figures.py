"""Figures of each scene that is the same in every study: the gallery's plates, and what orderings
of translucent polygons are measured on.

`python tests/support/scene_figures.py` writes them anew (tests/data/models/scenes.json), where a
scene is changed on purpose, in a commit of its own.
"""

from __future__ import annotations

import json
from dataclasses import asdict, is_dataclass
from pathlib import Path

import numpy as np

from seethrough.experiment.gallery.gallery_plates import DYNAMIC
from seethrough.experiment.gallery.gallery_scenes import sections
from seethrough.renderer.models.translucent.scenes import SCENES

FIGURES = Path(__file__).resolve().parents[1] / "data" / "models" / "scenes.json"
ORDERED = [
    name for name in SCENES if name not in ("soup10000", "soup100000")
]  # as soup1000, larger


def moments(rows):
    """Sums of the columns of (n, k) numbers, plain, squared and by their place in the list: any
    number that changes changes one of them, and so does one that moves to another row."""
    rows = np.asarray(rows, float).reshape(len(rows), -1)
    place = np.linspace(0.5, 1.5, len(rows))[:, None]
    return [s.sum(axis=0).tolist() for s in (rows, rows**2, rows * place)]


def polygons(made):
    """Of one set of polygons."""
    if made is None:
        return None
    return {
        "count": len(made),
        "corners": np.bincount(made.counts).tolist(),
        "vertices": moments(made.vertices),
        "attributes": moments(made.attributes),
        "objects": np.bincount(made.objects).tolist(),
    }


def translucent(made):
    """Of a scene to be ordered."""
    return {
        "closed": made.closed,
        "polygons": polygons(made.polygons),
        "opaque": polygons(made.opaque),
        "texture": None if made.texture is None else moments(made.texture.reshape(-1, 4)),
    }


def plate(shown):
    """Of one of the gallery's pictures."""
    objects, camera, technique = shown.scene.objects, shown.camera, shown.technique
    used = asdict(technique) if is_dataclass(technique) else {}
    look = {k: getattr(shown.scene.look, k) for k in shown.scene.look.on}
    return {
        "caption": shown.caption,
        "size": list(shown.size),
        "camera": [*camera.eye, *camera.rotation.ravel(), camera.fov_y, camera.near, camera.far],
        "technique": {k: str(v) for k, v in used.items() if v != getattr(DYNAMIC, k, None)},
        "transforms": moments([o.transform for o in objects]),
        "colors": moments([o.color for o in objects]),
        "targets": np.flatnonzero(shown.scene.targets).tolist(),
        "impenetrable": np.flatnonzero(shown.scene.impenetrable).tolist(),
        "groups": np.bincount(np.bincount(shown.scene.group_of)).tolist(),
        "meshes": moments([[len(o.mesh.triangles), o.mesh.radius, *o.mesh.bounds.ravel()]
                           for o in objects]),
        **({"look": look} if look else {}),
    }  # fmt: skip


def everything():
    """{name: figures} of all of them."""
    made = {f"ordered {name}": translucent(SCENES[name]()) for name in ORDERED}
    for section in sections(4 / 3):
        if not section.small:  # those are the first of their technique, one value changed
            made |= {f"gallery {p.name}": plate(p) for p in section.plates}
        made[f"section {section.title}"] = [section.about, *map(list, section.refused)]
    return made


def _rounded(value):
    if isinstance(value, float):
        return float(f"{value:.9g}")
    if isinstance(value, list):
        return [_rounded(v) for v in value]
    return {k: _rounded(v) for k, v in value.items()} if isinstance(value, dict) else value


if __name__ == "__main__":
    rows = [f"{json.dumps(k)}: {json.dumps(_rounded(v))}" for k, v in everything().items()]
    FIGURES.write_text("{\n" + ",\n".join(rows) + "\n}\n", encoding="utf-8")
