"""Materials of glTF 2.0: base colour, its texture, where that lies, what alpha means."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.files.gltf_file import GltfFile
from seethrough.renderer.models.files.gltf_json import (
    MATERIALS,
    SAMPLERS,
    TEXTURES,
    MaterialRow,
    Placing,
)
from seethrough.renderer.models.files.part import GREY, WHITE, Found, linear_rgba
from seethrough.renderer.models.files.source import Refused
from seethrough.renderer.models.files.texture import CLAMP, MIRROR, REPEAT, Texture, decoded

_SPECULAR: Final = "KHR_materials_pbrSpecularGlossiness"
_PLACED: Final = "KHR_texture_transform"


@dataclass(frozen=True, eq=False)
class Material:
    """color (4,) linear RGBA; `texture` looked up at set `uv_set`, moved by `place` (2, 3);
    alpha below `cutoff` is not shown, any alpha counts as 1 where `opaque`."""

    color: Floats
    texture: Texture | None = None
    uv_set: int = 0
    place: Floats | None = None
    cutoff: float = 0.0
    opaque: bool = True
    plain: bool = False


class Materials:
    """The materials of a file by number, made when first asked for."""

    def __init__(self, file: GltfFile, found: Found) -> None:
        self._file, self._found = file, found
        self._made: dict[int | None, Material] = {None: Material(linear_rgba(GREY), plain=True)}
        self._textures: dict[int, Texture] = {}

    def get(self, index: int | None) -> Material:
        """Raises Refused."""
        if index not in self._made:
            self._made[index] = self._material(self._file.row(MATERIALS, index))
        return self._made[index]

    def _material(self, raw: MaterialRow) -> Material:
        extensions = raw.get("extensions", {})
        pbr = raw.get("pbrMetallicRoughness", {})
        factor, reference = pbr.get("baseColorFactor"), pbr.get("baseColorTexture")
        if _SPECULAR in extensions:
            older = extensions[_SPECULAR]
            factor, reference = older.get("diffuseFactor"), older.get("diffuseTexture")
        if "KHR_materials_unlit" in extensions:
            self._found.note("what is unlit there is lit here, like everything else")
        if any(raw.get("emissiveFactor", ())):
            self._found.note("light that its materials emit is not shown")
        color = np.array(WHITE if factor is None else factor, float)
        if color.shape != (4,) or not np.isfinite(color).all():
            raise Refused(f"baseColorFactor = {str(factor)[:60]}: expected four finite numbers")
        texture, uv_set, place = None, 0, None
        if reference is not None:
            texture = self._texture(reference["index"])
            uv_set = reference.get("texCoord", 0)
            moved = reference.get("extensions", {}).get(_PLACED)
            if moved is not None:
                uv_set, place = moved.get("texCoord", uv_set), _place(moved)
        mode = raw.get("alphaMode", "OPAQUE")
        if mode not in ("OPAQUE", "MASK", "BLEND"):
            raise Refused(f"alphaMode = {str(mode)[:40]!r}: expected OPAQUE, MASK or BLEND")
        cutoff = float(raw.get("alphaCutoff", 0.5)) if mode == "MASK" else 0.0
        if mode == "BLEND":
            self._found.note("what blends (alphaMode BLEND) is opaque here, but for alpha 0")
        return Material(np.clip(color, 0, 1), texture, uv_set, place, cutoff, mode == "OPAQUE")

    def _texture(self, index: int) -> Texture:
        if index not in self._textures:
            raw = self._file.row(TEXTURES, index)
            extensions = raw.get("extensions", {})
            number = raw.get("source")
            for name in ("EXT_texture_webp", "EXT_texture_avif"):
                if name in extensions and number is None:
                    number = extensions[name].get("source")
            if number is None:
                said = ", ".join(extensions) or "none"
                raise Refused(f"textures[{index}]: no PNG or JPEG picture ({said[:80]})")
            data, what = self._file.image(number)
            sampler = self._file.row(SAMPLERS, raw["sampler"]) if "sampler" in raw else {}
            wrap = (sampler.get("wrapS", REPEAT), sampler.get("wrapT", REPEAT))
            if not set(wrap) <= {REPEAT, CLAMP, MIRROR}:
                raise Refused(f"{what}: wrap = {wrap}: expected a way that glTF knows")
            self._textures[index] = decoded(data, what, wrap, sampler.get("magFilter") == 9728)
        return self._textures[index]


def _place(moved: Placing) -> Floats:
    """(2, 3) new ← old texture coordinates: scaled, then turned, then moved."""
    scale, offset = moved.get("scale", [1, 1]), moved.get("offset", [0, 0])
    if len(scale) != 2 or len(offset) != 2:
        raise Refused(f"{_PLACED} = {str(moved)[:60]}: expected two numbers each")
    (sx, sy), (x, y), angle = scale, offset, float(moved.get("rotation", 0.0))
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c * sx, s * sy, x], [-s * sx, c * sy, y]], float)
