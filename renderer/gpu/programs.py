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


class Shader:
    """A program whose uniforms are looked up once: asking for one costs a draw."""

    def __init__(self, program: moderngl.Program) -> None:
        self.program = program
        self.members = {name: program[name] for name in program}

    def set(self, **values: object) -> None:
        """Set uniforms, leaving out those that the compiler found unused."""
        for name, value in values.items():
            if name in self.members:
                self.members[name].value = value  # type: ignore[union-attr]

    def __getitem__(self, name: str) -> moderngl.Uniform:
        return self.members[name]  # type: ignore[return-value]


def program(
    context: moderngl.Context,
    vertex: str,
    fragment: str,
    defines: Sequence[str] = (),
    version: int = 330,
) -> Shader:
    """Build a program; `shade()` of renderer.lighting is known to the fragment shader."""
    head = f"#version {version} core\n" + "".join(f"#define {d}\n" for d in defines)
    return Shader(
        context.program(
            vertex_shader=head + _source(vertex),
            fragment_shader=head + lighting.glsl() + _source(fragment),
        )
    )
