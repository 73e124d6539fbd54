"""Writes the shipped scenes anew, beside this file, the same bytes each time."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from seethrough.renderer.models.forms.shapes import Shape
from seethrough.renderer.models.shipped.assembly_file import assembly_file
from seethrough.renderer.models.shipped.glb import Node, glb
from seethrough.renderer.models.shipped.jeep_file import jeep_file
from seethrough.renderer.models.shipped.office_file import office_file

FOLDER = Path(__file__).parent
SAID = "made by the Seethrough project, of whose licence it is part"
SCENES: dict[str, Callable[[], tuple[list[Node], dict[str, Shape]]]] = {
    "assembly": assembly_file, "jeep": jeep_file, "office": office_file,
}  # fmt: skip


def made(name: str) -> bytes:
    """A scene's file."""
    return glb(*SCENES[name](), SAID)


def main() -> int:
    """Write all of them, and say how large they are."""
    for name in SCENES:
        data = made(name)
        (FOLDER / f"{name}.glb").write_bytes(data)
        print(f"{name}.glb: {len(data)} bytes")
    return 0


if __name__ == "__main__":
    sys.exit(main())
