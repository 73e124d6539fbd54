"""What the user can mend: shown as one line a fault, exit status 2."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence

from seethrough.renderer.meant import meant

MOST = 40  # lines of faults: more come of one mistake more often than of forty


class InputError(Exception):
    """Bad input. The message names file, key, value and what was expected (CONVENTIONS.md).

    `faults` are those that are told, a line each, `more` how many there are besides; `lines` are
    what to print.
    """

    def __init__(self, *faults: str, more: int = 0) -> None:
        self.faults, self.more = faults, more
        self.lines = (*faults, *([f"… and {more} more"] if more else []))
        super().__init__("\n".join(self.lines))


def gathered(faults: Sequence[str], more: int = 0) -> InputError:
    """One error of many faults, of which the first are told."""
    return InputError(*faults[:MOST], more=more + max(0, len(faults) - MOST))


def one_line(text: str) -> str:
    """Text for a terminal: what would end the line or drive the terminal becomes an escape."""
    return "".join(
        c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text
    )


def short(text: str) -> str:
    """At most 60 characters of it, without line ends."""
    text = " ".join(text[:1000].split())
    return text if len(text) <= 60 else text[:57] + "…"


def shown(value: object) -> str:
    """A value as a TOML file has it, shortened."""
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if isinstance(value, list | tuple) and len(value) <= 60:
        return short(f"[{', '.join(map(shown, value))}]")
    text = json.dumps(value, default=str, ensure_ascii=False)
    return short(one_line(text))


def unknown(name: str, known: Iterable[str], what: str = "key") -> str:
    """What to say of a name that there is not: the nearest one that there is, and all of them."""
    names = tuple(known)
    return f"unknown {what}{meant(name, names) or ';'} known: {', '.join(names) or 'none'}"
