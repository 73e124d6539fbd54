"""The world `scene`: tags, places to stand, moving; and the task `locate` in it."""

from dataclasses import replace

import numpy as np
import pytest
from scene_files import file_of

from seethrough.renderer.events import KeyPress, PointerPress, PointerRelease
from seethrough.tasks.catalog import TASKS, WORLDS, setting
from seethrough.tasks.kit.hud import Inset, Mark, Sought
from seethrough.tasks.kit.skills.finding import TILTS
from seethrough.tasks.kit.tags import KindTag, Tag, fits
from seethrough.tasks.kit.world import FileFaults
from seethrough.tasks.locate.locate_task import LocateParameters
from seethrough.tasks.select.select_task import MARKED, SelectParameters
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters
from seethrough.tasks.worlds.scene import scene_place
from seethrough.tasks.worlds.scene.scene_parameters import Item, SceneParameters
from seethrough.tasks.worlds.scene.scene_place import opened

SCENE, LOCATE, SELECT = WORLDS["scene"], TASKS["locate"], TASKS["select"]
NODES = [
    {"name": "hull left", "mesh": 0, "translation": [-5, 0, 0]},
    {"name": "hull right", "mesh": 0, "translation": [5, 0, 0]},
    {"name": "pump.001", "mesh": 0, "extras": {"target": 1, "label": "pump"}},
    {"name": "pump.002", "mesh": 0, "translation": [0, 4, 0],
     "extras": {"target": True, "label": "pump"}},
    {"name": "valve", "mesh": 0, "translation": [0, 0, 6], "extras": {"importance": 0.5}},
    {"name": "stand", "camera": 0, "translation": [0, 3, 20]},
]  # fmt: skip
CAMERAS = [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}]


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "engine.glb").write_bytes(file_of(NODES, range(6), cameras=CAMERAS))
    return tmp_path


def read(folder, **more):
    return SCENE.found(SceneParameters(("engine.glb",), **more), folder)


@pytest.mark.parametrize(
    ("name", "pattern", "of_it"),
    [
        ("pump.001", "pump*", True),
        ("pump.001", "*.00*", True),
        ("Pump.001", "pump*", False),
        ("pump", "pump*", True),
        ("a pump", "pump*", False),
        ("pump[1]", "pump[1]", True),
        ("pump1", "pump[1]", False),
        ("pump?", "pump?", True),
        ("pumps", "pump?", False),
        ("two\nlines", "two*lines", True),
        ("pump", "", False),
        ("pump", "***", True),
        ("a" * 200 + "b", "*a" * 40 + "c", False),  # 10^40 ways to try it, for who goes back
    ],
)
def test_a_pattern_is_a_name_with_stars(name, pattern, of_it):
    assert fits(name, pattern) is of_it


def test_tags_come_from_the_file_then_from_the_table_and_the_last_one_holds(folder):
    p = read(
        folder,
        tags=(
            Tag("hull*", group="body", wall=True),
            Tag("hull right", wall=False, impenetrable=True),
            Tag("valve", target=True),
            Tag("pump.002", occluder=True),
        ),
    )
    place = opened(p, "engine.glb")
    left, right, one, two, valve = place.scene.objects
    assert [o.target for o in place.scene.objects] == [False, False, True, False, True]
    assert (left.kind, right.kind) == ("wall", "hull right")
    assert left.group == right.group is not None
    assert one.group is None
    assert [o.impenetrable for o in (left, right)] == [False, True]
    assert (valve.importance, one.importance) == (0.5, 0.0)
    assert place.labels == ("hull left", "hull right", "pump", "pump", "valve")
    assert place.alike(2) == (2, 3)
    assert two.kind == "pump.002"


def test_units_and_the_axis_upwards_are_the_studys(folder):
    """A millimetre is a thousandth; where z points up, what was up lies towards the viewer."""
    plain, small = read(folder), read(folder, unit=0.001, up="z")
    a, b = (opened(p, "engine.glb").scene.centers for p in (plain, small))
    a, b = a - a[0], b - b[0]
    assert np.allclose(b, 0.001 * np.stack([a[:, 0], a[:, 2], -a[:, 1]], axis=1), atol=1e-12)


def test_an_orbit_is_about_the_middle_or_about_what_the_study_names(folder):
    for about, name in (("", None), ("valve", "valve")):
        place = opened(read(folder, about=about), "engine.glb")
        corners = place.scene.corners.reshape(-1, 3)
        middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
        if name is not None:
            middle = place.scene.centers[place.names.index(name)]
        assert np.allclose(middle, 0, atol=1e-9)
        far = np.linalg.norm(place.scene.centers, axis=1) + place.scene.radii
        assert place.radius >= far.max() - 1e-9


def test_a_camera_of_the_file_is_where_one_begins(folder):
    """Standing there, walking from there, or on that side of an orbit."""
    for move in ("fixed", "walk"):
        p = read(folder, move=move, start="stand")
        camera = SCENE.viewer(opened(p, "engine.glb"), p, 4 / 3).camera()
        assert np.allclose(camera.eye[[0, 2]], (0, 20))
        assert np.allclose(camera.forward, (0, 0, -1))
    p = read(folder, start="stand")
    eye = SCENE.viewer(opened(p, "engine.glb"), p, 4 / 3).camera().eye
    (stand,) = opened(p, "engine.glb").cameras.values()
    assert np.allclose(eye / np.linalg.norm(eye), stand.eye / np.linalg.norm(stand.eye))


def test_fixed_views_step_round():
    """The office has four cameras: once round is where one began."""
    p = SceneParameters(("office",), move="fixed")
    viewer = SCENE.viewer(opened(p, "office"), p, 4 / 3)
    seen = [viewer.camera()]
    for time in range(4):
        viewer = viewer.on_event(KeyPress(float(time), "right"))
        seen.append(viewer.camera())
    assert len({tuple(c.eye.tolist()) for c in seen}) == 4
    assert seen[0] is seen[4]
    assert viewer.on_event(KeyPress(9.0, "left")).camera() is seen[3]


def test_what_a_data_folder_keeps_is_the_scene(folder, tmp_path):
    """Array for array, though the file is gone."""
    p = read(folder, tags=(Tag("valve", target=True),))
    kept = tmp_path / "models"
    kept.mkdir()
    for name, content in SCENE.keeps(p).items():
        (kept / name).write_bytes(content())
    before = opened(p, "engine.glb")
    (folder / "engine.glb").unlink()
    after = opened(SCENE.kept_in(p, kept), "engine.glb")
    assert after.names == before.names and after.labels == before.labels
    assert np.array_equal(after.scene.transforms, before.scene.transforms)
    for a, b in zip(after.scene.objects, before.scene.objects, strict=True):
        assert np.array_equal(a.mesh.vertices, b.mesh.vertices)
        assert (a.target, a.kind, a.group) == (b.target, b.kind, b.group)
    with pytest.raises(FileFaults, match="expected the scene as it was shown"):
        SCENE.kept_in(replace(p, detail=7), kept)
    (file,) = kept.iterdir()
    whole = file.read_bytes()
    for broken in (b"", whole[:100], whole[: len(whole) // 2], b"PK" + bytes(500)):
        file.write_bytes(broken)
        scene_place._unpacked.cache_clear()
        with pytest.raises(FileFaults, match=rf"expected what was kept: .*{file.name}: not a kept"):
            SCENE.kept_in(p, kept)


def test_items_are_every_target_of_every_file_or_those_that_the_study_lists(folder):
    p = read(folder)
    assert [a.place.names[a.thing] for a in SCENE.items(p)] == ["pump.001", "pump.002"]
    p = read(folder, items=(Item("pump.002", start="stand"), Item("pump.001")))
    first, second = SCENE.items(p)
    assert (first.place.start, second.place.start) == ("stand", "")
    assert [a.place.names[a.thing] for a in (first, second)] == ["pump.002", "pump.001"]
    assert first.place.scene is second.place.scene


def located(folder, **own):
    p = read(folder, tags=(Tag("valve", target=True),))
    at = setting(LOCATE, p, LocateParameters(**own))
    made = LOCATE.make_scene(np.random.default_rng(1), replace(at, item=2))  # the valve
    return LOCATE.begin(made, at, 4 / 3)


def clicked(state, *things):
    for k, thing in enumerate(things):
        for event in (
            PointerPress(k + 0.5, 0.5, 0.5, thing=thing),
            PointerRelease(k + 0.6, 0.5, 0.5),
        ):
            state = LOCATE.on_event(state, event)
    return state


def test_a_trial_of_locate_ends_with_the_right_click_and_counts_the_wrong_ones(folder):
    state = located(folder)
    said = next(e for e in LOCATE.view(state).hud if isinstance(e, Sought))
    assert said.values == (("what", "valve"),) and said.things == (4,)
    state = clicked(state, 0, -1)
    assert LOCATE.outcome(state) is None
    done = LOCATE.outcome(clicked(state, 4))
    assert (done.answer, done.truth, done.correct) == ("valve", "valve", True)
    assert done.value("wrong_clicks") == 2


def test_tries_end_a_trial_with_what_was_clicked_last(folder):
    done = LOCATE.outcome(clicked(located(folder, tries=2), 0, 1))
    assert (done.answer, done.correct, done.value("wrong_clicks")) == ("hull right", False, 2)
    assert LOCATE.outcome(clicked(located(folder, tries=1), -1)).answer == "nothing"


def test_either_thing_of_one_name_is_right(folder):
    p = read(folder)
    at = setting(LOCATE, p, LocateParameters())
    state = LOCATE.begin(
        LOCATE.make_scene(None or np.random.default_rng(1), replace(at, item=0)), at, 1.5
    )
    assert LOCATE.outcome(clicked(state, 3)).correct


def test_a_picture_says_what_to_look_for(folder):
    hud = LOCATE.view(located(folder, show="picture")).hud
    said = next(e for e in hud if isinstance(e, Sought))
    assert said.text == "locate.pictured" and not said.values
    assert any(isinstance(e, Inset) for e in hud)


@pytest.mark.parametrize(
    ("mark", "rings", "colored"), [("under", 0, 1), ("over", 1, 0), ("both", 1, 1)]
)
def test_select_marks_its_only_target_under_the_technique_or_over_it(mark, rings, colored):
    at = setting(SELECT, AbstractParameters(objects=40), SelectParameters(mark=mark))
    made = SELECT.make_scene(np.random.default_rng(3), at)
    view = SELECT.view(SELECT.begin(made, at, 4 / 3))
    assert view.scene.targets.sum() == 1 and view.scene.targets[made.thing]
    assert sum(o.color == MARKED for o in view.scene.objects) == colored
    found = [e for e in view.hud if isinstance(e, Mark)]
    assert len(found) == rings
    if rings:  # about the thing's middle as the camera sees it
        x, y, z = (view.scene.centers[made.thing] - view.camera.eye) @ view.camera.rotation
        half = 2 * -z * np.tan(view.camera.fov_y / 2)
        assert found[0].at == pytest.approx((2 / 3 + x / half, 0.5 - y / half))


def test_select_counts_misses():
    at = setting(SELECT, AbstractParameters(objects=40), SelectParameters())
    made = SELECT.make_scene(np.random.default_rng(3), at)
    state = SELECT.begin(made, at, 4 / 3)
    for k, thing in enumerate((-1, (made.thing + 1) % 40, made.thing)):
        assert SELECT.outcome(state) is None
        for event in (
            PointerPress(k + 0.5, 0.5, 0.5, thing=thing),
            PointerRelease(k + 0.6, 0.5, 0.5),
        ):
            state = SELECT.on_event(state, event)
    assert SELECT.outcome(state).value("misses") == 2


def test_generated_worlds_take_tags_by_kind():
    """Groups and what is impenetrable, of shapes and of walls; nothing else changes."""
    tags = (KindTag("s*", impenetrable=True), KindTag("torus", group="rings"))
    plain, told = (
        WORLDS["abstract"]
        .make(np.random.default_rng(1), AbstractParameters(objects=60, tags=t))
        .scene
        for t in ((), tags)
    )
    assert np.array_equal(plain.transforms, told.transforms)
    assert not plain.impenetrable.any()
    kinds = np.array([o.kind for o in told.objects])
    assert np.array_equal(told.impenetrable, kinds == "sphere")
    assert {o.group for o in told.objects if o.kind == "torus"} == {0}
    assert {o.group for o in told.objects if o.kind != "torus"} == {None}
    p = BuildingParameters(grid=6, objects=14, tags=(KindTag("*wall", impenetrable=False),))
    walls = WORLDS["building"].make(np.random.default_rng(1), p).scene.objects
    assert {o.kind for o in walls if o.impenetrable} == {"floor"}


def test_a_name_is_itself_but_for_stars(tmp_path):
    """Editors write brackets into names; a question mark is one."""
    names = ("Bolt[1]", "bolt?", "bolt2", "b.lt2")
    nodes = [{"name": n, "mesh": 0, "translation": [5 * i, 0, 0]} for i, n in enumerate(names)]
    (tmp_path / "engine.glb").write_bytes(file_of(nodes, range(4)))
    for pattern, fitting in (
        ("Bolt[1]", {"Bolt[1]"}), ("bolt?", {"bolt?"}), ("b.lt*", {"b.lt2"}),
        ("*[*", {"Bolt[1]"}), ("*lt*2", {"bolt2", "b.lt2"}), ("*", set(names)),
    ):  # fmt: skip
        place = opened(read(tmp_path, tags=(Tag(pattern, target=True),)), "engine.glb")
        assert {place.names[i] for i in place.targets} == fitting


def test_of_target_and_occluder_the_last_one_holds(tmp_path):
    """Said of what it belongs to, of the thing, in the study's table, in this order."""
    nodes = [
        {"name": "body", "mesh": 0, "children": [1], "extras": {"occluder": True}},
        {"name": "pump", "mesh": 0, "translation": [5, 0, 0], "extras": {"target": 1}},
    ]
    (tmp_path / "engine.glb").write_bytes(file_of(nodes, (0,)))
    for tags, targets in (
        ((), ["pump"]),
        ((Tag("body", target=True),), ["body", "pump"]),
        ((Tag("pump", occluder=True),), []),
        ((Tag("pump", occluder=True), Tag("*", target=True)), ["body", "pump"]),
        ((Tag("*", target=True), Tag("pump", occluder=True)), ["body"]),
        ((Tag("pump", target=False),), []),
    ):
        place = opened(read(tmp_path, tags=tags), "engine.glb")
        assert [place.names[i] for i in place.targets] == targets


def test_cameras_of_one_name_are_all_there(tmp_path):
    """A file's names need not differ: each view is one of the fixed ones."""
    nodes = [
        {"name": "a", "mesh": 0},
        *({"name": "cam", "camera": 0, "translation": [0, 0, z]} for z in (7, 8, 9)),
    ]
    (tmp_path / "engine.glb").write_bytes(file_of(nodes, range(4), cameras=CAMERAS))
    p = read(tmp_path, move="fixed", start="cam 2")
    place = opened(p, "engine.glb")
    assert [float(c.eye[2]) for c in place.cameras.values()] == [7, 8, 9]
    assert SCENE.viewer(place, p, 4 / 3).camera().eye[2] == 8


@pytest.mark.parametrize(("unit", "at"), [(1e6, 1e25), (1e-6, 0.001)])
def test_a_scene_of_no_size_that_can_be_drawn_is_refused(tmp_path, unit, at):
    scale = [1e-4] * 3 if unit < 1 else [1, 1, 1]
    nodes = [{"name": "a", "mesh": 0, "scale": scale}, {"name": "b", "mesh": 0, "scale": scale}]
    nodes[1]["translation"] = [at, 0, 0]
    (tmp_path / "engine.glb").write_bytes(file_of(nodes, range(2)))
    with pytest.raises(FileFaults) as caught:
        read(tmp_path, unit=unit)
    assert "m large: expected from 1e-06 to 1e+09 m; is `unit` right?" in str(caught.value)


def test_files_that_a_study_pins_are_held_to_their_hash(folder):
    own = read(folder).sha256
    assert read(folder, sha256=own).sha256 == own
    with pytest.raises(FileFaults) as caught:
        read(folder, sha256=("0" * 64,))
    said = f"sha256[0] = {'0' * 64}: expected {own[0]}, which the file has"
    assert str(caught.value) == said


def test_nobody_meets_one_thing_twice_by_two_names(folder):
    """One file written two ways; one item written twice. From another camera it is another item."""
    with pytest.raises(FileFaults) as caught:
        SCENE.found(SceneParameters(("engine.glb", "./engine.glb")), folder)
    said = "files[1] = ./engine.glb: expected a file that differs from engine.glb"
    assert str(caught.value) == said
    twice = (Item("pump.001"), Item("pump.001", start="stand"), Item("pump.001"))
    with pytest.raises(FileFaults) as caught:
        read(folder, items=twice)
    assert str(caught.value) == "items[2].ask = pump.001: expected another than items[0]"
    assert len(SCENE.items(read(folder, items=twice[:2]))) == 2


def test_a_camera_of_the_file_shows_what_stands_right_before_it(folder):
    """What is a four-hundredth of the scene's radius away is not cut off; all of the scene is in
    reach, from outside as well."""
    place = opened(read(folder), "engine.glb")
    camera = place.cameras["stand"]
    assert 0 < camera.near <= place.radius / 400
    farthest = np.linalg.norm(place.scene.corners - camera.eye, axis=-1).max()
    assert camera.far >= farthest


def test_an_orbit_is_looked_at_from_above_as_much_as_from_below():
    """Four heights, each on its own, no way up more than down."""
    assert len(set(TILTS)) == 4 and sum(TILTS) == 0
    assert max(np.abs(TILTS)) < np.pi / 2
