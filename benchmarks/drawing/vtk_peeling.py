"""VTK's dual depth peeling on the same triangles, where vtk is installed.

Beside dynamic transparency it is exact: VTK knows no targets, so that every penetrable object gets
the opacity `alpha_target`, and as many layers blend as dynamic transparency could ask for. 100
peels leave none out (0 would peel nothing), and an occlusion ratio of 0 lets none be skipped.
Beside constant opacity both draw all surfaces, each from both sides, in 4 peels, targets and what
is impenetrable opaque. Times are ratios within VTK and within Seethrough, each against its own
opaque frame.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator

import numpy as np

from seethrough.benchmarks.drawing.scenes import SCENES
from seethrough.benchmarks.drawing.speed import drawing, times
from seethrough.benchmarks.rows import Row as Figure
from seethrough.benchmarks.rows import row
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.constant.constant import ConstantParameters
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard

VIEWS, PEELS, FEW = 2, 100, 4
EXACT = DynamicTransparency(exact=True)
LEFT_OUT = "VTK's depth peeling: left out, vtk is not installed (pip install 'seethrough[vtk]')"


class Peeled:
    """A scene in VTK: opaque, or with `opacity` (n,) for each object and so many peels; all its
    surfaces or those that face the eye."""

    def __init__(
        self,
        scene: Scene,
        size: tuple[int, int],
        opacity: np.ndarray | None,
        peels: int = PEELS,
        both_sides: bool = False,
    ) -> None:
        import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (draws)
        from vtkmodules import vtkRenderingCore as core

        self.view = core.vtkRenderer()
        self.view.SetBackground(*scene.background)
        self.window = core.vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(*size)
        self.window.AddRenderer(self.view)
        mapper = core.vtkPolyDataMapper()
        mapper.SetInputData(_poly_data(scene, opacity))
        actor = core.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetBackfaceCulling(not both_sides)
        if opacity is not None:
            actor.ForceTranslucentOn()
            self.window.SetAlphaBitPlanes(1)
            self.view.SetUseDepthPeeling(1)
            self.view.SetMaximumNumberOfPeels(peels)
            self.view.SetOcclusionRatio(0.0)
        self.view.AddActor(actor)

    def draw(self, camera: Camera) -> None:
        """One frame, drawn to its end."""
        seen = self.view.GetActiveCamera()
        seen.SetPosition(*camera.eye)
        seen.SetFocalPoint(*(camera.eye - camera.rotation[:, 2]))
        seen.SetViewUp(*camera.rotation[:, 1])
        seen.SetViewAngle(float(np.degrees(camera.fov_y)))
        seen.SetClippingRange(camera.near, camera.far)
        self.window.Render()
        self.finish()

    def finish(self) -> None:
        """Wait until everything is drawn."""
        self.window.WaitForCompletion()

    def read(self) -> np.ndarray:
        """(h, w, 3) the frame, row 0 on top."""
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

        grab = vtkWindowToImageFilter()
        grab.SetInput(self.window)
        grab.ReadFrontBufferOff()
        grab.Update()
        picture = grab.GetOutput()
        width, height, _ = picture.GetDimensions()
        rows = vtk_to_numpy(picture.GetPointData().GetScalars())
        return rows.reshape(height, width, -1)[::-1, :, :3].copy()


def _poly_data(scene: Scene, opacity: np.ndarray | None) -> object:
    """All triangles of a scene in world space, coloured by vertex."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    points, normals, colors, faces, base = [], [], [], [], 0
    for k, thing in enumerate(scene.objects):
        mesh, matrix = thing.mesh, thing.transform
        points.append(mesh.vertices @ matrix[:3, :3].T + matrix[:3, 3])
        turned = mesh.normals @ np.linalg.inv(matrix[:3, :3])
        normals.append(turned / np.linalg.norm(turned, axis=1, keepdims=True))
        alpha = 1.0 if opacity is None else opacity[k]
        rgba = np.c_[mesh.colors * np.asarray(thing.color), np.full(len(mesh.vertices), alpha)]
        colors.append(np.round(255 * np.clip(rgba, 0, 1)).astype(np.uint8))
        faces.append(mesh.triangles + base)
        base += len(mesh.vertices)
    data, cells, places = vtkPolyData(), vtkCellArray(), vtkPoints()
    places.SetData(numpy_to_vtk(np.concatenate(points).astype(np.float32), deep=True))
    triangles = np.concatenate(faces)
    rows = np.c_[np.full(len(triangles), 3), triangles].astype(np.int64)
    cells.SetCells(len(triangles), numpy_to_vtkIdTypeArray(rows.ravel(), deep=True))
    data.SetPoints(places)
    data.SetPolys(cells)
    data.GetPointData().SetNormals(
        numpy_to_vtk(np.concatenate(normals).astype(np.float32), deep=True)
    )
    paint = np.concatenate(colors) if opacity is not None else np.concatenate(colors)[:, :3]
    data.GetPointData().SetScalars(numpy_to_vtk(np.ascontiguousarray(paint), deep=True))
    return data


def main(size: tuple[int, int], where: list[str], constant: bool) -> None:
    """Print, for each of some scenes, the time of a peeled frame against an opaque one."""
    found = {}
    for name in where:
        scene, cameras = SCENES[name](size[0] / size[1], VIEWS)
        opacity = np.where(scene.impenetrable, 1.0, EXACT.alpha_target)
        if constant:
            opacity = np.where(scene.impenetrable | scene.targets, 1.0, ConstantParameters().alpha)
        opaque = Peeled(scene, size, None)
        peeled = Peeled(scene, size, opacity, FEW if constant else PEELS, both_sides=constant)
        spent = times({"opaque": opaque.draw, "peeled": peeled.draw}, cameras, opaque)
        assert peeled.view.GetLastRenderingUsedDepthPeeling()
        found[name] = spent["peeled"] / spent["opaque"]
    print(json.dumps(found))


def theirs(size: tuple[int, int], where: list[str], constant: bool) -> dict[str, float]:
    """What VTK takes for a frame of each scene over its own opaque one, beside constant opacity or
    beside dynamic transparency; nothing, and a line that says so, without vtk."""
    try:
        import vtkmodules  # noqa: F401
    except ModuleNotFoundError:
        print(LEFT_OUT, file=sys.stderr)
        return {}
    # A process of its own: two libraries cannot share the thread's current OpenGL context.
    code = (
        "from seethrough.benchmarks.drawing.vtk_peeling import main; "
        f"main({size}, {where}, {constant})"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return dict(json.loads(done.stdout.splitlines()[-1]))


def figures(renderer: Renderer) -> Iterator[Figure]:
    """Rows for the three scenes."""
    for name, value in theirs(renderer.size, list(SCENES), constant=False).items():
        scene, cameras = SCENES[name](renderer.size[0] / renderer.size[1], VIEWS)
        ways = {
            "standard": drawing(renderer, scene, Standard()),
            "exact": drawing(renderer, scene, EXACT),
        }
        ours = times(ways, cameras, renderer.context)
        yield row(f"VTK, {PEELS} peels / VTK opaque", name, value, "×", None, None)
        value = ours["exact"] / ours["standard"]
        yield row("exact / standard, beside VTK", name, value, "×", None, None)
