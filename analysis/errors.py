"""What the owner of the data can mend: each problem is one line (CONVENTIONS.md, bad input)."""

from __future__ import annotations

from collections.abc import Iterable

SHOWN = 20


class DataError(Exception):
    """Data that cannot be analysed. `lines` name file, row, column, value and what was expected."""

    def __init__(self, lines: str | Iterable[str]) -> None:
        self.lines = (lines,) if isinstance(lines, str) else tuple(lines)
        super().__init__("\n".join(self.lines))

    def shown(self) -> tuple[str, ...]:
        """At most `SHOWN` lines; the last one counts the rest."""
        more = len(self.lines) - SHOWN
        lines = tuple(_printable(line) for line in self.lines[:SHOWN])
        return lines if more <= 0 else (*lines, f"and {more} more like these")


def _printable(line: str) -> str:
    """What would end the line or drive the terminal becomes an escape: data may hold anything."""
    return "".join(
        c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in line
    )


def number_above(key: str, value: object, above: float) -> float:
    """A number of a study's [analysis] table. Raises DataError unless it is one above `above`."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not above < value < 1e300:
        raise DataError(f"analysis.{key} = {value!r}: expected a number above {above:g}")
    return float(value)
