"""The same seed gives the same scene on every machine: hashes of coordinates rounded to 1e-6."""

import hashlib

import numpy as np
import pytest

from seethrough.renderer.scene import geometry
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import abstract_scene
from seethrough.tasks.worlds.building.building import count_building, unique_building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

# Meshes of this test alone: the models that ship may grow without these scenes changing.
_MESHES = {
    "ball": geometry.sphere(0.8),
    "block": geometry.box(1, 1.5, 2),
    "cone": geometry.cone(0.5, 1.5),
    "drum": geometry.cylinder(0.7, 1),
}
MODELS = {name: (lambda mesh=mesh: mesh) for name, mesh in _MESHES.items()}


def stream(*key):
    return np.random.default_rng(np.random.SeedSequence(2026, spawn_key=key))


def fingerprint(scene):
    """SHA-256 of every object's kind, flags, colour and world vertices, rounded to 1e-6."""
    digest = hashlib.sha256()
    for thing in scene.objects:
        digest.update(f"{thing.kind},{thing.target},{thing.impenetrable};".encode())
        vertices = thing.mesh.vertices @ thing.transform[:3, :3].T + thing.transform[:3, 3]
        for numbers in (vertices, np.array(thing.color)):
            # + 0 turns −0 into 0; integers have one representation, little-endian here.
            digest.update((np.round(numbers * 1e6) + 0).astype("<i8").tobytes())
        digest.update(thing.mesh.triangles.astype("<i4").tobytes())
    return digest.hexdigest()[:16]


SCENES = {
    "count": lambda: abstract_scene(stream(1), AbstractParameters()),
    "pattern K": lambda: abstract_scene(stream(2), AbstractParameters(), "K"),
    "unique": lambda: unique_building(stream(3), BuildingParameters(), MODELS).scene,
    "count in building": lambda: count_building(stream(4), BuildingParameters(), MODELS).scene,
}
GOLDEN = {
    "count": "94cd11a00842d686",
    "pattern K": "5f4ff979fbb3fde6",
    "unique": "0d41909cdbcef980",
    "count in building": "74b3340f8edb36bf",
}


@pytest.mark.parametrize("name", SCENES)
def test_scene_is_the_same_as_ever(name):
    assert fingerprint(SCENES[name]()) == GOLDEN[name]


def test_fingerprint_sees_a_thousandth_of_a_millimetre():
    scene = SCENES["count"]()
    thing = scene.objects[100]
    matrix = thing.transform.copy()
    matrix[0, 3] += 2e-6
    objects = [*scene.objects]
    objects[100] = type(thing)(thing.mesh, matrix, thing.color, kind=thing.kind)
    assert fingerprint(type(scene)(tuple(objects))) != fingerprint(scene)
