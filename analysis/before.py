"""The one adapter for data that were recorded before sidecars held a `design`.

Such data are all of one design: transparency within, scenarios that bring two tasks each. Only this
module and `published/` know it by name.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from seethrough.analysis.design import (
    ABSOLUTE,
    RELATIVE,
    Design,
    Factor,
    Item,
    Measured,
    Prediction,
    Task,
)
from seethrough.analysis.errors import DataError, number_above

TRANSPARENCY, SCENARIO = ("standard", "dynamic"), ("abstract", "walkthrough")
TASKS = {"abstract": ("count", "pattern"), "walkthrough": ("unique", "count_in_building")}
MARGINS = {"time": 1.0, "count_error": 0.0, "correct": 0.0, "distance": 0.0}
"""What a margin could be declared of, and above what: of times it is a ratio."""
RATIOS = ("time",)
FACTORS = (
    Factor(
        "transparency",
        "within",
        TRANSPARENCY,
        "standard",
        labels={"standard": "standard transparency", "dynamic": "dynamic transparency"},
        scenes="alone",
    ),
    Factor("scenario", "within", SCENARIO, "abstract", scenes="changed", tasks=TASKS),
)
EACH = ("scenario", "transparency")
ITEMS = (
    Item("efficiency", "efficiency", EACH, "ratings", points=5),
    Item("ease", "ease of use", EACH, "ratings", points=5),
    Item("enjoy", "enjoyment", EACH, "ratings", points=5),
    Item("preference", "preference for dynamic transparency (0 or 1)", of="transparency"),
    Item("depth_self_report", "self-reported depth perception (0–4)"),
    Item("depth_test", "static depth test (correct of 3)"),
)
ACCURACY = ("count_error", "absolute_error", "distance", "correct")


def design_before(config: Mapping[str, object]) -> Design:
    """The design of a study of then; `config`: the resolved study of its sidecars.

    Raises DataError where its margins make no sense.
    """
    analysis = config.get("analysis")
    declared = analysis.get("margins") if isinstance(analysis, Mapping) else None
    margins = _margins(declared or {})
    return Design(FACTORS, _tasks(margins), predictions=_predictions(), items=ITEMS)


def _tasks(margin: Mapping[str, float]) -> tuple[Task, ...]:
    time = Measured(
        "time", "time", "s", log=True, margin=margin.get("time"), label="completion time",
        pool=True, digits=2,
    )  # fmt: skip
    correct = Measured(
        "correct", "correct", direction="more", scale="binary", adds="share",
        margin=margin.get("correct"), label="right answers",
    )  # fmt: skip
    off = margin.get("count_error")
    counting = (
        Measured("count_error", "count_error", adds=RELATIVE, scale="count", margin=off,
                 label="relative error", pool=True),
        Measured("absolute_error", "count_error", adds=ABSOLUTE, scale="count", margin=off,
                 label="absolute relative error", pool=True, price=True),
    )  # fmt: skip
    place = Measured("distance", "distance", "units", margin=margin.get("distance"),
                     label="distance", price=True, digits=2)  # fmt: skip
    return (
        Task("count", "T1", (time, *counting, correct), "T1 count"),
        Task("pattern", "T2", (time, correct), "T2 pattern"),
        Task("unique", "T3", (time, place, correct), "T3 unique"),
        Task("count_in_building", "T4", (time, *counting, correct), "T4 in building"),
    )


def _predictions() -> tuple[Prediction, ...]:
    """The paper's three, in its own words."""
    return (
        Prediction("P1", "dynamic transparency is faster", ("time",), "transparency", "less",
                   "dynamic"),
        Prediction("P2", "dynamic transparency does not cost accuracy", ACCURACY, "transparency",
                   "not worse", "dynamic"),
        Prediction("P3", "static depth perception does not suffer", ("depth_test",), "",
                   "at least"),
    )  # fmt: skip


def _margins(table: object) -> dict[str, float]:
    """The declared margins, checked: a ratio above 1 for times, else above 0 in the own unit."""
    if not isinstance(table, Mapping):
        raise DataError(f"analysis.margins = {table!r}: expected a table")
    unknown = [name for name in table if name not in MARGINS]
    if unknown:
        raise DataError(f"analysis.margins.{unknown[0]}: expected among {', '.join(MARGINS)}")
    return {
        name: number_above(f"margins.{name}", value, MARGINS[name])
        for name, value in table.items()
        if value is not None
    }


def planned_trials(design: Mapping[str, object]) -> int | None:
    """How many trials each was to do, by a config of then; None where it does not say."""
    each, levels, tasks = (design.get(k) for k in ("trials", "transparency", "tasks"))
    if isinstance(each, int) and isinstance(levels, Sequence) and isinstance(tasks, Sequence):
        return each * len(levels) * len(tasks)
    return None
