"""Model files that cannot be shown: each is refused in one line that says why."""

import json
import warnings

import numpy as np
import pytest
from model_cases import RGB, TRIANGLES, XYZ, mtl, plain
from model_cases_gltf import pbr
from model_files import CUBE, QUADS, Gltf, logo, obj, ply, png, stl

from seethrough.renderer.models.user import MOST_TRIANGLES, load_model, read_model

LIST = [(("uchar", "int"), "vertex_indices")]


def gltf(change=lambda g: None, binary=True, **primitive):
    """The cube with a change to its JSON."""
    g = Gltf()
    g.made = g.primitive(CUBE, TRIANGLES, **primitive)
    change(g)
    return g.binary() if binary else g.text()


def packed(name):
    def change(g):
        g.json["extensionsRequired"] = [name]
        g.made["extensions"] = {name: {"bufferView": 0}}
        for accessor in g.json["accessors"]:
            del accessor["bufferView"]

    return gltf(change)


def meshopt(g):
    g.json["bufferViews"][0]["extensions"] = {"EXT_meshopt_compression": {"buffer": 0}}
    g.json["bufferViews"][0]["buffer"] = 1
    g.json["more"] = {"buffers": 1}


def two_buffers():
    g = Gltf()
    g.primitive(CUBE, TRIANGLES)
    meshopt(g)
    text = json.loads(g.text())
    text["buffers"].append({"byteLength": text["buffers"][0]["byteLength"]})
    return json.dumps(text).encode()


def with_texture(data=None, uri=None, **texture):
    def change(g):
        number = g.texture(data, uri)
        g.json["textures"][number].update(texture)
        if texture:
            del g.json["textures"][number]["source"]
        g.json["materials"].append(pbr(texture={"index": number}))
        g.made["material"] = 0
        g.made["attributes"]["TEXCOORD_0"] = g.array(np.zeros((8, 2)))

    return gltf(change)


def put(key, value):
    """A change of the JSON at a path, as ("nodes", 0, "children")."""

    def change(g):
        place = g.json
        for step in key[:-1]:
            place = place[step]
        place[key[-1]] = value

    return gltf(change)


def points_and(rows, name="face", kinds=LIST, colors=None):
    vertices = CUBE if colors is None else [(*p, *c) for p, c in zip(CUBE, colors, strict=True)]
    return ply([("vertex", XYZ if colors is None else XYZ + RGB, vertices), (name, kinds, rows)])


def float_colors(value):
    kinds = XYZ + [("float", n) for n in ("red", "green", "blue")]
    rows = [(*p, 0.5, value, 0.5) for p in CUBE]
    return ply([("vertex", kinds, rows), ("face", LIST, [[t] for t in TRIANGLES])])


def clear_ply():
    rows = [(*p, 9, 9, 9, 0) for p in CUBE]
    kinds = [*XYZ, *RGB, ("uchar", "alpha")]
    return ply([("vertex", kinds, rows), ("face", LIST, [[t] for t in TRIANGLES])])


SIDED = [("usemtl m0", [[v + 1 for v in q] for q in QUADS])]
MAPPED = mtl([(1, 1, 1)], "map_Kd logo.png")
CIRCLE = np.column_stack([np.cos(np.arange(6000)), np.sin(np.arange(6000)), np.zeros(6000)])

BROKEN = [
    ("draco.glb", packed("KHR_draco_mesh_compression"), "compressed with Draco"),
    ("meshopt.gltf", two_buffers(), "compressed with meshopt"),
    ("needs.glb", put(("extensionsRequired",), ["VENDOR_x"]), "needs VENDOR_x, which is not known"),
    ("ktx.glb", with_texture(b"", extensions={"KHR_texture_basisu": {}}), "no PNG or JPEG picture"),
    ("ktx2.glb", with_texture(b"\xabKTX 20\xbb\r\n\x1a\n" + b"\0" * 80), r"is compressed \(KTX2\)"),
    ("words.glb", with_texture(b"no picture"), "expected a picture"),
    ("half.glb", with_texture(png(logo())[:200]), "picture, it cannot be read"),
    ("lost.glb", with_texture(uri="lost.png"), r"texture 'lost\.png': expected a file beside"),
    ("away.glb", with_texture(uri="../../../etc/hostname"), "expected a file beside the model"),
    ("points.glb", gltf(lambda g: g.made.update(mode=0)), "0 triangles, only points: expected"),
    ("lines.glb", gltf(lambda g: g.made.update(mode=3)), "0 triangles, only lines: expected"),
    ("one.gltf", b'{"asset": {"version": "1.0"}, "meshes": {}}', "glTF of version 1.0: expected 2"),
    ("cut.glb", gltf()[:-100], "the file is cut off"),
    ("beyond.glb", put(("accessors", 1, "count"), 3000), "accessors.1.: reaches beyond"),
    ("many.glb", put(("accessors", 0, "count"), 10**12), "1000000000000 entries: expected at most"),
    ("circle.glb", put(("nodes", 0, "children"), [0]), r"nodes\[0\]: is part of the scene twice"),
    (
        "no-node.glb",
        put(("scenes", 0, "nodes"), [7]),
        r"nodes\[7\] of 1: expected one the",
    ),
    (
        "kind.glb",
        put(("accessors", 0, "componentType"), 1),
        "componentType = 1: expected 5120",
    ),
    (
        "nan.glb",
        put(("nodes", 0, "scale"), [float("nan"), 1, 1]),
        r"scale\[0\] = NaN: expected",
    ),
    ("deep.gltf", b"[" * 100_000, "expected a GLTF file, it cannot be read"),
    ("nan-color.ply", float_colors(float("nan")), r"colour of vertex 0 = \(0\.5, nan, 0\.5\)"),
    ("clear.ply", clear_ply(), "0 triangles that can be seen, all are transparent"),
    (
        "cloud.ply",
        ply([("vertex", XYZ, CUBE)]),
        r"expected a mesh \(it has 8 points\)",
    ),
    ("row.ply", points_and([[(0, 1, 99)]]), "a triangle names vertex 99 of 8"),
    ("cut.ply", points_and([[t] for t in TRIANGLES])[:-30], "fewer than 12 face entries"),
    ("round.ply", points_and([[range(8)]])[:120], "expected a PLY file, it cannot be read"),
    ("inf.stl", stl([(np.inf, 0, 0), *CUBE[1:]], TRIANGLES), r"\(inf, 0, 0\): expected finite"),
    ("cut.stl", stl(CUBE, TRIANGLES)[:-9], "the file is cut off"),
    ("two.stl", b"solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\n", "2 corners: expected three"),
    ("zero.obj", plain(CUBE, [(-1, 0, 1)]), r"line 9: a face names vertex 0 of 8"),
    ("inf.obj", b"v inf 0 0\n" + plain(CUBE, QUADS), "vertex 0 = .inf, 0, 0.: expected finite"),
    ("word.obj", b"v 0 0 x\n", r"line 1: 'v 0 0 x': expected numbers"),
    ("short.obj", b"v 0 0\n", "line 1: a vertex of 2 numbers"),
    ("huge.obj", plain(np.asarray(CUBE) * 1e40, QUADS), "expected smaller than 1e.30 coordinates"),
    ("corners.obj", plain(CIRCLE, [range(6000)]), "a polygon of 6000 corners: expected at most"),
    ("lost.obj", obj(CUBE, SIDED, "mtllib lost.mtl"), "materials 'lost.mtl': expected a file"),
    ("bad-kd.obj", obj(CUBE, SIDED, "mtllib bad.mtl"), "Kd 1 nan 1: expected 3 finite numbers"),
    ("map.obj", obj(CUBE, SIDED, "mtllib map.mtl"), "texture 'logo.png': expected a file beside"),
]
BESIDE = {"bad.mtl": mtl([(1, "nan", 1)]), "map.mtl": MAPPED}


@pytest.mark.parametrize(("name", "data", "says"), BROKEN, ids=[b[0] for b in BROKEN])
def test_what_cannot_be_shown_is_one_line(tmp_path, name, data, says):
    for other, content in BESIDE.items():
        (tmp_path / other).write_bytes(content)
    path = tmp_path / name
    path.write_bytes(data)
    with pytest.raises(ValueError, match=says) as caught, warnings.catch_warnings():
        warnings.simplefilter("error")  # numpy's words would stand on the terminal beside the line
        load_model(path)
    said = str(caught.value)
    assert said.startswith(f"{path}: ") and "\n" not in said and len(said) < len(str(path)) + 250


def test_any_flipped_byte_gives_a_model_or_one_line(tmp_path):
    """Two hundred files broken at random: no other error gets out."""
    rng = np.random.default_rng(12)
    whole = {
        "a.glb": gltf(),
        "a.ply": points_and([[t] for t in TRIANGLES]),
        "a.obj": plain(CUBE, QUADS),
    }
    for _ in range(200):
        name = str(rng.choice(list(whole)))
        data = bytearray(whole[name])
        for place in rng.integers(0, len(data), 3):
            data[place] = rng.integers(256)
        (tmp_path / name).write_bytes(bytes(data))
        try:
            load_model(tmp_path / name)
        except ValueError as error:
            assert str(error).startswith(str(tmp_path / name)) and "\n" not in str(error)


def test_the_digest_covers_what_lies_beside(tmp_path):
    from seethrough.renderer.models.user import read_model

    files = {"a.obj": obj(CUBE, SIDED, "mtllib a.mtl"), "a.mtl": mtl([(1, 0, 0)])}
    digests = []
    for color in ((1, 0, 0), (0, 1, 0)):
        files["a.mtl"] = mtl([color])
        for name, data in files.items():
            (tmp_path / name).write_bytes(data)
        digests.append(read_model(tmp_path / "a.obj")[1].digest)
    assert len(set(digests)) == 2


MANY = 10_000  # what a scene may hold of one thing


@pytest.mark.parametrize(
    ("counts", "says"),
    [((2, 3), r"\[2, 3\] entries"), ((1, 1), None), ((MANY,), None), ((MANY + 1,), "10001"),
     ((MANY + 1, 2), r"\[2, 10001\]"), ((), r"\[\] entries")],
)  # fmt: skip
def test_copies_need_one_number_of_entries_and_not_too_many(tmp_path, counts, says):
    """Of every attribute as many; what is refused is refused before any is made."""
    g = Gltf()
    g.primitive([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    names = ("TRANSLATION", "SCALE")[: len(counts)]
    rows = {n: g.array(np.ones((c, 3))) for n, c in zip(names, counts, strict=True)}
    g.json["nodes"][0]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": rows}}
    path = tmp_path / "many.glb"
    path.write_bytes(g.binary())
    if says is None:
        copies = max(counts)
        mesh, facts = read_model(path)
        assert facts.in_file == copies and len(mesh.triangles) >= 1
    else:
        with pytest.raises(ValueError, match=says) as caught:
            load_model(path)
        assert "\n" not in str(caught.value)


def test_triangles_are_counted_over_all_parts_of_a_scene(tmp_path):
    """A mesh of a third of what may be, four times: no single part is too many."""
    g = Gltf()
    made = g.primitive([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    third = MOST_TRIANGLES // 3
    # An accessor without a view is zeros: a file of a few bytes.
    g.json["accessors"].append({"componentType": 5121, "count": 3 * third, "type": "SCALAR"})
    made["indices"] = len(g.json["accessors"]) - 1
    g.json["nodes"] = [{"mesh": 0} for _ in range(4)]
    g.json["scenes"] = [{"nodes": [0, 1, 2, 3]}]
    path = tmp_path / "large.glb"
    path.write_bytes(g.binary())
    with pytest.raises(ValueError, match=rf"{4 * third} triangles: expected at most"):
        load_model(path)
