"""A study as it was read: what holds everywhere, its factors, and what holds in each cell."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import pickle
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from seethrough import registry
from seethrough.experiment.study.beside import plugin_files
from seethrough.experiment.study.design.design import Design, Trial
from seethrough.experiment.study.design.factors import Cell, Factor, Levels
from seethrough.experiment.study.tables.cells import Part
from seethrough.experiment.study.tables.reading import Chosen, Question, TaskOptions
from seethrough.experiment.study.tables.study_tables import (
    AnalysisTable,
    DesignTable,
    DisplayTable,
    PracticeTable,
    SessionTable,
    StudyTable,
)
from seethrough.renderer.declared import Declares
from seethrough.renderer.scene.look import Look
from seethrough.tasks.catalog import TASKS, WORLDS
from seethrough.tasks.kit.base import NoParameters, Setting
from seethrough.tasks.kit.world import WorldParameters


@dataclass(frozen=True)
class Study:
    """A whole study, checked: what holds everywhere, its factors, and each cell's `parts`.

    `general` is the [study] table. It, `design`, `practice`, `display` and `questions` are as the
    base of the study has them; a level may say otherwise of its cells. `tables` are the base's
    technique, world and task, and `look` is the base's. `translations` are the texts of languages
    of its own, by their files, as experiment/study/translations.py reads them.
    """

    general: StudyTable
    factors: tuple[Factor, ...]
    design: DesignTable
    practice: PracticeTable
    display: DisplayTable
    session: SessionTable
    questions: Mapping[str, Question] = field(hash=False)
    analysis: AnalysisTable
    texts: Mapping[str, str] = field(hash=False)
    tables: Mapping[str, Chosen | TaskOptions] = field(hash=False)
    look: Look
    parts: Mapping[Cell, Part] = field(hash=False)
    excluded: tuple[Levels, ...] = field(hash=False)
    translations: Mapping[str, Mapping[str, str]] = field(default_factory=dict, hash=False)

    def __reduce__(self) -> tuple[object, ...]:
        """For another process, which has to know the code that the study brings along before it can
        read anything else of it."""
        files = plugin_files.files_of(self.plugins())
        if not files:
            return (Study.__new__, (Study,), self.__dict__)
        return (_restored, (files, pickle.dumps(self.__dict__)))

    @cached_property
    def plan(self) -> Design:
        """The design: which session each slot has."""
        table = self.general
        plans = {cell: part.plan for cell, part in self.parts.items()}
        return Design(
            self.factors, plans, self.design.order, table.participants, table.seed,
            self.excluded, self.design.redraw,
        )  # fmt: skip

    def part(self, levels: Levels) -> Part:
        """What holds at these levels: a level of every factor."""
        return self.parts[tuple(levels[factor.name] for factor in self.factors)]

    def setting(self, trial: Trial) -> Setting:
        """Where and how a trial's task is set."""
        part = self.part(trial.levels)
        plain = TASKS[trial.task].Parameters if trial.task in TASKS else NoParameters
        own = part.task_options.tables.get(trial.task) or plain()
        return Setting(WORLDS[part.world], part.place, own)

    def tasks(self) -> tuple[str, ...]:
        """Every task that some cell asks for, in the order of the file."""
        return tuple(dict.fromkeys(t for part in self.parts.values() for t in part.design.tasks))

    def session_part(self, slot: int) -> Part:
        """A part that has what holds in the whole session of a slot: its display and language."""
        group, _ = self.plan.group_of(slot)
        return self.parts[self.plan.groups[group].cells[0]]

    def factor(self, name: str) -> Factor:
        """The factor of this name. Raises KeyError."""
        return {f.name: f for f in self.factors}[name]

    def parameters(self, kind: str, name: str) -> object:
        """What the base says of a world or technique: its parameters; None if nothing."""
        chosen = self.tables[kind]
        return chosen.tables.get(name) if isinstance(chosen, Chosen) else None

    def places(self) -> tuple[WorldParameters, ...]:
        """The parameters of every world that some cell uses, each once."""
        return tuple(dict.fromkeys(part.place for part in self.parts.values()))

    def with_places(self, change: Callable[[WorldParameters], WorldParameters]) -> Study:
        """The study with other parameters of its worlds."""
        known: dict[object, WorldParameters] = {place: change(place) for place in self.places()}
        parts = {
            cell: dataclasses.replace(part, place=known[part.place])
            for cell, part in self.parts.items()
        }
        world = self.tables["world"]
        assert isinstance(world, Chosen)
        made: dict[str, Declares] = {n: known.get(own) or own for n, own in world.tables.items()}
        tables = {**self.tables, "world": dataclasses.replace(world, tables=made)}
        return dataclasses.replace(self, parts=parts, tables=tables)

    def resolved(self) -> dict[str, object]:
        """Every value, defaults included, as plain JSON types; `parse` reads it again."""
        questions = [
            {"name": name, **_question_table(asked)} for name, asked in self.questions.items()
        ]
        plain = {
            "study": self.general,
            "design": self.design,
            "practice": self.practice,
            "display": self.display,
            "session": self.session,
            "analysis": self.analysis,
        }
        said = {name: json.loads(table.model_dump_json()) for name, table in plain.items()}
        if not self.practice.explore:
            del said["practice"]["explore"]  # so a study of before is the same study
        if not self.design.tasks:
            del said["design"]["tasks"]  # every cell's levels say them
        if self.design.select is None:
            del said["design"]["select"]
        return {
            **said,
            "factors": [_factor_table(factor) for factor in self.factors],
            **{n: _chosen_table(t) for n, t in self.tables.items() if isinstance(t, Chosen)},
            "look": _plain(self.look),
            "task": _task_table(self.tables),
            "questions": questions,
            "texts": dict(self.texts),
            **({"plugins": self.plugins()} if self.plugins() else {}),
            **({"translations": self.translations} if self.translations else {}),
        }

    def plugins(self) -> list[dict[str, str]]:
        """Each technique, world, task and kind of question in use that is not ours, with the hash
        of its code; the file's name where the study brought it along."""
        parts = self.parts.values()
        questions = {q.use: q for part in parts for q in part.questions.values()}
        used = {
            "technique": [part.technique_name for part in parts],
            "world": [part.world for part in parts],
            "task": self.tasks(),
            "question": [use for use in questions if use in registry.known("question")],
        }
        return [
            {"kind": kind, "name": name, "file": origin.beside, "sha256": origin.sha256}
            for kind, names in used.items()
            for name in dict.fromkeys(names)
            if (origin := registry.origin(kind, name)) is not None
        ]

    def digest(self) -> str:
        """SHA-256 of the resolved study: two sessions with the same digest ran the same study."""
        text = json.dumps(self.resolved(), sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()


def _restored(files: Sequence[plugin_files.PluginFile], data: bytes) -> Study:
    """A study from another process of ours."""
    for own in files:
        plugin_files.provide(own, Path(own.file), f"{own.kind} {own.name}")
    study = Study.__new__(Study)
    study.__dict__.update(pickle.loads(data))
    return study


def _question_table(asked: Question) -> dict[str, object]:
    said: dict[str, object] = json.loads(asked.table.model_dump_json(exclude_defaults=True))
    return {**said, "use": asked.use, **_plain(asked.parameters)}


def _factor_table(factor: Factor) -> dict[str, object]:
    levels = [
        {"name": lv.name, "part": lv.part, "label": lv.label, "number": lv.number}
        for lv in factor.levels
    ]
    people = dict(zip(factor.names, factor.people, strict=True)) if factor.people else None
    return {
        "name": factor.name, "vary": factor.kind, "order": factor.order,
        "baseline": factor.baseline, "people": people, "text": factor.text, "levels": levels,
    }  # fmt: skip


def _plain(value: Declares) -> dict[str, object]:
    """Parameters as JSON has them; where a file lies differs between stations of one study."""
    table: dict[str, Any] = json.loads(json.dumps(dataclasses.asdict(value)))
    table.pop("folder", None)
    for model in table.get("models", ()):
        model.pop("folder", None)
    return table


def _chosen_table(chosen: Chosen) -> dict[str, object]:
    use = {"use": chosen.use} if chosen.use else {}
    return {**use, **{name: _plain(own) for name, own in chosen.tables.items()}}


def _task_table(tables: Mapping[str, Chosen | TaskOptions]) -> dict[str, object]:
    options = tables["task"]
    assert isinstance(options, TaskOptions)
    own = {
        name: {**_plain(options.tables[name]), **options.own.get(name, {})}
        for name in options.tables
    }
    # What is off is not said: so a study of before is the same study.
    asked = options.every.model_dump(exclude_defaults=True)
    return {"limit": options.every.limit, **asked, **own}
