"""The figure of time against error: a colour a level, and the mean's arrow."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from made_designs import DESIGNS, make_design

from seethrough.analysis.report import Options, figures_of, make_report


def _layers(spec: dict[str, Any]) -> list[dict[str, Any]]:
    rows = spec["vconcat"] if "vconcat" in spec else [spec]
    return [layer for row in rows for panel in row["hconcat"] for layer in panel["layer"]]


def test_levels_have_colours_of_their_own(tmp_path: Path) -> None:
    """Panels share one scale: with a list for each, the second level's colour came back."""
    report = make_report(make_design(tmp_path / "data", DESIGNS["four"]), Options())
    (figure,) = [f for f in figures_of(report.sections) if f.key == "tradeoff"]
    scales = [e["scale"] for layer in _layers(figure.spec)
              if isinstance(e := layer["encoding"].get("color"), dict)]  # fmt: skip
    assert scales
    for scale in scales:
        assert scale == scales[0]
        assert len(set(scale["range"])) == len(scale["domain"]) == 4


def test_the_means_arrow_has_everybodys_means(tmp_path: Path) -> None:
    report = make_report(make_design(tmp_path / "data", DESIGNS["scenes"]), Options())
    (figure,) = [f for f in figures_of(report.sections) if f.key == "tradeoff"]
    tables = {b.key: b for s in report.sections for b in s.blocks if hasattr(b, "rows")}
    row = tables["tests_log_time"].rows[0]
    tips = [v["tip"] for layer in _layers(figure.spec) for v in layer["data"]["values"]
            if str(v.get("tip", "")).startswith("means")]  # fmt: skip
    assert len(tips) == 1
    assert f"{row['geometric_baseline']:.3g} to {row['geometric_level']:.3g} s" in tips[0]
