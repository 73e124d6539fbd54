"""Texts that lie beside what they belong to: `texts/LANGUAGE.toml` in a plug-in's own package."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from functools import cache
from importlib import resources


class OwnTexts(Mapping[str, Mapping[str, str]]):
    """Language → name of a text → the text, of a package; read when somebody asks for them."""

    def __init__(self, package: str) -> None:
        self._package = package

    def __getitem__(self, language: str) -> Mapping[str, str]:
        if language not in _languages(self._package):
            raise KeyError(language)
        return _read(self._package, language)

    def __iter__(self) -> Iterator[str]:
        return iter(_languages(self._package))

    def __len__(self) -> int:
        return len(_languages(self._package))


@cache
def _languages(package: str) -> tuple[str, ...]:
    folder = resources.files(package).joinpath("texts")
    return tuple(sorted(f.name[:-5] for f in folder.iterdir() if f.name.endswith(".toml")))


@cache
def _read(package: str, language: str) -> Mapping[str, str]:
    file = resources.files(package).joinpath("texts", f"{language}.toml")
    return texts_in(tomllib.loads(file.read_text(encoding="utf-8")))


def texts_in(table: Mapping[str, object]) -> dict[str, str]:
    """The texts of a file of ours, by the names `table.key`. Raises TypeError for what is none."""
    found = flat(table)
    wrong = [name for name, value in found.items() if not isinstance(value, str)]
    if wrong:
        raise TypeError(f"{wrong[0]} = {found[wrong[0]]!r}: expected a text")
    return {name: str(value) for name, value in found.items()}


def flat(table: Mapping[str, object], prefix: str = "") -> dict[str, object]:
    """What stands in tables as one table, by the names `table.key`."""
    found: dict[str, object] = {}
    for key, value in table.items():
        if isinstance(value, Mapping):
            found |= flat(value, f"{prefix}{key}.")
        else:
            found[prefix + key] = value
    return found
