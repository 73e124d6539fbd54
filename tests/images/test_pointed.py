"""What a click hits is what the exact picture shows most at that pixel, for every technique."""

import numpy as np
import pytest

from seethrough import registry
from seethrough.experiment.display.stage import Stage
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.session.hand import Hand
from seethrough.renderer.events import KeyPress, PointerPress, PointerRelease, Tick
from seethrough.renderer.reference.pointed import NOTHING, pointed
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene import geometry
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import translation
from seethrough.renderer.techniques.base import Shot
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.hud import Mark

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


def test_presses_and_enter_are_told_what_they_hit_where_the_view_aims():
    """A view without an aim tells nothing; other keys and moves are left as they are."""
    standard = registry.get("technique", "standard").Parameters()
    hand = Hand(standard, SIZE[0] / SIZE[1], window=600)
    wall = (SIZE[0] / SIZE[1] / 2 - 0.11, 0.5)
    view = View(scene(), CAMERA, aim=(0.01, 0.01))
    told = hand.pointed(PointerPress(1.0, *wall), view)
    assert (told.thing, told.time) == (0, 1.0)
    assert hand.pointed(KeyPress(1.0, "enter"), view).thing == NOTHING
    at = View(scene(), CAMERA, aim=wall)
    assert hand.pointed(KeyPress(1.0, "space"), at).thing == 0
    for event in (KeyPress(1.0, "w"), PointerRelease(1.0, *wall), Tick(1.0)):
        assert hand.pointed(event, at) is event
    deaf = View(scene(), CAMERA)
    assert hand.pointed(PointerPress(1.0, *wall), deaf).thing is None


def test_marks_are_drawn_over_the_view_where_they_say(context):
    """A ring is red at its radius and leaves its middle free; a cross is red in its middle."""
    size = (160, 120)
    stage = Stage(context, size, Texts("en"))
    target = context.framebuffer([context.texture(size, 4)])
    standard = registry.get("technique", "standard").Parameters()
    for form, middle in (("ring", False), ("cross", True)):
        view = View(Scene(()), CAMERA, (Mark((0.5, 0.5), 0.2, form),))
        stage.draw_view(view, standard, target, 1 / 60)
        pixels = np.frombuffer(target.read(components=3, alignment=1), np.uint8)
        picture = pixels.reshape(120, 160, 3)[::-1].astype(int)
        red = (picture[..., 0] > 150) & (picture[..., 1] < 100)
        assert red[58:63, 58:63].any() == middle
        assert red[56:65, 60 + 22 : 60 + 27].any()  # its right end, at a fifth of the height
        assert not red[:, 100:].any()
