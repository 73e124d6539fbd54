"""Verdicts of `seethrough check`: every line ends in one, and the worst decides its exit status."""

from __future__ import annotations

OK, WARNING, FAILS = "ok", "WARNING", "FAILS"


class Verdicts:
    """Prints what was checked, a line each, and counts."""

    def __init__(self) -> None:
        self.found = {OK: 0, WARNING: 0, FAILS: 0}

    def say(self, what: str, text: str, verdict: str = OK, why: str = "") -> None:
        """A line: what was checked, how it is, and the verdict with its reason."""
        self.found[verdict] += 1
        print(f"{what:<11} {text}: {verdict}" + (f", {why}" if why else ""))

    def sum_up(self) -> int:
        """The last line; 1 where anything fails, else 0."""
        warnings, failures = self.found[WARNING], self.found[FAILS]
        worst = FAILS if failures else WARNING if warnings else OK
        counts = f"{_many(failures, 'failure')}, {_many(warnings, 'warning')}"
        print(f"{'verdict':<11} {counts}: {worst}")
        return 1 if failures else 0


def _many(count: int, word: str) -> str:
    return f"{count} {word}" + ("" if count == 1 else "s")
