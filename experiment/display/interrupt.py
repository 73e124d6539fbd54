"""Ctrl-C while a session starts or runs: noticed at moments at which it can be obeyed.

Raised in the middle of a library's callback, an interrupt ends the program (C++) or is lost
(ctypes). So the first one is only noted, and raised by `check`; a second one is raised at once.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

_pressed = threading.Event()


@contextmanager
def deferred() -> Iterator[None]:
    """Note interrupts instead of raising them; one that nobody checked for is raised at the end."""
    if threading.current_thread() is not threading.main_thread():
        yield  # only the main thread is told of signals
        return
    _pressed.clear()
    before = signal.signal(signal.SIGINT, _note)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
    check()


def check() -> None:
    """Raises KeyboardInterrupt if Ctrl-C was pressed."""
    if _pressed.is_set():
        _pressed.clear()
        raise KeyboardInterrupt


def _note(*_: object) -> None:
    if _pressed.is_set():
        raise KeyboardInterrupt
    _pressed.set()
