"""What a stranger's code may do to a session: nothing but end it, in one line.

Code that raises, does not come back or gives what nobody can use is found by its suite; what the
suite did not meet ends the session here. Trials that were completed stay.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType, UnionType
from typing import TypeVar

from numpy.random import Generator

from seethrough import registry
from seethrough.experiment.display.display import Leave
from seethrough.experiment.errors import InputError, one_line
from seethrough.renderer.events import Event
from seethrough.tasks.kit.base import Example, Outcome, Setting, Task, View
from seethrough.tasks.kit.hud import FloorPlan
from seethrough.tasks.kit.world import Place

Made = TypeVar("Made")
PATIENCE = 60.0  # s for one call: a busy machine that compiles our kernels in it took 20


class PluginFailed(InputError):
    """A stranger's code ended the session."""


class _TookTooLong(BaseException):
    """Raised within code that does not come back; nobody's `except Exception` stops it."""


@contextmanager
def limited(seconds: float, what: str) -> Iterator[None]:
    """Raises PluginFailed in what takes longer. Only where a timer can interrupt: in the main
    thread, and not on Windows."""
    able = hasattr(signal, "setitimer") and threading.current_thread() is threading.main_thread()
    if not able:
        yield
        return

    def stop(number: int, frame: FrameType | None) -> None:
        raise _TookTooLong

    before = signal.signal(signal.SIGALRM, stop)
    left, _ = signal.setitimer(signal.ITIMER_REAL, seconds)  # of whoever limits this as well
    try:
        yield
    except _TookTooLong as error:
        where = registry.place_of(error)
        raise PluginFailed(f"{what}: did not come back within {seconds:.0f} s{where}") from None
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
        signal.setitimer(signal.ITIMER_REAL, left)


def is_stranger(kind: str, name: str) -> bool:
    """Whether a plug-in is not ours."""
    return name in registry.known(kind) and registry.origin(kind, name) is not None


def called(kind: str, name: str, what: str, call: Callable[[], Made]) -> Made:
    """What a call gives that runs the code of a plug-in; of a stranger's, every fault becomes
    PluginFailed. Raises what leaving raises."""
    if not is_stranger(kind, name):
        return call()
    where = f"{kind} {name}: {what}"
    try:
        with limited(PATIENCE, where):
            return call()
    except (InputError, Leave):
        raise
    except Exception as error:
        raise PluginFailed(f"{where}: {said(kind, name, error)}") from error


def said(kind: str, name: str, error: Exception) -> str:
    """An exception in a line: what, and where in the plug-in's own code."""
    origin = registry.origin(kind, name)
    where = registry.place_in(error, {str(path) for path in origin.files} if origin else ())
    return f"raised {one_line(f'{type(error).__name__}: {error}')}{where}"


class Watched:
    """A task that runs a stranger's code, its own or its world's (`kind`, `name`): each call
    is limited, and what it gives is looked at."""

    def __init__(self, task: Task, kind: str = "task", name: str = "") -> None:
        self._task, self._kind, self._blamed = task, kind, name or task.name
        self.name, self.code, self.version = task.name, task.code, task.version
        self.source, self.texts, self.simulate = task.source, task.texts, task.simulate
        self.worlds, self.Parameters, self.measures = task.worlds, task.Parameters, task.measures
        self.title, self.instruction, self.takes = task.title, task.instruction, task.takes

    def _call(self, what: str, call: Callable[[], Made], kinds: type | UnionType = object) -> Made:
        found = called(self._kind, self._blamed, what, call)
        if not isinstance(found, kinds):
            wanted = getattr(kinds, "__name__", None) or "an Outcome or None"
            shown = one_line(repr(found))[:80]
            raise PluginFailed(
                f"{self._kind} {self._blamed}: {what}: gave {shown}, expected {wanted}"
            )
        return found

    def make_scene(self, rng: Generator, setting: Setting) -> Place:
        """The task's."""
        return self._call("make_scene", lambda: self._task.make_scene(rng, setting))

    def begin(self, made: Place, setting: Setting, aspect: float) -> object:
        """The task's."""
        return self._call("begin", lambda: self._task.begin(made, setting, aspect))

    def on_event(self, state: object, event: Event) -> object:
        """The task's."""
        return self._call("on_event", lambda: self._task.on_event(state, event))

    def view(self, state: object) -> View:
        """The task's, a View."""
        return self._call("view", lambda: self._task.view(state), View)

    def outcome(self, state: object) -> Outcome | None:
        """The task's, an Outcome or None."""
        return self._call("outcome", lambda: self._task.outcome(state), Outcome | None)

    def solution(self, state: object) -> FloorPlan | None:
        """The task's."""
        return self._call("solution", lambda: self._task.solution(state), FloorPlan | None)

    def example(self, state: object, aspect: float) -> Example:
        """The task's, an Example."""
        return self._call("example", lambda: self._task.example(state, aspect), Example)
