"""The commands `render` and `gallery`: pictures on disk, one line for bad input."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from seethrough.experiment.cli import main
from seethrough.experiment.gallery import gallery_hard
from seethrough.experiment.gallery.gallery_plates import Section
from seethrough.experiment.gallery.gallery_scenes import sections
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.techniques.dynamic.dynamic_transparency import GRANULARITIES, MASKS, MODES


def test_a_picture_is_written_and_explained(tmp_path, capsys):
    """The size asked for, something in it, and the reasons on request."""
    out = tmp_path / "a.png"
    words = ["render", "abstract", "--size", "120x90", "--out", str(out), "--explain"]
    assert main([*words, "--without", "hulls", "--set", "width=5"]) == 0
    picture = np.asarray(Image.open(out))
    assert picture.shape == (90, 120, 3)
    assert picture.std() > 5
    text = capsys.readouterr().out
    assert "200 objects" in text
    assert "shortcuts taken: cull, opaque, masks, levels, prepass, counting" in text


@pytest.mark.parametrize(
    ("extra", "message"),
    [
        (["--size", "0x10"], "--size = 0x10: expected WIDTHxHEIGHT"),
        (["--seed", "-1"], "--seed = -1: expected a number ≥ 0"),
        (["--samples", "99"], "--samples = 99: expected a number from 0 to 16"),
        (["--set", "mask=square"], "mask = 'square', expected one of"),
        (["--set", "mask=[['a']]"], "mask = [['a']], expected one of"),
        (["--set", "exact=yes"], "exact = 'yes', expected true or false"),
        (["--set", "exact=1"], "exact = 1, expected true or false"),
        (["--technique", "see_through", "--set", "kinds=3"], "kinds = 3, expected an array of tex"),
        (["--technique", "see_through", "--set", "kinds=[3]"], "kinds = [3], expected an array of"),
        (["--look", "fog=-3"], "look: fog = -3, expected a number from 0 to 1000000"),
        (
            ["--look", "mist=3"],
            "--look = mist=3: expected KEY=VALUE with one of antialiasing, ",
        ),
        (["--set", "depth=3"], "--set = depth=3: expected KEY=VALUE with one of"),
        (["--without", "luck"], "--without = luck: expected one of cull"),
        (["--out", "a.jpg"], "--out = a.jpg: expected a name that ends in .png"),
        (["--out", "no/where/a.png"], "expected an existing folder"),
    ],
)
def test_bad_input_is_one_line_and_status_two(tmp_path, capsys, extra, message):
    """Never a traceback."""
    words = ["render", "abstract", "--out", str(tmp_path / "a.png"), *extra]
    assert main(words) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1


def test_the_gallery_shows_every_mask_granularity_and_mode():
    """By the names of its pictures, each once."""
    names = [plate.name for section in sections(4 / 3) for plate in section.plates]
    assert len(set(names)) == len(names)
    assert {f"mask-{mask}" for mask in MASKS} <= set(names)
    assert {f"granularity-{granularity}" for granularity in GRANULARITIES} <= set(names)
    assert {f"mode-{mode}" for mode in MODES} <= set(names)
    assert {"layers-1", "model-additive", "combine-min", "kept", "impenetrable"} <= set(names)
    hard = ("inside", "face", "tiny", "half", "behind", "near-plane", "long-wall", "line-50")
    meeting = ("crossing", "links", "touch", "coincide", "plane", "dolls", "million", "near-far")
    assert {f"hard-{name}" for name in (*hard, *meeting, "targets-0", "targets-200")} <= set(names)


def test_the_page_shows_the_pictures_and_what_is_refused(tmp_path, capsys, monkeypatch):
    """Each picture is written in its size, with words for those who do not see it."""
    first = next(gallery_hard._numbers())
    odd = replace(first, name="odd", caption="7 < 30", size=(30, 7))
    refused = tuple(gallery_hard._refused())
    some = [Section("Some & few", "", (first, odd)), Section("Refused", "", (), refused)]
    monkeypatch.setattr(
        "seethrough.experiment.commands.pictures.gallery.sections", lambda *_: iter(some)
    )
    assert main(["gallery", "--out", str(tmp_path / "out")]) == 0
    assert capsys.readouterr().out.endswith("index.html: 2 pictures\n")
    page = (tmp_path / "out" / "index.html").read_text("utf-8")
    assert '<img src="odd.png" alt="7 &lt; 30"' in page and "Some &amp; few" in page
    assert "transform of lamp has a value that is not finite" in page
    assert "alpha_target = 1.5" in page and "mask = &#x27;square&#x27;" in page
    assert len(refused) == 4
    for plate in (first, odd):
        with Image.open(tmp_path / "out" / f"{plate.name}.png") as picture:
            assert picture.size == plate.size


@pytest.mark.parametrize("name", ["abstract-dynamic", "walkthrough-standard", "jeep-dynamic"])
def test_the_pictures_of_the_readme_are_the_gallerys(name, tmp_path, context):
    """Drawn again, they look the same: drivers and roundings may differ at edges."""
    kept = Path(__file__).parents[3] / "docs" / "pictures" / f"{name}.png"
    plate = next(p for s in sections(4 / 3) for p in s.plates if p.name == name)
    renderer = Renderer(context, plate.size, samples=4)
    renderer.draw(plate.scene, plate.camera, plate.technique)
    with Image.open(kept) as picture:
        then = np.asarray(picture.convert("RGB")).astype(int)
    apart = np.abs(renderer.read() - then).max(axis=2)
    # Roundings differ between drivers by a step or two, coverage at edges by more.
    assert (apart > 2).mean() < 0.02
    assert kept.stat().st_size < 300 * 1024
