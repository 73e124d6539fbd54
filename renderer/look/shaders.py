"""What shaders are told of a look: constants of the source, so that what is off costs nothing."""

from __future__ import annotations

from collections.abc import Sequence

from seethrough.renderer.look import floor, fog
from seethrough.renderer.scene.look import Look
from seethrough.renderer.scene.scene import Color

GLSL = floor.GLSL + fog.GLSL


def defines(look: Look, background: Color) -> tuple[str, ...]:
    """The lines after #define."""
    found: list[str] = []
    if look.has_floor:
        found.append("FLOOR")
    if look.floor_grid > 0:
        found.append(f"FLOOR_GRID {_number(look.floor_grid)}")
    if look.ground_shadows > 0:
        found.append("FLOOR_SHADOWS")
    if look.fog > 0:
        rgb = ", ".join(_number(c) for c in background)
        found += [
            f"FOG_COLOR vec3({rgb})",
            f"FOG_RATE {_number(1 / look.fog)}",
            f"FOG_START {_number(look.fog_start)}",
        ]
    return tuple(found)


def beside_floors(look: Sequence[str]) -> tuple[str, ...]:
    """Those of the lines that what is no floor has to be drawn with: nothing is asked of it then,
    which on a software rasteriser is worth a program of its own."""
    return tuple(line for line in look if not line.startswith("FLOOR"))


def _number(value: float) -> str:
    """As GLSL reads it: always a floating-point number."""
    return f"{value:.9e}"
