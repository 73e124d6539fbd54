"""The keys that every question of a study has, whatever its kind."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import field_validator

from seethrough.experiment.errors import short
from seethrough.experiment.study.tables.scopes import BLOCK
from seethrough.experiment.study.tables.study_tables import Table, as_tuple, key

MOMENTS = ("start", "trial", "task_set", "condition", "end")
Wanted = str | int | float | tuple[str | int | float, ...] | Mapping[str, int | float]
GIVEN = "a table of item and a number, a text, an array of them, or { least = 1, most = 3 }"


def is_wanted(value: object) -> bool:
    """Whether it can be what an earlier answer has to be."""
    if isinstance(value, Mapping):
        numbers = [_is_number(v) for v in value.values()]
        return bool(value) and set(value) <= {"least", "most"} and all(numbers)
    if isinstance(value, list | tuple):
        return bool(value) and all(isinstance(v, str) or _is_number(v) for v in value)
    return isinstance(value, str) or _is_number(value)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


STARTS = ("consent", "demographics", "color_check")  # asked at the start unless a study says not


class QuestionTable(Table):
    """[questions]: a named table each, asked in this order; the name is the kind or block to use,
    unless `use` says another. A kind's own keys stand beside these."""

    use: Annotated[str, key("the kind of question, or ready block; empty: its own name")] = ""
    when: Annotated[
        Literal["", "start", "trial", "task_set", "condition", "end"],
        key("when it is asked: at the start or the end, or after each trial, task set or "
            "condition; empty: when such a block usually is", scope=BLOCK),
    ] = ""  # fmt: skip
    each: Annotated[
        tuple[str, ...] | None,
        key("once for each level of these factors, the last time that they are met; none: as such "
            "a block usually is", said="an array of factors' names", scope=BLOCK),
    ] = None  # fmt: skip
    only: Annotated[
        Mapping[str, str | tuple[str, ...]],
        key("only for these levels", said="a table of factor and level, or levels", scope=BLOCK,
            default_factory=dict),
    ]  # fmt: skip
    given: Annotated[
        Mapping[str, Wanted],
        key("only if an item of an earlier question was answered so, about the same levels",
            said=GIVEN, scope=BLOCK, default_factory=dict),
    ]  # fmt: skip
    order: Annotated[
        Literal["", "shuffled"],
        key("`shuffled`: neighbours that say so come in another order for each participant"),
    ] = ""
    of: Annotated[str, key("the factor whose levels are compared")] = ""
    off: Annotated[bool, key("not asked: a level may switch a question off", scope=BLOCK)] = False
    file: Annotated[str, key("text file beside the study's, of a page to be agreed to")] = ""

    _arrays = field_validator("each", mode="before")(as_tuple)

    @field_validator("only", mode="before")
    @classmethod
    def _levels(cls, value: object) -> object:
        if not isinstance(value, Mapping):
            return value
        return {k: tuple(v) if isinstance(v, list) else v for k, v in value.items()}

    @field_validator("given", mode="before")
    @classmethod
    def _given(cls, value: object) -> object:
        if not isinstance(value, Mapping):
            return value
        for item, wanted in value.items():
            if not is_wanted(wanted):
                raise ValueError(f"{GIVEN} (of {short(item)})")
        return cls._levels(value)
