"""TOML files as editors save them: what cannot be read is said in one line."""

from __future__ import annotations

import codecs
import tomllib
from pathlib import Path
from typing import Any

from experiment.errors import InputError, short

_OTHERS = (
    (codecs.BOM_UTF32_LE, "UTF-32"),  # first: UTF-16's mark begins it
    (codecs.BOM_UTF32_BE, "UTF-32"),
    (codecs.BOM_UTF16_LE, "UTF-16"),
    (codecs.BOM_UTF16_BE, "UTF-16"),
)


def read_toml(path: Path) -> dict[str, Any]:
    """The table in a file. Raises InputError."""
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    return parse_toml(content, str(path))


def parse_toml(content: bytes, file: str) -> dict[str, Any]:
    """The table in a file's bytes: UTF-8, with or without a mark in front. Raises InputError."""
    try:
        # Some editors begin a file of UTF-8 with a mark that is no part of its text.
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        named = _encoding(content)
        said = f"byte {error.start} is not UTF-8" if named is None else f"is {named}, not UTF-8"
        raise InputError(f"{file}: {said}; expected to be saved as UTF-8") from None
    if named := _encoding(content):
        raise InputError(f"{file}: is {named}, not UTF-8; expected to be saved as UTF-8")
    try:
        return tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise InputError(f"{file}: not valid TOML: {_said(error, text)}") from None


def _encoding(content: bytes) -> str | None:
    """The encoding that a file is in, where its start tells."""
    marked = next((name for mark, name in _OTHERS if content.startswith(mark)), None)
    # Without a mark: every other byte of the first letters is null.
    start = content[:64]
    if marked is None and len(start) >= 8 and not len(start) % 2:
        if not any(start[1::2]) or not any(start[::2]):
            return "UTF-16"
    return marked


# tomllib's words → ours, where theirs do not say what to mend.
_WORDS = (
    ("Cannot overwrite a value", "a key that stands there already"),
    ("Cannot declare", "a table that stands there already:"),
)


def _said(error: Exception, text: str) -> str:
    if isinstance(error, RecursionError):
        return "brackets within brackets, too deep"
    said = " ".join(str(error).split())
    for theirs, ours in _WORDS:
        said = said.replace(theirs, ours)
    number = said.rpartition("(at line ")[2].partition(",")[0]
    lines = text.split("\n")
    if number.isdecimal() and int(number) <= len(lines):
        return f"{said}: {short(lines[int(number) - 1])}".removesuffix(": ")
    return said
