"""Pictures smaller and larger than the window: widths in pixels of the window go with them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seethrough.experiment.suites import technique_scenes as scenes
from seethrough.experiment.suites.technique_scale import at_half
from seethrough.experiment.suites.variants import pairwise
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.techniques.breakaway.breakaway import Breakaway, BreakawayParameters
from seethrough.renderer.techniques.importance import importance
from seethrough.renderer.techniques.importance.importance import ImportanceParameters


class Wide(Breakaway):
    """A hole whose margin is as many pixels in every picture, by its rule and by its shader."""

    def __init__(self):
        class Parameters(BreakawayParameters):
            pass

        self.Parameters = Parameters
        super().__init__()

    def touches(self, p, state, shot):
        return super().touches(p, state, replace(shot, scale=1.0))

    def known(self, p, state, seen):
        return super().known(p, state, replace(seen, shot=replace(seen.shot, scale=1.0)))

    def rule(self, p, state, seen, known):
        return super().rule(p, state, replace(seen, shot=replace(seen.shot, scale=1.0)), known)

    def uniforms(self, p, state, shot):
        return super().uniforms(p, state, replace(shot, scale=1.0))

    def pictures(self, p, state, shot, needed):
        return super().pictures(p, state, replace(shot, scale=1.0), needed)


def halved(technique, context):
    variants = pairwise(technique.Parameters(), np.random.default_rng(11))
    return at_half(variants, scenes.cases(), scenes.covered(), context)


def test_the_suite_notices_widths_that_do_not_shrink(context):
    """It is its own reference at half size: only the window's picture tells."""
    found = halved(Wide(), context)
    assert not found.holds and "0.00 % of the pixels" not in found.said


def test_the_suite_notices_a_pattern_that_is_not_met_whole(context, monkeypatch):
    """A small picture's pixels meet one cell in four, always the same ones: .25 of them are none,
    in the rule and in the shader alike."""
    monkeypatch.setattr(importance, "_cell", lambda shot: shot.scale)
    found = halved(importance.TECHNIQUE, context)
    assert not found.holds and "within 0.6" in found.said


DOOR = ImportanceParameters(style="screen door", least=0.3)


@pytest.mark.parametrize("scale", [1.0, 1.5, 2.0, 3.0])
def test_a_screen_door_grows_with_a_larger_picture(context, scale):
    """Before the target, each cell of the window's pattern is so many pixels wide and high."""
    case, window = scenes.covered(), (96, 72)
    size = (round(96 * scale), round(72 * scale))
    renderer = Renderer(context, size, window=window[1])
    renderer.draw(case.scene, case.camera, DOOR)
    truth = exact(case.scene, case.camera, DOOR, size, scale=scale)
    drawn = renderer.read()
    apart = np.abs(drawn - truth.picture * 255).max(axis=2)[~truth.near_edge]
    assert apart.max() <= 1.0  # half of it rounding to 8 bits
    small = Renderer(context, window)
    small.draw(case.scene, case.camera, DOOR)
    # Red is the target, which shows wherever a cell is open.
    open_, wide = (p[..., 0] > 1.5 * p[..., 1] for p in (small.read(), drawn))
    rows, columns = (((np.arange(n) + 0.5) / scale).astype(int) for n in wide.shape)
    middle = (rows[:, None] // 12 % 6 // 2 == 1) & (columns // 16 % 6 // 2 == 1)
    assert (wide == open_[rows[:, None], columns])[middle].all()
    assert open_[24:48, 32:64].mean() == 11 / 16  # 5 of 16 cells are closed for .3
