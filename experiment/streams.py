"""Standard streams as a program finds them: closed by whoever started it, or by who read them."""

from __future__ import annotations

import os
import select
import sys
from typing import TextIO

READER_GONE = 141  # as a shell reports a program that SIGPIPE ended: 128 + 13


def fill() -> None:
    """Open what is closed of the three streams, so that no file of ours gets a stream's number."""
    while (number := os.open(os.devnull, os.O_RDWR)) < 3:
        pass
    os.close(number)
    if sys.stdout is None:
        sys.stdout = open(os.devnull, "w", encoding="utf-8")
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")


def reader_is_gone() -> bool:
    """Whether nobody reads standard output or standard error any more."""
    return any(_gone(stream) for stream in (sys.stdout, sys.stderr))


def leave_quietly() -> None:
    """Let what is still to be written to a stream without a reader go nowhere, at exit too."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (sys.stdout, sys.stderr):
        if _gone(stream):
            os.dup2(nowhere, stream.fileno())
    os.close(nowhere)


def _gone(stream: TextIO) -> bool:
    try:
        number = stream.fileno()
    except (OSError, ValueError, AttributeError):  # a test's, or none
        return False
    if hasattr(select, "poll"):
        asked = select.poll()
        asked.register(number, select.POLLOUT)
        return any(event & (select.POLLERR | select.POLLHUP) for _, event in asked.poll(0))
    try:
        stream.flush()  # Windows: what could not be written still waits
    except OSError:
        return True
    return False
