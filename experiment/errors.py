"""What the user can mend: shown as one line, exit status 2."""

from __future__ import annotations


class InputError(Exception):
    """Bad input. The message names file, key, value and what was expected (CONVENTIONS.md)."""
