"""Which of the names that there are somebody meant who wrote another."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from difflib import get_close_matches

ALIKE = 0.65  # of difflib's ratio: one wrong letter of three still passes, of two none does
LONGEST = 100  # letters that are compared: what is longer is no name


def nearest(name: str, known: Iterable[str]) -> str:
    """The name among those known that is most like it, "" where none is. Case does not count."""
    names = {known_name.lower(): known_name for known_name in known}
    near = get_close_matches(name.lower()[:LONGEST], names, 1, ALIKE)
    return names[near[0]] if near else ""


def meant(value: object, known: Collection[str]) -> str:
    """ ", did you mean NAME?" of a text, or of the first strange one of several; else ""."""
    said = value if isinstance(value, list | tuple) else (value,)
    strange = [one for one in said if isinstance(one, str) and one not in known]
    near = nearest(strange[0], known) if strange else ""
    return f", did you mean {near}?" if near else ""


def one_of(value: object, known: Collection[str]) -> str:
    """What to expect of a value that is not one of those known, the nearest one at its end."""
    return f"one of {', '.join(known)}{meant(value, known)}"
