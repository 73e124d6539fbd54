"""What a task measures: a column of the trial table, and all that statistics have to know of it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, Literal


@dataclass(frozen=True)
class Measure:
    """A measure by the `name` of its column.

    `direction` says which values are better. `adds` says how a person's trials in a cell become one
    value: by their mean, sum or median, or as the share of those that are true. `log`: differences
    are ratios, so logarithms are compared. `rows`: "right" leaves out trials whose answer is wrong.
    `margin` is a difference too small to matter, in the measure's unit (a ratio where `log`); most
    measures leave that to the study.
    """

    name: str
    unit: str
    direction: Literal["less", "more"]
    scale: Literal["ratio", "count", "bounded", "ordinal", "binary", "censored"]
    adds: Literal["mean", "sum", "median", "share"] = "mean"
    log: bool = False
    rows: Literal["all", "right"] = "all"
    margin: float | None = None
    label: str = ""

    def as_dict(self) -> dict[str, Any]:
        """As a sidecar has it: plain JSON types."""
        return asdict(self)


# Times come from the session, not from a task: every task has this one, and every task knows
# whether an answer is right.
TIME = Measure("time", "s", "less", "ratio", log=True, label="completion time")
CORRECT = Measure("correct", "", "more", "binary", "share", label="right answers")
COUNT_ERROR = Measure("count_error", "objects", "less", "count", label="error of the count")
DISTANCE = Measure("distance", "world units", "less", "ratio", label="distance of the mark")
