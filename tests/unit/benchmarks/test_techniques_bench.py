"""The table of techniques: each measure on a scene where its value is known, and its picture."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seethrough.benchmarks.drawing import techniques as bench
from seethrough.benchmarks.drawing.technique_figure import draw, picture
from seethrough.benchmarks.drawing.technique_ways import Way, ways_of
from seethrough.benchmarks.rows import row
from seethrough.experiment.gallery.gallery_failures import CAMERA, failures
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques import named
from seethrough.renderer.techniques.base import Shot

SIZE = (160, 120)


@pytest.fixture(scope="module")
def renderer():
    return Renderer(standalone(), SIZE, without=frozenset({"still"}))


@pytest.fixture(autouse=True)
def small(monkeypatch):
    monkeypatch.setattr(bench, "SIZE", SIZE)
    monkeypatch.setattr(bench, "LOOKED", SIZE)


def measured(renderer, scene, way):
    """figure → value, for one camera."""
    hidden = [bench._hidden(renderer, scene, CAMERA)]
    path = bench._path("abstract", scene, CAMERA)
    still = [bench._frame(renderer, scene, c, Way(named("standard"), named("standard")))
             for c in path]  # fmt: skip
    rows = [
        *bench._off(renderer, "x: y", scene, [CAMERA], way),
        *bench._shown(renderer, "x: y", scene, [CAMERA], way, hidden),
        bench._pops(renderer, "x: y", scene, path, way, still),
    ]
    return {r["figure"]: r["value"] for r in rows}


def way(name, **changes):
    p = replace(named(name), **changes)
    return Way(p, p)


WALL = failures()["standard"].scene  # a ball behind a wall


def test_the_standard_picture_uncovers_changes_and_loses_nothing(renderer):
    found = measured(renderer, WALL, way("standard"))
    assert found == {
        "error": 0.0, "changed pixels": 0.0, "uncovered, mean": 0.0, "uncovered, least": 0.0,
        "contrast": 0.0, "context left": 100.0, "pops": 0.0,
    }  # fmt: skip


def test_a_hole_uncovers_all_of_the_ball_and_leaves_the_rest_of_the_wall(renderer):
    """The wall is 7 × 5, the hole a disc of .8 and 12 of the window's pixels about it."""
    found = measured(renderer, WALL, way("breakaway"))
    assert found["uncovered, least"] == 100.0 and found["error"] == 0.0
    assert 50 < found["context left"] < 95
    assert found["changed pixels"] > 2


def test_transparency_uncovers_as_much_as_it_lets_through(renderer):
    """One front surface of opacity .3 before the ball: .7 of it shows; of the wall .3 is left."""
    found = measured(renderer, WALL, way("constant", alpha=0.3))
    assert found["uncovered, mean"] == pytest.approx(70.0, abs=0.1)  # 8 bits of the opacity
    assert found["context left"] == pytest.approx(30.0, abs=0.1)


def test_fewer_peels_than_layers_are_in_error_and_all_are_not(renderer):
    scene = failures()["constant"].scene  # twelve panes
    p = named("constant")
    off = {
        count: measured(renderer, scene, Way(replace(p, layers=count), p))["error"]
        for count in (1, 4, 20)
    }
    assert off[1] > off[4] > 1 > off[20] == 0.0


def test_what_jumps_while_everything_stands_still_is_a_pop(renderer):
    """Hands that stay on the view: without a move of anything there is none, by a turn some."""
    scene = failures()["breakaway"].scene
    found = measured(renderer, scene, way("breakaway", margin=0.0, jagged=0.0))
    assert 0 < found["pops"] < 5


def test_hands_reach_for_the_target_in_the_middle(renderer):
    lens = ways_of("lens", Shot(WALL, CAMERA, SIZE))["lens"]
    state = lens.state(Shot(WALL, CAMERA, SIZE))
    assert measured(renderer, WALL, lens)["uncovered, mean"] > 90
    assert state.depth > 9
    nobody = Scene(tuple(o for o in WALL.objects if not o.target))
    assert lens.state(Shot(nobody, CAMERA, SIZE)) == lens.p.technique.begin(lens.p)


def test_the_figure_names_every_way_and_draws_what_is_missing_as_nothing(tmp_path):
    rows = []
    for scene in ("abstract", "jeep"):
        for k, name in enumerate(("cutaway", "constant, 4 peels", "idle")):
            rows.append(row("time", f"{scene}: {name}", 1.0 + k, "×"))
            if name != "idle":
                rows.append(row("error", f"{scene}: {name}", 3.0 * k, "of 255"))
                rows.append(row("context left", f"{scene}: {name}", 50.0, "%"))
                for figure in ("changed pixels", "pops", "contrast", "uncovered, mean",
                               "uncovered, least"):  # fmt: skip
                    if scene == "abstract":
                        rows.append(row(figure, f"{scene}: {name}", 10.0, "%"))
    rows.append(row("adaptive_cutaway: border off by more than 4 px", "jeep", 0.1, "%"))
    rows += [row("time", "jeep: quick", 0.3, "×"), row("error", "jeep: quick", 900.0, "of 255"),
             row("context left", "jeep: quick", 120.0, "%")]  # fmt: skip
    for axes in (axes for part in picture(rows).subfigs for axes in part.axes):
        (left, right), (a, b) = axes.get_xlim(), sorted(axes.get_ylim())
        points = np.concatenate([line.get_xydata() for line in axes.lines])
        shown = points[np.isfinite(points).all(axis=1)]
        assert len(shown) and (left <= shown[:, 0]).all() and (shown[:, 0] <= right).all()
        assert (a <= shown[:, 1]).all() and (shown[:, 1] <= b).all()
    draw(rows, tmp_path / "a.svg")
    text = (tmp_path / "a.svg").read_text("utf-8")
    assert "cutaway  1" in text and "constant, 4 peels  2" in text and "idle" not in text
    assert "walkthrough" not in text and "var(--ink)" in text
