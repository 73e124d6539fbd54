"""One TOML file is a study: read, checked, frozen. Every message about a config is made here."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from importlib import resources
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    ValidationError,
    field_validator,
)

from experiment.design import Factors
from experiment.errors import InputError
from experiment.folders import PARTICIPANT
from experiment.own_models import beside
from experiment.parameter_tables import from_table
from experiment.study_files import LARGEST_TEXT, read_beside, read_toml
from renderer.techniques.dynamic import DynamicTransparency
from tasks.parameters import AbstractParameters, BuildingParameters

TaskName = Literal["count", "pattern", "unique", "count_in_building"]
TASK_SCENARIO: Mapping[str, str] = {
    "count": "abstract",
    "pattern": "abstract",
    "unique": "walkthrough",
    "count_in_building": "walkthrough",
}


QuestionnaireBlock = Literal["ratings", "comparison", "tlx", "sus", "depth_test", "remarks"]

# What `analysis` knows by these names; a contract test holds both to each other.
AnalysisTest = Literal["time", "accuracy", "ratings", "tradeoff", "validity", "mixed"]
EXCLUSIONS = ("timed_out", "focus_lost", "frames_missed")


def _exclusion(value: str) -> str:
    kind, _, name = value.partition(":")
    if value not in EXCLUSIONS and not (kind == "participant" and PARTICIPANT.fullmatch(name)):
        raise ValueError(f"one of {', '.join(EXCLUSIONS)} or participant:ID")
    return value


def _as_tuple(value: Any) -> Any:
    """TOML has arrays, frozen tables have tuples."""
    return tuple(value) if isinstance(value, list) else value


def _once(value: tuple[str, ...]) -> tuple[str, ...]:
    if len(set(value)) < len(value):
        raise ValueError("each name once")
    return value


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


class StudyTable(_Table):
    """[study]: what it is."""

    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9]{1,32}$")]
    title: Annotated[str, Field(min_length=1, max_length=200)]
    description: Annotated[str, Field(min_length=1)]
    participants: Annotated[int, Field(ge=1, le=10_000)]
    seed: Annotated[int, Field(ge=0, lt=2**63)]
    language: Annotated[str, Field(pattern=r"^[a-z]{2}$")] = "en"


class DesignTable(_Table):
    """[design]: what is crossed, and how often.

    Transparency levels are to be equally hard: `tolerance` bounds their difference in the shares of
    the targets that can be seen and that are hidden, `imbalance` that in the numbers of targets,
    occluders and visible objects and in the way to walk, as a share of their mean. Scenes named in
    `redraw` are drawn again to keep both (experiment/certificate.py).
    """

    transparency: Annotated[
        tuple[Literal["standard", "dynamic"], ...], Field(min_length=1, max_length=2)
    ] = ("standard", "dynamic")
    tasks: Annotated[tuple[TaskName, ...], Field(min_length=1)] = (
        "count",
        "pattern",
        "unique",
        "count_in_building",
    )
    trials: Annotated[int, Field(ge=1, le=100)] = 3
    training: Annotated[int, Field(ge=0, le=20)] = 1
    redraw: tuple[str, ...] = ()
    tolerance: Annotated[float, Field(gt=0, le=1)] = 0.05
    imbalance: Annotated[float, Field(gt=0, le=2)] = 0.2

    _arrays = field_validator("transparency", "tasks", "redraw", mode="before")(_as_tuple)
    _unique = field_validator("transparency", "tasks")(_once)

    def factors(self) -> Factors:
        """The design's factors, tasks grouped by scenario in the order of the scenarios."""
        scenarios = ("abstract", "walkthrough")
        tasks = {s: tuple(t for t in self.tasks if TASK_SCENARIO[t] == s) for s in scenarios}
        present = {s: ts for s, ts in tasks.items() if ts}
        return Factors(self.transparency, present, self.trials, self.training, redraw=self.redraw)


class DisplayTable(_Table):
    """[display]: the window, in pixels, and what it promises.

    `samples` for antialiasing: "auto" takes 4 on a graphics card and none on a software
    rasteriser, which would miss 60 Hz.
    """

    width: Annotated[int, Field(ge=1, le=8192)] = 800
    height: Annotated[int, Field(ge=1, le=8192)] = 600
    fullscreen: bool = False
    refresh: Annotated[float, Field(ge=10, le=1000)] = 60.0
    samples: Literal["auto", 0, 2, 4, 8] = "auto"


class SessionTable(_Table):
    """[session]: limits in seconds, 0 is none (training: 004 §VI-G); pages before and after.

    `consent` is a text file beside the study's; `resume` says where an interrupted session goes
    on: at the start of the block it broke off in, or at the trial. A session not heard of for
    `stale_after` loses its slot when somebody needs one. `ledger` is the address of a PostgreSQL
    that many stations share (its password belongs into PostgreSQL's own password file).
    """

    training_limit: Annotated[float, Field(ge=0, le=1e9)] = 300.0
    trial_limit: Annotated[float, Field(ge=0, le=1e9)] = 0.0
    session_limit: Annotated[float, Field(ge=0, le=1e9)] = 4800.0
    consent: str = ""
    demographics: bool = False
    color_check: bool = False
    questionnaire: tuple[QuestionnaireBlock, ...] = ("ratings", "comparison", "remarks")
    resume: Literal["block", "trial"] = "block"
    stale_after: Annotated[float, Field(ge=0, le=1e9)] = 86_400.0
    # Where slots are kept is no part of what is studied: not in the digest, nor in any sidecar.
    ledger: Annotated[str, Field(pattern=r"^(postgresql://([^:@/]+@)?[^@]+)?$", exclude=True)] = ""

    _arrays = field_validator("questionnaire", mode="before")(_as_tuple)
    _unique = field_validator("questionnaire")(_once)


class AnalysisTable(_Table):
    """[analysis]: what is decided before anybody is invited; the report lists deviations."""

    alpha: Annotated[float, Field(gt=0, lt=1)] = 0.05
    tests: tuple[AnalysisTest, ...] = ()
    exclude: tuple[Annotated[str, AfterValidator(_exclusion)], ...] = ()

    _arrays = field_validator("tests", "exclude", mode="before")(_as_tuple)
    _unique = field_validator("tests", "exclude")(_once)


class Study(_Table):
    """A whole study, checked."""

    study: StudyTable
    design: DesignTable = DesignTable()
    abstract: Annotated[AbstractParameters, from_table(AbstractParameters)] = AbstractParameters()
    walkthrough: Annotated[BuildingParameters, from_table(BuildingParameters)] = (
        BuildingParameters()
    )
    dynamic: Annotated[DynamicTransparency, from_table(DynamicTransparency)] = DynamicTransparency()
    display: DisplayTable = DisplayTable()
    session: SessionTable = SessionTable()
    analysis: AnalysisTable = AnalysisTable()
    texts: dict[str, str] = {}

    def resolved(self) -> dict[str, Any]:
        """Every value, defaults included, as plain JSON types."""
        table = json.loads(self.model_dump_json())
        for model in table["walkthrough"]["models"]:
            del model["folder"]  # where a file lies differs between stations that run one study
        return table

    def with_walkthrough(self, parameters: BuildingParameters) -> Study:
        """The study with another building."""
        return self.model_copy(update={"walkthrough": parameters})

    def digest(self) -> str:
        """SHA-256 of the resolved study: two sessions with the same digest ran the same study."""
        text = json.dumps(self.resolved(), sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()


def shipped() -> dict[str, Path]:
    """Name → file of the studies that ship in configs/."""
    folder = Path(str(resources.files("configs")))
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
        f"{_short(name)}: no such file; expected a TOML file or one of: {', '.join(shipped())}"
    )


def _is_there(path: Path) -> bool:
    """Whether there is something that is no folder: what it is, reading it will say."""
    try:
        return os.path.lexists(path) and not path.is_dir()
    except (OSError, ValueError):  # a name that is too long for the disk, or holds a null byte
        return False


def load(name: str) -> Study:
    """Read and check a study. Raises InputError with file, key, value and what was expected."""
    path = find(name)
    study = _with_consent(parse(read_toml(path), str(path)), path)
    return study.with_walkthrough(beside(study.walkthrough, path))


def _with_consent(study: Study, path: Path) -> Study:
    """The study with the text of its consent file among its texts. Raises InputError."""
    if not study.session.consent:
        return study
    try:
        data = read_beside(path, study.session.consent, LARGEST_TEXT)
        text = data.decode("utf-8-sig").strip()
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        reason = "not UTF-8" if isinstance(error, UnicodeDecodeError) else reason
        raise InputError(
            f"{path}: session.consent = {_show(study.session.consent)}: expected a text file "
            f"beside the study ({reason})"
        ) from None
    return study.model_copy(update={"texts": {**study.texts, "consent.text": text}})


def parse(table: Mapping[str, Any], file: str) -> Study:
    """Check a study that is already a table; `file` is named in messages. Raises InputError."""
    try:
        study = Study.model_validate(dict(table))
    except ValidationError as error:
        raise InputError(f"{file}: {_message(error, table)}") from None
    _check_models(study.walkthrough, file)
    return study


def _check_models(parameters: BuildingParameters, file: str) -> None:
    """The building's models are there, each once, and enough of them to tell one from others."""
    types, own = parameters.types, [model.name for model in parameters.models]
    if not types and not own:
        return
    from renderer.models import MODELS

    for number, name in enumerate(own):
        if name in MODELS or own.count(name) > 1:
            raise InputError(
                f"{file}: walkthrough.models[{number}].name = {_show(name)}: expected a name that "
                "no other model has"
            )
    known = {*MODELS, *own}
    wrong = [t for t in types if t not in known or types.count(t) > 1]
    if wrong or (types and len(types) < 3 and parameters.objects > 1):
        raise InputError(
            f"{file}: walkthrough.types = {_show(wrong or types)}: expected three or more of "
            f"{', '.join(sorted(known))}, each once"
        )


def _message(error: ValidationError, table: Mapping[str, Any]) -> str:
    """The first problem: key = value: what was expected (and how many more there are)."""
    problems = error.errors(include_url=False)
    first = problems[0]
    key = _key(first["loc"], table)
    more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
    kind = first["type"]
    if kind == "missing":
        return f"{key}: missing, expected a value{more}"
    if kind == "extra_forbidden":
        return f"{key} = {_show(first['input'])}: unknown key{more}"
    reason = _plain(first["msg"])
    if kind == "value_error" and " = " in reason:
        # The parameters check themselves, and name the field and the value.
        return f"{key}.{reason.replace(', expected ', ': expected ', 1)}{more}"
    return f"{key} = {_show(first['input'])}: expected {reason}{more}"


# pydantic's words → ours, in this order.
_WORDS = (
    ("Value error, ", ""),
    ("Input should be ", ""),
    ("String should match pattern", "text that matches"),
    ("Tuple should have", ""),
    (" after validation", ""),
    ("a valid dictionary or instance of", "a table, as"),
    ("an instance of", "a table, as"),
    ("should ", ""),
)


def _plain(message: str) -> str:
    for theirs, ours in _WORDS:
        message = message.replace(theirs, ours)
    return _one_line(message)


def _key(location: Sequence[int | str], table: Mapping[str, Any]) -> str:
    """The dotted key as the file has it: pydantic adds names of types, which no file has."""
    parts: list[str] = []
    here: Any = table
    for i, part in enumerate(location):
        if isinstance(part, int):
            parts[-1:] = [f"{parts[-1]}[{part}]"] if parts else [f"[{part}]"]
            here = here[part] if isinstance(here, Sequence) and part < len(here) else None
        elif i == len(location) - 1 or (isinstance(here, Mapping) and part in here):
            parts.append(_short(str(part)))
            here = here.get(part) if isinstance(here, Mapping) else None
    return ".".join(parts) or "the file"


def _show(value: Any) -> str:
    return _short(_one_line(json.dumps(value, default=str, ensure_ascii=False)))


def _short(text: str) -> str:
    return text if len(text) <= 60 else text[:57] + "…"


def _one_line(text: str) -> str:
    return " ".join(text.split())
