"""Texts by key, from a language file; a study may replace any of them."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator, Mapping, Set
from importlib import resources

from seethrough import registry
from seethrough.experiment.errors import InputError, short, shown, unknown
from seethrough.renderer.meant import one_of
from seethrough.tasks.kit.own_texts import flat
from seethrough.tasks.kit.world import Texts as OwnTexts


def languages() -> tuple[str, ...]:
    """The languages that there are texts in."""
    folder = resources.files("seethrough.experiment.pages").joinpath("languages")
    return tuple(sorted(f.name[:-5] for f in folder.iterdir() if f.name.endswith(".toml")))


class Texts:
    """All texts of a session, in one language. Lookup of an unknown key raises KeyError."""

    def __init__(
        self,
        language: str,
        replaced: Mapping[str, str] | None = None,
        own: Mapping[str, str] | None = None,
    ) -> None:
        """`own`: what to show instead of a study's own words, which have no names."""
        folder = resources.files("seethrough.experiment.pages")
        file = folder.joinpath("languages", f"{language}.toml")
        if not file.is_file():
            raise InputError(
                f"study.language = {shown(language)}: expected {one_of(language, languages())}"
            )
        self._texts = flat(tomllib.loads(file.read_text(encoding="utf-8")))
        self._texts |= _of_plugins(language)
        for key, text in (replaced or {}).items():
            if key not in self._texts:
                raise InputError(f"texts.{short(key)}: {self.unknown(key)}")
            self._texts[key] = text
        self._own = dict(own or {})

    def __getitem__(self, key: str) -> str:
        return self._texts[key]

    def get(self, key: str) -> str:
        """The text, or the key itself for what needs no translation: letters, numbers, the names
        of a study's own models and levels."""
        plain = key.removeprefix("kind.").removeprefix("name.")
        return self._texts.get(key) or self._own.get(plain, plain)

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

    def unknown(self, key: str) -> str:
        """What to say of a text that there is not: those of its table, or the tables."""
        table = key.partition(".")[0]
        known = [k for k in self._texts if k.partition(".")[0] == table]
        tables = dict.fromkeys(k.partition(".")[0] for k in self._texts)
        return unknown(
            key, known or (f"{t}.…" if t not in self._texts else t for t in tables), "text"
        )

    def place(self, key: str) -> int:
        """Where a text stands among all."""
        return list(self._texts).index(key)

    def of_others(self, used: Mapping[str, Set[str]]) -> dict[str, bool]:
        """Text of a plug-in → whether that is one of these, by kind."""
        found: dict[str, bool] = {}
        for kind, name, texts in _each_plugin():
            for key in texts.get("en", {}):
                found[key] = found.get(key, False) or name in used[kind]
        return found

    def english_only(self, language: str, used: Mapping[str, Set[str]]) -> list[str]:
        """Texts of plug-ins that are used which have no other of this language."""
        return [key for kind, name, texts in _each_plugin() if name in used[kind]
                for key in texts.get("en", {}) if key not in texts.get(language, {})]  # fmt: skip

    def keys(self) -> frozenset[str]:
        """Every key there is."""
        return frozenset(self._texts)


def _of_plugins(language: str) -> dict[str, str]:
    """What plug-ins of every kind bring along; in English what they have no other of."""
    found: dict[str, str] = {}
    for _, _, texts in _each_plugin():
        found |= {**texts.get("en", {}), **texts.get(language, {})}
    return found


def _each_plugin() -> Iterator[tuple[str, str, OwnTexts]]:
    """(kind, name, texts) of each that brings some along."""
    for kind in ("technique", "task", "world", "question"):
        for name in registry.known(kind):
            try:
                texts = registry.get(kind, name).texts
            except registry.PluginError:
                continue  # a study that uses it is refused: this one may not
            yield kind, name, texts
