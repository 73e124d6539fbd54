"""What the user can mend: shown as one line, exit status 2."""

from __future__ import annotations


class InputError(Exception):
    """Bad input. The message names file, key, value and what was expected (CONVENTIONS.md)."""


def one_line(text: str) -> str:
    """Text for a terminal: what would end the line or drive the terminal becomes an escape."""
    return "".join(
        c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text
    )
