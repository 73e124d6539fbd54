"""Simulated people work techniques that hands move, by the events that a window would send; the
page before says which; and what cannot go together is refused in a line."""

from __future__ import annotations

import csv
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from recorded_session import STUDY, Simulated, play_recorded

from seethrough import registry
from seethrough.experiment import cli
from seethrough.experiment.errors import InputError
from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.people.runs.data_run import refuse_hands
from seethrough.experiment.replay.replayer import find_trial, replay
from seethrough.experiment.session.levels import hands
from seethrough.experiment.study.config import parse
from seethrough.experiment.study.design.design import session_for
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.visibility import Visibility, better
from seethrough.renderer.techniques import named
from seethrough.renderer.techniques.base import Shot
from seethrough.renderer.techniques.pointing import place_of
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.gestures import after
from seethrough.tasks.kit.skills.sweep import Sweep

ACTIVE = ("balloon", "dig", "fade", "lens")
IN_THE_CUBE = {
    **STUDY,
    "factors": {"view": {"levels": {
        name: {"technique": {"use": name}} for name in ("standard", *ACTIVE)
    }}},
    "design": {"trials": 1, "tasks": ["count"]},
    "technique": {
        "lens": {"depth": 40.0}, "dig": {"radius": 3.0, "depth": 40.0},
        "balloon": {"radius": 9.0, "depth": 40.0},
    },
    "world": {"use": "abstract", **STUDY["world"]},
}  # fmt: skip
WALKING = {
    **IN_THE_CUBE,
    "factors": {"view": {"levels": {n: {"technique": {"use": n}} for n in ("standard", "lens")}}},
    "design": {"trials": 1, "tasks": ["unique"]},
    "world": {"use": "building", **STUDY["world"]},
}


@pytest.fixture(scope="module")
def played(tmp_path_factory):
    """A simulated person's session with every technique that hands work, drawn and recorded."""
    folder = tmp_path_factory.mktemp("hands") / "data"
    play_recorded(folder, IN_THE_CUBE, Simulated)
    return folder


def of(folder, count):
    """Trials by technique."""
    found = (find_trial(folder, "P01", number) for number in range(1, count + 1))
    return {recorded.trial.levels["view"]: recorded for recorded in found}


def sample_scene():
    ball = geometry.sphere(1.0, 1)
    places = np.random.default_rng(2).uniform(-10, 10, (10, 3))
    return Scene(tuple(Object(ball, transforms.translation(*at)) for at in places))


def events(recorded):
    with open(recorded.events, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_simulated_hands_carry_each_technique_over_the_view(played):
    """By what it takes and nothing else; without one, no event is there that was not before."""
    trials = of(played, 5)
    for name in ACTIVE:
        rows = events(trials[name])
        count = Counter(row["event"] for row in rows)
        free = [r for r in rows if r["event"] == "PointerMove" and r["dragging"] == "false"]
        places = {(r["x"], r["y"]) for r in free}
        assert len(places) >= 9  # PLACES × PLACES of the first view
        takes = registry.get("technique", name).takes
        assert bool(count["Wheel"]) == ("wheel" in takes)
        keys = {row["key"] for row in rows if row["event"] == "KeyPress"}
        assert ("q" in keys) == (name == "dig")
        # Positions are where the view is, times go on.
        assert all(0 <= float(r["x"]) <= 4 / 3 and 0 <= float(r["y"]) <= 1 for r in free)
        times = [float(row["time"]) for row in rows]
        assert times == sorted(times)
    kinds = {row["event"] for row in events(trials["standard"])}
    assert "Wheel" not in kinds
    assert not [r for r in events(trials["standard"]) if r["dragging"] == "false"
                and r["event"] == "PointerMove"]  # fmt: skip


@pytest.mark.parametrize("name", ("standard", *ACTIVE))
def test_what_hands_did_is_replayed_to_the_pixel(played, name, capsys):
    recorded = of(played, 5)[name]
    words = ["replay", str(played), "--participant", "P01", "--trial", str(recorded.trial.number)]
    assert cli.main([*words, "--verify"]) == 0
    said = capsys.readouterr().out
    assert "no picture" not in said and said.endswith(" 0 different\n")
    states = {frame.view.drawn for frame in replay(recorded)}
    assert (len(states) >= 9) == (name in ACTIVE)


def test_hands_take_the_time_they_take(played):
    """What is searched place by place takes longer than what shows at once."""
    trials = of(played, 5)
    for name in ACTIVE:
        rows = events(trials[name])
        free = [float(r["time"]) for r in rows if r["event"] == "PointerMove"
                and r["dragging"] == "false"]  # fmt: skip
        # Pointing takes 1.1 s by the keystroke-level model, at the person's pace.
        assert np.diff(free[:9]).min() > 1.1 * 0.5
        assert float(trials[name].row["time"]) > free[8] - float(rows[0]["time"])


def test_a_walkers_hands_turn_the_wheel_and_leave_the_pointer_alone(tmp_path, capsys):
    """The pointer turns the viewer: the lens hangs in the middle of the view."""
    play_recorded(tmp_path / "data", WALKING, Simulated)
    recorded = of(tmp_path / "data", 2)["lens"]
    rows = events(recorded)
    found = next(i for i, r in enumerate(rows) if r["key"] == "space")  # then comes the plan
    assert "Wheel" in [row["event"] for row in rows[:found]]
    assert "Wheel" not in [row["event"] for row in rows[found:]]
    still = [r for r in rows[:found] if r["event"] == "PointerMove" and not float(r["dx"])]
    assert not still
    words = ["replay", str(tmp_path / "data"), "--participant", "P01", "--trial"]
    assert cli.main([*words, str(recorded.trial.number), "--verify"]) == 0
    assert capsys.readouterr().out.endswith(" 0 different\n")


def test_what_both_looks_showed_is_known():
    def seen(*areas):
        areas = np.array(areas)
        return Visibility(areas * 100, areas, np.stack([areas, areas], 1), areas, areas)

    both = better(seen(0.1, 0.5, 0.0), seen(0.3, 0.2, 0.0))
    assert both.area.tolist() == [0.3, 0.5, 0.0] and both.pixels.tolist() == [30, 50, 0]
    assert both.position[:, 1].tolist() == [0.3, 0.5, 0.0]


def test_a_search_knows_the_most_that_any_place_showed():
    """Nine places, of which each shows something else: all of it is known afterwards."""
    p = named("lens")
    camera = look_at(np.array([0.0, 0.0, 40.0]), np.zeros(3), fov_y=0.8, near=1.0, far=90.0)
    view = View(sample_scene(), camera, drawn=p.technique.begin(p))
    looked = []

    def look():
        areas = np.zeros(10)
        areas[len(looked) % 10] = 0.5
        looked.append(1)
        return Visibility(np.ones(10, int), areas, np.zeros((10, 2)), areas, areas)

    mood = SimulatedParticipant(np.random.default_rng(1))
    mood.begin_trial("count", 0.0)
    sweep = Sweep(mood._mood, p, 4 / 3)
    now = 0.0
    while events_ := sweep.events(view, look, now):
        assert all(e.time >= now for e in events_)
        now = events_[-1].time
    assert len(looked) == 10 and sweep.spent == pytest.approx(now)
    assert sweep.seen(look)().area.tolist() == [0.5] * 10
    assert sweep.events(view, look, now) == []  # the same view again: nothing to search


@pytest.mark.parametrize("far", (12.0, 300.0))
@pytest.mark.parametrize("name", ("lens", "balloon"))
def test_reaching_brings_the_technique_to_the_point(name, far):
    """Closed form: the pointer on the point's place, the depth its own or at most a step beyond,
    whether it was nearer or farther before."""
    camera = look_at(np.array([1.0, 2.0, 30.0]), np.zeros(3), fov_y=0.8, near=1.0, far=90.0)
    shot, p = Shot(Scene(()), camera, (400, 300)), replace(named(name), depth=far)
    rng = np.random.default_rng(3)
    for point in rng.uniform(-5, 5, (20, 3)):
        state = after(p, p.technique.begin(p), shot,
                      p.technique.reach(p, p.technique.begin(p), shot, point))  # fmt: skip
        depth = float(camera.depth(point[None])[0])
        assert depth * (1 - 1e-9) <= state.depth < depth * (1 + p.step)
        at = camera.eye + state.direction(shot) * depth
        np.testing.assert_allclose(at, point, atol=1e-9)
    assert place_of(shot, camera.eye - camera.forward) is None  # behind the viewer
    assert p.technique.reach(p, p.technique.begin(p), shot, camera.eye - camera.forward) == ()


def test_the_page_before_names_what_hands_do_where_anything_depends_on_them():
    """Of the lens, and not of the standard technique; of a walker, in the middle of the view."""
    for table, text in ((IN_THE_CUBE, "lens.controls"), (WALKING, "lens.controls.walking")):
        study = parse(table, "test")
        said = {t.levels["view"]: [b.text for b in hands(study, t)]
                for s in session_for(1, study.plan) for t in s.trials}  # fmt: skip
        assert said["lens"] == [text] and said["standard"] == []


def test_data_mode_refuses_what_hands_move_by_name():
    study = parse(IN_THE_CUBE, "test")
    with pytest.raises(InputError) as error:
        refuse_hands(study, "mine.toml")
    assert [line.split(": ")[1] for line in error.value.faults] == [
        f'technique.use = "{name}"' for name in ACTIVE
    ]
    assert all("--mode visual" in line for line in error.value.faults)
    plain = {**IN_THE_CUBE, "factors": {"view": {"levels": {
        n: {"technique": {"use": n}} for n in ("standard", "cutaway")
    }}}}  # fmt: skip
    refuse_hands(parse(plain, "test"), "mine.toml")


def test_a_key_that_technique_and_task_both_take_is_refused():
    """R fills holes and is one of the letters; Q is nobody's."""
    letters = {**IN_THE_CUBE, "design": {"trials": 1, "tasks": ["count", "pattern"]}}
    with pytest.raises(InputError) as error:
        parse(letters, "mine.toml")
    assert error.value.faults == (
        'mine.toml: factors.view.levels.dig.technique.use = "dig": expected a technique that '
        "leaves the key R to the task pattern in dig",
    )
    levels = {n: {"technique": {"use": n}} for n in ("standard", "lens")}
    parse({**letters, "factors": {"view": {"levels": levels}}}, "mine.toml")
