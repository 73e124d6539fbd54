"""What every section is given."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from numpy.random import Generator

from seethrough.analysis.cells import Cells, Missing
from seethrough.analysis.design import Design
from seethrough.analysis.exclude import Excluded
from seethrough.analysis.load.study import Study
from seethrough.analysis.plan import Plan


@dataclass(frozen=True, slots=True)
class Context:
    """A loaded study, its plan, the trials that count, and a place to note who is missing where.

    `missing` maps an analysis to the participants it had to leave out.
    """

    study: Study
    plan: Plan
    trials: pd.DataFrame
    excluded: tuple[Excluded, ...]
    seed: int
    missing: dict[str, tuple[Missing, ...]] = field(default_factory=dict)

    @property
    def design(self) -> Design:
        """What the study varied and measured."""
        return self.study.design

    @property
    def people(self) -> int:
        """How many participants have data."""
        return int(self.study.trials["participant"].nunique())

    def lacking(self, analysis: str, cells: Cells) -> None:
        """Note who lacks a cell of an analysis: left out of what needs that cell."""
        self.missing[analysis] = cells.missing

    def rng(self, purpose: int) -> Generator:
        """A stream of its own for each purpose: analysis streams are (3, …)."""
        return np.random.default_rng(np.random.SeedSequence(self.seed, spawn_key=(3, purpose)))
