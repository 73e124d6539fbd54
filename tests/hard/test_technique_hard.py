"""Every technique but dynamic (tests/hard/test_render_hard.py) where pictures break."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seethrough import registry
from seethrough.experiment.gallery.gallery_techniques import placed
from seethrough.experiment.suites.technique_hard import coplanar, deep, flat_and_behind, many
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.base import Shot

NAMES = [name for name in registry.known("technique") if name != "dynamic"]


def apart(context, name, case, size):
    """Steps of 255 by which the exact picture and the drawn one differ, where they may not, and
    the share of the pixels that is left out."""
    scene, camera = case.scene, case.camera
    p, state = placed(name, Shot(scene, camera, size), 9.0)
    p = p.technique.exactly(p)
    renderer = Renderer(context, size)
    renderer.draw(scene, camera, p, state=state)
    truth = exact(scene, camera, p, size, state)
    steps = np.abs(renderer.read() - truth.picture * 255).max(axis=2)[~truth.near_edge]
    return steps.max(initial=0.0), truth.near_edge.mean()


@pytest.mark.parametrize("make", [many, deep, coplanar])
@pytest.mark.parametrize("name", NAMES)
def test_many_deep_and_coplanar(context, name, make):
    """Within 1/255, what lies in one plane being left out: nobody says which of it is in front."""
    steps, left_out = apart(context, name, make(), (96, 72))
    assert steps <= 1.0
    # Edges of 300 small things, dilated for blueprint, whose lines look at neighbours.
    assert left_out <= (0.2 if make is coplanar or name == "blueprint" else 0.06)


@pytest.mark.parametrize("name", NAMES)
def test_targets_without_volume_behind_the_viewer_and_cut_by_the_near_plane(context, name):
    """They take part as far as they are there."""
    steps, left_out = apart(context, name, flat_and_behind(), (96, 72))
    assert steps <= 1.0 and left_out <= 0.06


@pytest.mark.parametrize("size", [(1, 1), (301, 7)])
@pytest.mark.parametrize("name", NAMES)
def test_pictures_of_odd_sizes(context, name, size):
    """A single pixel, and a strip."""
    assert apart(context, name, many(), size)[0] <= 1.0


@pytest.mark.parametrize("name", NAMES)
def test_scenes_without_targets_or_without_anything(context, name):
    """They are drawn, and what there is shows."""
    case = many()
    others = Scene(tuple(o for o in case.scene.objects if not o.target))
    assert apart(context, name, replace(case, scene=others), (48, 36))[0] <= 1.0
    nothing = replace(case, scene=Scene(()))
    assert apart(context, name, nothing, (48, 36)) == (pytest.approx(0, abs=0.51), 0.0)
