"""Constant transparency in the orders of papers 000 to 003, as a condition: those that cut are
right, those that compare distances are wrong where they have to be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seethrough.experiment import cli
from seethrough.experiment.suites.technique_scenes import cases
from seethrough.experiment.suites.technique_suite import SIZE
from seethrough.renderer.errors import CannotDraw
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.gpu.rules import order_painter
from seethrough.renderer.plan.planner import plan
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.techniques import named

CONSTANT = named("constant")
CASES = {case.name: case for case in cases()}


def share_off(context, case, p):
    """The share of the pixels more than 1/255 off, and how many steps the worst is."""
    renderer = Renderer(context, SIZE)
    renderer.draw(case.scene, case.camera, p)
    truth = exact(case.scene, case.camera, replace(p, order="pixel"), SIZE)
    steps = np.abs(renderer.read() - truth.picture * 255).max(axis=2)[~truth.near_edge]
    return float((steps > 1).mean()), float(steps.max())


@pytest.mark.parametrize("surfaces", ["front", "all"])
@pytest.mark.parametrize("order", ["bsp", "feudal"])
@pytest.mark.parametrize("name", ["room", "close", "mirrored"])
def test_methods_that_cut_are_exact(context, name, order, surfaces):
    """But for pixels whose middle lies on a cut, of which the reference knows nothing: at most one
    in a thousand."""
    off, _ = share_off(context, CASES[name], replace(CONSTANT, order=order, surfaces=surfaces))
    assert off <= 0.001


@pytest.mark.parametrize(
    ("order", "name", "surfaces"),
    [("distance", "room", "front"), ("axis_tree", "room", "front"), ("boxes", "close", "all")],
)
def test_methods_that_cut_nothing_are_wrong_where_things_are_long_or_cross(
    context, order, name, surfaces
):
    """A floor-long wall has no one distance; a box within a shell has two sides of it."""
    off, worst = share_off(context, CASES[name], replace(CONSTANT, order=order, surfaces=surfaces))
    assert off > 0.002 and worst > 4


def test_nothing_of_it_is_left_for_the_next_frame(context):
    """Depth is written again after it: the standard frame is what it was."""
    case, standard = CASES["room"], named("standard")
    renderer = Renderer(context, SIZE)
    renderer.draw(case.scene, case.camera, standard)
    before = renderer.read().copy()
    renderer.draw(case.scene, case.camera, replace(CONSTANT, order="distance"))
    renderer.draw(case.scene, case.camera, standard)
    assert np.array_equal(renderer.read(), before)


def test_too_many_triangles_are_refused_in_a_line(context, monkeypatch):
    monkeypatch.setattr(order_painter, "MOST", 10)
    case = CASES["room"]
    with pytest.raises(CannotDraw, match=r'order = "bsp", expected "pixel" where \d+ triangles'):
        Renderer(context, SIZE).draw(case.scene, case.camera, replace(CONSTANT, order="bsp"))
    monkeypatch.setattr(order_painter, "MOST", 10_000)
    monkeypatch.setattr(order_painter, "MOST_PIECES", 10)
    with pytest.raises(CannotDraw, match='order = "bsp", expected "pixel" where'):
        Renderer(context, SIZE).draw(case.scene, case.camera, replace(CONSTANT, order="bsp"))


def test_a_command_says_so_in_a_line(capsys, tmp_path):
    words = ["render", "jeep", "--technique", "constant", "--set", "order=distance"]
    assert cli.main([*words, "--out", str(tmp_path / "a.png")]) == 2
    said = capsys.readouterr().err
    assert 'order = "distance", expected "pixel"' in said and said.count("\n") == 1


def test_peels_and_an_order_exclude_each_other():
    with pytest.raises(ValueError, match='layers = 4, expected none with order = "bsp"'):
        replace(CONSTANT, order="bsp", layers=4)


def test_what_is_looked_at_and_planned_is_by_pixel(context):
    """Polygons have no numbers of their objects: eyes see the right picture."""
    case = CASES["room"]
    wrong, right = replace(CONSTANT, order="axis_tree"), CONSTANT
    looks = [Renderer(context, SIZE).look(case.scene, case.camera, p, SIZE) for p in (wrong, right)]
    assert np.array_equal(looks[0].area, looks[1].area) and looks[0].area.any()
    ruled = [plan(case.scene, case.camera, p, SIZE).ruled.tolist() for p in (wrong, right)]
    assert ruled[0] == ruled[1] != []
