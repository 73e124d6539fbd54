"""The rules of a kind of plug-in, tried on one of them: `seethrough KIND check NAME`, our tests.

A rule is a function that takes a plug-in and gives a line for everything that is wrong. One that
raises has found something, too: a plug-in's code may do anything. But one that has nothing to try
raises NothingToTest, lest it looks as if all were well.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from importlib import import_module
from typing import Protocol, TypeVar, get_type_hints

from seethrough import registry
from seethrough.experiment.errors import one_line
from seethrough.experiment.pages.texts import Texts, languages
from seethrough.experiment.session.strangers import PluginFailed, limited
from seethrough.experiment.suites.finding import Finding, NothingToTest, note
from seethrough.renderer.declared import Declares, Key, declared

Plugin = TypeVar("Plugin", contravariant=True)


class Rule(Protocol[Plugin]):
    """Gives a line for everything that is wrong with a plug-in."""

    def __call__(self, plugin: Plugin, /) -> Iterator[str]: ...


RULE_LIMIT = 60.0  # s: the slowest rule of ours takes a few

# Kind → the module with its rules.
RULES = {kind: f"{__package__}.{kind}_rules" for kind in ("task", "world", "question")}


def findings(kind: str, name: str) -> Iterator[Finding]:
    """Every rule of a kind, tried on the plug-in of that name. Raises KeyError if there is none."""
    plugin = registry.get(kind, name)
    for rule in import_module(RULES[kind]).RULES:
        said = (rule.__doc__ or rule.__name__).split("\n\n")[0]
        said = one_line(" ".join(said.split())).rstrip(".")
        try:
            problems = _tried(rule, plugin)
        except NothingToTest as why:
            yield note(said, f"nothing to test: {one_line(str(why))}")
        else:
            yield Finding(said, not problems, "; ".join(problems) or "nothing found")


def _tried(rule: Rule[Plugin], plugin: Plugin) -> list[str]:
    """The first problems. Raises NothingToTest where the rule does, and had found none."""
    found = []
    try:
        with limited(RULE_LIMIT, "a rule"):
            for problem in rule(plugin):
                found.append(one_line(problem))
                if len(found) == 5:
                    break
    except NothingToTest:
        if not found:
            raise
    except PluginFailed as error:
        found.append(str(error))
    except Exception as error:  # a stranger's code may raise anything
        said = one_line(f"raised {type(error).__name__}: {error}")
        found.append(f"{said}{registry.place_of(error)}")
    return found


def describes_itself(plugin: object, words: tuple[str, ...]) -> Iterator[str]:
    """Problems with what every kind says of itself, and with `words` that a kind says besides."""
    for word in ("name", "version", "source", *words):
        value = getattr(plugin, word, None)
        if not (isinstance(value, str) and value.strip() and value.isprintable()):
            yield f"{word} = {value!r}: expected a text"
    name = str(getattr(plugin, "name", ""))
    if not (name.isidentifier() and name.isascii() and name == name.lower()):
        yield f"name = {name!r}: expected lower-case letters, digits and _"


def parameters_declared(cls: type[Declares]) -> Iterator[str]:
    """Problems with a class of parameters: frozen, each declared, and the wrong ones refused.

    Raises NothingToTest where there is none that could be wrong.
    """
    made = getattr(cls, "__dataclass_params__", None)
    if made is None or not made.frozen:
        yield f"Parameters = {cls!r}: expected a frozen dataclass"
        return
    keys, hints = declared(cls), get_type_hints(cls)
    for field in dataclasses.fields(cls):
        if field.name in keys and not keys[field.name].meaning:
            yield f"{field.name}: expected to say what it means"
    given = {f.name: _some(hints[f.name]) for f in dataclasses.fields(cls) if _needed(f)}
    wrongs = {name: _wrong(said) for name, said in keys.items()}
    if all(wrong is None for wrong in wrongs.values()):
        raise NothingToTest("no parameter has limits or choices")
    for name, wrong in wrongs.items():
        if wrong is None:
            continue
        try:
            cls(**{**given, name: wrong})
        except ValueError as error:
            if name not in str(error):
                yield f"{name} = {wrong!r}: refused without being named ({error})"
        else:
            yield f"{name} = {wrong!r}: expected to be refused; `check(self)` in __post_init__ does"


def _needed(field: dataclasses.Field[object]) -> bool:
    missing = dataclasses.MISSING
    return field.default is missing and field.default_factory is missing


def _some(hint: object) -> object:
    known: dict[object, object] = {str: "text", int: 1, float: 1.0}
    return known.get(hint, "text")


def _wrong(said: Key) -> object:
    """A value that the declaration forbids."""
    if said.choices:
        return "no such choice"
    if said.low is None:
        return None
    return (said.low - 1, said.low - 1) if said.point else said.low - 1


class HasTexts(Protocol):
    """A plug-in that brings texts along."""

    @property
    def texts(self) -> Mapping[str, Mapping[str, str]]:
        """Language → name → text."""


def texts_in_every_language(plugin: HasTexts, prefixes: tuple[str, ...]) -> Iterator[str]:
    """Problems with texts that a plug-in brings along."""
    if not plugin.texts:
        return
    english = plugin.texts.get("en", {})
    if not english:
        yield "texts: expected English ones (en)"
    for key in english:
        if key.split(".")[0] not in prefixes:
            yield f"texts: {key}: expected a name that begins with {prefixes[0]}."
    for language in plugin.texts:
        own = plugin.texts[language]
        yield from (f"texts, {language}: no {key}" for key in english if key not in own)
        yield from (f"texts, {language}: {key} is in no other" for key in own if key not in english)


def unknown_texts(keys: set[str]) -> Iterator[str]:
    """Problems with names of texts that participants would be shown."""
    for language in languages():
        known = Texts(language).keys()
        for key in sorted(keys):
            if key not in known:
                yield f"text {key}: expected to be in {language}"
