"""`seethrough new study`: a few questions, a commented file, and a workflow that tries it."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from seethrough import registry
from seethrough.experiment.errors import InputError
from seethrough.experiment.study.config import load

WORKFLOW = """name: study
on: [push, pull_request]
jobs:
  dry-run:
    runs-on: ubuntu-latest
    steps:
      - uses: actions/checkout@v4
      - uses: actions/setup-python@v5
        with: {{ python-version: "3.12" }}
      - run: pip install seethrough
      - run: sudo apt-get install -y libgl1-mesa-dri libegl1
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
name = "{plain}"
title = "{title}"
description = "{title}: a study of how people see past what is in the way."
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
    """Ask, write the study and its workflow, check what was written. Raises InputError."""
    said = _proposed if yes or not sys.stdin.isatty() else (ask or _asked)
    task = _one_of(said, "What do people do?", registry.known("task"), "count")
    world = registry.get("task", task).worlds[0]
    known = registry.known("technique")
    views = said(
        f"Which techniques, with spaces between? Of {', '.join(known)}", "standard dynamic"
    )
    chosen = views.replace(",", " ").split()
    if len(chosen) < 2 or len(set(chosen)) < len(chosen) or not set(chosen) <= set(known):
        raise InputError(f"techniques = {views}: expected two or more of {', '.join(known)}")
    people = said("How many people?", str(4 * len(chosen)))
    if not (people.isascii() and people.isdecimal() and 1 <= int(people) <= 10_000):
        raise InputError(f"people = {people}: expected a whole number from 1 to 10000")
    title = said("What is it called?", f"{', '.join(chosen)} compared").replace('"', "'")
    levels = "\n".join(f'levels.{view} = {{ technique.use = "{view}" }}' for view in chosen)
    words = {"name": name, "plain": name.replace("_", ""), "title": title, "people": people,
             "levels": levels, "world": world, "task": task}  # fmt: skip
    study, workflow = folder / f"{name}.toml", folder / ".github" / "workflows" / "study.yml"
    for path in (study, workflow):
        if path.exists():
            raise InputError(f"{path}: exists already; expected a new file")
    try:
        workflow.parent.mkdir(parents=True, exist_ok=True)
        study.write_text(STUDY.format(**words), "utf-8")
        workflow.write_text(WORKFLOW.format(name=name), "utf-8")
    except OSError as error:
        raise InputError(f"{folder}: {error.strerror}, expected a folder to write to") from None
    load(str(study))
    print(f"{study}\n{workflow}\nnext: seethrough design {study}")
    return 0


def _proposed(question: str, proposal: str) -> str:
    return proposal


def _asked(question: str, proposal: str) -> str:
    return input(f"{question} [{proposal}] ").strip() or proposal


def _one_of(ask: Ask, question: str, known: tuple[str, ...], proposal: str) -> str:
    said = ask(f"{question} One of {', '.join(known)}", proposal)
    if said not in known:
        raise InputError(f"{said}: expected one of {', '.join(known)}")
    return said
