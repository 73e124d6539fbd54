"""What a window does while something is being made: it says so, and goes on answering the desktop.

The work is done in another thread, and touches no graphics. The first frame says so already, so
that it stands there too while the next picture is drawn for the first time.
"""

from __future__ import annotations

import time
from abc import abstractmethod
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager
from functools import partial
from typing import TYPE_CHECKING, TypeVar

from seethrough.experiment.display.clock import Clock
from seethrough.experiment.display.display import Leave
from seethrough.experiment.display.stage import Stage
from seethrough.experiment.pages.form import Form
from seethrough.experiment.pages.pages import Answers, Page

if TYPE_CHECKING:
    from moderngl import Context


Made = TypeVar("Made")

PATIENCE = 0.1  # s; between two trials, what is made sooner is not worth a word


def meanwhile(work: Callable[[], Made], frame: Callable[[], None], patience: float) -> Made:
    """What `work` gives; until then, but not before `patience` seconds, `frame` again and again.

    Without patience there is one frame at least. An exception of either is raised.
    """
    pool = ThreadPoolExecutor(1)
    try:
        done, began = pool.submit(work), time.monotonic()
        if not patience:
            frame()
        while not done.done():
            if time.monotonic() - began < patience:
                time.sleep(0.002)
            else:
                frame()
        return done.result()
    finally:
        pool.shutdown(wait=False)


class Waits:
    """The part of a window that waits, or shows what somebody else does (display/window.py)."""

    stage: Stage
    clock: Clock
    context: Context
    on_frame: Callable[[], None]
    _closed: bool
    _passed: float

    @abstractmethod
    def _pump(self) -> float: ...

    @abstractmethod
    def _graphics(self) -> AbstractContextManager[None]: ...

    @abstractmethod
    def _flip(self) -> float: ...

    @abstractmethod
    def _escape_pressed(self) -> bool: ...

    @abstractmethod
    def confirm_leaving(self) -> None: ...

    @abstractmethod
    def _draw_page(self, form: Form) -> bool: ...

    def waiting(self, work: Callable[[], Made], said: str = "wait.scene") -> Made:
        """Do what takes time and no graphics, and say so. Raises Leave if the session is to end."""
        say = partial(self._say, said)
        return meanwhile(work, say, 0.0 if self.stage.on_page else PATIENCE)

    def _say(self, said: str) -> None:
        self._pump()
        with self._graphics():
            self.stage.draw_waiting(said, self.context.screen, self._passed)
        self.on_frame()
        self._flip()
        if self._closed:
            raise Leave
        if self._escape_pressed():
            shown = self.stage.last
            self.confirm_leaving()
            self.stage.last = shown

    def prepare(self, page: Page) -> None:
        """Have ready what a page shows. Raises Leave if the session is to end."""
        if page.takes_time:
            self.waiting(page.prepare, "wait.scene" if page.shows_scenes else "wait.page")

    def present(self, page: Page, answers: Answers, seconds: float) -> None:
        """Show a page that somebody else has filled in. Raises Leave on Esc or a closed window."""
        self.prepare(page)
        form = Form(page, dict(answers))
        end = self.clock.now() + seconds
        while self.clock.now() < end:
            self._draw_page(form)
            if self._closed or self._escape_pressed():
                raise Leave
