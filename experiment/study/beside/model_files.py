"""The files that a study's model brings along: beside the study too, before a reader opens any.

An OBJ file names materials, those name pictures, a glTF file its buffers and pictures.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import unquote

from seethrough.experiment.study.beside.study_files import LARGEST_MODEL, place_beside, read_regular

_URI = re.compile(rb'"uri"\s*:\s*("(?:[^"\\]|\\.)*")')
_LIBRARY = re.compile(rb"^[ \t]*mtllib[ \t]+(.+?)[ \t]*\r?$", re.MULTILINE)
_MAP = re.compile(
    rb"^[ \t]*(?:map_\w+|bump|disp|decal|refl|norm)[ \t]+(?:.*[ \t])?(\S+)[ \t]*\r?$",
    re.MULTILINE | re.IGNORECASE,
)


def check_files(study: Path, name: str) -> None:
    """Raises ValueError, OSError unless a model and all that it names lie beside the study."""
    place = place_beside(study, name)
    if not os.path.lexists(place):
        return  # whoever reads models says so
    data = read_regular(place, LARGEST_MODEL)
    for other in _named(place.suffix.lower(), data):
        try:
            found = place_beside(study, str(Path(name).parent / other))
            if os.path.lexists(found):
                more = read_regular(found, LARGEST_MODEL)
                if place.suffix.lower() == ".obj":
                    _check_pictures(study, Path(name).parent, more)
        except (ValueError, OSError) as error:
            reason = error.strerror if isinstance(error, OSError) else error
            raise ValueError(f"names {other[:60]!r}: {reason}") from None


def _check_pictures(study: Path, folder: Path, library: bytes) -> None:
    for name in _MAP.findall(library):
        found = place_beside(study, str(folder / name.decode("utf-8", "replace")))
        if os.path.lexists(found):
            read_regular(found, LARGEST_MODEL)


def _named(kind: str, data: bytes) -> Iterator[str]:
    """Names of other files in an OBJ or a glTF file."""
    if kind == ".obj":
        for name in _LIBRARY.findall(data):
            yield name.decode("utf-8", "replace")
    elif kind in (".gltf", ".glb"):
        for quoted in _URI.findall(data):
            try:
                uri = str(json.loads(quoted))
            except ValueError:
                uri = quoted.decode("utf-8", "replace")
            if not uri.startswith("data:"):
                yield unquote(uri)
