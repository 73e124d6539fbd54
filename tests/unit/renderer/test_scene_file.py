"""Files of many things: each node a thing where the file puts it, against matrices worked out by
hand; what ships is what the code makes."""

import numpy as np
import pytest
from scene_files import file_of

from seethrough.renderer.models import shipped
from seethrough.renderer.models.scene_file import read_scene
from seethrough.renderer.models.shipped.make import FOLDER, SCENES, made


def test_each_node_is_a_thing_where_the_file_puts_it(tmp_path):
    """A child moves with its parent; copies of a mesh are one mesh, also where the file wrote it
    twice; what is said of a parent holds for what is below, unless that says otherwise."""
    half = 2**-0.5  # a quarter turn about y: x becomes −z
    nodes = [
        {"name": "pump", "mesh": 0, "translation": [10, 0, 0], "children": [1, 2],
         "extras": {"group": "engine", "target": True}},
        {"name": "valve", "mesh": 1, "translation": [0, 5, 0], "rotation": [0, half, 0, half],
         "extras": {"target": False}},
        {"name": "eye", "camera": 0, "translation": [0, 0, 8]},
        {"mesh": 0, "scale": [-1, 1, 1]},
        {"name": "pivot", "translation": [1, 2, 3]},
    ]  # fmt: skip
    cameras = [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}]
    (tmp_path / "a.glb").write_bytes(file_of(nodes, (0, 3, 4), 2, cameras=cameras))
    found = read_scene(tmp_path / "a.glb")
    assert [t.name for t in found.things] == ["pump", "valve", "thing 3"]
    pump, valve, mirrored = found.things
    assert pump.mesh is valve.mesh is mirrored.mesh
    assert np.allclose(pump.transform[:3, 3], (10, 0, 0))
    corner = valve.transform @ (1, 0, 0, 1)
    assert np.allclose(corner[:3], (10, 5, -1))
    assert np.linalg.det(mirrored.transform[:3, :3]) == pytest.approx(-1)
    assert pump.extras == {"group": "engine", "target": True}
    assert valve.extras == {"group": "engine", "target": False}
    assert [(s.name, s.fov_y) for s in found.standpoints] == [("eye", 0.9)]
    assert np.allclose(found.standpoints[0].transform[:3, 3], (10, 0, 8))
    assert np.allclose(found.spots["pivot"], (1, 2, 3))
    # The mesh stays in its own frame: its highest corner is the file's.
    assert np.allclose(pump.mesh.bounds, [(0, 0, 0), (1, 2, 3)])


@pytest.mark.parametrize("name", SCENES)
def test_what_ships_is_what_the_code_makes(name):
    """Places to a ten thousandth of a unit, which is what the file rounds to."""
    kept, again = (FOLDER / f"{name}.glb").read_bytes(), made(name)
    assert len(kept) < 2**20
    assert len(again) == len(kept)
    apart = [k != a for k, a in zip(kept, again, strict=True)]
    assert sum(apart) <= len(kept) // 1000  # another library's cosine may round another way


@pytest.mark.parametrize(
    ("name", "things", "targets", "cameras"),
    [("jeep", 36, 23, 0), ("assembly", 60, 24, 0), ("office", 50, 19, 4)],
)
def test_the_shipped_scenes_hold_what_they_promise(name, things, targets, cameras):
    """Sixty parts; forty things in an office beside its walls and floor."""
    found = read_scene(FOLDER / f"{name}.glb")
    assert len(found.things) == things
    assert sum(t.extras.get("target") is True for t in found.things) == targets
    assert len(found.standpoints) == cameras
    names = [t.name for t in found.things]
    assert len(set(names)) == len(names)
    if name == "office":
        assert sum(t.extras.get("wall") is True for t in found.things) == 9
        assert things - 9 - 1 == 40
    assert shipped.__doc__


def test_single_things_come_as_one(tmp_path):
    """An OBJ is one thing, of the file's name."""
    (tmp_path / "wedge.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    )
    found = read_scene(tmp_path / "wedge.obj")
    assert [t.name for t in found.things] == ["wedge"]
    assert np.allclose(found.things[0].mesh.bounds, [(0, 0, 0), (1, 1, 1)])
