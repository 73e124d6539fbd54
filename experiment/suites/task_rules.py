"""What a task has to be."""

from __future__ import annotations

from collections.abc import Iterator
from string import ascii_lowercase

import numpy as np
from numpy.typing import NDArray

from seethrough.experiment.suites.finding import NothingToTest
from seethrough.experiment.suites.played import KEYS, anything, begun, no_clock, played, same
from seethrough.experiment.suites.suite import (
    Rule,
    describes_itself,
    parameters_declared,
    texts_in_every_language,
    unknown_texts,
)
from seethrough.renderer.events import KeyPress, Tick
from seethrough.tasks.catalog import WORLDS, setting, taken, worlds_of
from seethrough.tasks.kit.base import Outcome, Setting, Task, View
from seethrough.tasks.kit.hud import Button, Entry, FloorPlan, Inset, Label
from seethrough.tasks.kit.measure import Measure
from seethrough.tasks.kit.skills.strategy import Strategy
from seethrough.tasks.kit.world import FILES

SEEDS = (1, 2)
BLIND = 200  # events of somebody who does not know what to do


def _settings(task: Task) -> Iterator[Setting]:
    """The task in each world that it names. Raises NothingToTest where that is none."""
    if not worlds_of(task):
        raise NothingToTest("it names no world")
    for world in worlds_of(task):
        yield setting(task, WORLDS[world].Parameters())


def says_what_it_is(task: Task) -> Iterator[str]:
    """It says what it is: name, code, source, worlds, measures, texts."""
    yield from describes_itself(task, ("code", "title", "instruction"))
    if not task.worlds:
        yield "worlds = (): expected one or more"
    yield from (f"worlds: {w}: no such world" for w in worlds_of(task) if w not in WORLDS)
    names = [m.name for m in task.measures if isinstance(m, Measure)]
    if len(names) < len(task.measures) or len(set(names)) < len(names):
        yield f"measures = {task.measures!r}: expected Measures, each of another name"
    if not isinstance(task.simulate, Strategy):
        yield f"simulate = {task.simulate!r}: expected a Strategy"


def refuses_wrong_parameters(task: Task) -> Iterator[str]:
    """Its parameters are declared, and wrong ones refused by name."""
    yield from parameters_declared(task.Parameters)


def has_its_texts(task: Task) -> Iterator[str]:
    """All that it says is in every language."""
    yield from texts_in_every_language(task, (task.name,))
    keys = {task.title, task.instruction}
    for given in _settings(task):
        trial = played(task, given, SEEDS[0])
        for state in (trial.states[0], trial.states[-1]):
            labels = (e.text for e in task.view(state).hud if isinstance(e, Label))
            keys |= {text for text in labels if len(text) > 1}  # a letter is its own text
    yield from unknown_texts(keys)


def makes_the_same_scene_again(task: Task) -> Iterator[str]:
    """One stream, one scene; another stream, another one, unless it is from a file."""
    for given in _settings(task):
        one, two, other = (task.view(begun(task, given, s)).scene for s in (1, 1, 2))
        if not np.array_equal(one.transforms, two.transforms):
            yield f"{given.world.name}: one stream made two scenes"
        drawn = given.place.scenes != FILES
        if (
            drawn
            and one.transforms.shape == other.transforms.shape
            and np.array_equal(one.transforms, other.transforms)
        ):
            yield f"{given.world.name}: two streams made one scene"


def is_pure(task: Task) -> Iterator[str]:
    """The same events give the same states and the same outcome, whatever was asked between."""
    for given in _settings(task):
        first, again = (played(task, given, SEEDS[0]) for _ in range(2))
        if first.events != again.events or first.outcome != again.outcome:
            yield f"{given.world.name}: played twice, it went two ways"
        # Old states stay what they were: each leads to the next again, now that all were used.
        for number in range(0, len(first.events), max(1, len(first.events) // 50)):
            state = task.on_event(first.states[number], first.events[number])
            if not same(task.view(state), task.view(first.states[number + 1])):
                yield f"{given.world.name}: event {number}: an old state leads somewhere else now"


def _global_stream() -> NDArray[np.uint32]:
    """Where numpy's own stream is, which nobody may touch."""
    state = np.random.get_state(legacy=True)  # noqa: NPY002
    assert isinstance(state, tuple)
    return state[1].copy()


def reads_no_clock(task: Task) -> Iterator[str]:
    """It reads no clock, and draws from no stream but its own."""
    for given in _settings(task):
        state = begun(task, given, SEEDS[0])
        before = _global_stream()
        with no_clock(task):
            for event in anything(np.random.default_rng(1), 50):
                state = task.on_event(state, event)
                task.view(state)
                task.outcome(state)
        if not np.array_equal(before, _global_stream()):
            yield f"{given.world.name}: drew from numpy's global stream"


def takes_any_event(task: Task) -> Iterator[str]:
    """Whatever a participant does, it shows a view and raises nothing."""
    for given in _settings(task):
        for seed in SEEDS:
            state = begun(task, given, seed)
            for event in anything(np.random.default_rng(seed), BLIND):
                state = task.on_event(state, event)
                view, outcome = task.view(state), task.outcome(state)
                if not isinstance(view, View) or not np.isfinite(view.camera.eye).all():
                    yield f"{given.world.name}: {event}: expected a View with a camera somewhere"
                if not isinstance(outcome, Outcome | None):
                    yield f"{given.world.name}: {event}: outcome {outcome!r}: expected an Outcome"
                if outcome is not None:
                    break


def says_which_keys_it_takes(task: Task) -> Iterator[str]:
    """Every key that changes anything, at any moment of a trial, is its own or its world's."""
    for given in _settings(task):
        own = taken(task) | taken(given.world)
        trial = played(task, given, SEEDS[0])
        now = max((e.time for e in trial.events), default=0.0) + 1.0
        for state in trial.states[:: max(1, len(trial.states) // 5)]:
            if task.outcome(state) is not None:
                continue
            before = said(task, task.on_event(state, Tick(now)))
            strange = [
                k for k in (*ascii_lowercase, *KEYS) if f"key:{k}" not in own
                and said(task, task.on_event(state, KeyPress(now, k))) != before
            ]  # fmt: skip
            if strange:
                names = ", ".join(sorted(set(strange)))
                yield f"{given.world.name}: answers to {names}, which `takes` lacks"
                break


def said(task: Task, state: object) -> tuple[object, ...]:
    """What keys make of a trial: what is drawn over its view, hints left out, and its answer."""
    view = task.view(state)
    hud = [e for e in view.hud if not hasattr(e, "look") and getattr(e, "tone", "") != "hint"]
    return (*hud, task.outcome(state), view.captured, *view.camera.eye, *view.camera.rotation.flat)


def fits_the_view(task: Task) -> Iterator[str]:
    """What it draws over the view lies in the view, wide or narrow, from a trial's first state to
    its last."""
    drawn = 0
    for given in _settings(task):
        for aspect in (4 / 3, 16 / 9):
            states = played(task, given, SEEDS[0], aspect).states
            placed = {
                element.rect
                for state in (*states[:: max(1, len(states) // 10)], states[-1])
                for element in task.view(state).hud
                if isinstance(element, Button | Entry | Inset | FloorPlan)
            }
            drawn += len(placed)
            for r in placed:
                if min(r.x, r.y) < 0 or r.x + r.width > aspect or r.y + r.height > 1:
                    yield f"{given.world.name}: {r} lies outside of a view {aspect:.2f} wide"
    if not drawn:
        raise NothingToTest("it draws no button, entry, inset or plan")


def is_done_by_simulated_people(task: Task) -> Iterator[str]:
    """A simulated person answers, in order of time, and every measure is filled in."""
    for given in _settings(task):
        for seed in SEEDS:
            trial, where = played(task, given, seed), f"{given.world.name}, seed {seed}"
            times = [event.time for event in trial.events if hasattr(event, "within")]
            if times != sorted(times):
                yield f"{where}: events go back in time"
            if trial.outcome is None:
                yield f"{where}: no answer after {len(trial.events)} events"
                continue
            for measure in task.measures:
                if trial.outcome.value(measure.of) is None:
                    yield f"{where}: measure {measure.name}: expected a value"


def shows_what_it_is_about(task: Task) -> Iterator[str]:
    """For its instruction's picture it names objects and cameras."""
    for given in _settings(task):
        state = begun(task, given, SEEDS[0])
        example, count = task.example(state, 4 / 3), len(task.view(state).scene.objects)
        if not example.cameras or not example.asked:
            yield f"{given.world.name}: expected one camera and one object or more"
        if any(not 0 <= i < count for i in example.asked):
            yield f"{given.world.name}: asked = {example.asked}: expected indices of objects"


RULES: tuple[Rule[Task], ...] = (
    says_what_it_is,
    refuses_wrong_parameters,
    has_its_texts,
    makes_the_same_scene_again,
    is_pure,
    reads_no_clock,
    takes_any_event,
    says_which_keys_it_takes,
    fits_the_view,
    is_done_by_simulated_people,
    shows_what_it_is_about,
)
