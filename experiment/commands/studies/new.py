"""`seethrough new`: a package of one's own that already passes its suite, to begin with."""

from __future__ import annotations

import argparse
import re
from importlib.resources import files
from pathlib import Path

from seethrough import registry
from seethrough.experiment.errors import InputError, short

HELP = "write a package with a plug-in of your own, to begin with"
LONGEST = 40
NAME = re.compile(rf"[a-z][a-z0-9_]{{0,{LONGEST - 1}}}")
KINDS = ("technique", "task", "world", "question", "study")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What the command takes."""
    parser.add_argument("kind", choices=KINDS, help="what kind of thing")
    parser.add_argument("name", metavar="NAME", help="its name, as a study will say it")
    parser.add_argument("folder", metavar="DIR", type=Path, help="a folder that is made for it")
    parser.add_argument(
        "--yes", action="store_true", help="of a study: ask nothing, take what is proposed"
    )


def run(args: argparse.Namespace) -> int:
    """Write the package and say what to do with it."""
    where = f"new {args.kind}: NAME = {short(args.name)}"
    if args.kind == "study":
        from seethrough.experiment.study.new_study import new_study
        from seethrough.experiment.study.tables.study_tables import NAME as PLAIN
        from seethrough.experiment.study.tables.study_tables import is_plain

        if not is_plain(args.name):
            raise InputError(f"{where}: expected {PLAIN}")
        return new_study(args.name, args.folder, args.yes)
    if not NAME.fullmatch(args.name):
        raise InputError(
            f"{where}: expected 1 to {LONGEST} small letters, digits and _, a letter first"
        )
    if args.name in registry.known(args.kind):
        raise InputError(f"{where}: there is one of this name already")
    from seethrough.experiment.study.tables.plugins import taken_names

    if args.name in taken_names(args.kind):
        raise InputError(f"{where}: expected another name, a study says other things by it")
    templates = files("seethrough.experiment.suites").joinpath("templates")
    found = registry.KINDS[args.kind]
    words = {
        "NAME": args.name,
        "MODULE": f"seethrough_{args.name}",
        "GROUP": found.group.removeprefix("seethrough."),
        "CONSTANT": found.constant,
    }
    try:
        args.folder.mkdir(parents=True)
        for template, file in (
            ("pyproject.txt", "pyproject.toml"),
            (f"{args.kind}.txt", f"{words['MODULE']}.py"),
        ):
            text = templates.joinpath(template).read_text("utf-8")
            for word, value in words.items():
                text = re.sub(rf"\b{word}\b", value, text)
            (args.folder / file).write_text(text, "utf-8")
    except OSError as error:
        raise InputError(
            f"new {args.kind}: DIR = {args.folder}: {error.strerror or error}, expected a folder "
            "that can be made"
        ) from error
    print(
        f"{args.folder}: install it (pip install -e {args.folder}), then\n"
        f"seethrough {args.kind} check {args.name}"
    )
    return 0
