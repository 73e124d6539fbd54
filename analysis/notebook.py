"""Data and results of a study as tables of pandas; what `seethrough.api` offers of the analysis."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd

    from seethrough.analysis.design import Design
    from seethrough.analysis.page.blocks import Table


@dataclass(frozen=True, slots=True)
class Loaded:
    """A study's verified data.

    `trials`: a row for each trial that was recorded, with every column that the study's factors and
    measures have; `left_out` says by which rule a trial does not count in the report, "" where it
    does. `answers`: a row for each answer of the questionnaire. Columns of factors, tasks and
    participants are categories in the study's order; times are seconds; right and timed_out are 0
    and 1, missing values NaN. `design`: factors, tasks with their measures, predictions.
    """

    trials: pd.DataFrame
    answers: pd.DataFrame
    design: Design
    source: str

    @property
    def factors(self) -> list[str]:
        """The factors' columns, in the study's order."""
        return [factor.name for factor in self.design.factors]

    @property
    def counted(self) -> pd.DataFrame:
        """The trials that count in the report."""
        return self.trials[self.trials["left_out"] == ""]


def load(data: str | PathLike[str], source: str | None = None) -> Loaded:
    """Read and verify a data folder, as the report does.

    `source` chooses among several: "human", "simulated", "pilot". Raises
    `seethrough.analysis.errors.DataError`, a line for each fault, where a report would be refused.
    """
    import pandas as pd

    from seethrough.analysis.exclude import apply_rules
    from seethrough.analysis.load.plan import make_plan
    from seethrough.analysis.load.study import load_study

    study = load_study(Path(data), source)
    plan = make_plan(study)
    _, excluded = apply_rules(study.trials, plan.exclude, plan.too_fast)
    why = {e.row_id: e.rule for e in excluded}
    left_out = [why.get(str(row), "") for row in study.trials["row_id"]]
    levels = {**study.design.levels, "task": study.design.task_names}

    def ordered(table: pd.DataFrame) -> pd.DataFrame:
        known = {}
        for name in (n for n in table.columns if n in levels):
            texts = table[name].astype("str")
            there = texts.where(texts.isin(levels[name]))  # answers asked once have no level
            known[name] = pd.Categorical(there, categories=list(levels[name]), ordered=True)
        plain = [name for name in table.columns if not name.startswith("_")]
        return table[plain].assign(**known)

    trials = ordered(study.trials).assign(left_out=left_out)
    return Loaded(trials, ordered(study.questionnaire), study.design, study.source)


def results(
    data: str | PathLike[str], source: str | None = None, seed: int = 1
) -> Mapping[str, pd.DataFrame]:
    """The tables of a folder's report, by the names of their CSV files, rows by their first column.

    Numbers are at full precision; what does not exist is NaN, and `frame.attrs["undefined"]` says
    why, by (row, column); `frame.attrs["title"]` and `["note"]` are the table's. `seed`: of what
    is drawn (permutations). Raises DataError where a report would be refused.
    """
    from seethrough.analysis.report import Options, make_report, tables_of

    report = make_report(Path(data), Options(source=source, seed=seed))
    return {table.key: _frame(table) for table in tables_of(report)}


def _frame(table: Table) -> pd.DataFrame:
    """A report's table as a data frame."""
    import pandas as pd

    from seethrough.analysis.stats.undefined import Undefined

    names = [column.name for column in table.columns]
    rows: dict[str, list[object]] = {name: [] for name in names}
    why: dict[tuple[str, str], str] = {}
    for row in table.rows:
        for name in names:
            value = row.get(name)
            if isinstance(value, Undefined):
                why[str(row[names[0]]), name] = value.reason
                value = float("nan")
            rows[name].append(value)
    frame = pd.DataFrame(rows).set_index(names[0])
    frame.attrs.update(title=table.title, note=table.note, undefined=why)
    return frame
