"""The keys of a study file as they are declared: for messages, and the reference docs/keys.md.

`python -m seethrough.experiment.study.tables.keys` writes the reference anew.
"""

from __future__ import annotations

import dataclasses
import sys
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Literal, TypeAlias, get_args, get_origin, get_type_hints

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from seethrough.experiment.errors import shown
from seethrough.experiment.generated import write_anew
from seethrough.experiment.study.tables import plugins
from seethrough.experiment.study.tables.factor_tables import FACTOR_KEYS
from seethrough.experiment.study.tables.question_table import STARTS, QuestionTable
from seethrough.experiment.study.tables.study_tables import (
    TABLES,
    MarginsTable,
    PredictionTable,
    SelectTable,
    TaskTable,
)
from seethrough.renderer.declared import Declares, Key, allowed, declared
from seethrough.renderer.scene.look import Look

REFERENCE = Path(__file__).resolve().parents[3] / "docs" / "keys.md"
REQUIRED = object()

ABOUT = {
    "study": "What the study is.",
    "factors.NAME": "What the study varies: a table each, whose name becomes a column.",
    "design": "Orders, and what happens in each condition.",
    "design.select": "The rule by which scenes are selected, said before anybody is invited: "
    "`power --scenes` holds them to it, the report says that scenes were selected.",
    "practice": "Before the trials of each task set.",
    "display": "The window, and what it promises.",
    "session": "Its limit, and what becomes of a broken-off session.",
    "analysis": "What is decided before anybody is invited.",
    "analysis.margins": "Differences that would not matter; a measure without one has none.",
    "analysis.predictions": "What is expected, a table `[[analysis.predictions]]` each.",
    "technique": "What draws; a factor's levels may each name another one.",
    "world": "Where tasks are done; a factor's levels may each name another one.",
    "look": "How the picture looks besides what the technique shows: cues of depth and contact. "
    "All are off without being set.",
    "task": "What holds for each task.",
    "task.NAME": "What holds for one task.",
    "questions.NAME": "A named table each, asked in this order.",
    "world.building.models": "A model of the study's own, `[[world.building.models]]` each.",
    "world.scene.tags": "What things of a scene are, `[[world.scene.tags]]` each: entries for all "
    "things whose names fit, the last one holds, beside what the file's extras say.",
    "world.scene.items": "An item: a scene and what is asked in it, `[[world.scene.items]]` each.",
    "world.abstract.tags": "What things of a kind are, `[[world.abstract.tags]]` each.",
    "world.building.tags": "What things of a kind are, `[[world.building.tags]]` each.",
}


BY_HAND = ("factors.NAME", "technique", "world")  # whose keys no class declares


# A table of ours, the parameters of a plug-in, or what each key may be and means.
Declaring: TypeAlias = type[BaseModel] | type[Declares] | Mapping[str, tuple[str, str]]


@cache
def tables() -> dict[str, Declaring]:
    """Table of a study file → what declares its keys."""
    found: dict[str, Declaring] = {"study": TABLES["study"], "factors.NAME": FACTOR_KEYS}
    found |= {"design": TABLES["design"], "design.select": SelectTable}
    found["practice"] = TABLES["practice"]
    for kind, said in (("technique", "what draws"), ("world", "where tasks are done")):
        found[kind] = {"use": (f"one of {', '.join(plugins.names(kind))}", said)}
        for name in plugins.names(kind):
            cls = plugins.parameters(kind, name)
            found[f"{kind}.{name}"] = cls
            found |= {f"{kind}.{name}.{n}": c for n, c in plugins.inner_tables(cls).items()}
    found["look"] = Look
    found |= {"task": TaskTable, "task.NAME": TaskTable}
    tasks = {name: plugins.parameters("task", name) for name in plugins.names("task")}
    found |= {f"task.{name}": cls for name, cls in tasks.items() if declared(cls)}
    found["questions.NAME"] = QuestionTable
    kinds = plugins.names("question")
    found |= {f"questions.{name}": plugins.parameters("question", name) for name in kinds}
    found |= {name: TABLES[name] for name in ("display", "session", "analysis")}
    return found | {"analysis.margins": MarginsTable, "analysis.predictions": PredictionTable}


def about(table: str) -> str:
    """What the reference says above a table's keys."""
    kind, _, name = table.partition(".")
    said = {"technique": "The technique", "world": "The world"}
    if kind == "questions" and name in plugins.taken_names("question"):
        return _about_ready(name)
    if kind == "questions" and table not in ABOUT:
        of = "Further keys of a question" if keys_of(table) else "A question"
        return f'{of} with `use = "{name}"`, or of that name.'
    if kind == "task" and table not in ABOUT:
        return f"Further keys of the task `{name}`."
    return ABOUT.get(
        table, f'{said.get(kind, "")} `{name}`: parameters of [{kind}] use = "{name}".'
    )


def _about_ready(name: str) -> str:
    from seethrough.experiment.study.tables.ready import READY  # asks for pages: not for --help

    block = READY[name]
    asks = " ".join((block.parts.__doc__ or "").split()).rstrip(".")
    source = "" if block.source == "ours" else f" Source: {block.source}."
    items = ", ".join(f"`{item}`" for item in block.items(block.Parameters(), name))
    when = "start" if name in STARTS else "end"
    return (
        f"The ready block `{name}`: {asks}.{source} It writes {items}, and is asked at the "
        f"{when} unless `when` says another time."
    )


@dataclasses.dataclass(frozen=True)
class StudyKey:
    """A key of a study file: where it stands, what it may be (`allowed`, in words), what it is
    without being set (REQUIRED: it has to be), its unit and its meaning."""

    table: str
    name: str
    allowed: str
    default: object
    unit: str
    meaning: str


@cache
def keys_of(table: str) -> dict[str, StudyKey]:
    """Name → key of a table."""
    declares = tables()[table]
    if isinstance(declares, Mapping):
        return {n: StudyKey(table, n, may, "", "", said) for n, (may, said) in declares.items()}
    if issubclass(declares, BaseModel):
        return {key.name: key for key in _of_model(table, declares)}
    found = _of_parameters(table, declares)
    return {key.name: key for key in found}


def _of_parameters(table: str, cls: type[Declares]) -> Iterator[StudyKey]:
    hints = get_type_hints(cls)
    defaults = {f.name: f.default for f in dataclasses.fields(cls)}
    for name, said in declared(cls).items():
        default = REQUIRED if defaults[name] is dataclasses.MISSING else defaults[name]
        yield StudyKey(table, name, allowed(hints[name], said), default, said.unit, said.meaning)


def _of_model(table: str, model: type[BaseModel]) -> Iterator[StudyKey]:
    for name, field in model.model_fields.items():
        extra = field.json_schema_extra
        more = {"unit": "", "said": "", **(extra if isinstance(extra, Mapping) else {})}
        inner = f"{table}.{name}"
        table_of = f"a table, [{inner}]" if inner in tables() else ""
        may = str(more["said"]) or table_of or _allowed(field)
        default = REQUIRED if field.is_required() else field.get_default(call_default_factory=True)
        yield StudyKey(table, name, may, default, str(more["unit"]), field.description or "")


def _allowed(field: FieldInfo) -> str:
    """What a field of pydantic's may be, from its type and its limits."""
    hint = field.annotation
    if get_origin(hint) is Literal:
        return f"one of {_choices(hint)}"
    if get_origin(hint) is tuple:
        inner = get_args(hint)[0]
        listed = get_origin(inner) is Literal
        return f"an array of {f'some of {_choices(inner)}, each once' if listed else 'texts'}"
    limits: dict[str, float] = {}
    for limit in field.metadata:
        limits |= {n: getattr(limit, n) for n in ("ge", "gt", "le", "lt") if hasattr(limit, n)}
    low, high = limits.get("ge", limits.get("gt")), limits.get("le", limits.get("lt"))
    words, optional, none = allowed(hint, Key("", low=low, high=high)).partition(", or no such")
    if low is not None and high is None:
        words += f" from {low:g}"
    above = [f"above {low:g}"] if "gt" in limits else []
    below = [f"below {high:g}"] if "lt" in limits else []
    return ", ".join([words, *([" and ".join(above + below)] if above or below else [])]) + (
        optional + none
    )


def _choices(hint: object) -> str:
    return ", ".join(shown(choice) for choice in get_args(hint))


def reference() -> str:
    """docs/keys.md."""
    parts = [_HEAD]
    for table in tables():
        double = table.endswith((".models", ".predictions"))
        head = f"## `[[{table}]]`" if double else f"## `[{table}]`"
        if not keys_of(table):
            none = "It has no keys" + " of its own" * table.startswith("questions.")
            parts.append(f"{head}\n\n{about(table)} {none}.")
            continue
        columns = ("| key | may be | default | unit | meaning |", "| --- | --- | --- | --- | --- |")
        rows = map(_row, keys_of(table).values())
        parts.append("\n".join([head, "", about(table), "", *columns, *rows]))
    return "\n\n".join([*parts, _TAIL])


def _row(key: StudyKey) -> str:
    default = "required" if key.default is REQUIRED else _default(key.default)
    default = "none" if default == '`""`' and key.table in BY_HAND else default
    return f"| `{key.name}` | {key.allowed} | {default} | {key.unit} | {key.meaning} |"


def _default(value: object) -> str:
    if isinstance(value, BaseModel):
        return "its keys'"
    if value is None:
        return "none"
    if isinstance(value, float):
        return f"`{value:.6g}`" if value != int(value) else f"`{value:.1f}`"
    if isinstance(value, tuple):
        return f"`[{', '.join(shown(v) for v in value)}]`"
    return f"`{shown(value)}`"


_HEAD = """# The keys of a study file

Made by `python -m seethrough.experiment.study.tables.keys` from what the code declares: change the
declaration, not this page. A study file is TOML, in UTF-8; `seethrough check FILE --config-only`
reads it and names every fault. What is not set has its default, which is that of the published
study."""

_TAIL = """## Code of your own

A technique, world, task or kind of question that is in none of these tables is brought along:
`[technique.NAME]`, `[world.NAME]`, `[task.NAME]` or `[question.NAME]` with its `file`, a Python
file beside the study, as `[task.nearer]` with `file = "nearer.py"`. Its own keys stand beside
`file`, those of a question in `[questions]`.

## `[texts]`

Any text that participants read, by its name in `experiment/pages/languages/en.toml` or in the
`texts/en.toml` of a task or world, table and key with a dot between: `"welcome.text" = "Hello."`
An unknown name is refused.

## When is an answer right?

The column `correct` of a trial says it (data/README.md):

- T1 `count` and T4 `count_in_building`: the number is exactly the true one.
- T2 `pattern`: the letter is the one that the red cones form.
- T3 `unique`: the mark lies in the same room as the thing. Rooms differ in size, so a mark may be
  right at 9 world units from the thing, or wrong at 1 where a wall lies between; how far it is off
  stands in `distance`.
- `depth_order`: the mark is that of the thing whose middle is nearer.
- `read`: the digit is the one on the sign.
"""


if __name__ == "__main__":
    sys.exit(write_anew(REFERENCE, reference, "It lists what a study file may say."))
