"""Progress of long work, on standard error: a bar on a terminal, now and then a line elsewhere."""

from __future__ import annotations

import sys
import time
from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
from rich.progress import Progress as Bar

LINE_EVERY = 5.0  # seconds between lines where there is no terminal


class Progress:
    """Counts `total` steps: `with Progress("simulating", 384) as p: p.step("what")`."""

    def __init__(self, what: str, total: int) -> None:
        self.what = what
        self.total = total
        self.done = 0
        self._start = self._said = time.monotonic()
        console = Console(stderr=True)
        columns = (
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TimeRemainingColumn(),
        )
        self._bar = Bar(*columns, console=console) if console.is_terminal else None
        self._task = self._bar.add_task(what, total=total) if self._bar else None

    def __enter__(self) -> Progress:
        if self._bar:
            self._bar.start()
        else:
            self._line("")
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._bar:
            self._bar.stop()
        else:
            self._line("done" if kind is None else "stopped")

    def step(self, detail: str = "", steps: int = 1) -> None:
        """One more is done, or several."""
        self.done += steps
        if self._bar and self._task is not None:
            self._bar.update(self._task, completed=self.done, description=f"{self.what} {detail}")
        elif time.monotonic() - self._said >= LINE_EVERY:
            self._line(detail)

    def _line(self, detail: str) -> None:
        self._said = time.monotonic()
        passed = self._said - self._start
        text = f"{self.what}: {self.done}/{self.total} after {passed:.1f} s {detail}"
        print(text.rstrip(), file=sys.stderr, flush=True)
