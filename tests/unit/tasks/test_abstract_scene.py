"""The abstract world's promises, for any seed."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from seethrough.renderer.scene.scene import Object
from seethrough.tasks.kit.enclosure import bounding_radius, enclosing_pairs
from seethrough.tasks.kit.letters import LETTERS, grid_reach, letter_points
from seethrough.tasks.worlds.abstract.abstract_parameters import SHAPES, AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import (
    RED,
    _disclosed,
    abstract_scene,
    distractor_color,
    placed,
    unit_mesh,
)

SEEDS = st.integers(0, 2**32 - 1)


def scene_of(seed, pattern=None, **changes):
    return abstract_scene(np.random.default_rng(seed), AbstractParameters(**changes), pattern)


@settings(max_examples=15, deadline=None)
@given(SEEDS, st.sampled_from([None, *LETTERS]))
def test_scene_is_as_published(seed, pattern):
    scene = scene_of(seed, pattern)
    red = [o for o in scene.objects if o.color == RED]
    assert len(scene.objects) == 200
    assert 20 <= len(red) <= 40
    assert all(o.target == (o.color == RED) for o in scene.objects)
    for thing in scene.objects:
        vertices = thing.mesh.vertices @ thing.transform[:3, :3].T
        radius = np.linalg.norm(vertices, axis=1).max()
        # The scale is a quotient of two rounded numbers.
        assert 2.5 * (1 - 1e-12) <= radius <= 5 * (1 + 1e-12)
        assert np.abs(vertices + thing.transform[:3, 3]).max() <= 50 * (1 + 1e-12)
        if not thing.target:
            assert thing.color[0] == 0 and max(thing.color) <= 1
    assert enclosing_pairs(scene.objects) == []
    assert not any(o.impenetrable for o in scene.objects)


@settings(max_examples=10, deadline=None)
@given(SEEDS, st.sampled_from(sorted(LETTERS)))
def test_pattern_is_all_the_red_cones(seed, letter):
    scene = scene_of(seed, letter)
    cones = [o.transform[:3, 3] for o in scene.objects if o.target and o.kind == "cone"]
    assert len(cones) == sum(row.count("#") for row in LETTERS[letter])
    assert_allclose([c[1] for c in cones], 0)
    # Any turn about the vertical keeps the distances of the drawing: compare all of them, sorted.
    drawn = letter_points(letter, 45 / grid_reach(), 0)
    distances = [
        np.sort(np.linalg.norm(p[:, None] - p[None], axis=2), axis=None)
        for p in (np.array(cones), drawn)
    ]
    assert_allclose(distances[0], distances[1], atol=1e-9)


def test_one_seed_one_scene_another_seed_another():
    first, again, other = scene_of(5), scene_of(5), scene_of(6)
    assert np.array_equal(first.transforms, again.transforms)
    assert not np.array_equal(first.transforms, other.transforms)


def test_shapes_are_shared_meshes_of_about_13k_triangles():
    counts = []
    for seed in range(10):
        scene = scene_of(seed)
        assert len({id(o.mesh) for o in scene.objects}) == 4
        counts.append(sum(len(o.mesh.triangles) for o in scene.objects))
    assert 12_000 < np.mean(counts) < 15_000  # Elmqvist2009, table 2: 13k
    for shape in SHAPES:
        assert_allclose(np.linalg.norm(unit_mesh(shape).vertices, axis=1).max(), 1, rtol=1e-12)


def test_places_and_orientations_are_spread():
    centers = np.concatenate([scene_of(s).transforms[:, :3, 3] for s in range(20)])
    radius = np.concatenate([[bounding_radius(o) for o in scene_of(s).objects] for s in range(5)])
    # Uniform on ±(50 − r), r about 3.75: mean 0 and s.d. 46.25/√3, each to five standard errors.
    error = 46.25 / 3**0.5 / len(centers) ** 0.5
    assert np.abs(centers.mean(axis=0)).max() < 5 * error
    assert_allclose(centers.std(axis=0), 46.25 / 3**0.5, rtol=5 / (2 * len(centers)) ** 0.5)
    assert abs(radius.mean() - 3.75) < 5 * 2.5 / 12**0.5 / len(radius) ** 0.5


def test_target_numbers_reach_both_ends():
    numbers = {int(scene_of(s, objects=50).targets.sum()) for s in range(80)}
    assert numbers == {5, 6, 7, 8, 9, 10}


def test_the_letters_are_those_of_the_study():
    assert sorted(LETTERS) == ["C", "K", "R", "X", "Y"]
    for rows in LETTERS.values():
        assert len(rows) == 7 and all(len(row) == 5 for row in rows)
        assert any(row[0] == "#" for row in rows) and any(row[4] == "#" for row in rows)


def test_a_letter_reads_the_right_way_round_from_above():
    points = letter_points("K", 1.0, 0.0)
    # The K's stem is its left column (−x), its top row is far (−z).
    assert (points[:, 0] == -2).sum() == 7
    assert_allclose(sorted(points[points[:, 2] == -3][:, 0]), [-2, 2])
    turned = letter_points("K", 1.0, np.pi / 2)  # to the left about +y: +x goes to −z
    assert_allclose(turned[:, 2], -points[:, 0], atol=1e-12)


@pytest.mark.parametrize(
    "changes, message",
    [
        ({"side": 0}, r"side = 0, expected a number from 1 to 10000"),
        ({"objects": 0}, r"objects = 0, expected a whole number from 1 to 5000"),
        ({"target_share": (0.3, 0.1)}, r"target_share = \[0.3, 0.1\], expected \[lowest, highest"),
        ({"target_share": (0.101, 0.104)}, r"holds a whole number of 200 objects"),
        ({"radius": (2.5, 40.0)}, r"radius = \[2.5, 40.0\], expected"),
        (
            {"shapes": ("sphere", "egg")},
            r"shapes = \['sphere', 'egg'\], expected an array of some of .sphere., ",
        ),
        ({"shapes": ()}, r"shapes = \[\], expected an array of some of"),
        ({"fov_y": float("nan")}, r"fov_y = nan, expected a number from 0.1 to 2.5"),
    ],
)
def test_parameters_are_refused_by_name(changes, message):
    with pytest.raises(ValueError, match=message):
        AbstractParameters(**changes)


def test_a_letter_that_does_not_fit_is_refused():
    said = r"objects = 50, expected enough of them: the letter takes \d+ red cones, "
    with pytest.raises(ValueError, match=said + r"target_share allows 10$"):
        scene_of(1, "R", objects=50, target_share=(0.1, 0.2))
    with pytest.raises(ValueError, match=said + r"targets allow 5$"):
        scene_of(1, "R", objects=50, targets=(1, 5))
    with pytest.raises(ValueError, match=r"expected another than the pattern's cones"):
        scene_of(1, "Y", shapes=("cone",))


def test_other_shapes_do_not_change_what_a_pattern_is():
    scene = scene_of(3, "X", shapes=("cone", "box"))
    assert {o.kind for o in scene.objects if o.target} == {"cone", "box"}


# Viénot, Brettel & Mollon 1999: what a deuteranope and a protanope see, in linear RGB.
DEUTAN = np.array([[0.29275, 0.70725, 0.0], [0.29275, 0.70725, 0.0], [-0.02234, 0.02234, 1.0]])
PROTAN = np.array([[0.11238, 0.88762, 0.0], [0.11238, 0.88762, 0.0], [0.00401, -0.00401, 1.0]])


@pytest.mark.parametrize("sight", [np.eye(3), DEUTAN, PROTAN])
def test_the_safe_palette_keeps_targets_apart_for_everybody(sight):
    safe = AbstractParameters(palette="colour-blind-safe")
    scene = abstract_scene(np.random.default_rng(1), safe)
    seen = np.array([sight @ np.power(o.color, 2.2) for o in scene.objects])
    chroma = seen / seen.sum(axis=1, keepdims=True)  # hue without lightness, which shading changes
    targets, others = chroma[scene.targets], chroma[~scene.targets]
    apart = np.linalg.norm(targets[:, None] - others[None], axis=2)
    # Twice the largest distance among the distractors themselves would be a gap anybody sees; the
    # published palette has targets and distractors that coincide for a deuteranope.
    assert apart.min() > 0.4


def test_the_palettes_differ_in_colour_alone():
    published = abstract_scene(np.random.default_rng(1), AbstractParameters())
    safe = abstract_scene(np.random.default_rng(1), AbstractParameters(palette="colour-blind-safe"))
    np.testing.assert_array_equal(published.transforms, safe.transforms)
    np.testing.assert_array_equal(published.targets, safe.targets)


def test_an_unknown_palette_is_named():
    with pytest.raises(ValueError, match=r"palette = 'pink', expected one of .published., "):
        AbstractParameters(palette="pink")


def test_clutter_is_set_without_changing_targets():
    """`targets` and `distractors` are counts of their own; without them `objects` is shared out."""
    for targets, distractors, most in ((None, 80, 40), ((15, 25), 380, 25), ((15, 25), None, 25)):
        p = AbstractParameters(side=200.0, targets=targets, distractors=distractors)
        found = [abstract_scene(np.random.default_rng(s), p).targets for s in range(12)]
        counts = {int(t.sum()) for t in found}
        assert min(counts) >= (15 if targets else 20) and max(counts) <= most and len(counts) > 1
        others = {len(t) - int(t.sum()) for t in found}
        expected = {200 - n for n in counts} if distractors is None else {distractors}
        assert others == expected


def test_more_targets_than_objects_are_refused():
    with pytest.raises(ValueError, match=r"targets = \[100, 250\], expected at most `objects`"):
        AbstractParameters(targets=(100, 250))
    assert AbstractParameters(targets=(100, 250), distractors=0).target_range == (100, 250)


@pytest.mark.parametrize(
    ("radii", "fixed", "stay"),
    [
        ((2, 4), 0, 1),  # what is enclosed is drawn again: it would never be seen
        ((2, 4), 1, 0),  # but what keeps its place does, whichever of them it is
        ((4, 2), 1, 0),
        ((4, 2), 0, 0),
    ],
)
def test_of_two_balls_in_one_place_the_inner_is_drawn_again_unless_it_is_fixed(radii, fixed, stay):
    """`radii`: index 0 is the first object; `fixed` of them keep their place."""
    p = AbstractParameters()
    ball = unit_mesh("sphere")
    made = [Object(ball, placed(np.zeros(3), scale=float(r)), RED, kind="sphere")
            for r in radii]  # fmt: skip
    found = _disclosed(np.random.default_rng(1), p, list(made), fixed)
    assert [a is b for a, b in zip(found, made, strict=True)] == [k == stay for k in (0, 1)]
    assert enclosing_pairs(found) == []


def test_the_safe_palette_is_blue_whatever_is_drawn():
    """Colours that a screen has, without red, bluer than green by enough to be told from it."""
    p = AbstractParameters(palette="colour-blind-safe")
    drawn = np.array([
        distractor_color(p, g, b) for g in np.linspace(0, 1, 11) for b in np.linspace(0, 1, 11)
    ])  # fmt: skip
    assert drawn.min() >= 0 and drawn.max() <= 1
    assert not drawn[:, 0].any()
    assert (drawn[:, 2] + 0.2 >= drawn[:, 1]).all()
    shades = drawn.reshape(11, 11, 3)
    assert (np.diff(shades[..., 1], axis=0) > 0).all() and (
        np.diff(shades[..., 2], axis=1) > 0
    ).all()
