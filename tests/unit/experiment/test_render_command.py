"""The commands `render` and `gallery`: pictures on disk, one line for bad input."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from experiment.cli import main
from experiment.gallery import plates
from renderer.techniques.dynamic import GRANULARITIES, MASKS


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
    names = [plate.name for plate in plates(4 / 3)]
    assert len(set(names)) == len(names)
    for mask in MASKS:
        assert f"mask-{mask}" in names
    for granularity in GRANULARITIES:
        assert f"granularity-{granularity}" in names
    assert {"mode-active", "layers-1", "model-additive", "hard-dolls"} <= set(names)
