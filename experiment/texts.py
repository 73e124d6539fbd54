"""Texts by key, from a language file; a study may replace any of them."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from importlib import resources
from typing import Any

from experiment.errors import InputError


class Texts:
    """All texts of a session, in one language. Lookup of an unknown key raises KeyError."""

    def __init__(self, language: str, replaced: Mapping[str, str] | None = None) -> None:
        file = resources.files("experiment").joinpath("languages", f"{language}.toml")
        if not file.is_file():
            raise InputError(f"study.language = {language:.60}: no such language file")
        self._texts = _flat(tomllib.loads(file.read_text(encoding="utf-8")))
        for key, text in (replaced or {}).items():
            if key not in self._texts:
                known = f"{', '.join(list(self._texts)[:40])}, …"
                raise InputError(f"texts.{key:.60}: unknown text; known: {known}")
            self._texts[key] = text

    def __getitem__(self, key: str) -> str:
        return self._texts[key]

    def get(self, key: str) -> str:
        """The text, or the key itself for what needs no translation: letters, numbers, the names
        of a study's own models."""
        return self._texts.get(key, key.removeprefix("kind."))

    def fill(self, key: str, values: Iterable[tuple[str, str | float]] = ()) -> str:
        """The text with its {placeholders} filled; values that are keys are looked up too."""
        text = self.get(key)
        for name, value in values:
            shown = self.get(value) if isinstance(value, str) else self.number(value)
            text = text.replace("{" + name + "}", shown)
        return text

    def number(self, value: float) -> str:
        """A measured number as people write it: from ten on without a fraction."""
        digits = 1 if round(abs(value), 1) < 10 else 0
        return f"{value:.{digits}f}".replace(".", self["decimal"])

    def keys(self) -> frozenset[str]:
        """Every key there is."""
        return frozenset(self._texts)


def _flat(table: Mapping[str, Any], prefix: str = "") -> dict[str, str]:
    flat: dict[str, str] = {}
    for key, value in table.items():
        if isinstance(value, Mapping):
            flat |= _flat(value, f"{prefix}{key}.")
        else:
            flat[prefix + key] = value
    return flat
