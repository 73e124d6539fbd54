"""Pairs of pictures of things behind walls: the truth is true, and answers are counted rightly."""

from dataclasses import replace

import numpy as np
import pytest

from seethrough.benchmarks.drawing import pairs
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.techniques import named


@pytest.mark.parametrize("way, floating", [("dynamic", False), ("see_through", True)])
def test_both_things_are_behind_walls_and_shown(context, way, floating):
    renderer = Renderer(context, pairs.SIZE)
    one = pairs.pair(np.random.default_rng(5), renderer, way, floating)
    empty = replace(one.scene, objects=one.scene.objects[:-2])
    drawn = {}
    for technique in ("standard", way):
        for name, scene in (("both", one.scene), ("none", empty)):
            renderer.draw(scene, one.camera, named(technique))
            drawn[technique, name] = renderer.read().astype(int)
    assert np.array_equal(drawn["standard", "both"], drawn["standard", "none"])
    changed = np.abs(drawn[way, "both"] - drawn[way, "none"]).max(axis=2) > 2
    halves = [one.camera.places(one.scene.centers[[k]])[0, 0] for k in (-2, -1)]
    middle = round((sum(halves) / 2) * pairs.SIZE[1] / 2 + pairs.SIZE[0] / 2)
    assert changed[:, :middle].sum() >= pairs.SHOWN < changed[:, middle:].sum()
    spots = np.array([thing.transform[:3, 3] for thing in one.scene.objects[-2:]])
    flat = np.hypot(*(spots - one.camera.eye)[:, [0, 2]].T)
    assert np.allclose(flat, one.far)
    assert pairs.RATIO[0] <= one.far.max() / one.far.min() <= pairs.RATIO[1]
    assert (spots[:, 1] > 0).all() == floating


def test_answers_are_counted_by_cues():
    kinds = {"technique": "dynamic", "things": "standing"}
    truth = {
        "1.png": {"cues": "without", "nearer": "A", **kinds},
        "2.png": {"cues": "with", "nearer": "A", **kinds},
        "3.png": {"cues": "with", "nearer": "B", **kinds},
    }
    answers = {"1.png": "B", "2": "A", "3": "B"}
    lines = pairs.counted(truth, answers)
    assert "all, without cues: 0 of 1 right" in lines
    assert "all, with cues: 2 of 2 right" in lines
    assert "things standing, with cues: 2 of 2 right" in lines
    with pytest.raises(ValueError, match=r"answers to 3\.png: expected A or B"):
        pairs.counted(truth, {"1.png": "B", "2.png": "A", "3.png": "C"})
