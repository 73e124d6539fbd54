"""A study's table read: base, factors and every cell, with all that is wrong in any of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeGuard

from seethrough.experiment.record.columns import RESERVED
from seethrough.experiment.study.design.design import Design
from seethrough.experiment.study.design.factors import (
    MEASURED,
    Cell,
    Factor,
    Level,
    Levels,
    every_cell,
)
from seethrough.experiment.study.study import Study
from seethrough.experiment.study.tables.cells import Part, every_combination, parts_of
from seethrough.experiment.study.tables.factor_tables import level_name, read_factors
from seethrough.experiment.study.tables.parameter_tables import MISSING, Fault
from seethrough.experiment.study.tables.question_checks import unfit_questions
from seethrough.experiment.study.tables.reading import read
from seethrough.experiment.study.tables.scopes import sections
from seethrough.experiment.study.tables.study_tables import DesignTable
from seethrough.renderer.meant import one_of

MOST_CELLS = 10_000
DESCRIBED = ("plugins", "translations")  # what a sidecar says besides


class Parser:
    """A study's table while it is read."""

    def __init__(self, table: Mapping[str, object]) -> None:
        self.base = {k: v for k, v in table.items() if k != "factors"}
        listed = self.base.get("questions")
        if _are_named(listed):  # of a sidecar: in order
            self.base["questions"] = {
                t["name"]: {k: v for k, v in t.items() if k != "name"} for t in listed
            }
        factors = table.get("factors", {})
        if _are_factors(factors):
            factors = {t["name"]: _from_sidecar(t) for t in factors}
        self.table = factors
        self.faults: list[Fault] = []

    def study(self) -> tuple[Study | None, list[Fault]]:
        """The study, or None where something is wrong."""
        self.faults += [
            Fault(name, value, known=("factors", *sections()))
            for name, value in self.base.items()
            if name not in (*sections(), *DESCRIBED)
        ]
        if "study" not in self.base:
            self.faults.append(Fault("study", MISSING, "a table, [study]"))
        found = {s: self._read(s) for s in ("study", "session", "analysis", "design", "practice",
                                            "display", "questions", "look")}  # fmt: skip
        tables = {s: self._read(s) for s in ("technique", "world", "task")}
        people = found["study"].participants if found["study"] is not None else None
        factors, wrong = read_factors(self.table, RESERVED, people)
        self.faults += wrong
        texts = self._texts()
        if not wrong and (total := every_combination(factors)) > MOST_CELLS:
            self.faults.append(Fault("factors", total, f"at most {MOST_CELLS} cells"))
            return None, self.faults
        excluded = self._excluded(factors, found["design"]) if not wrong else ()
        if wrong or self.faults:
            return None, [*self.faults, *(self._of_levels(factors) if not wrong else ())]
        cells = every_cell(factors, excluded)
        parts, unfit = parts_of(self.base, factors, cells)
        more = unfit or [*self._of_all(found, factors, excluded, parts), *_outlast(found, parts)]
        if more:
            return None, more
        return Study(
            found["study"], factors, found["design"], found["practice"], found["display"],
            found["session"], found["questions"], found["analysis"], texts, tables,
            found["look"], parts, excluded, self._translations(),
        ), []  # fmt: skip

    def _of_levels(self, factors: tuple[Factor, ...]) -> list[Fault]:
        """What is wrong in levels, besides what is wrong already: all of it is told at once."""
        known = {fault.key for fault in self.faults}
        _, faults = parts_of(self.base, factors, every_cell(factors))
        return [f for f in faults if f.key not in known and f.value is not MISSING]

    def _read(self, section: str) -> Any:
        value, faults = read(section, self.base.get(section, {}), False)
        if section == "study" and section not in self.base:
            return None
        self.faults += faults
        return value

    def _translations(self) -> dict[str, dict[str, str]]:
        """Texts of languages of the study's own, as a sidecar has them."""
        said = self.base.get("translations", {})
        tables = said.items() if isinstance(said, Mapping) else ()
        return {str(n): {str(k): str(v) for k, v in t.items()} for n, t in tables}

    def _texts(self) -> dict[str, str]:
        texts = self.base.get("texts", {})
        if not isinstance(texts, Mapping):
            self.faults.append(Fault("texts", texts, "a table, [texts]"))
            return {}
        self.faults += [Fault(f"texts.{n}", t, "text") for n, t in texts.items()
                        if not isinstance(t, str)]  # fmt: skip
        return dict(texts)

    def _excluded(
        self, factors: tuple[Factor, ...], design: DesignTable | None
    ) -> tuple[Levels, ...]:
        found: list[Levels] = []
        names = [factor.name for factor in factors]
        for number, entry in enumerate(design.exclude if design is not None else ()):
            where = f"design.exclude[{number}]"
            levels: dict[str, str] = {}
            for name, value in entry.items():
                level = level_name(value)
                own = next((f for f in factors if f.name == name), None)
                if own is None:
                    self.faults.append(Fault(f"{where}.{name}", value, known=tuple(names)))
                elif level not in own.names:
                    expected = one_of(level, own.names)
                    self.faults.append(Fault(f"{where}.{name}", value, expected))
                else:
                    levels[name] = level
            if not entry:
                self.faults.append(Fault(where, {}, "levels of some factors"))
            found.append(levels)
        if not self.faults:
            self.faults += _left_without(factors, found)
        return tuple(found)

    def _of_all(
        self, found: Mapping[str, Any], factors: tuple[Factor, ...], excluded: tuple[Levels, ...],
        parts: Mapping[Cell, Part],
    ) -> list[Fault]:  # fmt: skip
        """What no table can know alone."""
        plan = Design(factors, {}, found["design"].order, found["study"].participants,
                      excluded=excluded)  # fmt: skip
        faults = []
        if any(group.people < 1 for group in plan.groups):
            expected = f"at least one for each of {len(plan.groups)} groups"
            faults.append(Fault("study.participants", plan.people, expected))
        names = [f.name for f in factors]
        faults += unfit_questions(factors, found["questions"], parts)
        for number, name in enumerate(found["analysis"].pairwise):
            if name not in names:
                faults.append(Fault(f"analysis.pairwise[{number}]", name, one_of(name, names)))
        for number, said in enumerate(found["analysis"].predictions):
            where = f"analysis.predictions[{number}]"
            if said.contrast and said.contrast not in names:
                expected = one_of(said.contrast, names)
                faults.append(Fault(f"{where}.contrast", said.contrast, expected))
        return faults


def _outlast(found: Mapping[str, Any], parts: Mapping[Cell, Part]) -> list[Fault]:
    """Trials that may take longer than the whole session."""
    most = found["session"].limit
    longest = {
        (task, part.task_options.limit(task))
        for part in parts.values()
        for task in part.design.tasks
    }
    return [
        Fault("task.limit", limit, f"at most session.limit ({most:g}), within which {task} ends")
        for task, limit in sorted(longest)
        if 0 < most < limit
    ]


def _left_without(factors: tuple[Factor, ...], excluded: list[Levels]) -> list[Fault]:
    """Levels that no cell has any more."""
    there = every_cell(factors, excluded)
    faults = []
    for i, factor in enumerate(factors):
        for level in factor.names:
            if not any(cell[i] == level for cell in there):
                number = next(
                    n for n, e in enumerate(excluded) if e.get(factor.name, level) == level
                )
                expected = f"cells of factors.{factor.name}.levels.{level} that are left"
                faults.append(Fault(f"design.exclude[{number}]", dict(excluded[number]), expected))
    return faults


def _are_named(tables: object) -> TypeGuard[list[Mapping[str, Any]]]:
    """Whether it is an array of tables that have names, as a sidecar has them."""
    return isinstance(tables, list) and all(
        isinstance(t, Mapping) and isinstance(t.get("name"), str) for t in tables
    )


def _are_factors(tables: object) -> TypeGuard[list[Mapping[str, Any]]]:
    """Whether it is an array of factors, each with an array of levels."""
    return _are_named(tables) and all(
        _are_named(t.get("levels"))
        and all(isinstance(level.get("part"), Mapping) for level in t["levels"])
        for t in tables
    )


def _from_sidecar(table: Mapping[str, Any]) -> dict[str, Any]:
    """A factor as a sidecar has it, as a study file would say it."""
    said = {k: v for k, v in table.items() if k != "name" and v not in (None, "")}
    said["levels"] = [
        Level(t["name"], t["part"], str(t.get("label", "")), t.get("number"))
        for t in table["levels"]
    ]
    if said.get("vary") == MEASURED:
        said["values"] = [level.name for level in said.pop("levels")]
    return said
