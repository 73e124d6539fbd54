"""glTF files that are not what the format says: one line that names the place, never another
picture than the file's."""

import json
import struct
from copy import deepcopy

import numpy as np
import pytest
from scene_files import file_of

from seethrough.renderer.models.scene_file import read_scene
from seethrough.renderer.models.user import load_model

NODES = [
    {
        "name": "a",
        "mesh": 0,
        "translation": [1, 0, 0],
        "scale": [1, 1, 1],
        "rotation": [0, 0, 0, 1],
    },
    {"name": "eye", "camera": 0},
]
CAMERAS = [{"type": "perspective", "perspective": {"yfov": 0.9}}]
MATERIALS = [{"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1]}, "alphaCutoff": 0.5}]
WHOLE, NUMBER = "a whole number of at least 0", "a finite number smaller than 1e+30"


def table_of():
    """The JSON and the data of a file in which nothing is wrong."""
    file = file_of(deepcopy(NODES), (0, 1), cameras=deepcopy(CAMERAS), materials=MATERIALS)
    length = struct.unpack_from("<I", file, 12)[0]
    return json.loads(file[20 : 20 + length]), file[28 + length :]


def written(folder, table, data):
    text = json.dumps(table).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(data), b"BIN\0") + data
    path = folder / "a.glb"
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
    return path


def set_at(table, way, value):
    *most, last = way
    for step in most:
        table = table[step]
    table[last] = value


WRONG = [
    (("nodes",), 3, "nodes = 3: expected an array"),
    (("meshes", 0), 1, "meshes[0] = 1: expected an object"),
    (("asset",), [], "asset = []: expected an object"),
    (("accessors", 0, "count"), "x", f'accessors[0].count = "x": expected {WHOLE}'),
    (("accessors", 0, "count"), -1, f"accessors[0].count = -1: expected {WHOLE}"),
    (("accessors", 0, "count"), 2.5, f"accessors[0].count = 2.5: expected {WHOLE}"),
    (("accessors", 0, "count"), True, f"accessors[0].count = true: expected {WHOLE}"),
    (("accessors", 0, "normalized"), 1, "accessors[0].normalized = 1: expected true or false"),
    (("accessors", 0, "bufferView"), None, f"accessors[0].bufferView = null: expected {WHOLE}"),
    (("bufferViews", 0, "byteOffset"), -4, f"bufferViews[0].byteOffset = -4: expected {WHOLE}"),
    (("nodes", 0, "children"), 5, "nodes[0].children = 5: expected an array"),
    (("nodes", 0, "children"), [-1], f"nodes[0].children[0] = -1: expected {WHOLE}"),
    (("nodes", 0, "scale"), [1, float("nan"), 1], f"nodes[0].scale[1] = NaN: expected {NUMBER}"),
    (("nodes", 0, "translation", 2), 1e200, f"nodes[0].translation[2] = 1e+200: expected {NUMBER}"),
    (("nodes", 0, "rotation"), "abcd", 'nodes[0].rotation = "abcd": expected an array'),
    (("nodes", 0, "rotation"), [1, 2], "nodes[0].rotation = [1, 2]: expected 4 numbers"),
    (("nodes", 0, "extensions"), 5, "nodes[0].extensions = 5: expected an object"),
    (("cameras", 0, "perspective"), {}, f"cameras[0].perspective.yfov: missing, expected {NUMBER}"),
    (
        ("cameras", 0),
        {"type": "perspective"},
        "cameras[0].perspective: missing, expected an object",
    ),
    (("materials", 0, "alphaCutoff"), "x", f'materials[0].alphaCutoff = "x": expected {NUMBER}'),
    (
        ("nodes", 0, "matrix"),
        [1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
        "nodes[0].matrix: its last row is 0.5, 0, 0, 1: expected 0, 0, 0, 1",
    ),
    (
        ("nodes", 0, "matrix"),
        [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2],
        "nodes[0].matrix: its last row is 0, 0, 0, 2: expected 0, 0, 0, 1",
    ),
    (
        ("accessors", 1, "componentType"),
        5122,  # whole numbers that may be negative: −1 is no vertex
        "accessors[1].componentType = 5122: expected 5121, 5123 or 5125 of indices",
    ),
    (("accessors", 0, "type"), "VEC2", "accessors[0].type = 'VEC2': expected VEC3 of POSITION"),
    (
        ("accessors", 0, "componentType"),
        5124,
        "accessors[0].componentType = 5124: expected 5120, 5121, 5122, 5123, 5125 or 5126",
    ),
]


@pytest.mark.parametrize(("way", "value", "message"), WRONG)
def test_what_is_not_what_the_format_says_is_named_by_its_place(tmp_path, way, value, message):
    table, data = table_of()
    path = written(tmp_path, table, data)
    assert len(read_scene(path).things) == 1
    set_at(table, way, value)
    path = written(tmp_path, table, data)
    with pytest.raises(ValueError) as caught:
        read_scene(path)
    assert str(caught.value) == f"{path}: {message}"


def with_array(values, kind, component, **more):
    """A file whose mesh has colours of that kind."""
    table, data = table_of()
    own = np.asarray(values, kind)
    table["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": own.nbytes})
    view, shape = len(table["bufferViews"]) - 1, f"VEC{own.shape[1]}"
    table["accessors"].append(
        {"bufferView": view, "componentType": component, "count": len(own), "type": shape, **more}
    )
    table["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = len(table["accessors"]) - 1
    table["buffers"][0]["byteLength"] = len(data) + own.nbytes
    return table, data + own.tobytes()


def test_whole_numbers_as_colours_are_shares_or_refused(tmp_path):
    """128 of 255 is half of the light; 128 that is no share would be shown as white."""
    half = [[128, 0, 0, 255]] * 4
    path = written(tmp_path, *with_array(half, "u1", 5121, normalized=True))
    (thing,) = read_scene(path).things
    light = 128 / 255
    assert np.allclose(thing.mesh.colors[:, 0], 1.055 * light ** (1 / 2.4) - 0.055, atol=1e-3)
    path = written(tmp_path, *with_array(half, "u1", 5121))
    with pytest.raises(ValueError, match="expected 5126, 5121 or 5123 of COLOR, shares where they"):
        read_scene(path)


def test_every_vertex_has_one_of_everything(tmp_path):
    path = written(tmp_path, *with_array([[1, 0, 0]] * 3, "<f4", 5126))
    with pytest.raises(
        ValueError, match=r"primitives\[0\].COLOR_0: 3 entries: expected 4, one a v"
    ):
        read_scene(path)


@pytest.mark.parametrize("suffix", [".glb", ".gltf", ".obj", ".ply", ".stl"])
def test_what_a_reader_trips_over_is_told_in_our_words(tmp_path, suffix):
    """No type of Python's, whatever bytes are changed: what is read shows, or one line says why."""
    models = {".glb": file_of(deepcopy(NODES), (0, 1), cameras=deepcopy(CAMERAS))}
    models[".gltf"] = json.dumps(table_of()[0]).encode()
    models[".obj"] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1/1/1 2 4\n"
    models[".ply"] = (
        b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        b"property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    )
    models[".stl"] = b"\0" * 80 + struct.pack("<I12fH", 1, *range(12), 0)
    rng = np.random.default_rng(17)
    path = tmp_path / f"a{suffix}"
    for _ in range(60):
        data = bytearray(models[suffix])
        for place in rng.integers(len(data), size=rng.integers(1, 4)):
            data[place] = rng.integers(256)
        path.write_bytes(data[: len(data) if rng.random() < 0.7 else rng.integers(len(data))])
        try:
            load_model(path)
        except ValueError as error:
            assert str(error).startswith(f"{path}: ")
            assert "Error" not in str(error)
            assert "object" not in str(error) or "expected an object" in str(error)
            assert "\n" not in str(error)
