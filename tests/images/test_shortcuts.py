"""Every shortcut leaves the picture as it is, and leaves work out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from sample_scenes import before_column, column, room

from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.models.vehicles.jeep import jeep_scene
from seethrough.renderer.plan.frame_plan import SHORTCUTS
from seethrough.renderer.scene import transforms
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques import named
from seethrough.renderer.techniques.base import Shot
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.removal import CAPS
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.kit.controls import orbit
from seethrough.tasks.worlds.abstract.abstract_scene import AbstractParameters, abstract_scene

SIZE = (160, 120)
TECHNIQUE = DynamicTransparency(width=8, min_transmittance=0.2, doubt=0.0)
SCENES = {
    "column": (column(1, impenetrable=0.2), before_column(1)),
    "row of targets": (column(6, targets=0.8), before_column(6)),
    "room": room(),
}


def drawn(context, scene, camera, without, technique=TECHNIQUE):
    renderer = Renderer(context, SIZE, without=without)
    stats = renderer.draw(scene, camera, technique)
    return renderer.read().astype(int), stats, renderer.plan


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("shortcut", sorted(SHORTCUTS))
def test_the_long_way_gives_the_same_picture(context, name, shortcut):
    """Equal in every pixel; a hull's distance and a looked-up one, or a blended and a sorted
    pixel, may differ by rounding."""
    scene, camera = SCENES[name]
    short, _, _ = drawn(context, scene, camera, frozenset())
    long, _, _ = drawn(context, scene, camera, frozenset({shortcut}))
    allowed = 1 if shortcut in ("hulls", "parts") else 0
    assert np.abs(short - long).max() <= allowed


HOLES = ("cutaway", "breakaway", "adaptive_cutaway")


@pytest.mark.parametrize("cap", CAPS)
@pytest.mark.parametrize("name", HOLES)
def test_what_a_hole_takes_or_leaves_whole_is_sorted_out_without_a_trace(context, name, cap):
    """Equal in every pixel over worlds of many convex things and rooms, walked into; and in the
    worlds less is drawn."""
    technique = replace(named(name), cap=cap)
    renderers = [Renderer(context, SIZE, without=w) for w in ({"still"}, {"still", "removed"})]
    fewer = 0
    for seed in range(6):
        world = abstract_scene(np.random.default_rng(seed), AbstractParameters())
        ahead = orbit(AbstractParameters(), 4 / 3, float(seed)).camera()
        inside = replace(ahead, eye=ahead.eye * 0.4)
        for scene, camera in ((world, ahead), (world, inside), room(), SCENES["column"]):
            for renderer in renderers:
                renderer.draw(scene, camera, technique)
            np.testing.assert_array_equal(renderers[0].read(), renderers[1].read())
            shot = Shot(scene, camera, SIZE)
            pictures = technique.technique.pictures(
                technique, None, shot, renderers[0].needed(scene, camera, technique)
            )
            among = renderers[0].plan.ruled
            whole, cut, _ = technique.technique.cut(shot, pictures, among)
            assert not set(whole) & set(cut)
            fewer += len(cut) < len(among)
    assert fewer > 0


@pytest.mark.parametrize("turned", [1, -1])
@pytest.mark.parametrize("name", HOLES)
def test_what_a_hole_leaves_of_large_meshes_is_drawn_without_a_trace(context, name, turned):
    """Equal in every pixel: a jeep and its mirror image, from round about and from within; and of
    its triangles fewer are drawn."""
    mirror = np.diag([turned, 1.0, 1.0, 1.0])
    scene = Scene(tuple(replace(o, transform=mirror @ o.transform) for o in jeep_scene().objects))
    middle = np.array([0.0, 0.42, 0.0])
    eyes = [np.array([a * 3.4, 1.1, b * 3.4]) for a, b in ((0.4, 0.9), (-0.9, -0.4), (0.1, 0.2))]
    renderers = [Renderer(context, SIZE, without=w) for w in ({"still"}, {"still", "removed"})]
    drawn_of = []
    for cap in CAPS:
        technique = replace(named(name), cap=cap)
        for eye in eyes:
            camera = look_at(eye, middle, fov_y=0.6, near=0.05, far=20)
            pictures = []
            for renderer in renderers:
                with renderer.context.query(primitives=True) as query:
                    renderer.draw(scene, camera, technique)
                pictures.append(renderer.read())
                drawn_of.append(query.primitives)
            np.testing.assert_array_equal(*pictures)
    assert sum(drawn_of[::2]) < 0.9 * sum(drawn_of[1::2])


@pytest.mark.parametrize("name", SCENES)
def test_the_long_way_takes_longer(context, name):
    """Counters of passes, draws, masks and ordered objects."""
    scene, camera = SCENES[name]
    _, short, frame = drawn(context, scene, camera, frozenset())
    assert 0 < short.masks <= scene.targets.sum()
    assert 0 < short.ordered < len(scene.objects)
    _, painter, _ = drawn(context, scene, camera, frozenset({"levels"}))
    assert painter.passes > short.passes or name == "row of targets"  # each alone anyway
    _, all_blend, _ = drawn(context, scene, camera, frozenset({"opaque"}))
    assert all_blend.ordered > short.ordered
    _, _, whole = drawn(context, scene, camera, frozenset({"cull"}))
    assert len(whole.opaque) >= len(frame.opaque)
    _, masked, _ = drawn(context, scene, camera, frozenset({"masks"}))
    assert masked.masks >= short.masks


def test_a_frame_without_occluded_targets_is_the_standard_frame(context):
    """The same passes and draws, and not a single mask."""
    scene, camera = SCENES["column"]
    ahead = replace(scene, objects=tuple(replace(o, target=False) for o in scene.objects))
    plain, standard, _ = drawn(context, ahead, camera, frozenset(), Standard())
    picture, stats, _ = drawn(context, ahead, camera, frozenset())
    assert stats == standard
    assert (stats.passes, stats.masks, stats.ordered) == (1, 0, 0)
    np.testing.assert_array_equal(picture, plain)


def test_nothing_happens_while_nothing_changes(context):
    """Neither plan nor draw; but any change of scene, camera, technique or size draws again."""
    scene, camera = SCENES["column"]
    renderer = Renderer(context, SIZE)
    first = renderer.draw(scene, camera, TECHNIQUE)
    picture = renderer.read()
    assert renderer.draw(scene, replace(camera), TECHNIQUE).draws == 0
    np.testing.assert_array_equal(renderer.read(), picture)
    assert renderer.draw(scene, camera, replace(TECHNIQUE, width=3)).draws > 0
    assert renderer.draw(replace(scene), camera, TECHNIQUE).draws == first.draws
    renderer.resize((80, 60))
    assert renderer.draw(scene, camera, TECHNIQUE).draws > 0


TURNED = transforms.rotation_y(0.02)[:3, :3]
CHANGES = {
    "fov_y": {"fov_y": 0.6},
    "near": {"near": 12.0},
    "far": {"far": 25.0},
    "eye": {"eye": before_column(1).eye + np.array([0.1, 0, 0])},
    "rotation": {"rotation": before_column(1).rotation @ TURNED},
}


@pytest.mark.parametrize("name", CHANGES)
def test_every_part_of_a_camera_that_changes_is_drawn(context, name):
    """Each changes the picture, and is the only one that does."""
    scene, camera = SCENES["column"]
    changed = replace(camera, **CHANGES[name])
    expected, _, _ = drawn(context, scene, changed, frozenset())
    renderer = Renderer(context, SIZE)
    renderer.draw(scene, camera, TECHNIQUE)
    assert (renderer.read() != expected).any()
    assert renderer.draw(scene, changed, TECHNIQUE).draws > 0
    np.testing.assert_array_equal(renderer.read(), expected)


def test_layers_are_counted_only_where_they_matter(context):
    """Three layers of 0.3 leave 0.34: no count for τ = 0.2, but one for τ = 0.6."""
    scene, camera = SCENES["row of targets"]
    _, _, frame = drawn(context, scene, camera, frozenset(), replace(TECHNIQUE, width=1))
    _, _, strict = drawn(
        context, scene, camera, frozenset(), replace(TECHNIQUE, width=1, min_transmittance=0.9)
    )
    assert len(frame.counted) < len(strict.counted) <= len(strict.masked)


def test_an_unknown_shortcut_is_refused(context):
    """By name, with what there is."""
    with pytest.raises(ValueError, match=r"without = \['magic'\], expected some of"):
        Renderer(context, SIZE, without=frozenset({"magic"}))
