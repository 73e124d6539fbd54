"""Draws figures in a second process while this one goes on with the statistics.

Drawing takes as long as everything else together; a report has two cores to hand. The worker is
started at once, so that it has its libraries when the first figure comes.
"""

from __future__ import annotations

import multiprocessing
from concurrent.futures import Future, ProcessPoolExecutor
from pathlib import Path
from types import TracebackType

from analysis.page.blocks import Figure

FORMATS = ("svg", "png", "pdf")


def _warm_up() -> None:
    import analysis.page.pictures  # noqa: F401


def _draw(figure: Figure, folder: Path) -> str:
    from analysis.page.pictures import write_files

    return write_files(figure, folder, FORMATS)


class Drawing:
    """A context in which figures are drawn into `folder`; `pictures` waits for their inline SVG."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        # spawned, not forked: a fork would copy the threads that numpy's libraries have started
        context = multiprocessing.get_context("spawn")
        self._pool = ProcessPoolExecutor(1, mp_context=context, initializer=_warm_up)
        self._started: Future[None] = self._pool.submit(_warm_up)
        self._pending: dict[str, Future[str]] = {}

    def __enter__(self) -> Drawing:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._pool.shutdown(cancel_futures=kind is not None)

    def add(self, figure: Figure) -> None:
        """Draw `figure` when the worker is free."""
        if figure.key not in self._pending:
            # only now: bad data are refused before the first figure, and leave no folder behind
            self._folder.mkdir(parents=True, exist_ok=True)
            self._pending[figure.key] = self._pool.submit(_draw, figure, self._folder)

    def pictures(self) -> dict[str, str]:
        """Inline SVG of every figure added, by key; the files are then written."""
        return {key: future.result() for key, future in self._pending.items()}
