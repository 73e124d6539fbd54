"""Dynamic transparency as Elmqvist2009 (§V) draws it, to be measured against: two passes for each
object in the order of the centres, and for each target a mask by ping-pong in two small buffers.
"""

from __future__ import annotations

import moderngl
import numpy as np

from seethrough.renderer.gpu.device import pipeline
from seethrough.renderer.gpu.device.meshes import MeshStore
from seethrough.renderer.gpu.device.pipeline import MASK, NOTHING, OBJECT
from seethrough.renderer.gpu.device.programs import Shader, program
from seethrough.renderer.gpu.device.scene_table import Run, SceneTable
from seethrough.renderer.gpu.device.targets import FrameTarget
from seethrough.renderer.gpu.levels.lens import clip_from_offset
from seethrough.renderer.plan.planner import plan
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard

CELLS = 128  # the paper's buffers
_WHOLE = """#version 330 core
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
"""
_GROW = """#version 330 core
uniform sampler2D grown;
uniform float ring;
out vec4 picture;
void main() {
    ivec2 cell = ivec2(gl_FragCoord.xy), most = textureSize(grown, 0) - 1;
    picture = texelFetch(grown, cell, 0);
    if (picture.a < 1.0) return;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
            if (texelFetch(grown, clamp(cell + ivec2(x, y), ivec2(0), most), 0).a < 1.0)
                picture.a = ring;
}
"""
_STRETCH = """#version 330 core
uniform sampler2D grown;
uniform vec2 size;
out vec4 picture;
void main() { picture = texture(grown, gl_FragCoord.xy / size); }
"""


class PaperWay:
    """Draws frames of a size; `masks_only` leaves out all but the masks."""

    def __init__(self, context: moderngl.Context, size: tuple[int, int]) -> None:
        self._context = context
        self._store = MeshStore(context)
        self._object = program(context, "object.vert", "object.frag")
        self._depth = program(context, "object.vert", "depth.frag")
        self._constant = self._with_constant()
        self._grow = Shader(context.program(vertex_shader=_WHOLE, fragment_shader=_GROW))
        self._stretch = Shader(context.program(vertex_shader=_WHOLE, fragment_shader=_STRETCH))
        self._grow_array = context.vertex_array(self._grow.program, [])
        self._stretch_array = context.vertex_array(self._stretch.program, [])
        self.target = FrameTarget(context, size)
        self._buffers = [context.texture((CELLS, CELLS), 4) for _ in range(2)]
        self._small = [context.framebuffer([b]) for b in self._buffers]
        self._tables: dict[int, SceneTable] = {}

    def _with_constant(self) -> Shader:
        from seethrough.renderer.gpu.device.programs import _source

        fragment = (
            "#version 330 core\nuniform float opacity;\nout vec4 picture;\n"
            "void main() { picture = vec4(0.0, 0.0, 0.0, opacity); }\n"
        )
        vertex = "#version 330 core\n" + _source("object.vert")
        return Shader(self._context.program(vertex_shader=vertex, fragment_shader=fragment))

    def draw(
        self,
        scene: Scene,
        camera: Camera,
        technique: DynamicTransparency,
        masks_only: bool = False,
    ) -> None:
        """One frame."""
        table = self._tables.setdefault(id(scene), SceneTable(self._context, self._store, scene))
        size = self.target.size
        drawn = plan(scene, camera, Standard(), size).opaque
        depth = camera.depth(scene.group_centers[drawn])
        order = drawn[np.argsort(np.where(scene.impenetrable[drawn], -np.inf, -depth))]
        sequence, runs = table.sequence([np.array([i]) for i in order.tolist()], camera)
        table.table.use(0)
        sequence.use(1)
        matrix = clip_from_offset(camera, size)
        for shader in (self._object, self._depth, self._constant):
            shader["clip_from_offset"].write(matrix)
            shader.set(table=0, sequence=1)
        self.target.clear(scene.background)
        for i, part in zip(order.tolist(), runs, strict=True):
            if not masks_only:
                self._draw_object(part)
            if scene.targets[i]:
                self._draw_mask(part, technique)

    def _draw_object(self, part: list[Run]) -> None:
        context = self._context
        context.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE | moderngl.BLEND)
        context.depth_func = "<="
        for shader, blend in ((self._depth, NOTHING), (self._object, OBJECT)):
            pipeline.blend(context, blend)
            for mesh, first, count in part:
                mesh.draw(context, shader, first, count)

    def _draw_mask(self, part: list[Run], technique: DynamicTransparency) -> None:
        """Algorithm 2: the target into a buffer, n rings, then over the whole frame."""
        context, rings = self._context, round(technique.width)
        self._small[0].use()
        self._small[0].clear(0.0, 0.0, 0.0, 1.0)
        context.enable_only(moderngl.CULL_FACE)
        self._constant.set(opacity=technique.alpha_target)
        for mesh, first, count in part:
            mesh.draw(context, self._constant, first, count)
        context.enable_only(moderngl.NOTHING)
        for k in range(rings):
            self._small[(k + 1) % 2].use()
            self._buffers[k % 2].use(5)
            edge = technique.alpha_edge
            self._grow.set(grown=5, ring=edge + (1 - edge) * k / rings)
            self._grow_array.render(moderngl.TRIANGLES, 3)
        self.target.framebuffer.use()
        context.enable_only(moderngl.BLEND)
        pipeline.blend(context, MASK)
        self._buffers[rings % 2].use(5)
        self._stretch.set(grown=5, size=self.target.size)
        self._stretch_array.render(moderngl.TRIANGLES, 3)
