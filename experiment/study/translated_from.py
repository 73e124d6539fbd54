"""What each translation was made from: the comment right above it, as `seethrough texts` writes it.

    # "Welcome"
    title = "Bienvenue"

Whoever translates a text again puts the new words there, too; without such a comment nothing is
known, as in files that were written by hand.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path

import tomlkit
from tomlkit.container import Container
from tomlkit.items import Comment, Table, Whitespace

from seethrough.experiment.study.beside.study_files import LARGEST_TEXT, read_beside
from seethrough.experiment.study.study import Study
from seethrough.experiment.study.translations import needed


def sources(text: str) -> dict[str, str]:
    """Name of a text → what it was translated from, of those in a file's text, which is TOML."""
    return dict(_below(tomlkit.parse(text), "", None))


def _below(table: Container, prefix: str, above: str | None) -> Iterator[tuple[str, str]]:
    for key, item in table.body:
        if isinstance(item, Comment):
            above = _said(item.as_string())
        elif isinstance(item, Whitespace):
            above = None
        elif key is not None:
            name = f"{prefix}{key.key}"
            if isinstance(item, Table):
                yield from _below(item.value, f"{name}.", above)
            elif above is not None:
                yield name, above
            above = None


def _said(comment: str) -> str | None:
    """The text in a comment; None where there is something else."""
    try:
        found = json.loads(comment.strip().removeprefix("#"))
    except ValueError:
        return None
    return found if isinstance(found, str) else None


def stale(study: Study, given: Mapping[str, str], data: bytes) -> dict[str, str]:
    """Name → what it was translated from, of each text that is another one by now; `data` is the
    file of what is `given`."""
    made_from = sources(data.decode("utf-8-sig"))
    return {
        key: made_from[key]
        for key, text in needed(study).items()
        if given.get(key, "").strip() and made_from.get(key, text) != text
    }


def stale_in(study: Study, path: Path, language: str) -> dict[str, tuple[str, str]]:
    """Name → (what it was translated from, what it is now), of the stale texts of one of the
    languages of the study at `path`."""
    data = read_beside(path, language, LARGEST_TEXT)
    found, now = stale(study, study.translations[language], data), needed(study)
    return {key: (before, now[key]) for key, before in found.items()}
