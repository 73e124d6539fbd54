"""One thing that a suite has looked at."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Finding:
    """What was looked at, whether it is as it must be, and what was found in words.

    `tested`: whether it could have failed. What was only measured, or gave nothing to test, is a
    note and no verdict.
    """

    name: str
    holds: bool
    said: str
    tested: bool = True

    def __str__(self) -> str:
        verdict = "FAIL" if not self.holds else "ok  " if self.tested else "note"
        return f"{verdict}  {self.name}: {self.said}"


class NothingToTest(Exception):
    """A plug-in gives a rule nothing that could fail; the message says why."""


def note(name: str, said: str) -> Finding:
    """What is told and judges nothing."""
    return Finding(name, True, said, tested=False)
