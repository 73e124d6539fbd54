"""One TOML file is a study: read, checked, frozen."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, Field, ValidationError

from seethrough.experiment.errors import MOST, InputError, gathered, short, shown
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.study.design import Trial, scene_names, slot_of
from seethrough.experiment.study.own_model_files import beside
from seethrough.experiment.study.parameter_tables import Fault, faulty, from_table
from seethrough.experiment.study.study_errors import study_error
from seethrough.experiment.study.study_files import LARGEST_TEXT, read_beside
from seethrough.experiment.study.study_tables import (
    AnalysisTable,
    DesignTable,
    DisplayTable,
    SessionTable,
    StudyTable,
    Table,
)
from seethrough.experiment.study.toml_file import read_toml
from seethrough.renderer.techniques import named
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.tasks.catalog import TASKS, WORLDS
from seethrough.tasks.kit.base import Setting
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters


def _known_models(parameters: BuildingParameters) -> BuildingParameters:
    """The building's models are there, each once, and enough of them to tell one from others."""
    types, own = parameters.types, [model.name for model in parameters.models]
    if not types and not own:
        return parameters
    from seethrough.renderer.models import MODELS

    found = [
        Fault(f"models[{number}].name", name, "a name that no other model has")
        for number, name in enumerate(own)
        if name in MODELS or own.count(name) > 1
    ]
    known = {*MODELS, *own}
    wrong = [t for t in types if t not in known or types.count(t) > 1]
    if wrong or (types and len(types) < 3 and parameters.objects > 1):
        expected = f"three or more of {', '.join(sorted(known))}, each once"
        found.append(Fault("types", wrong or types, expected))
    if found:
        raise faulty(found)
    return parameters


class Study(Table):
    """A whole study, checked."""

    study: StudyTable
    design: DesignTable = DesignTable()
    abstract: Annotated[AbstractParameters, from_table(AbstractParameters)] = AbstractParameters()
    walkthrough: Annotated[
        BuildingParameters, from_table(BuildingParameters), AfterValidator(_known_models)
    ] = BuildingParameters()
    dynamic: Annotated[DynamicTransparency, from_table(DynamicTransparency)] = DynamicTransparency()
    display: DisplayTable = DisplayTable()
    session: SessionTable = SessionTable()
    analysis: AnalysisTable = AnalysisTable()
    texts: dict[str, str] = Field(default_factory=dict)

    def resolved(self) -> dict[str, Any]:
        """Every value, defaults included, as plain JSON types."""
        table = json.loads(self.model_dump_json())
        for model in table["walkthrough"]["models"]:
            del model["folder"]  # where a file lies differs between stations that run one study
        return table

    def technique(self, level: str) -> Any:
        """What a trial of this transparency level is drawn with."""
        return named(level, {"dynamic": self.dynamic})

    def setting(self, trial: Trial) -> Setting:
        """Where and how a trial's task is set."""
        task = TASKS[trial.task]
        worlds = (WORLDS[name] for name in task.worlds)
        world = next(w for w in worlds if w.scenario == trial.scenario)
        return Setting(world, getattr(self, trial.scenario), task.Parameters())

    def with_walkthrough(self, parameters: BuildingParameters) -> Study:
        """The study with another building."""
        return self.model_copy(update={"walkthrough": parameters})

    def digest(self) -> str:
        """SHA-256 of the resolved study: two sessions with the same digest ran the same study."""
        text = json.dumps(self.resolved(), sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()


def shipped() -> dict[str, Path]:
    """Name → file of the studies that ship in configs/."""
    folder = Path(str(resources.files("seethrough.configs")))
    return {p.stem: p for p in sorted(folder.glob("*.toml"))}


def find(name: str) -> Path:
    """The config file for a path or a shipped study's name. Raises InputError."""
    path = Path(name)
    if _is_there(path):
        return path
    if path.name == name and name in shipped():
        return shipped()[name]
    if path.parent == Path("configs") and path.stem in shipped() and path.suffix == ".toml":
        return shipped()[path.stem]
    raise InputError(
        f"{short(name)}: no such file; expected a TOML file or one of: {', '.join(shipped())}"
    )


def _is_there(path: Path) -> bool:
    """Whether there is something that is no folder: what it is, reading it will say."""
    try:
        return os.path.lexists(path) and not path.is_dir()
    except (OSError, ValueError):  # a name that is too long for the disk, or holds a null byte
        return False


def load(name: str) -> Study:
    """Read and check a study. Raises InputError: of each fault file, key, value and what was
    expected."""
    path = find(name)
    table = read_toml(path)
    faults: list[str] = []
    more = 0
    try:
        study = parse(table, str(path))
    except InputError as error:
        faults += error.faults
        more = error.more
    session = table.get("session")
    named = session.get("consent", "") if isinstance(session, Mapping) else ""
    try:
        consent = _consent(named, path) if named and isinstance(named, str) else None
    except InputError as error:
        faults += error.faults
    if faults:
        raise gathered(faults, more)
    if consent is not None:
        study = study.model_copy(update={"texts": {**study.texts, "consent.text": consent}})
    return study.with_walkthrough(beside(study.walkthrough, path))


def _consent(name: str, path: Path) -> str:
    """The text of the consent file beside the study at `path`. Raises InputError."""
    try:
        return read_beside(path, name, LARGEST_TEXT).decode("utf-8-sig").strip()
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        reason = "not UTF-8" if isinstance(error, UnicodeDecodeError) else reason
        raise InputError(
            f"{path}: session.consent = {shown(name)}: expected a text file beside the study "
            f"({reason})"
        ) from None


def parse(table: Mapping[str, Any], file: str) -> Study:
    """Check a study that is already a table; `file` is named in messages. Raises InputError."""
    faults: list[str] = []
    more = 0
    try:
        study = Study.model_validate(dict(table))
    except ValidationError as error:
        found = study_error(error, table, file)
        faults, more = [*found.faults], found.more
    else:
        faults += [f"{file}: {line}" for line in _unknown_scenes(study)]
    faults += [f"{file}: {line}" for line in _unknown_texts(table)]
    if faults:
        raise gathered(faults, more)
    return study


def _unknown_scenes(study: Study) -> list[str]:
    """A scene to be drawn again is one that a participant meets."""
    factors = study.design.factors()
    met: dict[int, list[str]] = {}
    wrong: list[str] = []
    for number, name in enumerate(study.design.redraw):
        slot = slot_of(name)
        if slot not in met:
            met[slot] = scene_names(slot, factors)
        if name not in met[slot]:
            like = f"such as {met[slot][0]}, as `check --redraw` prints them"
            wrong.append(f"design.redraw[{number}] = {shown(name)}: expected a scene of it, {like}")
        if len(wrong) > MOST:
            break
    return wrong


def _unknown_texts(table: Mapping[str, Any]) -> list[str]:
    """Every language has the same texts."""
    texts = table.get("texts")
    if not texts or not isinstance(texts, Mapping):
        return []
    english = Texts("en")
    wrong = [name for name in texts if name not in english.keys()]
    return [f"texts.{short(name)}: {english.unknown(name)}" for name in wrong[: MOST + 1]]
