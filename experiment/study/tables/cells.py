"""Every cell of a study as the whole study that it is: base and levels merged, each table checked
once for each content that the factors give it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

from seethrough.experiment.study.design.design import CellPlan
from seethrough.experiment.study.design.factors import Cell, Factor
from seethrough.experiment.study.tables import plugins
from seethrough.experiment.study.tables.factor_tables import where_set
from seethrough.experiment.study.tables.merge import leaves, merged
from seethrough.experiment.study.tables.parameter_tables import MISSING, Fault
from seethrough.experiment.study.tables.reading import Question, Read, TaskOptions, read
from seethrough.experiment.study.tables.study_tables import (
    DesignTable,
    DisplayTable,
    PracticeTable,
    StudyTable,
)
from seethrough.renderer.scene.look import Look
from seethrough.renderer.techniques.base import Parameters
from seethrough.tasks.kit.world import OWN, WorldParameters

VARIED = (
    "study",
    "design",
    "practice",
    "technique",
    "world",
    "look",
    "task",
    "display",
    "questions",
)


@dataclass(frozen=True)
class Part:
    """What holds in a cell: `technique` draws, in the `world` made with `place`, which has that
    `look`; `task_options` of trials; `design` with its tasks, `practice` and `questions`; `display`
    of the session, and `general`, the [study] table."""

    technique: Parameters
    technique_name: str
    world: str
    place: WorldParameters
    look: Look
    task_options: TaskOptions
    design: DesignTable
    practice: PracticeTable
    questions: Mapping[str, Question] = field(hash=False)
    display: DisplayTable
    general: StudyTable

    @property
    def plan(self) -> CellPlan:
        """What the design needs to know of the cell."""
        shared = self.place.scenes != OWN
        design = self.design
        return CellPlan(self.world, design.tasks, design.trials, self.practice.count, shared)


# Section → the factors that set its keys, and what it makes at each of their levels: what that is
# depends on the section.
Values: TypeAlias = dict[str, tuple[tuple[int, ...], dict[Cell, Any]]]


def parts_of(
    base: Mapping[str, object], factors: Sequence[Factor], cells: Sequence[Cell]
) -> tuple[dict[Cell, Part], list[Fault]]:
    """Every cell's part, and all that is wrong in any of them; {} where something is."""
    faults: list[Fault] = []
    values: Values = {}
    for section in VARIED:
        touching = tuple(
            i for i, f in enumerate(factors) if any(section in level.part for level in f.levels)
        )
        there = dict.fromkeys(tuple(cell[i] for i in touching) for cell in cells)
        found: dict[Cell, object] = {}
        plain = {f.key for f in read(section, base.get(section, {}), False)[1]}
        for key in there:
            own = [(factors[i], level) for i, level in zip(touching, key, strict=True)]
            value, wrong = _read(section, base, own)
            found[key] = value
            faults += [_named(fault, own, plain) for fault in wrong]
        values[section] = (touching, found)
    if not faults:
        faults = _unfit(factors, cells, values)
    if faults:
        return {}, list({(f.key, repr(f.value)[:200]): f for f in faults}.values())
    return {cell: _part(cell, values) for cell in cells}, []


def _read(section: str, base: Mapping[str, object], levels: Sequence[tuple[Factor, str]]) -> Read:
    table: dict[str, object] = {section: base.get(section, {})}
    for factor, name in levels:
        part = factor.level(name).part
        if section in part:
            table = merged(table, {section: part[section]})
    return read(section, table[section], True)


def _named(fault: Fault, levels: Sequence[tuple[Factor, str]], plain: set[str]) -> Fault:
    """The fault by the factor and level that set its key, where the base did not."""
    if fault.key in plain:
        return fault
    for factor, name in levels:
        for path, _ in leaves(factor.level(name).part):
            key = ".".join(path)
            if fault.key == key or fault.key.startswith((f"{key}.", f"{key}[")):
                listed = not factor.level(name).part or factor.level(name).number is not None
                return fault._replace(key=where_set(factor, name, fault.key, listed))
    setters = [(f, n) for f, n in levels if any(_sets(f, lv.name, fault.key) for lv in f.levels)]
    if fault.value is MISSING and setters:
        factor, name = setters[0]
        return fault._replace(key=where_set(factor, name, fault.key, False))
    return fault


def _sets(factor: Factor, level: str, key: str) -> bool:
    return any(".".join(path) == key for path, _ in leaves(factor.level(level).part))


def _part(cell: Cell, values: Values) -> Part:
    own = {s: found[tuple(cell[i] for i in at)] for s, (at, found) in values.items()}
    technique, world = own["technique"], own["world"]
    return Part(
        technique.parameters, technique.use, world.use, world.parameters, own["look"],
        own["task"], own["design"], own["practice"], own["questions"], own["display"], own["study"],
    )  # fmt: skip


def _unfit(
    factors: Sequence[Factor],
    cells: Sequence[Cell],
    values: Values,
) -> list[Fault]:
    """Tasks that there are not, or not in the cell's world, and keys that two things take."""
    faults: dict[tuple[str, str], Fault] = {}
    known = plugins.names("task")
    (at_design, designs), (at_world, worlds) = values["design"], values["world"]
    at_technique, techniques = values["technique"]
    for cell in cells:
        design = designs[tuple(cell[i] for i in at_design)]
        world = worlds[tuple(cell[i] for i in at_world)]
        where = "/".join(cell) and f" in {'/'.join(cell)}"
        if not design.tasks:
            said = f"an array of some of {', '.join(known)}{where}"
            faults.setdefault(("", ""), Fault("design.tasks", MISSING, said))
        for number, task in enumerate(design.tasks):
            if world.use not in plugins.worlds_of(task):
                here = [t for t in known if world.use in plugins.worlds_of(t)]
                key = _set_at(factors, cell, "design.tasks", f"[{number}]")
                said = f"a task of the world {world.use}{where}: {', '.join(here) or 'none'}"
                faults.setdefault((key, task), Fault(key, task, said))
        technique = techniques[tuple(cell[i] for i in at_technique)]
        key = _set_at(factors, cell, "technique.use")
        for said in plugins.clashes(technique.use, world.use, design.tasks):
            faults.setdefault((key, said), Fault(key, technique.use, f"{said}{where}"))
    return list(faults.values())


def _set_at(factors: Sequence[Factor], cell: Cell, key: str, which: str = "") -> str:
    """A key by the factor and level that set it in a cell, where the base does not."""
    for factor, name in zip(factors, cell, strict=True):
        if _sets(factor, name, key):
            return where_set(factor, name, f"{key}{which}", False)
    return f"{key}{which}"


def every_combination(factors: Sequence[Factor]) -> int:
    """Cells that there would be if none were left out."""
    total = 1
    for factor in factors:
        total *= len(factor.levels)
    return total
