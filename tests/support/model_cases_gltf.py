"""Models of glTF 2.0 with their descriptions: what each file is to look like."""

from __future__ import annotations

import base64

import numpy as np
from model_cases import TRIANGLES, Case, polygons, textured
from model_files import CUBE, QUADS, RED, SIDES, SQUARE, Gltf, logo, png
from model_reference import Face, light, shown

POINTS = np.asarray(CUBE)
OWN = POINTS[[v for q in QUADS for v in q]]  # each side with corners of its own
UV = np.tile(SQUARE, (6, 1))
HALF = shown(0.5)


def pbr(color=None, texture=None, **more):
    """A material's JSON."""
    made = {}
    if color is not None:
        made["baseColorFactor"] = [*color, 1.0][:4]
    if texture is not None:
        made["baseColorTexture"] = texture
    return {"pbrMetallicRoughness": made, **more}


def simple(color):
    """Every side in one colour as shown."""
    return polygons(CUBE, QUADS, [color] * 6)


def _plain():
    g = Gltf()
    g.primitive(CUBE, TRIANGLES, material=pbr((0.5, 0.5, 0.5)))
    yield "half.gltf", g.text(), simple((HALF,) * 3), {}, ""
    g = Gltf()
    g.primitive(CUBE, TRIANGLES)
    yield "none.glb", g.binary(), simple((0.7,) * 3), {}, ""
    g = Gltf()
    g.primitive(CUBE, TRIANGLES, material={"extensions": {"KHR_materials_unlit": {}}})
    yield "unlit.glb", g.binary(), simple((1.0,) * 3), {}, "unlit"
    g = Gltf()
    for i, q in enumerate(QUADS):
        g.primitive(POINTS[list(q)], [0, 1, 2, 0, 2, 3], material=pbr(light(SIDES[i])))
    yield "sides.glb", g.binary(), polygons(CUBE, QUADS, SIDES), {}, ""
    g = Gltf()
    g.primitive(POINTS[np.ravel(TRIANGLES)])
    yield "no-indices.glb", g.binary(), simple((0.7,) * 3), {}, ""
    old = {"diffuseFactor": [*light(RED), 1.0]}
    g = Gltf()
    material = {"extensions": {"KHR_materials_pbrSpecularGlossiness": old}}
    g.primitive(CUBE, TRIANGLES, material=material)
    yield "specular.glb", g.binary(), simple(RED), {}, ""
    g = Gltf()
    blend = pbr((0.5, 0.5, 0.5, 0.3), alphaMode="BLEND")
    g.primitive(CUBE, TRIANGLES, material=blend)
    yield "blend.glb", g.binary(), simple((HALF,) * 3), {}, "BLEND"
    g = Gltf()
    g.primitive(CUBE, TRIANGLES, material=pbr((0.5, 0.5, 0.5, 0.0)))
    yield "opaque-alpha-0.glb", g.binary(), simple((HALF,) * 3), {}, ""


def _colors():
    corner = np.array([(x / 2, y, z / 1.5) for x, y, z in CUBE])
    factor = np.array((0.9, 0.5, 1.0))
    faces = [Face(POINTS[list(t)], corner[list(t)] * factor) for t in TRIANGLES]
    g = Gltf()
    material = pbr(factor)
    g.primitive(CUBE, TRIANGLES, material=material, COLOR_0=g.array(corner))
    yield "vertices.glb", g.binary(), faces, {}, ""
    eight = np.round(255 * np.column_stack([corner, np.ones(8)])).astype("u1")
    faces = [Face(POINTS[list(t)], eight[list(t), :3] / 255) for t in TRIANGLES]
    g = Gltf()
    g.primitive(CUBE, TRIANGLES, COLOR_0=g.array(eight, "u1", normalized=True))
    yield "vertices-8.gltf", g.text(), faces, {}, ""


def _shapes():
    sides = [(0, 1, 3, 2), (4, 6, 7, 5)]
    g = Gltf()
    g.primitive(CUBE, [0, 1, 2, 3], mode=5)
    g.primitive(CUBE, sides[1], mode=6)
    yield "strip-fan.glb", g.binary(), polygons(CUBE, sides), {}, "open"
    g = Gltf()
    g.primitive(CUBE, TRIANGLES)
    g.primitive(CUBE, [0, 1, 2, 3], mode=1)
    yield "lines.glb", g.binary(), simple((0.7,) * 3), {}, "lines"
    g = Gltf()
    g.primitive(CUBE, TRIANGLES, material=pbr(light(RED)))
    g.json["scenes"] = [{"nodes": [0, 2]}]
    g.json["nodes"] = [
        {"mesh": 0, "scale": [-1, 1, 0.5]}, {"mesh": 0, "translation": [1, 2, 0]},
        {"children": [1], "rotation": [0, 0, np.sin(0.3), np.cos(0.3)]}, {"mesh": 0},
    ]  # fmt: skip
    c, s = np.cos(0.6), np.sin(0.6)
    turned = (POINTS + np.array([1, 2, 0])) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]).T
    both = polygons(POINTS * [-1, 1, 0.5], QUADS, [RED] * 6) + polygons(turned, QUADS, [RED] * 6)
    yield "nodes.gltf", g.text(), both, {}, ""
    g = Gltf()
    g.primitive(CUBE, TRIANGLES)
    moved = POINTS.copy()
    moved[[6, 7]] += [0.0, 1.0, 0.0]
    rows = g.view(np.array([6, 7], "<u2").tobytes())
    values = g.view(np.asarray(moved[[6, 7]], "<f4").tobytes())
    where = {"bufferView": rows, "componentType": 5123}
    place = g.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
    g.json["accessors"][place]["sparse"] = {
        "count": 2, "indices": where, "values": {"bufferView": values},
    }  # fmt: skip
    yield "sparse.glb", g.binary(), polygons(moved, TRIANGLES), {}, ""
    g = Gltf()
    made = g.primitive(CUBE, TRIANGLES)
    shift = np.zeros((8, 3))
    shift[[6, 7], 1] = 2.0
    made["targets"] = [{"POSITION": g.array(shift)}]
    g.json["meshes"][0]["weights"] = [0.5]
    yield "morph.glb", g.binary(), polygons(moved, TRIANGLES), {}, "blend"
    g = Gltf()
    joints = np.zeros((8, 4))
    joints[[6, 7], 0] = 1
    weights = np.tile([1.0, 0, 0, 0], (8, 1))
    g.primitive(
        POINTS * 10, TRIANGLES, JOINTS_0=g.array(joints, "u1"), WEIGHTS_0=g.array(weights)
    )  # fmt: skip
    tenth = np.diag([0.1, 0.1, 0.1, 1.0])
    g.json["skins"] = [{"joints": [1, 2], "inverseBindMatrices": g.array([tenth.T.ravel()] * 2)}]
    g.json["nodes"] = [
        {"mesh": 0, "skin": 0, "scale": [7, 7, 7]}, {}, {"translation": [0, 1, 0]},
    ]  # fmt: skip
    g.json["scenes"] = [{"nodes": [0, 1, 2]}]
    yield "skin.glb", g.binary(), polygons(moved, TRIANGLES), {}, "joints"
    g = Gltf()
    g.json["extensionsRequired"] = g.json["extensionsUsed"] = ["KHR_mesh_quantization"]
    made = g.primitive(CUBE, TRIANGLES)
    small = np.round(POINTS / 2 * 32767)
    made["attributes"]["POSITION"] = g.array(small, "i2", normalized=True)
    yield "quantized.glb", g.binary(), polygons(small, TRIANGLES), {}, ""
    g = Gltf()
    g.primitive(CUBE, TRIANGLES)
    at = [[0, 0, 0], [3, 0, 0], [0, 0, 4]]
    g.json["nodes"][0]["extensions"] = {
        "EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": g.array(at)}}
    }
    three = [f for t in at for f in polygons(POINTS + t, QUADS)]
    yield "instances.glb", g.binary(), three, {}, ""


def _textured(file="texture.glb", faces=None, uv=UV, uv_set="TEXCOORD_0", picture=None, **options):
    """The cube with a picture; `options` are for its material, sampler and where it lies."""
    g = Gltf()
    picture = logo() if picture is None else picture
    uri, sampler = options.pop("uri", None), options.pop("sampler", None)
    reference = {"index": g.texture(png(picture), uri, sampler), **options.pop("reference", {})}
    more = {uv_set: g.array(uv), **options.pop("attributes", lambda g: {})(g)}
    material = pbr(options.pop("color", None), reference, **options)
    g.primitive(OWN, [(4 * i, 4 * i + a, 4 * i + b) for i in range(6) for a, b in ((1, 2), (2, 3))],
                material=material, **more)  # fmt: skip
    return file, g.binary(), textured(picture) if faces is None else faces


def _textures():
    yield *_textured(), {}, ""
    data = "data:image/png;base64," + base64.b64encode(png(logo())).decode()
    yield *_textured("data.glb", uri=data), {}, ""
    yield *_textured("beside.glb", uri="my%20logo.png"), {"my logo.png": png(logo())}, ""
    tint, corner = np.array((1.0, 0.5, 0.25)), np.array((0.5, 1.0, 1.0))
    faces = textured(logo(), tint=tint * corner)
    made = {"color": tint, "attributes": lambda g: {"COLOR_0": g.array(np.tile(corner, (24, 1)))}}
    yield *_textured("product.glb", faces, **made), {}, ""
    angle = 0.4
    moved = {"offset": [0.2, 0.3], "rotation": angle, "scale": [1.5, 0.8]}
    c, s = np.cos(angle), np.sin(angle)
    to = np.asarray(SQUARE) * [1.5, 0.8]
    to = np.column_stack([c * to[:, 0] + s * to[:, 1], c * to[:, 1] - s * to[:, 0]])
    to = to + np.array([0.2, 0.3])
    reference = {"extensions": {"KHR_texture_transform": moved}}
    yield *_textured("moved.glb", textured(logo(), to), reference=reference), {}, ""
    wide = UV * 2 - 0.5
    faces = textured(logo(), np.asarray(SQUARE) * 2 - 0.5, wrap=("mirror", "clamp"))
    yield *_textured("wrapped.glb", faces, wide, sampler={"wrapS": 33648, "wrapT": 33071}), {}, ""
    second = {"attributes": lambda g: {"TEXCOORD_0": g.array(UV * 0)}, "reference": {"texCoord": 1}}
    yield *_textured("second.glb", uv_set="TEXCOORD_1", **second), {}, ""
    clear = np.dstack([logo(), np.zeros((32, 32), np.uint8)])
    yield *_textured("opaque.glb", textured(logo()), picture=clear), {}, ""
    y, x = np.mgrid[:32, :32] / 32
    hole = np.dstack([logo(), np.where(abs(x - 0.5) + abs(y - 0.5) < 0.3, 0, 255)]).astype("u1")
    faces = textured(hole, cutoff=0.5)
    yield *_textured("mask.glb", faces, picture=hole, alphaMode="MASK"), {}, "open"
    sixteen = logo(16)
    yield *_textured("small.glb", textured(sixteen), picture=sixteen), {}, ""


CASES = [
    Case(name, data, faces, beside, says)
    for made in (_plain, _colors, _shapes, _textures)
    for name, data, faces, beside, says in made()
]
