"""`seethrough bench ordering_accuracy` on a tiny scene: its rows, its figure, what it advises."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

from seethrough.benchmarks.orderings import ordering_accuracy, ordering_exactness, paper_figures
from seethrough.benchmarks.orderings.ordering_advice import advice
from seethrough.benchmarks.orderings.ordering_exactness import edge_distance
from seethrough.experiment import cli
from seethrough.renderer.models.translucent.scenes import panels
from seethrough.renderer.polygons.polygons import polygons_from
from seethrough.renderer.scene.camera import look_at

TINY = ("fence",)
KEYS = {"figure", "scene", "value", "unit", "must", "aim", "met"}


def test_the_command_prints_rows_and_advice_and_writes_them(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(ordering_accuracy, "SCENES", TINY)
    defaults = {"figures": (TINY, 2), "measure": (1, 1)}
    monkeypatch.setattr(ordering_exactness.figures, "__defaults__", defaults["figures"])
    monkeypatch.setattr(ordering_accuracy.measure, "__defaults__", defaults["measure"])
    file = tmp_path / "rows.json"
    assert cli.main(["bench", "ordering_accuracy", "--json", str(file)]) == 0
    rows = json.loads(file.read_text("utf-8"))
    said = capsys.readouterr().out.splitlines()
    assert len(rows) == 2 * 3 + 4 * 18
    assert all(set(row) == KEYS and np.isfinite(row["value"]) for row in rows)
    assert len({(row["figure"], row["scene"]) for row in rows}) == len(rows)
    assert [row for row in rows if row["must"] is not None and not row["met"]] == []
    assert len(said) == len(rows) + 2
    results = ordering_accuracy.results_of(rows)
    # Which of the exact ways is quickest is for the clock to say, on whatever machine this is.
    assert said[-1].startswith("Polygons that stand still, intersecting or not: ")
    assert said[-1] == advice(results)
    assert rows[6:] == list(ordering_accuracy.rows(results))
    by = {result["way"]: result for result in results}
    assert by["exact list"]["rmse"] == 0
    assert by["feudal static (002)"]["rmse"] < 0.1 * by["unsorted"]["rmse"]
    ordering_accuracy.draw_figure(results, tmp_path / "figure.svg")
    drawn = ElementTree.parse(tmp_path / "figure.svg").getroot()
    text = " ".join(drawn.itertext())
    assert "fence" in text and "exact list" in text and "prefers-color-scheme: dark" in text


def result(way, rmse, over, frame, prepare=0.0, scene="one"):
    return {
        "scene": scene, "way": way, "rmse": rmse, "over": over, "frame_ms": frame,
        "prepare_ms": prepare,
    }  # fmt: skip


def test_advice_follows_the_numbers():
    results = [
        result("bsp", 0.1, 0.01, 4.0, 20.0),
        result("feudal", 0.1, 0.3, 3.0, 80.0),
        result("distance", 2.0, 5.0, 2.0),
        result("view depth", 3.0, 5.0, 3.0),
        result("unsorted", 8.0, 30.0, 2.0),
        result("depth peeling, 4", 1.0, 3.0, 8.0),
        result("depth peeling, 8", 0.0, 0.0, 14.0),
        result("exact list", 0.0, 0.0, 20.0),
    ]
    text = advice(results)
    assert "still, intersecting or not: bsp, at most 0.01 % of the pixels off, at 2 ×" in text
    assert "feudal" not in text  # three pixels in a thousand are off
    assert "does no harm: distance, 2–2/255 off, 4 × nearer than unsorted, at 1 ×" in text
    assert "depth peeling, 8 passes, exact at 7 ×" in text
    never = text.partition("in every scene: ")[2]
    assert never == "view depth; depth peeling, 4; exact list."


def test_a_way_is_never_the_best_only_if_another_is_better_in_every_scene():
    results = [
        result("one", 1.0, 1.0, 2.0),
        result("unsorted", 0.5, 1.0, 1.0),
        result("one", 1.0, 1.0, 2.0, scene="two"),
        result("unsorted", 1.5, 1.0, 1.0, scene="two"),
    ]
    assert "Preparation aside" not in advice(results)
    results[3]["rmse"] = 0.9
    assert advice(results).endswith("in every scene: one.")


def test_distance_to_the_nearest_edge_is_in_pixels():
    """A square of 2 × 2 seen from straight ahead: 25 pixels a unit from the middle outwards."""
    square = polygons_from([[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]])
    camera = look_at(np.array([0.0, 0.0, 4.0]), np.zeros(3), fov_y=2 * np.arctan(0.5))
    pixels = np.zeros((100, 140), bool)
    pixels[50, 70] = pixels[50, 95] = pixels[20, 70] = True
    found = edge_distance(pixels, square, camera)
    # Row 0 is on top: the upper edge lies at row 25, the right one at column 95.
    assert found == pytest.approx([25 - 20.5, 24.5, 0.5], abs=1e-9)


def test_frame_rates_are_of_every_way(monkeypatch, tmp_path):
    monkeypatch.setattr(paper_figures, "RATED", (80, 60))
    rates = paper_figures.frame_rates(panels(5))
    assert set(rates) == {"ordered and drawn", "drawn unsorted", "ordered only"}
    assert min(rates.values()) > 0
    paper_figures.draw_rates({5: rates, 10: rates}, tmp_path / "rates.svg")
    assert "frames per second" in (tmp_path / "rates.svg").read_text("utf-8")


def test_unblended_hides_unsorted_is_wrong_sorted_is_exact(monkeypatch):
    monkeypatch.setattr(paper_figures, "SIZE", (120, 90))
    monkeypatch.setitem(paper_figures.VIEWS, "panels20", ((0.4, 0.28, 1.0), 1.22))
    ways = paper_figures.three_ways(panels(20))
    assert list(ways) == ["unblended", "unsorted", "sorted"]
    assert ways["unblended"][1] > 0.1 and ways["unsorted"][1] > 0.05
    # Sides that meet are equally deep along their edge: there rounding decides.
    assert ways["sorted"][1] <= 1e-3
