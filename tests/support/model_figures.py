"""Figures of each shipped model: `python tests/support/model_figures.py` writes them anew.

What participants see must not change unnoticed: a model is changed on purpose, in a commit of its
own, which writes these figures (tests/data/models/figures.json) with it.
"""

import json
from pathlib import Path

import numpy as np

from seethrough.renderer.models import MODELS
from seethrough.renderer.models.vehicles.jeep import jeep

FIGURES = Path(__file__).resolve().parents[1] / "data" / "models" / "figures.json"


def shipped():
    """{name: mesh} of the models, and of the jeep's parts."""
    parts = {f"jeep {number} {name}": mesh for number, (name, mesh) in enumerate(jeep())}
    return {name: make() for name, make in MODELS.items()} | parts


def figures(mesh):
    """Triangles, bounds, surface, the volume it encloses, its moments and its colour: a change of
    any vertex or colour changes one of them."""
    corners = mesh.vertices[mesh.triangles]
    a, b, c = np.moveaxis(corners, 1, 0)
    cross = np.cross(b - a, c - a)
    area = np.linalg.norm(cross, axis=1) / 2
    middle = corners.mean(axis=1)
    tint = mesh.colors[mesh.triangles].mean(axis=1)
    return {
        "triangles": len(mesh.triangles),
        "bounds": mesh.bounds.ravel().tolist(),
        "area": float(area.sum()),
        "volume": float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6),
        "center": (area @ middle).tolist(),
        "spread": (area @ middle**2).tolist(),
        "color": (area @ tint).tolist(),
        "normal": (area @ mesh.normals[mesh.triangles].mean(axis=1) ** 2).tolist(),
    }


if __name__ == "__main__":
    made = {name: figures(mesh) for name, mesh in sorted(shipped().items())}
    FIGURES.write_text(json.dumps(made, indent=1) + "\n", encoding="utf-8")
