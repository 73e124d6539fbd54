"""A technique's rule as a shader, with what it looks up: uniforms, and pictures of one number."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device.context import REQUIRED
from seethrough.renderer.gpu.device.programs import Shader, program
from seethrough.renderer.gpu.device.reused import kept
from seethrough.renderer.gpu.device.scene_table import Run, SceneTable
from seethrough.renderer.gpu.rules.scope import looked_up
from seethrough.renderer.plan.frame_plan import FramePlan
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.techniques.base import Parameters, Plain, Shot

PICTURES = 5  # the first texture unit of a rule's pictures


@dataclass(frozen=True, eq=False)
class Ruled:
    """What a rule's painter draws in a frame: the plan's ruled objects of a scene in its `table`,
    by a technique in a state; `matrix` is clip ← (world − eye)."""

    table: SceneTable
    frame: FramePlan
    technique: Parameters
    state: object
    shot: Shot
    matrix: bytes


class RulePrograms:
    """The programs of all techniques that were drawn, and their pictures."""

    def __init__(
        self, context: moderngl.Context, defines: Sequence[str], version: int = REQUIRED
    ) -> None:
        self._context, self._defines, self._version = context, ["RULED", *defines], version
        self._programs: dict[str, Shader] = {}
        self._pictures: dict[str, moderngl.Texture] = {}
        self._depth = program(context, "object.vert", "view_depth.frag")
        self._framebuffers: dict[tuple[int, int], moderngl.Framebuffer] = {}

    def ready(self, ruled: Ruled) -> Shader:
        """The technique's program with everything set but the sequence. Binds a framebuffer where
        the technique needs to know the targets' depth."""
        return self.prepared(ruled)[0]

    def prepared(self, ruled: Ruled) -> tuple[Shader, Mapping[str, NDArray[np.float32]]]:
        """The same, and the pictures that it looks up, as far as they were made on the CPU."""
        technique, state, shot, table = ruled.technique, ruled.state, ruled.shot, ruled.table
        rules = technique.technique
        # What a rule needs as it is drawn stays on the GPU; what it makes pictures of comes down.
        direct = rules.needs and getattr(type(rules), "pictures", None) is Plain.pictures
        needed = {} if direct else self.needed(table, technique, shot, ruled.matrix)
        if direct:
            self._draw_target_depth(table, shot, ruled.matrix)
        if rules.glsl not in self._programs:
            values = {"rule": rules.glsl}
            self._programs[rules.glsl] = program(
                self._context, "object.vert", "rule.frag", self._defines, self._version, values
            )
        shader = self._programs[rules.glsl]
        use(shader, shot.camera, ruled.matrix)
        table.set_look(shader, shot.camera, shot.size[1])
        shader.set(size=shot.size, lens=shot.camera.lens(shot.size[1]))
        for name, value in rules.uniforms(technique, state, shot).items():
            if name in shader.members:
                member: Any = shader[name]
                member.value = value
        shader.set(upright=not direct)
        if direct:
            depths = self._framebuffers[shot.size].color_attachments[0]
            assert isinstance(depths, moderngl.Texture)
            depths.use(PICTURES)
            shader.set(target_depth=PICTURES)
            return shader, {}
        part = looked_up(ruled.frame, shot.size)
        pictures = rules.pictures(technique, state, replace(shot, part=part), needed)
        for unit, (name, picture) in enumerate(sorted(pictures.items()), PICTURES):
            if name in shader.members:
                self._upload(name, picture, part).use(unit)
                shader.set(**{name: unit})
        return shader, pictures

    def needed(
        self, table: SceneTable, technique: Parameters, shot: Shot, matrix: bytes
    ) -> dict[str, NDArray[np.float32]]:
        """Name → (h, w) of the pictures that the technique needs."""
        rules = technique.technique
        return {name: self._target_depth(table, shot, matrix) for name in sorted(rules.needs)}

    def _upload(
        self, name: str, picture: NDArray[np.float32], part: tuple[int, int, int, int]
    ) -> moderngl.Texture:
        left, top, right, bottom = part
        size = (picture.shape[1], picture.shape[0])
        if name not in self._pictures or self._pictures[name].size != size:
            if name in self._pictures:
                self._pictures.pop(name).release()
            texture = kept(self._context.texture(size, 1, dtype="f4"))
            texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
            self._pictures[name] = texture
        rows = np.ascontiguousarray(picture[top:bottom, left:right], dtype="f4")
        self._pictures[name].write(rows, viewport=(left, top, right - left, bottom - top))
        return self._pictures[name]

    def _target_depth(self, table: SceneTable, shot: Shot, matrix: bytes) -> NDArray[np.float32]:
        """(h, w) view depth of the farthest front-facing surface of a target; 0 where there is
        none."""
        framebuffer = self._draw_target_depth(table, shot, matrix)
        data = framebuffer.read(components=1, dtype="f4", alignment=1)
        return np.frombuffer(data, "f4").reshape(shot.size[1], shot.size[0])[::-1]

    def _draw_target_depth(
        self, table: SceneTable, shot: Shot, matrix: bytes
    ) -> moderngl.Framebuffer:
        if shot.size not in self._framebuffers:
            for old in self._framebuffers.values():
                old.release()
            texture = kept(self._context.texture(shot.size, 1, dtype="f4"))
            texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
            depth = kept(self._context.depth_renderbuffer(shot.size))
            self._framebuffers = {shot.size: self._context.framebuffer([texture], depth)}
        framebuffer = self._framebuffers[shot.size]
        framebuffer.clear(depth=0.0)
        framebuffer.use()
        scene = shot.scene
        targets = np.nonzero(scene.targets & shot.boxes.inside)[0]
        sequence, runs = table.sequence([targets], shot.camera)
        self._context.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        self._context.depth_func = ">"
        draw(self._context, self._depth, table, sequence, runs[0], shot.camera, matrix)
        return framebuffer


def use(shader: Shader, camera: Camera, matrix: bytes) -> None:
    """Set what every program over objects takes."""
    shader["clip_from_offset"].write(matrix)
    right, up, back = (tuple(axis) for axis in camera.rotation.T.tolist())
    forward = tuple(-x for x in back)
    shader.set(table=0, sequence=1, right=right, up=up, forward=forward)


def draw(
    context: moderngl.Context,
    shader: Shader,
    table: SceneTable,
    sequence: moderngl.Texture,
    runs: list[Run],
    camera: Camera,
    matrix: bytes,
) -> None:
    """Draw objects of the sequence into the bound framebuffer."""
    table.table.use(0)
    sequence.use(1)
    use(shader, camera, matrix)
    for mesh, start, count in runs:
        mesh.draw(context, shader, start, count)


def numbers(technique: Parameters, shot: Shot) -> NDArray[np.float64]:
    """(n,) the technique's own number of each object."""
    return np.asarray(technique.technique.objects(technique, shot.scene), dtype=float)
