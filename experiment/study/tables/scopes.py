"""When a key of a study can change, as declared where the keys are: see `key(..., scope=…)` of
experiment/study/tables/study_tables.py.

    fixed     the same in the whole study
    session   the same in a whole session: between factors only
    block     the same in a whole block
    trial     from trial to trial: all that one sees
"""

from __future__ import annotations

from functools import cache

from pydantic.fields import FieldInfo

FIXED, SESSION, BLOCK, TRIAL = "fixed", "session", "block", "trial"

# Tables whose keys plug-ins and the renderer declare; every key in them has the table's scope.
OF_PLUGINS = {
    "technique": TRIAL, "world": TRIAL, "look": TRIAL, "task": BLOCK, "questions": BLOCK,
    "texts": FIXED,
}  # fmt: skip

SCENES = ("world", "task")  # tables that make scenes


@cache
def sections() -> tuple[str, ...]:
    """Tables of a study file, `factors` left out."""
    from seethrough.experiment.study.tables.study_tables import TABLES

    return (*TABLES, *OF_PLUGINS)


def scope_of(path: tuple[str, ...]) -> str:
    """The scope of a key of a known table; an unknown key's is that of its table's widest."""
    from seethrough.experiment.study.tables.study_tables import TABLES

    table, *rest = path
    if table in OF_PLUGINS:
        return OF_PLUGINS[table]
    fields = TABLES[table].model_fields
    if rest and rest[0] in fields:
        return _said(fields[rest[0]])
    scopes = {_said(field) for field in fields.values()}
    if rest:
        return TRIAL  # unknown: the table's own check says so
    return next(s for s in (FIXED, SESSION, BLOCK, TRIAL) if s in scopes)


def changes_scenes(path: tuple[str, ...]) -> bool:
    """Whether another value of the key may make other scenes, or ask something else of them."""
    return path[0] in SCENES or path[:2] == ("design", "tasks")


def _said(field: FieldInfo) -> str:
    """The scope that a key is declared with."""
    more = field.json_schema_extra
    return str(more.get("scope", FIXED)) if isinstance(more, dict) else FIXED
