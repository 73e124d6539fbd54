"""glTF 2.0: the meshes of a scene where its nodes put them, as they stand before any animation."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.files.gltf_file import (
    COLORS,
    COMPRESSED,
    INDICES,
    POSITIONS,
    TEXTURE_PLACES,
    GltfFile,
    compressed,
)
from seethrough.renderer.models.files.gltf_json import ACCESSORS, ANIMATIONS, MESHES, Primitive
from seethrough.renderer.models.files.gltf_material import Material, Materials
from seethrough.renderer.models.files.gltf_nodes import Node, Nodes
from seethrough.renderer.models.files.part import WHITE, Found, Part, checked_colors, too_many
from seethrough.renderer.models.files.source import Refused, Source

_KNOWN = {
    "KHR_mesh_quantization", "KHR_texture_transform", "EXT_texture_webp", "EXT_texture_avif",
    "KHR_lights_punctual", "EXT_mesh_gpu_instancing", "KHR_xmp_json_ld", *COMPRESSED,
}  # fmt: skip
_DRAWN_BY = {0: "points", 1: "lines", 2: "lines", 3: "lines"}


def read(source: Source) -> Found:
    """The triangles of a glTF or GLB file. Raises Refused."""
    file, found, materials = opened(source)
    total = 0
    for mesh, node, matrix in Nodes(file, found).meshes():
        found.parts += primitives(file, mesh, node, matrix, materials, found)
        total = sum(len(part.triangles) for part in found.parts)
        too_many(total)
    check_drawn(total, found)
    return found


def opened(source: Source) -> tuple[GltfFile, Found, Materials]:
    """The file, with what it needs known here. Raises Refused."""
    file, found = GltfFile(source), Found()
    for name in file.json.get("extensionsRequired", []):
        if name not in _KNOWN and not name.startswith("KHR_materials_"):
            raise Refused(f"needs {str(name)[:60]}, which is not known here: save it without")
    if file.rows(ANIMATIONS):
        found.note("it is animated: shown as it stands before any animation")
    return file, found, Materials(file, found)


def primitives(
    file: GltfFile, mesh: object, node: Node, matrix: Floats, materials: Materials, found: Found
) -> list[Part]:
    """What a mesh is made of that has triangles, moved by the matrix. Raises Refused."""
    parts = []
    for number, primitive in enumerate(file.row(MESHES, mesh).get("primitives", [])):
        mode = primitive.get("mode", 4)
        if mode in _DRAWN_BY:
            found.left_out.add(_DRAWN_BY[mode])
            continue
        if mode not in (4, 5, 6):
            raise Refused(f"meshes[{mesh}]: mode = {str(mode)[:20]}: expected 0 to 6")
        what = f"meshes[{mesh}].primitives[{number}]"
        parts.append(_part(file, primitive, node, matrix, materials, found, what))
    return parts


def check_drawn(total: int, found: Found) -> None:
    """Raises Refused where there are no triangles; notes what else is left out."""
    said = " and ".join(sorted(found.left_out))
    if not total:
        raise Refused(f"0 triangles{f', only {said}' if said else ''}: expected a mesh")
    if said:
        found.note(f"its {said} are not shown")


def _part(
    file: GltfFile,
    primitive: Primitive,
    node: Node,
    matrix: Floats,
    materials: Materials,
    found: Found,
    what: str,
) -> Part:
    attributes = primitive.get("attributes", {})
    if "POSITION" not in attributes:
        raise Refused(f"{what}: no POSITION: expected a mesh")
    for name, said in COMPRESSED.items():
        if name in primitive.get("extensions", {}):
            if "bufferView" not in file.row(ACCESSORS, attributes["POSITION"]):
                raise compressed(said, name)
            found.note(f"it is shown as it was before compression with {said}")
    points = node.posed(file.numbers(attributes["POSITION"], POSITIONS), primitive)
    for name in attributes:
        if name != "POSITION" and file.row(ACCESSORS, attributes[name])["count"] != len(points):
            count = file.row(ACCESSORS, attributes[name])["count"]
            raise Refused(
                f"{what}.{name[:40]}: {count} entries: expected {len(points)}, one a vertex"
            )
    if node.joints is not None and "JOINTS_0" in attributes:
        points = node.skinned(points, attributes)
    else:
        with np.errstate(invalid="ignore", over="ignore"):  # what is not finite is refused later
            plain = np.array_equal(matrix, np.eye(4))
            points = points if plain else points @ matrix[:3, :3].T + matrix[:3, 3]
    triangles = _triangles(file, primitive, len(points), what)
    if node.joints is None and np.linalg.det(matrix[:3, :3]) < 0:
        triangles = triangles[:, ::-1]
    material = materials.get(primitive.get("material"))
    colors = _colors(file, attributes, material, triangles, found)
    uv = None
    if material.texture is not None:
        name = f"TEXCOORD_{material.uv_set}"
        if name in attributes:
            uv = _placed(file.numbers(attributes[name], TEXTURE_PLACES), material)[triangles]
            found.colors.add("texture")
        else:
            found.note(f"a texture is not shown: no texture coordinates ({name})")
    texture = material.texture if uv is not None else None
    cutoff = -1.0 if material.opaque else material.cutoff
    return Part(points, triangles, colors, uv, texture, cutoff)


def _triangles(file: GltfFile, primitive: Primitive, count: int, what: str) -> NDArray[np.int64]:
    """(m, 3) vertices, of lists, strips and fans alike."""
    if "indices" in primitive:
        flat = file.accessor(primitive["indices"], INDICES)[:, 0].astype(np.int64)
    else:
        flat = np.arange(count)
    if len(flat) and flat.max() >= count:
        raise Refused(
            f"{what}: a triangle names vertex {flat.max()} of {count}: expected vertices it has"
        )
    mode = primitive.get("mode", 4)
    if mode == 4:
        return flat[: len(flat) // 3 * 3].reshape(-1, 3)
    if len(flat) < 3:
        return np.zeros((0, 3), np.int64)
    if mode == 5:
        rows = np.lib.stride_tricks.sliding_window_view(flat, 3).copy()
        rows[1::2] = rows[1::2, [1, 0, 2]]
        return rows
    middle = np.full(len(flat) - 2, flat[0])
    return np.stack([flat[1:-1], flat[2:], middle], axis=1)


def _colors(
    file: GltfFile,
    attributes: Mapping[str, int],
    material: Material,
    triangles: NDArray[np.int64],
    found: Found,
) -> Floats:
    """(m, 3, 4): the material's factor times the vertices' colours, both linear."""
    if "COLOR_0" in attributes:
        own = checked_colors(file.numbers(attributes["COLOR_0"], COLORS), "vertex")
        if own.shape[1] == 3:
            own = np.concatenate([own, np.ones((len(own), 1))], axis=1)
        factor = WHITE if material.plain else material.color
        colors = np.clip(own, 0, 1)[triangles] * factor
        found.colors.add("vertices")
    else:
        colors = np.broadcast_to(material.color, (*triangles.shape, 4)).copy()
    if not material.plain:
        found.colors.add("materials")
    elif "COLOR_0" not in attributes:
        found.colors.add("none in the file: grey")
    if material.opaque:
        colors[..., 3] = 1.0
    return colors


def _placed(uv: Floats, material: Material) -> Floats:
    if material.place is None:
        return uv
    return uv @ material.place[:, :2].T + material.place[:, 2]
