"""TOML files as editors save them: what cannot be read is said in one line.

What would take tomllib minutes is refused at once.
"""

from __future__ import annotations

import codecs
import re
import tomllib
from pathlib import Path

from seethrough.experiment.errors import InputError, short
from seethrough.experiment.study.beside.study_files import LARGEST_STUDY, read_regular

DEEPEST = 16  # names in a dotted key: a study has three
LONGEST = 200  # characters of a bare word: tomllib takes the square of a key's or number's length

_OTHERS = (
    (codecs.BOM_UTF32_LE, "UTF-32"),  # first: UTF-16's mark begins it
    (codecs.BOM_UTF32_BE, "UTF-32"),
    (codecs.BOM_UTF16_LE, "UTF-16"),
    (codecs.BOM_UTF16_BE, "UTF-16"),
)


_OPEN = re.compile(r"\"\"\"|\'\'\'|[\"\'#]")
_REST = {  # what follows the beginning of a text or comment, to its end
    '"""': re.compile(r'(?:[^"\\]|\\.|"(?!""))*"""', re.DOTALL),
    "'''": re.compile(r"(?:[^']|'(?!''))*'''"),
    '"': re.compile(r'(?:[^"\\\n]|\\.)*"'),
    "'": re.compile(r"[^'\n]*'"),
    "#": re.compile(r"[^\n]*"),
}
_DEEP = re.compile(rf"(?:[^\s.=\[\]{{}},]+[ \t]*\.[ \t]*){{{DEEPEST}}}")
_LONG = re.compile(rf"[^\s.=\[\]{{}},]{{{LONGEST + 1}}}")


def read_toml(path: Path) -> dict[str, object]:
    """The table in a file. Raises InputError."""
    try:
        content = read_regular(path, LARGEST_STUDY)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    return parse_toml(content, str(path))


def parse_toml(content: bytes, file: str) -> dict[str, object]:
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
    _refuse_slow(text, file)
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{file}: not valid TOML: {_said(error, text)}") from None


def _refuse_slow(text: str, file: str) -> None:
    """Raises InputError for what tomllib would take minutes for."""
    plain = _without_texts(text)
    if found := _LONG.search(plain) or _DEEP.search(plain):
        line, what = plain.count("\n", 0, found.start()) + 1, found.group()[:20]
        raise InputError(
            f"{file}: not a study's TOML: {what}…: expected keys of at most {DEEPEST} names, and "
            f"words and numbers of at most {LONGEST} characters (near line {line})"
        )


def _without_texts(text: str) -> str:
    """The same without texts and comments, which may hold anything."""
    kept, at = [], 0
    while opened := _OPEN.search(text, at):
        kept.append(text[at : opened.start()])
        rest = _REST[opened.group()].match(text, opened.end())
        if rest is None:
            return "".join(kept)  # no TOML: tomllib says where
        kept.append("_" + "\n" * text.count("\n", opened.start(), rest.end()))
        at = rest.end()
    return "".join([*kept, text[at:]])


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
