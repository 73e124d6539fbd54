"""`seethrough new study`: a few questions, a commented file, and a workflow that tries it."""

from __future__ import annotations

import json
import sys
import tomllib
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TypeVar

from seethrough import registry
from seethrough.experiment.errors import InputError
from seethrough.experiment.study.config import parse
from seethrough.renderer.meant import meant, one_of
from seethrough.tasks.kit.world import ANYWHERE

LONGEST_TITLE = 200
Answer = TypeVar("Answer")
WORKFLOW = """name: study
on: [push, pull_request]
jobs:
  dry-run:
    runs-on: ubuntu-latest
    steps:
      - uses: actions/checkout@v4
      - uses: actions/setup-python@v5
        with: {{ python-version: "3.12" }}
      # From where you have seethrough: a repository (git+https://…), or a wheel beside the study.
      - run: pip install ${{{{ vars.SEETHROUGH || 'seethrough' }}}}
      - run: sudo apt-get update && sudo apt-get install -y libgl1-mesa-dri libegl1
      - run: seethrough check {name}.toml --balance
      - run: seethrough simulate {name}.toml --participants 4 --out data
      - run: seethrough report data --out report
      - uses: actions/upload-artifact@v4
        with: {{ name: report, path: report }}
"""
STUDY = """# {title}
# What every key may be: `seethrough keys`, docs/keys.md. Try it: `seethrough check {name}.toml`,
# `seethrough design {name}.toml`, `seethrough simulate {name}.toml --participants 4 --out data`.

[study]
name = "{name}"
title = {quoted}
description = "A study of how people see past what is in the way." # yours: what it is about
participants = {people}
seed = 1 # makes every random choice of scenes and orders; any number will do

[factors.view] # what is compared: a column of the data; each level is a part of a study
{levels}

# A second factor: a key of the world, mixed from trial to trial.
# [factors.clutter]
# set = "world.abstract.distractors"
# values = [80, 180, 380]
# order = "mixed"

[world]
use = "{world}"

[design]
order = "williams" # each view equally often at each place, and after each other one
tasks = ["{task}"]
trials = 3 # of each task with each view

[practice]
trials = 1 # before the trials of each view

[questions] # in this order
demographics = {{}}
ratings = {{ when = "condition" }} # after each view
comparison = {{ of = "view" }}
remarks = {{}}

# What you expect, before there are data: the report answers it first.
[[analysis.predictions]]
name = "P1"
measure = "time"
contrast = "view" # each level against the first one
expect = "less"
"""
Ask = Callable[[str, str], str]


def new_study(name: str, folder: Path, yes: bool, ask: Ask | None = None) -> int:
    """Ask, write the study and its workflow, once what is written can be read. An answer that
    cannot be taken is asked for again. Raises InputError."""
    study, workflow = folder / f"{name}.toml", folder / ".github" / "workflows" / "study.yml"
    for path in (study, workflow):
        if path.exists():
            raise InputError(f"{path}: exists already; expected a new file")
    said = _proposed if yes or not sys.stdin.isatty() else (ask or _asked)
    task = _until(said, "What do people do?" + _of(registry.known("task")), "count", _task)
    techniques = registry.known("technique")
    question = f"Which techniques, with spaces between?{_of(techniques)}"
    chosen = _until(said, question, "standard dynamic", partial(_techniques, techniques))
    people = _until(said, "How many people?", str(4 * len(chosen)), _people)
    title = _until(said, "What is it called?", f"{', '.join(chosen)} compared", _title)
    levels = "\n".join(f'levels.{view} = {{ technique.use = "{view}" }}' for view in chosen)
    words = {"name": name, "title": title, "people": people,
             "quoted": json.dumps(title, ensure_ascii=False), "levels": levels,
             "world": _world(task), "task": task}  # fmt: skip
    text = STUDY.format(**words)
    parse(tomllib.loads(text), str(study))
    try:
        workflow.parent.mkdir(parents=True, exist_ok=True)
        study.write_text(text, "utf-8")
        workflow.write_text(WORKFLOW.format(**words), "utf-8")
    except OSError as error:
        raise InputError(f"{folder}: {error.strerror}, expected a folder to write to") from None
    print(f"{study}\n{workflow}\nnext: seethrough design {study}")
    return 0


def _proposed(question: str, proposal: str) -> str:
    return proposal


def _asked(question: str, proposal: str) -> str:
    try:
        return input(f"{question} [{proposal}] ").strip() or proposal
    except EOFError:
        raise InputError("new study: no answer, nothing was written: expected one") from None


def _until(ask: Ask, question: str, proposal: str, read: Callable[[str], Answer]) -> Answer:
    """Ask until there is an answer that can be read."""
    while True:
        said = ask(question, proposal)
        try:
            return read(said)
        except InputError as error:
            if ask is _proposed:
                raise
            print(error)


def _of(known: tuple[str, ...]) -> str:
    return f" Of {', '.join(known)}"


def _task(said: str) -> str:
    known = registry.known("task")
    if said not in known:
        raise InputError(f"task = {said}: expected {one_of(said, known)}")
    return said


def _world(task: str) -> str:
    """The first world that the task can be done in."""
    worlds = registry.get("task", task).worlds
    return registry.known("world")[0] if worlds == ANYWHERE else worlds[0]


def _techniques(known: tuple[str, ...], said: str) -> list[str]:
    chosen = said.replace(",", " ").split()
    if len(chosen) < 2 or len(set(chosen)) < len(chosen) or not set(chosen) <= set(known):
        raise InputError(
            f"techniques = {said}: expected two or more of {', '.join(known)}"
            + meant(chosen, known)
        )
    return chosen


def _people(said: str) -> str:
    if not (said.isascii() and said.isdecimal() and 1 <= int(said[:6]) <= 10_000):
        raise InputError(f"people = {said}: expected a whole number from 1 to 10000")
    return said


def _title(said: str) -> str:
    if not said.isprintable() or len(said) > LONGEST_TITLE:
        raise InputError(
            f"title = {said[:LONGEST_TITLE]!r}: expected at most {LONGEST_TITLE} letters on a line"
        )
    return said
