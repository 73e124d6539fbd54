"""A user's own models: files written here byte by byte, and each way they can be unusable."""

import base64
import json
import struct

import numpy as np
import pytest

from seethrough.renderer.models import user
from seethrough.renderer.models.user import load_model

# A wedge: a right triangle in x and y drawn out along z, on the ground, 4 long, 2 high, 1 deep.
CORNERS = [(0, 0, 0), (4, 0, 0), (0, 2, 0), (0, 0, 1), (4, 0, 1), (0, 2, 1)]
FACES = [
    (0, 2, 1), (3, 4, 5), (0, 1, 4), (0, 4, 3), (0, 3, 5), (0, 5, 2), (1, 2, 5), (1, 5, 4),
]  # fmt: skip
RECORD = [("normal", "<f4", 3), ("points", "<f4", (3, 3)), ("more", "<u2")]  # of a binary STL


def obj(corners=CORNERS, faces=FACES):
    lines = [f"v {x} {y} {z}" for x, y, z in corners]
    return "\n".join(lines + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]) + "\n"


def ply(corners=CORNERS, faces=FACES, color=(255, 0, 51)):
    head = (
        f"ply\nformat ascii 1.0\nelement vertex {len(corners)}\n"
        "property float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    body = [" ".join(map(str, (*c, *color))) for c in corners]
    return head + "\n".join(body + [f"3 {a} {b} {c}" for a, b, c in faces]) + "\n"


def stl(corners=CORNERS, faces=FACES):
    head = b"\0" * 80 + struct.pack("<I", len(faces))
    points = np.array(corners, "<f4")[np.array(faces)]
    record = np.zeros(len(faces), RECORD)
    record["points"] = points
    return head + record.tobytes()


def gltf(color=(0.2, 0.4, 0.8, 1.0), scale=1.0):
    points, faces = np.array(CORNERS, "<f4"), np.array(FACES, "<u2")
    data = points.tobytes() + faces.tobytes()
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    return json.dumps(
        {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0, "scale": [scale, 1, 1]}],
            "materials": [{"pbrMetallicRoughness": {"baseColorFactor": color}}],
            "meshes": [
                {"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}
            ],
            "buffers": [{"uri": uri, "byteLength": len(data)}],
            "bufferViews": [
                {"buffer": 0, "byteOffset": 0, "byteLength": points.nbytes},
                {"buffer": 0, "byteOffset": points.nbytes, "byteLength": faces.nbytes},
            ],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3",
                 "min": [0, 0, 0], "max": [4, 2, 1]},
                {"bufferView": 1, "componentType": 5123, "count": 24, "type": "SCALAR"},
            ],
        }
    )  # fmt: skip


def written(folder, name, content):
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def volume(mesh):
    a, b, c = np.moveaxis(mesh.vertices[mesh.triangles], 1, 0)
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


@pytest.mark.parametrize(
    ("name", "content", "color"),
    [
        ("wedge.obj", obj(), user.GREY),
        ("wedge.ply", ply(), (1.0, 0.0, 0.2)),
        ("wedge.stl", stl(), user.GREY),
        ("WEDGE.STL", stl(), user.GREY),
        ("wedge.gltf", gltf(), (0.48453, 0.66519, 0.90633)),  # linear there: IEC 61966-2-1 by hand
    ],
)
def test_each_kind_gives_the_same_wedge(tmp_path, name, content, color):
    mesh = load_model(written(tmp_path, name, content), size=2.0)
    np.testing.assert_allclose(mesh.bounds, [[-1, 0, -0.25], [1, 1, 0.25]], atol=1e-7)
    assert volume(mesh) == pytest.approx(0.5 * 2 * 1 * 0.5)
    assert len(mesh.triangles) == 8
    assert len(mesh.vertices) == 3 * 4 + 2 * 3  # three rectangles and two triangles, all sharp
    np.testing.assert_allclose(mesh.colors, np.tile(color, (18, 1)), atol=0.5 / 255)
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1)


def test_gltf_models_are_turned_to_face_minus_z(tmp_path):
    """The wedge's high side, at x = 0 in the file, comes to +x by half a turn."""
    for name, content, side in (("a.obj", obj(), -1), ("a.gltf", gltf(), 1)):
        mesh = load_model(written(tmp_path, name, content))
        top = mesh.vertices[mesh.vertices[:, 1].argmax()]
        assert np.sign(top[0]) == side


def test_the_scene_of_a_gltf_file_places_its_meshes(tmp_path):
    mesh = load_model(written(tmp_path, "long.gltf", gltf(scale=2.0)), size=8.0)
    np.testing.assert_allclose(np.ptp(mesh.vertices, axis=0), [8, 2, 1], atol=1e-6)


def test_up_and_turn(tmp_path):
    path = written(tmp_path, "wedge.stl", stl())
    raised = load_model(path, size=4.0, up="z")
    np.testing.assert_allclose(np.ptp(raised.vertices, axis=0), [4, 1, 2], atol=1e-6)
    turned = load_model(path, size=4.0, turn=90.0)
    np.testing.assert_allclose(np.ptp(turned.vertices, axis=0), [1, 2, 4], atol=1e-6)
    # Positive turns left: what lay at −x, the high side, comes to +z.
    assert turned.vertices[turned.vertices[:, 1].argmax(), 2] == pytest.approx(2.0)


def test_a_closed_surface_that_is_inside_out_is_turned(tmp_path):
    inside_out = [face[::-1] for face in FACES]
    mesh = load_model(written(tmp_path, "wedge.obj", obj(faces=inside_out)))
    assert volume(mesh) > 0
    # Of an open one nobody can tell the outside: it gets both sides.
    opened = load_model(written(tmp_path, "open.obj", obj(faces=inside_out[1:])))
    assert len(opened.triangles) == 2 * 7
    assert volume(opened) == pytest.approx(0)


def test_triangles_without_area_are_left_out(tmp_path):
    corners = [*CORNERS, (2, 0, 0), (4, 0, 0)]
    faces = [*FACES, (0, 1, 6), (1, 7, 3)]
    mesh = load_model(written(tmp_path, "wedge.obj", obj(corners, faces)))
    assert len(mesh.triangles) == 8


def nan_obj():
    return obj([*CORNERS[:4], ("nan", 0, 1), CORNERS[5]])


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("cup.fbx", "x", r"cup\.fbx: expected a model file, one of \.glb, \.gltf, \.obj"),
        ("cup.obj", "", r"cup\.obj: 0 bytes: expected a model, the file is empty"),
        ("cup.obj", "# only words\n", r"cup\.obj: "),
        ("cup.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", r"cup\.obj: "),
        ("cup.obj", "f 1 2 3\n", r"cup\.obj: "),
        ("cup.obj", obj(faces=[(0, 1, 99)]), r"cup\.obj: "),
        ("cup.obj", nan_obj(), r"cup\.obj: vertex \d+ = \(nan, 0, 1\): expected finite coord"),
        ("cup.obj", obj([(0, 0, 0)] * 6), r"cup\.obj: 0 triangles with an area: expected a mesh"),
        ("cup.ply", b"ply\xff\xfe\x00", r"cup\.ply: expected a PLY file, it cannot be read"),
        ("cup.ply", ply(faces=[]), r"cup\.ply: 0 triangles: expected a mesh"),
        ("cup.ply", ply([*CORNERS[:5], ("inf", 0, 0)]), r"cup\.ply: vertex 5 = \(inf, 0, 0\)"),
        (
            "cup.stl",
            b"\x01" * 300,
            r"cup\.stl: 300 bytes for 16843009 triangles: the file is cut off",
        ),
        ("cup.stl", stl()[:150], r"cup\.stl: "),
        ("cup.stl", stl(faces=[(0, 1, 1)]), r"cup\.stl: 0 triangles with an area"),
        ("cup.glb", b"glTF and then nothing", r"cup\.glb: expected a GLB file, it cannot be read"),
        ("cup.gltf", "{", r"cup\.gltf: expected a GLTF file, it cannot be read"),
        ("cup.gltf", '{"asset": {"version": "2.0"}}', r"cup\.gltf: "),
    ],
)
def test_what_cannot_be_shown_is_refused_in_one_line(tmp_path, name, content, message):
    path = written(tmp_path, name, content)
    with pytest.raises(ValueError, match=message) as caught:
        load_model(path)
    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith(str(path))


def test_a_missing_file_and_a_folder_are_refused(tmp_path):
    (tmp_path / "folder.obj").mkdir()
    for name in ("none.obj", "folder.obj"):
        with pytest.raises(ValueError, match=rf"{name}: expected a model file, there is none"):
            load_model(tmp_path / name)


def test_a_million_triangles_are_refused(tmp_path):
    n = 1_000_000
    record = np.zeros(n, RECORD)
    record["points"] = np.random.default_rng(1).random((n, 3, 3))
    path = written(tmp_path, "cloud.stl", b"\0" * 80 + struct.pack("<I", n) + record.tobytes())
    with pytest.raises(ValueError, match=r"cloud\.stl: 1000000 triangles: expected at most 250000"):
        load_model(path)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"up": "x"}, "wedge.obj: up = 'x': expected 'y' or 'z'"),
        ({"size": 0.0}, "wedge.obj: size = 0.0: expected a number > 0"),
        ({"size": float("nan")}, "wedge.obj: size = nan: expected a number > 0"),
        ({"turn": float("inf")}, "wedge.obj: turn = inf: expected an angle in degrees"),
    ],
)
def test_options_out_of_range_are_refused(tmp_path, options, message):
    with pytest.raises(ValueError, match=message):
        load_model(written(tmp_path, "wedge.obj", obj()), **options)
