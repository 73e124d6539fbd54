"""Figures of what becomes of each kind of model file: `python tests/support/read_figures.py` writes
them anew (tests/data/models/read.json).

That a model looks as it was made is tested by rays (tests/images/test_model_files.py). How many
triangles that takes, and how close it comes with few, is what these figures hold.
"""

from __future__ import annotations

import json
import tempfile
from dataclasses import asdict
from pathlib import Path

import model_cases
import model_cases_gltf
from model_figures import figures

from seethrough.renderer.models.user import read_model

FIGURES = Path(__file__).resolve().parents[1] / "data" / "models" / "read.json"
DETAIL = 1500  # triangles: too few for most of the pictures
CASES = {case.name: case for case in model_cases.CASES + model_cases_gltf.CASES}


def read(case, folder):
    """The mesh that a file becomes, in figures, and what is said of it."""
    for name, data in {case.name: case.data, **case.beside}.items():
        (folder / name).write_bytes(data)
    mesh, facts = read_model(folder / case.name, detail=DETAIL, **case.options)
    said = asdict(facts)
    del said["digest"]  # of the file alone
    return {"mesh": figures(mesh), "facts": json.loads(json.dumps(said))}


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as at:
        rows = [f"{json.dumps(n)}: {json.dumps(read(c, Path(at)))}" for n, c in CASES.items()]
    FIGURES.write_text("{\n" + ",\n".join(rows) + "\n}\n", encoding="utf-8")
