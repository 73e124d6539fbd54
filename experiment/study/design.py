"""The order of a study, from numbers alone: Latin squares, task orders, scene sets, streams.

Pure: the same study and slot give the same session on every machine.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator, SeedSequence

# First words of a stream's spawn key: what the stream is for (CONVENTIONS.md).
STUDY_SCENES, PARTICIPANT, SIMULATED = 0, 1, 2
TRAINING_TRIAL = 1_000  # first trial number of the training streams, above any study's trials


def williams_rows(k: int) -> tuple[tuple[int, ...], ...]:
    """Orders of k conditions: a Williams square for even k, two squares for odd k.

    Over all rows each condition stands once (odd k: twice) at each position and follows each
    other condition equally often (Williams 1949). Raises ValueError for k < 1.
    """
    if k < 1:
        raise ValueError(f"conditions = {k}, expected at least 1")
    first = [(i + 1) // 2 if i % 2 else (k - i // 2) % k for i in range(k)]
    square = [tuple((c + row) % k for c in first) for row in range(k)]
    if k % 2 and k > 1:
        square += [tuple(reversed(row)) for row in square]
    return tuple(square)


def order_of(slot: int, k: int) -> tuple[int, ...]:
    """The order of k conditions for a slot ≥ 1: the rows in turn."""
    rows = williams_rows(k)
    return rows[(_index(slot)) % len(rows)]


def task_order(slot: int, conditions: int, tasks: int) -> tuple[int, ...]:
    """The order of the tasks within every condition, for a slot.

    Orders alternate from slot to slot and swap with each pass through the conditions' rows, so
    that no row always meets the same task first.
    """
    index, rows = _index(slot), len(williams_rows(conditions))
    orders = williams_rows(tasks)
    return orders[(index + index // rows) % len(orders)]


def scene_set(slot: int, level: int, levels: int) -> int:
    """Which scene set goes with a transparency level, for a slot.

    Sets rotate over levels in the pattern of the parity of binary digits, which keeps them apart
    from the order of conditions (its period is k) and from the task order: with 2 × 2 conditions
    and two tasks, 16 slots cross set, task order and row completely.
    """
    index = _index(slot)
    rotation = index + index // 2 + index // 4 + index // 8
    return (level + rotation) % levels


def _index(slot: int) -> int:
    if slot < 1:
        raise ValueError(f"slot = {slot}, expected at least 1")
    return slot - 1


@dataclass(frozen=True)
class Trial:
    """One trial: where it stands in the session, what it asks, and the stream its scene is from."""

    number: int
    block: int
    task_set: int
    in_set: int
    transparency: str
    scenario: str
    task: str
    scene: str
    stream: tuple[int, ...]
    training: bool = False


@dataclass(frozen=True)
class TaskSet:
    """A task within a condition: its training, then its trials."""

    training: tuple[Trial, ...]
    trials: tuple[Trial, ...]


@dataclass(frozen=True)
class Factors:
    """What a design crosses: transparency levels × scenarios, tasks nested in scenarios.

    A scene named in `redraw` is drawn again, from a stream of its own, as often as it is named:
    the difficulty certificate says which (experiment/study/certificate.py).
    """

    transparency: tuple[str, ...]
    tasks: Mapping[str, tuple[str, ...]]  # scenario -> its tasks
    trials: int
    training: int
    static_scenarios: Sequence[str] = ()
    redraw: Sequence[str] = ()

    @property
    def conditions(self) -> tuple[tuple[str, str], ...]:
        """(transparency, scenario) in a fixed order."""
        return tuple((t, s) for t in self.transparency for s in self.tasks)


def session_for(slot: int, factors: Factors) -> tuple[TaskSet, ...]:
    """Every task set of a slot's session, in order."""
    sets: list[TaskSet] = []
    number = 0
    order = order_of(slot, len(factors.conditions))
    for block, condition in enumerate(order, start=1):
        transparency, scenario = factors.conditions[condition]
        tasks = factors.tasks[scenario]
        for which in task_order(slot, len(factors.conditions), len(tasks)):
            task_set = len(sets) + 1
            place = (block, task_set, transparency, scenario, tasks[which])
            trials = tuple(
                _trial(slot, factors, place, number + i, i) for i in range(1, factors.trials + 1)
            )
            training = tuple(
                _trial(slot, factors, place, 0, i, training=True)
                for i in range(1, factors.training + 1)
            )
            number += factors.trials
            sets.append(TaskSet(training, trials))
    return tuple(sets)


def _trial(
    slot: int,
    factors: Factors,
    place: tuple[int, int, str, str, str],
    number: int,
    in_set: int,
    training: bool = False,
) -> Trial:
    block, task_set, transparency, scenario, task = place
    level = factors.transparency.index(transparency)
    which = factors.tasks[scenario].index(task)
    scene_number = TRAINING_TRIAL + in_set if training else in_set
    scenario_number = list(factors.tasks).index(scenario)
    if scenario in factors.static_scenarios:
        chosen = scene_set(slot, level, len(factors.transparency))
        stream = (STUDY_SCENES, chosen, scenario_number, which, scene_number)
        scene = f"{scenario}-{'ABCDEFGHI'[chosen]}-{task}-{'training-' if training else ''}{in_set}"
    else:
        stream = (PARTICIPANT, slot, level, scenario_number, which, scene_number)
        scene = "stream-" + "-".join(map(str, stream))
    again = list(factors.redraw).count(scene)
    stream = (*stream, again) if again else stream
    return Trial(
        number, block, task_set, in_set, transparency, scenario, task, scene, stream, training
    )


def scene_names(slot: int, factors: Factors) -> list[str]:
    """The scenes that a slot's participant meets, and those that slots share."""
    again = len(factors.transparency)  # slots after which every shared set of scenes has occurred
    return [
        trial.scene
        for slot in (slot, *range(1, again + 1))
        for own in session_for(slot, factors)
        for trial in (*own.trials, *own.training)
    ]


def slot_of(scene: str) -> int:
    """Whose scene it is, if it is one participant's own; else the first slot's."""
    words = scene.split("-")
    own = words[0] == "stream" and len(words) > 2 and words[2].isascii() and words[2].isdigit()
    return max(int(words[2]), 1) if own and len(words[2]) < 10 else 1


def generator(seed: int, stream: Sequence[int]) -> Generator:
    """The Generator of a stream: any trial's scene can be made again alone."""
    return np.random.Generator(np.random.PCG64(SeedSequence(seed, spawn_key=tuple(stream))))
