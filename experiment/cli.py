"""The program `seethrough`: finds the command, imports only that, turns errors into one line."""

from __future__ import annotations

import argparse
import errno
import importlib
import re
import sys
from collections.abc import Sequence
from typing import NoReturn

from seethrough.analysis.errors import DataError
from seethrough.experiment import streams
from seethrough.experiment.errors import InputError, one_line, unknown
from seethrough.renderer.errors import CannotDraw
from seethrough.renderer.meant import one_of
from seethrough.tasks.kit.errors import NoScene

SAVING = {"run", "simulate", "demo"}  # commands that play sessions
ARGUMENT = re.compile(
    r"argument ([^:]+): (?:expected (?:one|at least one) argument|"
    r"invalid (\w+)(?: value)?: '(.*?)'(?: \(choose from (.*)\))?)", re.DOTALL,
)  # fmt: skip
KINDS = {"int": "a whole number", "float": "a number"}
FULL = (errno.ENOSPC, errno.EIO, errno.EDQUOT)  # where the output goes, as `> FILE` on a full disk

ROOMS = {  # where a command is, below commands/
    "studies": {
        "new": "write a package with a plug-in of your own, to begin with",
        "check": "check a study before anybody is invited",
        "design": "print, write or draw what a study's factors make",
        "prereg": "write a study's preregistration",
        "migrate": "rewrite a study file of an earlier version",
        "texts": "write what is to be translated for a study in a language of its own",
        "keys": "list what a study file may say: keys, types, defaults, limits, meaning",
    },
    "sessions": {
        "run": "run a participant's session in a window",
        "simulate": "play a study with simulated participants",
        "demo": "play the short study and make its report",
        "status": "slots of a study, its balance, and what to run next",
        "repair": "make one of a participant's folder that was played twice at once",
        "withdraw": "remove a participant's data, leaving a dated mark",
        "replay": "show a trial again from its log",
    },
    "data": {
        "report": "make the statistics report from a data folder",
        "export": "give the data another form: wide, parquet, bids, psychds",
        "seal": "print one hash over everything that was recorded",
        "power": "how many participants does a study need",
        "calibrate": "fit simulated participants to the published times",
    },
    "pictures": {
        "render": "draw a scene into a picture",
        "view": "look at a scene of translucent polygons, ordered by a method",
        "gallery": "draw every technique, parameter, look and hard case into a page",
    },
    "kinds": {
        "technique": "list techniques, or try one on all that it must keep to",
        "task": "list the tasks there are, or check one",
        "world": "list the worlds there are, or check one",
        "question": "list the kinds of questions there are, or check one",
    },
}
ELSEWHERE = {"bench": "seethrough.benchmarks.bench"}  # not the experiment's
COMMANDS = {name: said for room in ROOMS.values() for name, said in room.items()}
COMMANDS["bench"] = "measure accuracy against time"

# Commands that read a study, which may bring code along.
TRUSTING = {
    "run", "simulate", "calibrate", "power", "replay", "status", "check", "design", "prereg",
    "render", "texts",
}  # fmt: skip


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one line; the usage is in --help."""

    def error(self, message: str) -> NoReturn:
        said = one_line(_in_words(message))
        print(f"{self.prog}: {said} (see {self.prog} --help)", file=sys.stderr)
        raise SystemExit(2)


def _in_words(message: str) -> str:
    """What argparse says of an argument, as we say it: name = value: expected …"""
    found = ARGUMENT.fullmatch(message)
    if found is None:
        return message
    name, kind, value, choices = found.group(1, 2, 3, 4)
    if kind is None:
        return f"{name}: missing, expected a value"
    if not choices:
        return f"{name} = {value[:60]}: expected {KINDS.get(kind, kind)}"
    known = choices.replace("'", "").split(", ")
    return f"{name} = {value[:60]}: expected {one_of(value, known)}"


def _place(name: str) -> str:
    """The module of a command."""
    room = next((room for room, names in ROOMS.items() if name in names), None)
    return ELSEWHERE[name] if room is None else f"{__package__}.commands.{room}.{name}"


def _parser(argv: Sequence[str]) -> argparse.ArgumentParser:
    """A parser that knows every command's name, and the arguments of the one in `argv`."""
    from seethrough.experiment.files import trust  # a command's matter: this module knows none

    parser = _Parser(prog="seethrough", description="User studies of occlusion management.")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    chosen = next((a for a in argv if not a.startswith("-")), None)
    if chosen is not None and chosen not in COMMANDS:
        parser.error(f"{chosen[:60]}: {unknown(chosen, COMMANDS, 'command')}")
    for name, summary in COMMANDS.items():
        sub = commands.add_parser(name, help=summary, description=summary)
        if name == chosen:
            module = importlib.import_module(_place(name))
            module.add_arguments(sub)
            if name in TRUSTING:
                sub.add_argument("--trust", action="store_true", help=trust.TRUST)
            sub.set_defaults(run=module.run)
    return parser


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command; returns the exit status: 0 done, 2 bad input, 130 interrupted, 141 where
    nobody reads the output any more."""
    streams.fill()
    words = list(sys.argv[1:] if argv is None else argv)
    try:
        status = _run(words)
        sys.stdout.flush()
        return status
    except SystemExit:  # --help, or arguments that are wrong
        _let_go()
        raise
    except (KeyboardInterrupt, SystemError) as error:
        if not _is_interrupt(error):
            raise
        kept = "; every completed trial is saved" if {*words} & SAVING else ""
        # Python remembers that Ctrl-C came out of a string of code, as dataclasses are made of, and
        # would end by the signal whatever is returned here. The next string makes it forget.
        exec("")
        return _failed([f"interrupted{kept}"], 130)
    except OSError as error:
        if streams.reader_is_gone():
            streams.leave_quietly()
            return streams.READER_GONE
        if error.errno in FULL:
            return _failed([f"output: {error.strerror}"], 2)
        raise


def _is_interrupt(error: BaseException | None) -> bool:
    """Whether Ctrl-C is at the bottom of it: in compiled code it becomes a SystemError."""
    while error is not None and not isinstance(error, KeyboardInterrupt):
        error = error.__cause__ or error.__context__
    return error is not None


def _run(words: Sequence[str]) -> int:
    study = ""
    try:
        arguments = _parser(words).parse_args(words)
        study = getattr(arguments, "study", None) or ""
        if getattr(arguments, "trust", False):
            from seethrough.experiment.files import trust

            trust.trust_everything()
        return int(arguments.run(arguments) or 0)
    except InputError as error:
        return _failed(error.lines, 2)
    except DataError as error:
        return _failed(error.shown(), 2)
    except CannotDraw as error:
        return _failed([str(error)], 2)
    except NoScene as error:
        return _failed([f"{study}: {error}" if study else str(error)], 2)
    except OSError as error:
        if error.filename is None:
            raise
        return _failed([f"{error.filename}: {error.strerror}"], 2)
    except Exception as error:
        line = _of_a_plugin(error)
        if line is None:
            raise
        return _failed([line], 2)


def _of_a_plugin(error: Exception) -> str | None:
    """What to say of an exception in a plug-in of others; None where it is ours."""
    from seethrough import registry

    if isinstance(error, registry.PluginError):
        return str(error)
    found = registry.at_fault(error)
    if found is None:
        return None
    from seethrough.experiment.session.strangers import said

    return f"{' '.join(found)}: {said(*found, error)}"


def _let_go() -> None:
    """Write what still waits, or nothing where nobody reads it."""
    try:
        sys.stdout.flush()
    except OSError:
        streams.leave_quietly()


def _failed(lines: Sequence[str], status: int) -> int:
    """Say why, a line each."""
    for line in lines:
        print(f"seethrough: {one_line(line)}", file=sys.stderr)
    return status


if __name__ == "__main__":
    sys.exit(main())
