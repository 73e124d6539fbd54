"""Which item of a task each trial asks for, where a world's items are counted: those of files.

Sets of items rotate over a person's cells as sets of scenes do (experiment/study/design/items.py):
a set is a run of items, as long as a cell's trials and practice, in the study's order or one drawn
from its seed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from seethrough.experiment.study.design.design import (
    STUDY_SCENES,
    TRAINING_TRIAL,
    Trial,
    generator,
)
from seethrough.experiment.study.design.factors import CHANGED, Cell
from seethrough.experiment.study.study import Study
from seethrough.tasks.catalog import TASKS, WORLDS
from seethrough.tasks.kit.base import Counts, Needs, Setting
from seethrough.tasks.kit.world import FILES, FileWorld, Lists

ORDER = 200  # second word of the stream that orders items: no scene set has such a number


@dataclass(frozen=True)
class Need:
    """How many `items` of a task a person meets, in so many `cells` that share it, and how many
    there are in the file."""

    task: str
    cells: int
    each: int
    there: int

    @property
    def items(self) -> int:
        """How many different ones a person meets."""
        return self.cells * self.each


class StudyItems:
    """The items of a study's trials."""

    def __init__(self, study: Study) -> None:
        self.study = study
        self._orders: dict[tuple[str, object, object], tuple[int, ...] | None] = {}

    def of(self, trial: Trial) -> int | None:
        """The item that a trial asks for, None where they are not counted."""
        order = self._order(trial)
        if order is None:
            return None
        needed, each, before = self._place(trial)
        *_, word = trial.stream[:5]
        if word == 2 * TRAINING_TRIAL:  # the instruction's: one that nobody meets, if there is any
            return order[needed if needed < len(order) else before + each - 1]
        trials = self.study.part(trial.levels).design.trials
        number = trials + word - TRAINING_TRIAL if word > TRAINING_TRIAL else word
        chosen = trial.stream[1]
        return order[(before + chosen * each + number - 1) % len(order)]

    def needs(self) -> Iterator[Need]:
        """How many items each task takes, and how many there are, of each group and place."""
        plan, found = self.study.plan, {}
        for group in plan.groups:
            for cell in group.cells:
                for task in self.study.parts[cell].plan.tasks:
                    setting = self._setting(cell, task)
                    count = _count(task, setting)
                    if count is None:
                        continue
                    sets = self._sets(group.cells, cell, task)
                    total = sum(len(codes) for codes in sets.values())
                    need = Need(task, total, self._each(cell), count)
                    found[task, setting.place, need] = need
        yield from found.values()

    def _setting(self, cell: Cell, task: str) -> Setting:
        part = self.study.parts[cell]
        own = part.task_options.tables.get(task) or TASKS[task].Parameters()
        return Setting(WORLDS[part.world], part.place, own)

    def _each(self, cell: Cell) -> int:
        plan = self.study.parts[cell].plan
        return plan.trials + plan.practice

    def _sets(self, cells: tuple[Cell, ...], like: Cell, task: str) -> dict[int, set[int]]:
        """Of a person's cells with the same task in the same place: for each way of changing
        scenes, its cells."""
        plan, found = self.study.plan, dict[int, set[int]]()
        place = self.study.parts[like].place
        for cell in cells:
            part = self.study.parts[cell]
            if task in part.plan.tasks and part.place == place:
                changed = plan.code(cell, CHANGED)
                found.setdefault(changed, set()).add(plan.code(cell, "alone"))
        return found

    def _place(self, trial: Trial) -> tuple[int, int, int]:
        """Items that a person meets, items of a set, and the first of the trial's sets."""
        cell = tuple(trial.levels[factor.name] for factor in self.study.factors)
        group = next(g for g in self.study.plan.groups if cell in g.cells)
        sets, each = self._sets(group.cells, cell, trial.task), self._each(cell)
        mine = self.study.plan.code(cell, CHANGED)
        before = sum(len(codes) for changed, codes in sets.items() if changed < mine)
        return sum(map(len, sets.values())) * each, each, before * each

    def _order(self, trial: Trial) -> tuple[int, ...] | None:
        setting = self.study.setting(trial)
        key = (trial.task, setting.place, setting.task)
        if key not in self._orders:
            count = _count(trial.task, setting)
            order = tuple(range(count)) if count is not None else None
            if order is not None and not (isinstance(setting.place, Lists) and setting.place.items):
                which = sorted(self.study.tasks()).index(trial.task)
                rng = generator(self.study.general.seed, (STUDY_SCENES, ORDER, which))
                order = tuple(rng.permutation(len(order)).tolist())
            self._orders[key] = order
        return self._orders[key]


def lacking_items(study: Study) -> list[str]:
    """A line for each task that files have too little for: items, or targets of a scene."""
    lines = []
    for part in study.parts.values():
        if part.place.scenes != FILES:
            continue
        world = WORLDS[part.world]
        there = world.targets(part.place) if isinstance(world, FileWorld) else {}
        for task in part.design.tasks:
            asked = TASKS[task]
            least = asked.least if isinstance(asked, Needs) else 1
            lines += [
                f"world.{part.world}.{key}: expected {least} or more targets for {task}, there are "
                f"{count}: tag things with target = true"
                for key, count in there.items()
                if count < least
            ]
    for need in [] if lines else StudyItems(study).needs():
        if need.items > need.there:
            lines.append(
                f"design.trials: {need.task} takes {need.items} items, {need.each} (trials and "
                f"practice) in each of {need.cells} cells, so that nobody meets one twice: "
                f"expected at least so many targets in the scenes, there are {need.there}"
            )
    return list(dict.fromkeys(lines))


def _count(task: str, setting: Setting) -> int | None:
    """How many items a task can ask for there, None where scenes are drawn."""
    asked = TASKS[task]
    return asked.items(setting) if isinstance(asked, Counts) else None
