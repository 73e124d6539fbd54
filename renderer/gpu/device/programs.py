"""Shader programs, from the files in renderer/shaders."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING

import moderngl

from seethrough.renderer.look.shaders import GLSL
from seethrough.renderer.scene import lighting

if TYPE_CHECKING:
    from jinja2 import Template

LIT = """
#ifdef FLOOR_FLAT
vec3 lit(vec3 color, vec3 normal, vec3 offset) {
    float head = -dot(floor_light.xyz, offset) * inversesqrt(dot(offset, offset));
    return painted(min(floor_color * bright(floor_light.w, head), 1.0), normal, offset);
}
#else
vec3 lit(vec3 color, vec3 normal, vec3 offset) {
    return painted(min(color * shade(normal, -offset), 1.0), normal, offset);
}
#endif
"""


@cache
def _source(name: str) -> str:
    return files("seethrough.renderer").joinpath("shaders", name).read_text(encoding="utf-8")


class Shader:
    """A program whose uniforms are looked up once, and set when they change: each costs a draw."""

    def __init__(self, program: moderngl.Program) -> None:
        self.program = program
        members = {name: program[name] for name in program}
        self.members = frozenset(members)
        self._uniforms = {n: m for n, m in members.items() if isinstance(m, moderngl.Uniform)}
        self._values: dict[str, object] = {}

    def set(self, **values: object) -> None:
        """Set uniforms, leaving out those that the compiler found unused."""
        for name, value in values.items():
            if name in self._uniforms and self._values.get(name) != value:
                self._uniforms[name].value = value
                self._values[name] = value

    def __getitem__(self, name: str) -> moderngl.Uniform:
        return self._uniforms[name]


def program(
    context: moderngl.Context,
    vertex: str,
    fragment: str,
    defines: Sequence[str] = (),
    version: int = 330,
    values: Mapping[str, object] | None = None,
) -> Shader:
    """Build a program. Fragment shaders know `lit()`, a surface's colour in the light of
    renderer/scene/lighting.py with what is drawn on it, and `hazed()`, that colour from where the
    eye is (renderer/look). Both files are templates if `values` are given."""
    head = f"#version {version} core\n" + "".join(f"#define {d}\n" for d in defines)
    sources = [_source(n) if values is None else _filled_in(n, values) for n in (vertex, fragment)]
    return Shader(
        context.program(
            vertex_shader=head + lighting.glsl() + sources[0],
            fragment_shader=head + lighting.glsl() + GLSL + LIT + sources[1],
        )
    )


def _filled_in(name: str, values: Mapping[str, object]) -> str:
    return _template(name).render(values)


@cache
def _template(name: str) -> Template:
    """To read one takes several times as long as to fill it in."""
    from jinja2 import Environment  # for the few frames that need it

    return Environment(line_statement_prefix="%").from_string(_source(name))
