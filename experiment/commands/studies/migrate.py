"""`seethrough migrate`: a study file of an earlier version in the present language."""

from __future__ import annotations

import argparse
from pathlib import Path

from seethrough.experiment.errors import InputError
from seethrough.experiment.study.beside.toml_file import parse_toml, read_toml
from seethrough.experiment.study.config import find, load, parse
from seethrough.experiment.study.migrate import is_old


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("study", metavar="OLD.toml", help="a study file of an earlier version")
    parser.add_argument(
        "--out", type=Path, metavar="NEW.toml", help="default: OLD-migrated.toml beside it"
    )


def run(arguments: argparse.Namespace) -> int:
    """Write the new file, and make sure that it is the same study. The old one stays as it is."""
    from seethrough.experiment.study.migrate_file import migrated_text

    path = find(arguments.study)
    out = arguments.out or path.with_name(f"{path.stem}-migrated.toml")
    table = read_toml(path)
    if not is_old(table):
        raise InputError(f"{path}: is in the present language: expected one of an earlier version")
    if out.exists():
        raise InputError(f"{out}: exists already; expected a new file")
    text = migrated_text(path.read_bytes().decode("utf-8-sig"))
    new, same = parse(parse_toml(text.encode(), str(out)), str(out)), parse(table, str(path), True)
    if new.digest() != same.digest():
        raise InputError(f"{path}: expected a study that can be rewritten as it is")
    out.write_text(text, "utf-8")
    load(str(out))
    print(f"{out}: {new.general.name}, {len(new.parts)} cells; {path} stays as it was")
    return 0
