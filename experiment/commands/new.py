"""`seethrough new`: the beginning of a plug-in that passes its suite, to be changed bit by bit."""

from __future__ import annotations

import argparse
from importlib import resources
from pathlib import Path

from seethrough import registry
from seethrough.experiment.errors import InputError, shown

KINDS = ("task", "world", "question")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What the command takes."""
    parser.add_argument("kind", choices=KINDS, help="what to begin")
    parser.add_argument("name", metavar="NAME", help="lower-case letters, digits and _")
    parser.add_argument("folder", metavar="DIR", type=Path, help="made; must not be there yet")


def run(arguments: argparse.Namespace) -> int:
    """Write a package and say how to go on."""
    kind, name, folder = arguments.kind, arguments.name, arguments.folder
    if not (name.isidentifier() and name.isascii() and name == name.lower()):
        raise InputError(f"NAME = {shown(name)}: expected lower-case letters, digits and _")
    if name in registry.names(kind):
        raise InputError(f"NAME = {shown(name)}: expected a name that no other {kind} has")
    if folder.exists() or not folder.parent.is_dir():
        raise InputError(f"{folder}: expected a folder that is not there yet, in one that is")
    folder.mkdir()
    for template, file in ((kind, f"{name}.py"), ("pyproject", "pyproject.toml")):
        (folder / file).write_text(_filled(template, kind, name), "utf-8")
    print(f"{folder}: a {kind} that passes its suite; change {folder / name}.py, then")
    print(f"  pip install -e {folder}")
    print(f"  seethrough {kind} check {name}")
    return 0


def _filled(template: str, kind: str, name: str) -> str:
    file = resources.files("seethrough.experiment.plugins").joinpath("templates", f"{template}.txt")
    words = {"NAME": name, "KIND": kind, "CONSTANT": registry.KINDS[kind].constant}
    text = file.read_text("utf-8")
    for word, value in words.items():
        text = text.replace(word, value)
    return text
