"""What a click hits is what the exact picture shows most at that pixel, for every technique."""

import numpy as np
import pytest

from seethrough import registry
from seethrough.renderer.reference.pointed import NOTHING, pointed
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene import geometry
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import translation
from seethrough.renderer.techniques.base import Shot

SIZE = (48, 36)
CAMERA = look_at(np.array([0.0, 1.0, 9.0]), np.zeros(3), near=0.5, far=30.0)


def scene():
    """A target behind two walls, one of them of glass, another beside, and one that is far off."""
    ball, wall = geometry.sphere(1.0, 2), geometry.box(3.0, 3.0, 0.2)
    return Scene(
        (
            Object(wall, translation(-1.0, 0, 3.0), (0.2, 0.4, 0.8), kind="wall"),
            Object(ball, translation(-1.0, 0, 0), (1, 0, 0), target=True),
            Object(ball, translation(2.2, 0, 0), (0, 0.8, 0), target=True),
            Object(wall, translation(-1.0, 0, -4.0), (0.9, 0.8, 0.1)),
            Object(ball, translation(40.0, 0, -8.0), (0, 0, 1)),
        )
    )


@pytest.mark.parametrize("name", registry.known("technique"))
def test_a_click_hits_what_shows_most(name):
    """Every pixel that the reference is sure of."""
    technique = registry.get("technique", name)
    p = technique.Parameters()
    state, place = technique.begin(p), scene()
    picture = exact(place, CAMERA, p, SIZE)
    shot = Shot(place, CAMERA, SIZE)
    own = len(place.objects)
    checked = 0
    for row in range(1, SIZE[1], 5):
        for column in range(1, SIZE[0], 5):
            shares = picture.weights[:, row, column]
            rest = 1 - shares.sum()
            order = np.sort([*shares, rest])
            if picture.near_edge[row, column] or order[-1] - order[-2] < 1e-6:
                continue
            best = int(np.argmax([*shares, rest]))
            at = ((column + 0.5) / SIZE[1], (row + 0.5) / SIZE[1])
            assert pointed(shot, p, state, at) == (best if best < own else NOTHING)
            checked += 1
    assert checked > 40


def test_glass_is_clicked_through_and_a_wall_is_not():
    """The same place: through a body that shows a third the target is hit, else the wall."""
    constant, standard = (registry.get("technique", n) for n in ("constant", "standard"))
    middle = (SIZE[0] / SIZE[1] / 2 - 0.11, 0.5)
    shot = Shot(scene(), CAMERA, SIZE)
    glass = constant.Parameters(alpha=0.3)
    assert pointed(shot, glass, constant.begin(glass), middle) == 1
    plain = standard.Parameters()
    assert pointed(shot, plain, None, middle) == 0
