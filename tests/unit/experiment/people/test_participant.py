"""Simulated participants at the tasks, with eyes that see what a test lets them see."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose
from plain_trials import QUIET, begun, play, sight
from played_tasks import PUBLISHED, begin

from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.renderer.events import KeyPress, KeyRelease, PointerMove, PointerPress, Tick
from seethrough.renderer.scene import geometry
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.skills.effects import EFFECTS, plan_effects
from seethrough.tasks.kit.skills.hands import Hands
from seethrough.tasks.kit.skills.profile import PROFILES, Profile, profile
from seethrough.tasks.kit.skills.red import _red
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import Cloud


@pytest.mark.parametrize("seed", range(3))
def test_with_nothing_hidden_and_no_noise_the_count_is_right(seed):
    outcome, seconds, _, _ = play("count", seed, without=QUIET)
    assert outcome.correct
    assert 10 < seconds < 120


@pytest.mark.parametrize("seed", range(5))
def test_a_letter_seen_clearly_is_named(seed):
    outcome, seconds, _, _ = play("pattern", seed, without=QUIET)
    assert outcome.correct
    assert 3 < seconds < 60


@pytest.mark.parametrize("seed", range(3))
def test_the_unique_thing_is_found_and_marked(seed):
    outcome, seconds, _, _ = play("unique", seed, without=QUIET)
    assert outcome.correct and outcome.distance < 1.0
    assert 5 < seconds < 120


@pytest.mark.parametrize("seed", range(3))
def test_things_in_the_building_are_counted(seed):
    outcome, seconds, _, _ = play("count_in_building", seed, without=QUIET)
    assert outcome.correct
    assert 10 < seconds < 300


@pytest.mark.parametrize("name", ["unique", "count_in_building"])
def test_a_walker_looks_at_every_view_it_comes_to_twice_a_second_or_more(name):
    """While a key is held, the view changes: half a second at most from look to look."""
    task, state = TASKS[name], begun(name, 1)
    # Everything shows through walls here: only who leaves nothing unseen goes anywhere.
    thorough = replace(PROFILES["average"], diligence=1e-3)
    participant = SimulatedParticipant(np.random.default_rng(1), thorough, QUIET)
    participant.begin_trial(name, 0.0)
    now, held, spans, looked = 0.0, False, [], []
    while task.outcome(state) is None:
        view = task.view(state)
        looks = []

        def look(view=view, looks=looks):
            looks.append(view)
            return sight(view, np.ones(len(view.scene.objects), bool))

        batch = participant.events(view, look, now, name)
        keys = [e for e in batch if getattr(e, "key", "") == "up"]
        if keys:
            spans.append(keys[-1].time - (now if held else keys[0].time))
            held = isinstance(keys[-1], KeyPress)
            if held:
                spans[-1] = batch[-1].time - keys[-1].time
        elif held:
            spans.append(batch[-1].time - now)
        looked.append(bool(looks))
        for event in batch:
            state = task.on_event(state, event)
        now = max(e.time for e in batch)
    assert len(spans) > 5 and max(spans) <= 0.5
    assert all(looked[:-2])  # the last two views are those of the plan


def looks_on_steps(passing, name, trial):
    """Into how many looks steps of a walk are divided: those from a key's press to its release."""
    task, state = TASKS[name], begun(name, trial)
    person = SimulatedParticipant(
        np.random.default_rng(1), Profile(passing=passing, diligence=1e-3), QUIET
    )
    person.begin_trial(name, 0.0)
    now, found, held = 0.0, [], 0
    while task.outcome(state) is None:
        view = task.view(state)
        look = partial(sight, view, np.ones(len(view.scene.objects), bool))
        batch = person.events(view, look, now, name)
        ups = [type(e) for e in batch if getattr(e, "key", "") == "up"]
        held += bool(held) or KeyPress in ups
        if KeyRelease in ups:
            found.append(held)
            held = 0
        for event in batch:
            state = task.on_event(state, event)
        now = max(e.time for e in batch)
    return set(found)


@pytest.mark.parametrize("passing, looks", [(0, {1}), (1, {2, 3}), (2, {4, 6})])
def test_a_step_is_looked_at_so_many_times_as_often(passing, looks):
    walks = [(name, trial) for name in ("unique", "count_in_building") for trial in (1, 2, 3)]
    assert set().union(*(looks_on_steps(passing, *walk) for walk in walks)) == looks


@pytest.mark.parametrize("angle", [np.pi / 4, np.pi / 2, 3 * np.pi / 4, np.pi])
def test_turns_come_back_for_a_look_at_each_heading_in_half_a_second(angle):
    participant = SimulatedParticipant(np.random.default_rng(1), without=QUIET)
    participant.begin_trial("unique", 0.0)
    hands = Hands(participant._mood, 0.0)
    hands.mood = replace(hands.mood, pace=1.0)
    times, turned = [0.0], [0.0]
    for _ in hands.turning(angle, parts=round(angle / (np.pi / 4))):
        moves = [e.dx for e in hands.take() if isinstance(e, PointerMove)]
        turned.append(turned[-1] - sum(moves) * np.pi)
        times.append(hands.time)
    assert_allclose(turned, np.arange(len(turned)) * np.pi / 4, atol=1e-12)
    assert max(np.diff(times)) <= 0.5


def test_what_nobody_could_see_is_not_counted():
    def nothing(scene):
        return np.zeros(len(scene.objects), bool)

    assert play("count", shown=nothing)[0].answer == "0"
    assert play("count_in_building", shown=nothing)[0].answer == "0"

    def half(scene):
        return np.arange(len(scene.objects)) % 2 == 0

    outcome = play("count", shown=half, without=QUIET)[0]
    scene = begin("count").cloud.scene
    assert int(outcome.answer) == int(scene.targets[::2].sum())


def test_letters_without_cones_are_guessed():
    def no_cones(scene):
        return np.array([o.kind != "cone" for o in scene.objects])

    right = [play("pattern", s, shown=no_cones)[0].correct for s in range(20)]
    assert sum(right) < 13  # 20 guesses at 1/5: more has probability below 1e-5


def test_invisible_objects_do_not_change_a_thing():
    """The same events whatever the unseen objects are: nothing is read but what is visible."""

    def odd(scene):
        return np.arange(len(scene.objects)) % 2 == 1

    task = TASKS["count"]
    scene = begin("count").cloud.scene
    swapped = tuple(
        o if i % 2 else type(o)(o.mesh, o.transform, (1.0, 0.0, 0.0), True)
        for i, o in enumerate(scene.objects)
    )
    runs = []
    for objects in (scene.objects, swapped):
        world = begin("count", made=Cloud(type(scene)(objects)))
        participant = SimulatedParticipant(np.random.default_rng(9))
        participant.begin_trial("count", 0.0)
        now, events, state = 0.0, [], world
        while task.outcome(state) is None:
            view = task.view(state)
            batch = participant.events(view, lambda v=view: sight(v, odd(v.scene)), now, "count")
            for event in batch:
                state = task.on_event(state, event)
            now = batch[-1].time
            events += batch
        runs.append(events)
    assert runs[0] == runs[1]


@pytest.mark.parametrize("name", PUBLISHED)
def test_one_seed_one_performance(name):
    first, again, other = (
        play(name, 2, profile=PROFILES[p]) for p in ("average",) * 2 + ("hasty",)
    )
    assert first[2] == again[2]
    assert first[2] != other[2]


@pytest.mark.parametrize("name", PUBLISHED)
def test_events_come_in_order_and_tell_the_task_enough(name):
    _, _, events, _ = play(name, 3)
    times = [e.time for e in events if not isinstance(e, Tick)]
    assert times == sorted(times)
    if "abstract" in TASKS[name].worlds:
        assert any(isinstance(e, PointerPress) for e in events)
        assert all(e.dragging for e in events if isinstance(e, PointerMove))
    else:
        assert any(isinstance(e, PointerMove) and not e.dragging for e in events)


def test_a_drag_gain_that_surprises_is_learned():
    task = TASKS["count"]
    p = AbstractParameters(drag_gain=1.5)
    state = begin("count", p)
    participant = SimulatedParticipant(np.random.default_rng(4), without=["motor_noise"])
    participant.begin_trial("count", 0.0)
    now, yaws = 0.0, [state.orbit.yaw]
    while task.outcome(state) is None:
        view = task.view(state)
        look = sight(view, np.arange(200) % 60 < 10 * len(yaws))
        for event in participant.events(view, lambda s=look: s, now, "count"):
            state, now = task.on_event(state, event), event.time
        if state.orbit.yaw != yaws[-1]:
            yaws.append(state.orbit.yaw)
    turns = np.diff(yaws)
    assert turns[0] < 0.6 * np.pi / 3
    assert_allclose(turns[1:], np.pi / 3, rtol=1e-6)


def test_people_differ_and_practice_helps():
    slow, fast = [], []
    for seed in range(30):
        participant = SimulatedParticipant(np.random.default_rng(seed), without=["trial_noise"])
        moods = []
        for _ in range(8):
            participant.begin_trial("count", 0.0)
            moods.append(participant._mood.pace)
        slow.append(moods[0])
        fast.append(moods[-1])
    assert (np.array(slow) > np.array(fast)).all()
    # √(.35² + .30²) = .46, and 30 people give its s.d. to 13 %.
    assert 0.27 < np.std(np.log(fast)) < 0.65


def test_who_sees_nothing_quits():
    """Sooner than who sees something: nothing comes back that would make another look worth it."""
    seconds = {}
    for share in (0.0, 0.3, 1.0):
        outcome, seconds[share], _, _ = play("count", shown=lambda s, p=share: every(s, p))
        assert (outcome.answer == "0") == (share == 0)
    assert seconds[0.0] < seconds[0.3] and seconds[0.0] < seconds[1.0]


def every(scene, share):
    """(n,) some objects, spread over all, that are visible from everywhere."""
    count = len(scene.objects)
    return np.floor(np.arange(1, count + 1) * share) > np.floor(np.arange(count) * share)


def test_the_more_a_find_is_worth_the_more_often_one_looks():
    turns = []
    for worth in (1e-3, 60.0, 900.0):
        greedy = replace(PROFILES["average"], worth=worth)
        events = play("count", profile=greedy, without=QUIET)[2]
        turns.append(sum(isinstance(event, PointerPress) for event in events))
    assert turns == sorted(turns) and turns[0] == 0 and turns[1] > 0 and turns[2] > turns[1]


def test_a_thing_is_red_by_what_it_has_of_each_colour():
    colors = ((1, 0, 0), (0.6, 0.2, 0.2), (1, 1, 0), (1, 0.3, 0.3), (0.4, 0, 0), (0, 0, 1))
    scene = Scene(tuple(Object(geometry.box(), color=color) for color in colors))
    assert _red(scene).tolist() == [True, True, False, False, False, False]


def test_effects_are_planned_with_reasons():
    participant = SimulatedParticipant(np.random.default_rng(1), without=["crowding"])
    participant.begin_trial("count", 0.0)
    uses = participant.effects
    assert set(uses) == set(EFFECTS)
    assert not uses["crowding"].used and uses["crowding"].reason == "left out by --without"
    assert uses["slips"].used and not uses["drift"].used
    assert uses["drift"].reason == "no walking"
    participant.begin_trial("unique", 9.0)
    assert participant.effects["drift"].used and not participant.effects["slips"].used


@pytest.mark.parametrize("name", PUBLISHED)
def test_leaving_out_an_effect_changes_the_trials_that_call_for_it_and_no_others(name):
    """With everything visible: the same luck, event for event, where it is not called for."""
    thorough = replace(PROFILES["average"], diligence=1e-3)  # goes somewhere, though all is visible
    play_so = partial(play, name, 2, profile=thorough)
    whole = play_so()[2]
    uses = plan_effects(TASKS[name].simulate.effects, 0, frozenset())
    for effect in EFFECTS:
        # Nobody is tired at the start; slips are rare, and crowds too, with few things.
        if effect in ("fatigue", "slips", "crowding", "view_changes") and uses[effect].used:
            continue
        assert (play_so(without=[effect])[2] != whole) == uses[effect].used, effect


@pytest.mark.parametrize(
    "effect, common",
    [("slips", {"slip": 0.3}), ("crowding", {"crowded": 1.0, "crowding": 0.1}),
     ("view_changes", {"cloud_depth": 0.3})],
)  # fmt: skip
def test_rare_effects_change_counts_where_they_are_made_common(effect, common):
    often = replace(PROFILES["average"], **common)
    whole = play("count", 2, profile=often)[2]
    assert play("count", 2, profile=often, without=[effect])[2] != whole


def test_who_is_tired_varies_more():
    paces = {}
    for hour in (0.0, 3600.0):
        for without in ((), ("fatigue",)):
            person = SimulatedParticipant(np.random.default_rng(3), without=without)
            person.begin_trial("count", 0.0)
            person.begin_trial("count", hour)
            paces[hour, without] = person._mood.pace
    assert paces[0.0, ()] == paces[0.0, ("fatigue",)] == paces[3600.0, ("fatigue",)]
    assert paces[3600.0, ()] != paces[0.0, ()]


@pytest.mark.parametrize(
    "build, message",
    [
        (lambda: SimulatedParticipant(np.random.default_rng(), without=["gravity"]),
         r"--without = gravity: expected some of crowding, "),
        (lambda: profile("hero"), r"profile = hero: expected one of average, careful"),
        (lambda: Profile(key=-1), r"key = -1, expected a number from 0 to 1000"),
        (lambda: Profile(crowded=1.5), r"crowded = 1.5, expected a probability"),
        (lambda: Profile(speed=0), r"speed = 0, expected a number > 0"),
        (lambda: Profile(key=float("nan")), r"key = nan, expected a number from 0 to 1000"),
        (lambda: Profile(sd_care=4.0), r"sd_care = 4.0, expected a number from 0 to 3"),
        (lambda: Profile(orbit_step=4.0), r"orbit_step = 4.0, expected a number from 0 to 3.14159"),
        (lambda: Profile(subitising_range=0), r"subitising_range = 0, expected a number from 1 to"),
        (lambda: Profile(passing=11), r"passing = 11, expected a number from 0 to 10"),
        (lambda: Profile(passing=0.5), r"passing = 0.5, expected a whole number"),
        (lambda: Profile(tracked=2.5), r"tracked = 2.5, expected a whole number"),
        (lambda: Profile(subitise=0.5), r"subitise = 0.5, expected at most count = 0.3: a glance"),
        (lambda: SimulatedParticipant(np.random.default_rng()).begin_trial("chess", 0.0),
         r"task = chess, expected one of count"),
    ],
)  # fmt: skip
def test_bad_input_is_named(build, message):
    with pytest.raises(ValueError, match=message):
        build()


def test_an_answer_that_did_not_count_is_confirmed_again():
    outcome, now, _, participant = play("count")
    view = TASKS["count"].view(begin("count"))
    more = participant.events(view, lambda: None, now, "count")
    assert outcome is not None
    assert any(isinstance(e, KeyPress) and e.key == "enter" for e in more)
