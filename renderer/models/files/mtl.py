"""Materials of OBJ files: the colour Kd, the picture map_Kd, and what is wholly transparent."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.files.part import GREY, WHITE, Found, linear_rgba
from seethrough.renderer.models.files.source import Refused, Source
from seethrough.renderer.models.files.texture import CLAMP, REPEAT, Texture, decoded

# Options of a map and how many words follow each; those of -o, -s and -t are one to three numbers.
_OPTIONS = {
    "-blendu": 1, "-blendv": 1, "-boost": 1, "-bm": 1, "-cc": 1, "-clamp": 1, "-imfchan": 1,
    "-mm": 2, "-texres": 1, "-type": 1,
}  # fmt: skip
_NUMBERS = ("-o", "-s", "-t")


@dataclass(frozen=True, eq=False)
class Material:
    """color (4,) linear RGBA, `texture` with its scale and offset (2,) of u and v."""

    color: Floats
    texture: Texture | None = None
    scale: tuple[float, float] = (1.0, 1.0)
    offset: tuple[float, float] = (0.0, 0.0)
    plain: bool = False  # no colour and no picture: grey


def grey_material() -> Material:
    """What has no material."""
    return Material(linear_rgba(GREY), plain=True)


class Library:
    """The materials of an OBJ file by name; pictures are read when a material is asked for."""

    def __init__(self, source: Source, found: Found) -> None:
        self._source, self._report = source, found
        self._raw: dict[str, dict[str, list[str]]] = {}
        self._made: dict[str, Material] = {}
        self._pictures: dict[tuple[str, bool], Texture] = {}
        self.missing: list[str] = []
        self.read_any = False

    def read(self, name: str) -> None:
        """Take in a file of materials. One that isn't there is refused once it is needed."""
        try:
            data = self._source.beside(name, "materials")
        except Refused:
            self.missing.append(name)
            return
        self.read_any = True
        current: dict[str, list[str]] = {}
        for line in decoded_text(data).splitlines():
            words = line.split()
            if not words or words[0].startswith("#"):
                continue
            if words[0].lower() == "newmtl":
                current = self._raw.setdefault(_rest(line), {})
            else:
                current[words[0].lower()] = words[1:]

    def get(self, name: str) -> Material:
        """The material, grey where there is none of that name. Raises Refused."""
        if name not in self._made:
            self._made[name] = self._material(name)
        return self._made[name]

    def _material(self, name: str) -> Material:
        raw = self._raw.get(name)
        if raw is None and self.missing:
            raise Refused(
                f"materials {self.missing[0][:80]!r}: expected a file beside the model, there is "
                "none (without its mtllib line the model is grey)"
            )
        if raw is None:
            self._report.note(f"no material {name[:40]!r} in its files: grey")
            return grey_material()
        picture = raw.get("map_kd")
        kd = raw.get("kd")
        color = WHITE.copy() if picture else linear_rgba(GREY)
        if kd is not None:
            color = linear_rgba(np.clip(self._numbers(name, "Kd", kd[:3], 3), 0, 1))
        color[3] = self._alpha(name, raw)
        if not picture:
            return Material(color, plain=kd is None)
        file, texture, scale, offset = self._map(name, picture)
        return Material(color, self._picture(file, texture), scale, offset)

    def _alpha(self, name: str, raw: dict[str, list[str]]) -> float:
        alpha = 1.0
        if "d" in raw:
            words = [w for w in raw["d"] if w != "-halo"]
            alpha = self._numbers(name, "d", words[:1], 1)[0]
        elif "tr" in raw:
            alpha = 1 - self._numbers(name, "Tr", raw["tr"][:1], 1)[0]
        if "map_d" in raw:
            self._report.note("transparency from a picture (map_d) is shown opaque")
        if 0 < alpha < 1:
            self._report.note("half transparent materials are shown opaque")
        return float(np.clip(alpha, 0, 1))

    def _numbers(self, name: str, key: str, words: list[str], count: int) -> Floats:
        if count == 3 and len(words) == 1:
            words = words * 3  # green and blue are red's where they are left out
        try:
            values = np.array([float(w) for w in words])
        except ValueError:
            values = np.zeros(0)
        if len(values) != count or not np.isfinite(values).all():
            said = " ".join(words)[:40] or "nothing"
            raise Refused(f"material {name[:40]!r}: {key} {said}: expected {count} finite numbers")
        return values

    def _map(
        self, name: str, words: list[str]
    ) -> tuple[str, bool, tuple[float, float], tuple[float, float]]:
        """The file, whether it is clamped, scale and offset."""
        scale, offset, clamp = (1.0, 1.0), (0.0, 0.0), False
        i = 0
        while i < len(words) - 1 and words[i].lower() in (*_OPTIONS, *_NUMBERS):
            option = words[i].lower()
            i += 1
            if option in _NUMBERS:
                taken: list[float] = []
                while i < len(words) - 1 and len(taken) < 3 and _is_number(words[i]):
                    taken.append(float(words[i]))
                    i += 1
                pair = (*taken, *((1.0, 1.0) if option == "-s" else (0.0, 0.0))[len(taken) :])[:2]
                if option == "-s":
                    scale = (pair[0], pair[1])
                elif option == "-o":
                    offset = (pair[0], pair[1])
            else:
                clamp |= option == "-clamp" and words[i].lower() == "on"
                i += _OPTIONS[option]
        file = " ".join(words[i:])
        if not file:
            raise Refused(f"material {name[:40]!r}: map_Kd: expected the name of a picture")
        return file, clamp, scale, offset

    def _picture(self, file: str, clamp: bool) -> Texture:
        if (file, clamp) not in self._pictures:
            data = self._source.beside(file.strip('"'), "texture")
            wrap = CLAMP if clamp else REPEAT
            what = f"texture {file[:80]!r}"
            self._pictures[file, clamp] = decoded(data, what, (wrap, wrap), upward=True)
        return self._pictures[file, clamp]


def decoded_text(data: bytes) -> str:
    """UTF-8, with a mark in front or without; what is not UTF-8 counts as Latin-1."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def _rest(line: str) -> str:
    """What follows the first word."""
    words = line.split(None, 1)
    return words[1].strip() if len(words) > 1 else ""


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
