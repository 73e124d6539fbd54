"""What a task measures: a column of the trial table, and all that statistics have to know of it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Literal


@dataclass(frozen=True)
class Measure:
    """A measure by the `name` of its column.

    `direction` says which values are better. `adds` says how a person's trials in a cell become one
    value: by their mean, sum or median, or as the share of those that are true; signed errors as
    "relative" ones, |Σ error| / Σ truth, where over- and underestimates cancel, or as "relative
    absolute" ones, Σ |error| / Σ truth. `log`: differences
    are ratios, so logarithms are compared. `rows`: "right" leaves out trials whose answer is wrong.
    `margin` is a difference too small to matter, in the measure's unit (a ratio where `log`); most
    measures leave that to the study. `column`: whose values it is made of, where that has another
    name. `pool`: its tasks are also taken together. `price`: what time is set against.
    """

    name: str
    unit: str
    direction: Literal["less", "more"]
    scale: Literal["ratio", "count", "bounded", "ordinal", "binary", "censored"]
    adds: Literal["mean", "sum", "median", "share", "relative", "relative absolute"] = "mean"
    log: bool = False
    rows: Literal["all", "right"] = "all"
    margin: float | None = None
    label: str = ""
    column: str = ""
    pool: bool = False
    price: bool = False

    @property
    def of(self) -> str:
        """The column of its values."""
        return self.column or self.name

    def as_dict(self) -> dict[str, object]:
        """As a sidecar has it: plain JSON types."""
        return asdict(self)


# Times come from the session, not from a task: every task has this one, and every task knows
# whether an answer is right.
TIME = Measure("time", "s", "less", "ratio", log=True, label="completion time", pool=True)
CORRECT = Measure("correct", "", "more", "binary", "share", label="right answers")
COUNT_ERROR = Measure(
    "count_error", "", "less", "count", "relative", label="relative error", pool=True
)
ABSOLUTE_ERROR = Measure(
    "absolute_error", "", "less", "count", "relative absolute", label="absolute relative error",
    column="count_error", pool=True, price=True,
)  # fmt: skip
# Of any task whose study asks for it.
CONFIDENCE = Measure("confidence", "", "more", "ordinal", label="confidence")
DISTANCE = Measure("distance", "units", "less", "ratio", label="distance", price=True)
WRONG_CLICKS = Measure("wrong_clicks", "", "less", "count", label="wrong clicks", price=True)
MISSES = Measure("misses", "", "less", "count", label="misses", price=True)
