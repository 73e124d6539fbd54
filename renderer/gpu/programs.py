"""Shader programs, from the files in renderer/shaders."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from importlib.resources import files

import moderngl

from renderer import lighting


@cache
def _source(name: str) -> str:
    return files("renderer").joinpath("shaders", name).read_text(encoding="utf-8")


def program(
    context: moderngl.Context,
    vertex: str,
    fragment: str,
    defines: Sequence[str] = (),
    version: int = 330,
) -> moderngl.Program:
    """Build a program; `shade()` of renderer.lighting is known to the fragment shader."""
    head = f"#version {version} core\n" + "".join(f"#define {d}\n" for d in defines)
    return context.program(
        vertex_shader=head + _source(vertex),
        fragment_shader=head + lighting.glsl() + _source(fragment),
    )


def set_uniform(shader: moderngl.Program, name: str, value: object) -> None:
    """Set a uniform, unless the compiler found it unused."""
    if name in shader:
        shader[name].value = value  # type: ignore[union-attr]
