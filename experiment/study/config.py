"""One TOML file is a study: found, read, checked."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Iterator, Mapping
from importlib import resources
from pathlib import Path

from seethrough.experiment.errors import MOST, InputError, gathered, short, shown
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.study.beside.own_model_files import beside
from seethrough.experiment.study.beside.plugin_files import taken
from seethrough.experiment.study.beside.study_files import LARGEST_TEXT, read_beside
from seethrough.experiment.study.beside.toml_file import read_toml
from seethrough.experiment.study.design.design import number_of, scene_names
from seethrough.experiment.study.migrate import is_old, migrated
from seethrough.experiment.study.parser import Parser
from seethrough.experiment.study.predicted import unfit_predictions
from seethrough.experiment.study.selection import unfit_selection
from seethrough.experiment.study.study import Study
from seethrough.experiment.study.study_items import lacking_items
from seethrough.experiment.study.tables.study_errors import study_error
from seethrough.experiment.study.task_clashes import clashing_tasks
from seethrough.experiment.study.translations import (
    unshowable_names,
    unshowable_texts,
    with_translations,
)
from seethrough.renderer.meant import one_of

__all__ = ["Study", "find", "load", "parse", "shipped"]


def shipped() -> dict[str, Path]:
    """Name → file of the studies that ship in configs/ and configs/examples/."""
    folder = Path(str(resources.files("seethrough.configs")))
    return {p.stem: p for where in (folder, folder / "examples")
            for p in sorted(where.glob("*.toml"))}  # fmt: skip


def find(name: str) -> Path:
    """The config file for a path or a shipped study's name. Raises InputError."""
    path = Path(name)
    if _is_there(path):
        return path
    if path.name == name and name in shipped():
        return shipped()[name]
    if path.parent == Path("configs") and path.stem in shipped() and path.suffix == ".toml":
        return shipped()[path.stem]
    if os.path.isdir(path):  # of a name that no disk can have, too: it is none
        there = ", ".join(short(file.name) for file in _studies_in(path)) or "none"
        raise InputError(
            f"{short(name)}: a folder, expected a study's file; in it there are: {there}"
        )
    raise InputError(
        f"{short(name)}: no such file; expected a TOML file or {one_of(name, shipped())}"
    )


def _studies_in(folder: Path) -> list[Path]:
    """The files in a folder that have a [study] with a name: texts have one without."""
    return [path for path in sorted(folder.glob("*.toml"))
            if path.is_file() and _names_a_study(path)]  # fmt: skip


def _names_a_study(path: Path) -> bool:
    try:
        about = read_toml(path).get("study")
    except InputError:
        return True  # who asks for it is told what is wrong with it
    return isinstance(about, Mapping) and "name" in about


def _is_there(path: Path) -> bool:
    """Whether there is something that is no folder: what it is, reading it will say."""
    try:
        return os.path.lexists(path) and not path.is_dir()
    except (OSError, ValueError):  # a name that is too long for the disk, or holds a null byte
        return False


def load(name: str, translated: bool = True) -> Study:
    """Read and check a study. Raises InputError: of each fault file, key, value and what was
    expected. `translated`: with the texts of its own languages, which all have to be there."""
    path = find(name)
    faults: list[str] = []
    more = 0
    study = None
    table = taken(read_toml(path), path)
    try:
        study = parse(table, str(path))
    except InputError as error:
        faults += error.faults
        more = error.more
    texts = {}
    for key, text in _files(table):
        try:
            texts[f"{key}.text"] = _text(path, f"questions.{key}.file", text)
        except InputError as error:
            faults += error.faults
    if faults or study is None:
        raise gathered(faults, more)
    study = dataclasses.replace(study, texts={**study.texts, **texts})
    if lines := unshowable_texts(study, str(path)):
        raise gathered(lines)
    study = with_translations(study, path) if translated else study
    study = study.with_places(lambda place: beside(place, path))
    lacking = [f"{path}: {line}" for line in _of_all(study)]
    if lines := lacking + unshowable_names(study, str(path)):
        raise gathered(lines)
    return study


def _of_all(study: Study) -> Iterator[str]:
    """What neither tables nor records have to keep to, but who begins with a study."""
    yield from clashing_tasks(study)
    yield from unfit_predictions(study)
    yield from unfit_selection(study)
    yield from lacking_items(study)


def _files(table: Mapping[str, object]) -> list[tuple[str, str]]:
    """(name, file) of each question that shows a text file."""
    asked = table.get("questions")
    if not isinstance(asked, Mapping):
        return []
    return [
        (name, own["file"])
        for name, own in asked.items()
        if isinstance(own, Mapping) and isinstance(own.get("file"), str) and own["file"]
    ]


def _text(path: Path, key: str, name: str) -> str:
    """The text of a file beside the study at `path`. Raises InputError."""
    try:
        text = read_beside(path, name, LARGEST_TEXT).decode("utf-8-sig").strip()
        if not text:  # nobody can agree to a page without words
            raise ValueError("nothing is written in it")
        return text
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        reason = "not UTF-8" if isinstance(error, UnicodeDecodeError) else reason
        raise InputError(
            f"{path}: {key} = {shown(name)}: expected a text file beside the study ({reason})"
        ) from None


def parse(table: Mapping[str, object], file: str, before: bool = False) -> Study:
    """Check a study that is already a table; `file` is named in messages. Raises InputError.

    `before`: a table in the language of earlier versions is read as well, as records need.
    """
    if is_old(table):
        if not before:
            raise InputError(
                f"{file}: written for an earlier version: expected the present language, which "
                f"`seethrough migrate {file}` makes of it"
            )
        table = migrated(table)
    study, faults = Parser(table).study()
    lines = _unknown_texts(table) + (_unknown_scenes(study) if study is not None else [])
    if faults or lines or study is None:
        error = study_error(faults, file)
        raise gathered([*error.faults, *(f"{file}: {line}" for line in lines)], error.more)
    return study


def _unknown_scenes(study: Study) -> list[str]:
    """A scene to be drawn again is one that a participant meets."""
    met: dict[int, list[str]] = {}
    wrong: list[str] = []
    for which, name in enumerate(study.design.redraw):
        number = number_of(name)
        if number not in met:
            met[number] = scene_names(number, study.plan)
        if name not in met[number]:
            like = f"such as {met[number][0]}, as `check --redraw` prints them"
            wrong.append(f"design.redraw[{which}] = {shown(name)}: expected a scene of it, {like}")
        if len(wrong) > MOST:
            break
    return wrong


def _unknown_texts(table: Mapping[str, object]) -> list[str]:
    """Every language has the same texts."""
    texts = table.get("texts")
    if not texts or not isinstance(texts, Mapping):
        return []
    english = Texts("en")
    wrong = [name for name in texts if name not in english.keys()]
    return [f"texts.{short(name)}: {english.unknown(name)}" for name in wrong[: MOST + 1]]
