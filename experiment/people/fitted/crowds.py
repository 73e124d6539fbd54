"""Crowds that one process plays or several: the same rows, whoever played whom."""

from __future__ import annotations

import time
from collections.abc import Collection
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from types import TracebackType

from seethrough.experiment.people.fitted.calibration import TrialRow
from seethrough.experiment.people.fitted.fitting import Crowd
from seethrough.experiment.people.runs.looks import KeptLooks
from seethrough.experiment.people.runs.pool import Pool, drawing
from seethrough.experiment.study.config import Study
from seethrough.tasks.kit.skills.profile import Profile

CHUNK = 8  # people that a worker plays at a time


class Crowds:
    """Makes crowds of a study: `with Crowds(study, 60, tables, 2) as crowds: crowds.crowd(1, 96)`.

    Workers stay from evaluation to evaluation, with their worlds and with the looks in `tables`.
    """

    def __init__(self, study: Study, pool: int, tables: Path, workers: int = 1) -> None:
        self._of = study, pool, tables
        self._pool = drawing(study, pool, KeptLooks(tables))
        self._executor = None if workers == 1 else _executor(workers, self._of)
        self._elsewhere = 0.0

    def __enter__(self) -> Crowds:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._executor is not None:
            self._executor.shutdown(cancel_futures=True)

    def crowd(self, seed: int, count: int) -> Crowd:
        """So many people, spread evenly over what people are like."""
        if self._executor is None:
            return Crowd(seed, count, self._pool)
        return _Shared(seed, count, self._pool, self)

    def seconds(self) -> float:
        """Processor time so far, of this process and of its workers' plays."""
        return time.process_time() + self._elsewhere

    def play(
        self, seed: int, count: int, profile: Profile, tasks: Collection[str]
    ) -> list[TrialRow]:
        """Rows of a crowd in the order of its people, played by workers."""
        assert self._executor is not None
        parts = [range(i, min(i + CHUNK, count + 1)) for i in range(1, count + 1, CHUNK)]
        asked = [(seed, count, part, profile, tuple(tasks)) for part in parts]
        rows: list[TrialRow] = []
        for played, seconds in self._executor.map(_play, asked):
            rows += played
            self._elsewhere += seconds
        return rows


class _Shared(Crowd):
    """A crowd that workers play."""

    def __init__(self, seed: int, count: int, pool: Pool, crowds: Crowds) -> None:
        super().__init__(seed, count, pool)
        self._crowds = crowds

    def play(self, profile: Profile, tasks: Collection[str]) -> list[TrialRow]:
        """As anybody would play it alone."""
        return self._crowds.play(self.seed, len(self.slots), profile, tasks)


_made: list[Pool] = []  # the one that `_begin` made in a worker


def _executor(workers: int, of: tuple[Study, int, Path]) -> ProcessPoolExecutor:
    # Spawned, not forked: a forked process would share this one's graphics context.
    return ProcessPoolExecutor(
        workers, mp_context=get_context("spawn"), initializer=_begin, initargs=of
    )


def _begin(study: Study, pool: int, tables: Path) -> None:
    _made[:] = [drawing(study, pool, KeptLooks(tables))]


def _play(
    asked: tuple[int, int, range, Profile, Collection[str]],
) -> tuple[list[TrialRow], float]:
    """Rows of some people of a crowd, and the processor time that they took."""
    seed, count, slots, profile, tasks = asked
    crowd = Crowd(seed, count, _made[-1])
    crowd.slots = slots
    began = time.process_time()
    return crowd.play(profile, tasks), time.process_time() - began
