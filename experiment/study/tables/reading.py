"""A study's tables, each as its values: what is wrong comes with them, all of it at once.

A table's content is read once, however many cells have it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from pydantic import ValidationError

from seethrough.experiment.study.tables import plugins
from seethrough.experiment.study.tables.parameter_tables import MISSING, Fault, Faults, built
from seethrough.experiment.study.tables.question_table import STARTS, QuestionTable
from seethrough.experiment.study.tables.study_errors import faults_of
from seethrough.experiment.study.tables.study_tables import TABLES, Table, TaskTable
from seethrough.renderer.declared import Declares
from seethrough.renderer.meant import one_of
from seethrough.renderer.scene.look import Look


@dataclass(frozen=True)
class Chosen:
    """What [technique] or [world] says: the name in use ("" for none), its parameters, and those of
    every [technique.NAME]; `scenes` of a world."""

    use: str
    parameters: Any
    tables: Mapping[str, Declares]


@dataclass(frozen=True)
class TaskOptions:
    """What [task] says: what holds for `every` task, what some say of themselves (`own`: keys of
    TaskTable by task), and their parameters."""

    every: TaskTable = field(default_factory=TaskTable)
    own: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    tables: Mapping[str, Declares] = field(default_factory=dict)

    def of(self, task: str) -> TaskTable:
        """What holds for a task's trials."""
        return self.every.model_copy(update=dict(self.own.get(task, {})))

    def limit(self, task: str) -> float:
        """The most time for a task's trials (s; 0: no limit)."""
        return self.of(task).limit


@dataclass(frozen=True)
class Question:
    """A table of [questions]: when and for what it is asked, and what its kind may be told."""

    use: str
    table: QuestionTable
    parameters: Declares

    @property
    def when_asked(self) -> str:
        """start, trial, task_set, condition or end."""
        return self.table.when or ("start" if self.use in STARTS else "end")

    def meant_for(self, at: Mapping[str, str]) -> bool:
        """Whether a cell is among those that it is asked for: levels by factor."""
        return not self.table.off and all(
            at[factor] in ((wanted,) if isinstance(wanted, str) else wanted)
            for factor, wanted in self.table.only.items()
        )


Read = tuple[Any, list[Fault]]  # what a table makes depends on its section


def read(section: str, table: object, whole: bool) -> Read:
    """The values of a table and its faults; `whole` unless something may still be missing."""
    if not isinstance(table, Mapping):
        return None, [Fault(section, table, f"a table, [{section}]")]
    if section in ("technique", "world"):
        return _chosen(section, table, whole)
    if section == "look":
        return _look(table)
    if section == "task":
        return _task_options(table)
    if section == "questions":
        return _questions(table)
    return model(section, TABLES[section], table)


def model(section: str, kind: type[Table], table: Mapping[str, object]) -> Read:
    """A table of ours."""
    try:
        return kind.model_validate(dict(table)), []
    except ValidationError as error:
        return None, faults_of(error, section, table)


def _look(table: Mapping[str, object]) -> Read:
    try:
        return built(Look, table), []
    except Faults as error:
        return None, [fault._replace(key=f"look.{fault.key}") for fault in error.found]


def _chosen(section: str, table: Mapping[str, object], whole: bool) -> Read:
    known, faults = plugins.names(section), []
    tables: dict[str, Declares] = {}
    for name, own in table.items():
        if name == "use":
            continue
        where = f"{section}.{name}"
        if name not in known:
            faults.append(Fault(where, own, known=("use", *known)))
        elif not isinstance(own, Mapping):
            faults.append(Fault(where, own, f"a table, [{where}]"))
        else:
            tables[name], found = parameters(section, name, own)
            faults += found
    use = table.get("use", "")
    if use not in known and (use or "use" in table):
        faults.append(Fault(f"{section}.use", use, one_of(use, known)))
    elif not use and whole:
        faults.append(Fault(f"{section}.use", MISSING, one_of("", known)))
    if faults:
        return None, faults
    use = str(use)
    if use and use not in tables:
        tables[use], faults = parameters(section, use, {})
    return Chosen(use, tables.get(use), tables), faults


def parameters(section: str, name: str, table: Mapping[str, object]) -> Read:
    """The parameters of a technique, world or task."""
    where = f"{section}.{name}"
    try:
        made: Declares = built(plugins.parameters(section, name), table)
    except Faults as error:
        return None, [fault._replace(key=f"{where}.{fault.key}") for fault in error.found]
    more = plugins.further_faults(made)
    return made, [fault._replace(key=f"{where}.{fault.key}") for fault in more]


def _task_options(table: Mapping[str, object]) -> Read:
    known = plugins.names("task")
    plain = {k: v for k, v in table.items() if k not in known}
    value, faults = model("task", TaskTable, plain)
    faults = [f._replace(known=(*f.known, *known)) if f.known else f for f in faults]
    said: dict[str, Mapping[str, object]] = {}
    tables: dict[str, Declares] = {}
    for name in (k for k in table if k in known):
        own = table[name]
        if not isinstance(own, Mapping):
            faults.append(Fault(f"task.{name}", own, f"a table, [task.{name}]"))
            continue
        common = {k: v for k, v in own.items() if k in TaskTable.model_fields}
        options, found = model(f"task.{name}", TaskTable, common)
        faults += found
        if common and options is not None:
            said[name] = {k: getattr(options, k) for k in common}
        tables[name], found = parameters(
            "task", name, {k: v for k, v in own.items() if k not in common}
        )
        faults += found
    return (None if faults else TaskOptions(value, said, tables)), faults


def _questions(table: Mapping[str, object]) -> Read:
    found: dict[str, Question] = {}
    faults: list[Fault] = []
    for name, own in table.items():
        where = f"questions.{name}"
        if not isinstance(own, Mapping):
            faults.append(Fault(where, own, f"a table, [{where}]"))
            continue
        common = {k: v for k, v in own.items() if k in QuestionTable.model_fields}
        value, wrong = model(where, QuestionTable, common)
        faults += wrong
        said = own.get("use")
        use = said if isinstance(said, str) and said else name
        if use not in plugins.names("question"):
            known = plugins.names("question")
            faults.append(Fault(f"{where}.use", use, one_of(use, known)) if said
                          else Fault(where, use, known=known))  # fmt: skip
            continue
        kinds, wrong = parameters(
            "question", use, {k: v for k, v in own.items() if k not in common}
        )
        faults += [fault._replace(key=_below(fault.key, f"question.{use}", where),
                   known=fault.known and (*QuestionTable.model_fields, *fault.known))
                   for fault in wrong]  # fmt: skip
        if value is not None and not wrong:
            found[name] = Question(use, value, kinds)
    return (None if faults else found), faults


def _below(key: str, old: str, new: str) -> str:
    return f"{new}{key.removeprefix(old)}"
