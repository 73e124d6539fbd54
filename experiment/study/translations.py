"""A study's own language: a file of texts beside it, `language = "fr.toml"`.

It has every text that participants of the study read: those of pages, tasks, worlds and questions
by the names that they have in English, and below [study] the study's own, by where they stand in
its file. Nothing of another language is ever shown: a text that is missing is a fault.
"""

from __future__ import annotations

import dataclasses
import json
import re
import unicodedata
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

from seethrough.experiment.errors import InputError, gathered, short, shown, unknown
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.study.beside.study_files import LARGEST_TEXT, read_beside
from seethrough.experiment.study.beside.toml_file import parse_toml
from seethrough.experiment.study.study import Study
from seethrough.renderer.declared import declared
from seethrough.tasks.catalog import WORLDS
from seethrough.tasks.kit.own_texts import flat_values
from seethrough.tasks.kit.world import NamingWorld

OWN = "study."  # begins the names of a study's own texts
PLACE = re.compile(r"\{\w+\}")

# Tables of texts that only some studies show, by the questions that show them.
SHOWN_BY = {
    "tlx": ("tlx",),
    "sus": ("sus",),
    "depth": ("depth_test",),
    "color": ("color_check",),
    "comparison": ("comparison",),
    "rating": ("ratings", "comparison"),
    "consent": ("consent", "statement"),
    "demographics": ("demographics",),
    "gender": ("demographics",),
    "remarks": ("remarks",),
}


def is_own(language: str) -> bool:
    """Whether a study's language is a file beside it."""
    return language.endswith(".toml")


def languages_of(study: Study) -> tuple[str, ...]:
    """Every language that somebody in the study is spoken to in."""
    said = [study.general.language, *(part.general.language for part in study.parts.values())]
    return tuple(dict.fromkeys(said))


def own_texts(study: Study) -> dict[str, str]:
    """Where a text of the study's own stands → the text, each text once."""
    known = Texts("en").keys()
    found = {f"{OWN}title": study.general.title}
    for factor in study.factors:
        for level in factor.levels:
            plain = level.number is None and f"name.{level.name}" not in known
            if level.label or plain:
                found[f"{OWN}factors.{factor.name}.{level.name}"] = level.label or level.name
    of_parts = {id(p.questions): p.questions for p in study.parts.values()}
    every = [study.questions, *of_parts.values()]
    for name, question in ((n, q) for questions in every for n, q in questions.items()):
        for key, said in declared(type(question.parameters)).items():
            if said.shown:
                value = getattr(question.parameters, key)
                listed = not isinstance(value, str)
                for number, text in enumerate(value if listed else (value,), start=1):
                    where = f"{OWN}questions.{name}.{key}" + (f"_{number}" if listed else "")
                    if text and text not in known and text not in found.values():
                        found[_free(where, found)] = text
    return found


def _free(where: str, taken: Mapping[str, str]) -> str:
    """The name, or where another level's text has it, the next one."""
    number, name = 1, where
    while name in taken:
        number += 1
        name = f"{where}_or_{number}"
    return name


def _used(study: Study) -> dict[str, set[str]]:
    """The plug-ins whose texts a study may show, by kind."""
    return {
        "technique": {  # who reads how to use their hands
            part.technique_name
            for part in study.parts.values()
            if part.technique.technique.active(part.technique)
        },
        "world": {part.world for part in study.parts.values()},
        "task": {*study.tasks()},
        "question": {q.use for part in study.parts.values() for q in part.questions.values()},
    }


def needed(study: Study) -> dict[str, str]:
    """Every text that the study may show, by its name, in English or in the study's own words."""
    uses = {q.use for part in study.parts.values() for q in part.questions.values()}
    kinds = any(part.world != "abstract" for part in study.parts.values()) or "depth_test" in uses
    sure = [part.task_options.of(t) for part in study.parts.values() for t in part.design.tasks]
    texts = Texts("en", study.texts)
    plugins = texts.of_others(_used(study))
    found = {}
    for key in sorted(texts.keys(), key=texts.place):
        table = key.partition(".")[0]
        wanted = table not in SHOWN_BY or bool(uses & {*SHOWN_BY[table]})
        wanted &= kinds or table != "kind"
        wanted &= table != "confidence" or any(options.confidence for options in sure)
        wanted &= plugins.get(key, True)
        if wanted:
            found[key] = texts[key]
    return {**found, **own_texts(study)}


def read(study: Study, path: Path, file: str) -> dict[str, str]:
    """The texts in a language's file beside the study at `path`. Raises InputError: a line for each
    that is missing or cannot be shown."""
    where = f"{path}: study.language = {shown(file)}"
    try:
        data = read_beside(path, file, LARGEST_TEXT)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(f"{where}: expected a file of texts beside the study ({reason})") from None
    place = str(path.parent / file)
    found = flat_values(parse_toml(data, place))
    lines = [f"{place}: {line}" for line in _faults(study, found)]
    if lines:
        raise gathered(lines)
    return {key: text for key, text in found.items() if isinstance(text, str)}


def _faults(study: Study, found: Mapping[str, object]) -> Iterator[str]:
    wanted, every = needed(study), {*Texts("en").keys(), *own_texts(study)}
    for key, text in found.items():
        if key not in every:
            table = key.rpartition(".")[0]
            near = [k for k in every if k.rpartition(".")[0] == table] or [*own_texts(study)]
            yield f"{short(key)} = {shown(text)}: {unknown(key, near, 'text')}"
        elif not isinstance(text, str):
            yield f"{key} = {shown(text)}: expected text"
        elif text.strip() and (bad := unshowable(text)):
            yield f"{key} = {shown(text)}: expected letters that the font has, not {bad}"
    for key, text in wanted.items():
        said = found.get(key, "")
        if not isinstance(said, str):
            continue
        if text.strip() and not said.strip():
            yield f"{key}: missing, expected what is in English {shown(text)}"
        elif said.strip() and {*PLACE.findall(said)} != {*PLACE.findall(text)}:
            places = ", ".join(sorted({*PLACE.findall(text)})) or "none"
            yield f"{key} = {shown(said)}: expected these places for values: {places}"


def texts_of(study: Study, language: str) -> Texts:
    """All texts of a session in one of the study's languages."""
    if not is_own(language):
        return Texts(language, study.texts)
    given = study.translations[language]
    replaced = {k: v for k, v in given.items() if not k.startswith(OWN)}
    return Texts("en", {**study.texts, **replaced}, own_words(study, language))


def demand_texts(study: Study, language: str) -> None:
    """Raises InputError where a plug-in has no text in one of our languages, before anybody reads
    it in English. Sessions that were shown so are replayed as they were."""
    if is_own(language):
        return
    only = Texts(language, study.texts).english_only(language, _used(study))
    lacking = [key for key in only if key not in study.texts]
    if lacking:
        raise InputError(
            f"study.language = {shown(language)}: no text in it of {', '.join(lacking)}: expected "
            "them there where they are in English, or below [texts]"
        )


def own_words(study: Study, language: str) -> dict[str, str]:
    """What stands for each of a study's own texts in a language of its own; nothing in others."""
    given = study.translations.get(language)
    return {text: given[k] for k, text in own_texts(study).items() if k in given} if given else {}


def template(study: Study, given: Mapping[str, str], stale: Mapping[str, str]) -> str:
    """What is to be translated, as a file of texts: each text with its English, and what there is
    of it already. What is `stale` (name → what it was translated from) is to be translated again,
    with what it was beside it."""
    parts = [f"# Texts of the study {study.general.name}: fill in what stands between the quotes."]
    tables: dict[str, list[str]] = {}
    texts = needed(study)
    for key, text in texts.items():
        table, _, name = key.rpartition(".")
        while table in texts:  # a text of that name cannot be a table as well
            table, _, more = table.rpartition(".")
            name = f"{more}.{name}"
        name = json.dumps(name) if "." in name else name
        said = given.get(key, "")
        entry = f"# {_quoted(text)}\n"
        if key in stale:
            entry, said = f"# before: {_quoted(said)}, of {_quoted(stale[key])}\n{entry}", ""
        entry += f"{name} = {_quoted(said)}"
        tables.setdefault(table, []).append(entry)
    for table in sorted(tables, key=lambda name: (name != "", name.startswith(OWN[:-1]))):
        head = [f"[{table}]"] if table else []
        parts.append("\n".join([*head, *tables[table]]))
    return "\n\n".join(parts) + "\n"


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def unshowable(text: str) -> str:
    """The characters of a text that the font has no picture of, each once."""
    strange = {c for c in text if not ("\x20" <= c <= "~" or c in "\n\t\r")}
    # Of what controls, fonts may have a picture: no text is meant to show it.
    bad = [c for c in strange if unicodedata.category(c) == "Cc" or not _has(c)]
    return " ".join(sorted(c if c.isprintable() else f"U+{ord(c):04X}" for c in bad))


@cache
def _has(character: str) -> bool:
    from seethrough.experiment.pages.interface import has_glyph  # ImGui: only for rare letters

    return has_glyph(character)


def unshowable_texts(study: Study, file: str) -> list[str]:
    """A line for each text of the study's own that the font lacks letters for."""
    every = {**own_texts(study), **{f"texts.{k}": v for k, v in study.texts.items()}}
    return [
        f"{file}: {key.removeprefix(OWN)} = {shown(text)}: expected letters that the font has, not "
        f"{bad}"
        for key, text in every.items()
        if (bad := unshowable(text))
    ]


def unshowable_names(study: Study, file: str) -> list[str]:
    """A line for each name of a thing that participants read and the font lacks letters for."""
    named = [
        (f"world.{part.world}.{key}", name)
        for part in study.parts.values()
        if isinstance(world := WORLDS[part.world], NamingWorld)
        for key, name in world.called(part.place)
    ]
    return [
        f"{file}: {key}: a thing is called {shown(name)}: expected letters that the font has, not "
        f"{bad}"
        for key, name in dict.fromkeys(named)
        if (bad := unshowable(name))
    ]


def with_translations(study: Study, path: Path) -> Study:
    """The study with the texts of each language of its own. Raises InputError."""
    files = [language for language in languages_of(study) if is_own(language)]
    return dataclasses.replace(study, translations={f: read(study, path, f) for f in files})
