"""Files of a study, and the study's own: regular ones of a sensible size, beside it.

A study comes from a colleague or out of a download: it may name any file, and must not make the
program read it. Devices and pipes are never read, TOML that would take minutes is refused at once.
"""

from __future__ import annotations

import os
import re
import stat
import tomllib
from pathlib import Path, PureWindowsPath
from typing import Any

from experiment.errors import InputError

LARGEST_STUDY = 2**18  # bytes; the longest shipped study has 3,000
LARGEST_TEXT = 2**18
LARGEST_MODEL = 2**28
DEEPEST = 16  # names in a dotted key: a study has three
LONGEST = 200  # characters of a bare word: tomllib takes the square of a key's or number's length
AT_ONCE = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)

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


def read_toml(path: Path) -> dict[str, Any]:
    """A TOML file's table. Raises InputError in one line."""
    try:
        text = read_regular(path, LARGEST_STUDY).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: byte {error.start} is not UTF-8") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    plain = _without_texts(text)
    if found := _LONG.search(plain) or _DEEP.search(plain):
        line, what = plain.count("\n", 0, found.start()) + 1, found.group()[:20]
        raise InputError(
            f"{path}: not a study's TOML: {what}…: expected keys of at most {DEEPEST} names, and "
            f"words and numbers of at most {LONGEST} characters (near line {line})"
        )
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        reason = "nested too deep" if isinstance(error, RecursionError) else error
        raise InputError(f"{path}: not valid TOML: {' '.join(str(reason).split())}") from None


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


def read_beside(study: Path, name: str, most: int) -> bytes:
    """A file that a study names, which lies beside it or in a folder there.

    Raises ValueError for any other place or kind, OSError where it cannot be read.
    """
    return read_regular(place_beside(study, name), most)


def place_beside(study: Path, name: str) -> Path:
    """Where the file that a study names lies. Raises ValueError unless beside the study."""
    folder = study.parent
    if not name or "\0" in name or ".." in Path(name).parts or _is_absolute(name):
        raise ValueError("not a file beside the study")
    path = folder / name
    if not path.resolve().is_relative_to(folder.resolve()):
        raise ValueError("a link out of the study's folder")
    return path


def _is_absolute(name: str) -> bool:
    return Path(name).is_absolute() or bool(PureWindowsPath(name).anchor)


def read_regular(path: Path, most: int) -> bytes:
    """A regular file's bytes. Raises OSError; its reason says what it is instead."""
    file = os.open(path, os.O_RDONLY | AT_ONCE)
    with os.fdopen(file, "rb") as reading:
        about = os.fstat(file)
        if not stat.S_ISREG(about.st_mode):
            raise OSError(0, "not a regular file", str(path))
        data = reading.read(most + 1)
    if len(data) > most:
        raise OSError(0, f"more than {most} bytes", str(path))
    return data
