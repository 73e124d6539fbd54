"""The JSON of a glTF 2.0 file, as its specification has it: what is read here of each object.

A file may say otherwise: gltf_check holds it to what is declared here before anything is read.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Generic, Required, TypedDict, TypeVar

Row = TypeVar("Row")


@dataclass(frozen=True)
class Kind(Generic[Row]):
    """A top-level list of the file's, and what is in it."""

    name: str
    row: type[Row]


class Indices(TypedDict, total=False):
    """Where the places of an accessor's sparse entries are, or the entries themselves."""

    bufferView: Required[int]
    byteOffset: int
    componentType: int


class Sparse(TypedDict):
    """What of an accessor is replaced."""

    count: int
    indices: Indices
    values: Indices


class Accessor(TypedDict, total=False):
    """An array in a buffer."""

    bufferView: int
    byteOffset: int
    componentType: Required[int]
    type: Required[str]
    count: Required[int]
    normalized: bool
    sparse: Sparse


class View(TypedDict, total=False):
    """A part of a buffer."""

    buffer: Required[int]
    byteOffset: int
    byteLength: Required[int]
    byteStride: int
    extensions: Mapping[str, object]


class Buffer(TypedDict, total=False):
    """A file, or data within this one."""

    uri: str
    byteLength: Required[int]


class Image(TypedDict, total=False):
    """A picture: a file, data, or part of a buffer."""

    uri: str
    bufferView: int


class Primitive(TypedDict, total=False):
    """Triangles of a mesh: its attributes are accessors by name."""

    attributes: Required[Mapping[str, int]]
    indices: int
    material: int
    mode: int
    targets: list[Mapping[str, int]]
    extensions: Mapping[str, object]


class MeshRow(TypedDict, total=False):
    """A mesh."""

    name: object
    extras: object
    primitives: Required[list[Primitive]]
    weights: list[float]


class Instancing(TypedDict):
    """EXT_mesh_gpu_instancing: accessors by name."""

    attributes: Mapping[str, int]


class NodeExtensions(TypedDict, total=False):
    """The one that is looked at."""

    EXT_mesh_gpu_instancing: Instancing


class NodeRow(TypedDict, total=False):
    """Something in the scene, and where: a matrix, or a turn, a size and a place."""

    name: object
    extras: object
    camera: int
    mesh: int
    skin: int
    weights: list[float]
    children: list[int]
    matrix: list[float]
    rotation: list[float]
    scale: list[float]
    translation: list[float]
    extensions: NodeExtensions


class Perspective(TypedDict, total=False):
    """How wide a camera sees."""

    yfov: Required[float]


class CameraRow(TypedDict, total=False):
    """A camera."""

    name: object
    type: str
    perspective: Perspective


class SceneRow(TypedDict, total=False):
    """A scene: its roots."""

    nodes: list[int]


class Skin(TypedDict, total=False):
    """Joints that hold a mesh."""

    joints: Required[list[int]]
    inverseBindMatrices: int


class Placing(TypedDict, total=False):
    """KHR_texture_transform."""

    scale: list[float]
    rotation: float
    offset: list[float]
    texCoord: int


class TextureExtensions(TypedDict, total=False):
    """The one that is looked at."""

    KHR_texture_transform: Placing


class Reference(TypedDict, total=False):
    """Which texture, looked up by which coordinates."""

    index: Required[int]
    texCoord: int
    extensions: TextureExtensions


class Roughness(TypedDict, total=False):
    """A material's colours, of the metallic model."""

    baseColorFactor: list[float]
    baseColorTexture: Reference


class Specular(TypedDict, total=False):
    """A material's colours, of the older specular model."""

    diffuseFactor: list[float]
    diffuseTexture: Reference


class MaterialExtensions(TypedDict, total=False):
    """Those that are looked at."""

    KHR_materials_pbrSpecularGlossiness: Specular
    KHR_materials_unlit: Mapping[str, object]


class MaterialRow(TypedDict, total=False):
    """A material."""

    pbrMetallicRoughness: Roughness
    extensions: MaterialExtensions
    emissiveFactor: list[float]
    alphaMode: str
    alphaCutoff: float


class Origin(TypedDict, total=False):
    """Another picture of a texture's."""

    source: int


class TextureRow(TypedDict, total=False):
    """A picture, and how it is looked up."""

    source: int
    sampler: int
    extensions: Mapping[str, Origin]


class Sampler(TypedDict, total=False):
    """How a picture is looked up."""

    wrapS: int
    wrapT: int
    magFilter: int


class AnimationRow(TypedDict, total=False):
    """An animation: that there is one is all that is read."""

    channels: object


ACCESSORS: Kind[Accessor] = Kind("accessors", Accessor)
ANIMATIONS: Kind[AnimationRow] = Kind("animations", AnimationRow)
BUFFERS: Kind[Buffer] = Kind("buffers", Buffer)
CAMERAS: Kind[CameraRow] = Kind("cameras", CameraRow)
IMAGES: Kind[Image] = Kind("images", Image)
MATERIALS: Kind[MaterialRow] = Kind("materials", MaterialRow)
MESHES: Kind[MeshRow] = Kind("meshes", MeshRow)
NODES: Kind[NodeRow] = Kind("nodes", NodeRow)
SAMPLERS: Kind[Sampler] = Kind("samplers", Sampler)
SCENES: Kind[SceneRow] = Kind("scenes", SceneRow)
SKINS: Kind[Skin] = Kind("skins", Skin)
TEXTURES: Kind[TextureRow] = Kind("textures", TextureRow)
VIEWS: Kind[View] = Kind("bufferViews", View)
KINDS = (
    ACCESSORS, ANIMATIONS, BUFFERS, CAMERAS, IMAGES, MATERIALS, MESHES, NODES, SAMPLERS, SCENES,
    SKINS, TEXTURES, VIEWS,
)  # fmt: skip
