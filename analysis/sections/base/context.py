"""What every section is given."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from numpy.random import Generator
from numpy.typing import NDArray

from seethrough.analysis.cells import Cells, Missing
from seethrough.analysis.design import Design
from seethrough.analysis.exclude import Excluded
from seethrough.analysis.load.plan import Plan
from seethrough.analysis.load.study import Study
from seethrough.analysis.measures import groups_of


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
        """Note who lacks a cell of an analysis: left out of what needs that cell.

        Cells that nobody of a person's group has are not lacking: the study leaves them out, or
        gives them to another group.
        """
        groups = self.design.groups
        own = [groups_of(self.study.trials, f, cells.participants) for f in groups]
        keys = list(zip(*own, strict=True)) if own else [()] * len(cells.participants)
        there, expected = np.isfinite(cells.values), {}
        for key in set(keys):
            group = dict(zip((f.name for f in groups), key, strict=True))
            planned = self._planned(cells, group)
            met = there[[k == key for k in keys]].any(axis=0)
            expected[key] = planned & met if groups else planned
        each = np.array([expected[key] for key in keys]).reshape(there.shape)
        self.missing[analysis] = cells.lacking(each)

    def _planned(self, cells: Cells, group: dict[str, str]) -> NDArray[np.bool_]:
        """Which cells a group is to have: all but those that the study leaves out."""
        kept = [
            not self.design.left_out({**group, **dict(zip(cells.factors, at, strict=True))})
            for at in itertools.product(*cells.factors.values())
        ]
        return np.array(kept, dtype=bool).reshape([len(v) for v in cells.factors.values()])

    def rng(self, purpose: int) -> Generator:
        """A stream of its own for each purpose: analysis streams are (3, …)."""
        return np.random.default_rng(np.random.SeedSequence(self.seed, spawn_key=(3, purpose)))
