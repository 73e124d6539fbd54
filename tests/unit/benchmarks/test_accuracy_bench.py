"""The benchmark of accuracy: its measures, its figure, and what it leaves out."""

from __future__ import annotations

import sys
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from seethrough.benchmarks.drawing import accuracy, vtk_peeling
from seethrough.benchmarks.drawing.breaking import BREAKING
from seethrough.benchmarks.drawing.speed import row
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

CENTERS = DynamicTransparency(order="centers")


def wall_and_target() -> tuple[Scene, object]:
    """A wall whose centre lies behind the target that its near end hides."""
    wall = Object(geometry.box(0.2, 4, 40), transforms.translation(-1.5, 0, -19), (0.7, 0.7, 0.6))
    target = Object(geometry.sphere(0.8, 2), transforms.translation(-4, 0, -9), (1, 0, 0), True)
    camera = look_at(np.zeros(3), np.array([-2.0, 0, -9]), fov_y=0.9, near=0.1, far=100)
    return Scene((wall, target)), camera


def test_a_wrong_order_is_counted_where_the_wall_hides_the_target(context, monkeypatch):
    """By centres the target is drawn last: the wall hides it by depth, nothing shines through."""
    monkeypatch.setattr(accuracy, "SIZE", accuracy.LOOK)
    renderer = Renderer(context, accuracy.LOOK)
    scene, camera = wall_and_target()
    shown = accuracy._shown(renderer, scene, camera)
    pixels = renderer.look(scene, camera, accuracy.EXACT, accuracy.LOOK).pixels[1]
    wrong = accuracy.wrong_order(renderer, scene, camera, CENTERS, shown)
    assert wrong * np.prod(accuracy.LOOK) == pytest.approx(pixels, abs=1)
    for right in (DynamicTransparency(), replace(CENTERS, exact=True)):
        assert accuracy.wrong_order(renderer, scene, camera, right, shown) == 0


def test_differences_of_made_up_pictures():
    """A thousand pixels: one off by 200, nine by 3, the rest right."""
    truth = np.zeros((10, 100, 3), np.uint8)
    picture = truth.copy()
    picture[0, 0, 1], picture[0, 1:10] = 200, 3
    values = {r["figure"]: r["value"] for r in accuracy.errors("x: y", [truth], [picture], 0.5)}
    assert values["pixels off by more than 2/255"] == 1.0
    assert values["mean difference"] == pytest.approx((200 + 27) / 1000)
    assert values["largest difference"] == 200
    # Between the 999th and the 1000th of 1,000 sorted values, at 998.001.
    assert values["99.9th percentile"] == pytest.approx(3 + 0.001 * 197)
    assert next(accuracy.errors("x: y", [truth], [picture], 0.5))["met"] is False


@pytest.mark.parametrize("name", BREAKING)
def test_scenes_that_break_an_order_have_occluded_targets(context, name):
    """In every view something has to be blended, else there is nothing to break."""
    renderer = Renderer(context, (80, 60))
    scene, cameras = BREAKING[name](4 / 3, 2)
    for camera in cameras:
        assert renderer.draw(scene, camera, DynamicTransparency()).masks > 0


def test_the_figure_shows_every_order_in_every_scene(tmp_path):
    """A panel for each scene, a name for each way."""
    rows = [
        row(figure, f"{scene}: {way}", k + 1.0, "", None, None)
        for scene in ("abstract", "jeep")
        for k, way in enumerate(accuracy.WAYS)
        for figure in ("time / standard", "mean difference")
    ]
    rows.append(row("time / standard", "abstract: width 5", 2.0, "×", None, None))
    path = tmp_path / "figure.svg"
    accuracy.chart(rows, path)
    text = path.read_text("utf-8")
    assert text.count("<!-- abstract -->") == text.count("<!-- jeep -->") == 1
    assert all(f"<!-- {way} -->" in text for way in accuracy.WAYS)


def test_without_vtk_its_rows_are_left_out_with_a_line(monkeypatch, capsys):
    """Nothing else of the benchmark depends on it."""
    monkeypatch.setitem(sys.modules, "vtkmodules", None)
    assert list(vtk_peeling.figures(SimpleNamespace(size=(8, 8)))) == []
    assert capsys.readouterr().err == vtk_peeling.LEFT_OUT + "\n"
