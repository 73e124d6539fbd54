"""Models of many kinds against pictures of their own, cast from what they were made of."""

from __future__ import annotations

import model_cases
import model_cases_gltf
import numpy as np
import pytest
from model_reference import DIRECTIONS, cast, cast_mesh, standing

from seethrough.experiment.study.checked.contact_sheet import _sides
from seethrough.renderer.models.user import read_model

CASES = model_cases.CASES + model_cases_gltf.CASES
# Colours of 8 bits, and single precision: half a step of 255 each, doubled by sRGB where it is
# steepest for light of 8 bits.
PLAIN = 3 / 255
# What a picture may be off by in the mean, in steps of 255: looked up at the corners of the cube
# alone these are off by 70 to 90.
MEAN = 10.0
# Our rays meet a thousand places, the measure all: their means differ by chance. JPEG is off by 1.
CHANCE, CODED = 1.4, 1.0
DETAIL = 20_000


def write(folder, case):
    """The path of the case's file, with those beside it."""
    for name, data in {case.name: case.data, **case.beside}.items():
        (folder / name).write_bytes(data)
    return folder / case.name


def test_there_are_enough_kinds():
    names = [(case.name.rsplit(".", 1)[1], case.name) for case in CASES]
    assert len(set(names)) == len(names) >= 60
    assert len({case.data for case in CASES}) >= 58


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_a_model_looks_as_it_was_made(tmp_path, case):
    mesh, facts = read_model(write(tmp_path, case), detail=DETAIL, **case.options)
    gltf = case.name.endswith(("glb", "gltf"))
    loops = standing(case.faces, up=case.options.get("up", "y"), turned=gltf)
    said = f"{_sides(facts)} {facts.colors} {facts.notes}"
    assert case.says in said
    textured = any(face.picture is not None for face in case.faces)
    for direction in DIRECTIONS[: 2 if textured else 4]:
        right, ours = cast(case.faces, loops, direction), cast_mesh(mesh, direction)
        there, here = np.isfinite(right[:, 0]), np.isfinite(ours[:, 0])
        assert there.sum() > 50
        # Where alpha cuts a hole, its border is that of texels, cut straight: a ray there meets
        # the model in one picture and not in the other, or another texel's colour.
        border = 12 if "mask" in case.name else 0
        assert (there != here).sum() <= border
        off = np.abs(right - ours)[there & here].max(axis=1)
        if textured:
            assert 255 * off.mean() < CHANCE * facts.carried.mean + CODED
            assert facts.carried.mean < MEAN
            # 1 % was said of all sides, and a view meets three of them at a thousand places.
            beyond = (255 * off > facts.carried.most + CODED).sum()
            assert beyond <= 0.03 * len(off) + border
        else:
            assert off.max() < PLAIN
