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
    return flat(tomllib.loads(file.read_text(encoding="utf-8")))


def flat(table: Mapping[str, object]) -> dict[str, str]:
    """Texts in tables as one table, by the names `table.key`. Raises TypeError for what is none."""
    found: dict[str, str] = {}
    for key, value in flat_values(table).items():
        if not isinstance(value, str):
            raise TypeError(f"{key} = {value!r}: expected text")
        found[key] = value
    return found


def flat_values(table: Mapping[str, object], prefix: str = "") -> dict[str, object]:
    """What tables hold, texts or not, by the names `table.key`."""
    found: dict[str, object] = {}
    for key, value in table.items():
        if isinstance(value, Mapping):
            found |= flat_values(value, f"{prefix}{key}.")
        else:
            found[prefix + key] = value
    return found
