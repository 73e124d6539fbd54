"""The program `seethrough`: finds the command, imports only that, turns errors into one line."""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Sequence
from typing import NoReturn

from experiment.errors import InputError, one_line

COMMANDS = {
    "run": "run a participant's session in a window",
    "simulate": "play a study with simulated participants",
    "calibrate": "fit simulated participants to the published times",
    "power": "how many participants does a study need",
    "replay": "show a trial again from its log",
    "status": "slots of a study, its balance, and what to run next",
    "repair": "make one of a participant's folder that was played twice at once",
    "withdraw": "remove a participant's data, leaving a dated mark",
    "export": "give the data another form: wide, parquet, bids, psychds",
    "report": "make the statistics report from a data folder",
    "check": "check a study before anybody is invited",
    "render": "draw a scene into a picture",
    "view": "look at a scene of translucent polygons, ordered by a method",
    "bench": "measure accuracy against time",
    "gallery": "draw every mode, mask, granularity and hard case into a page",
    "demo": "play the short study and make its report",
}


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one line; the usage is in --help."""

    def error(self, message: str) -> NoReturn:
        print(f"{self.prog}: {one_line(message)} (see {self.prog} --help)", file=sys.stderr)
        raise SystemExit(2)


def _parser(argv: Sequence[str]) -> argparse.ArgumentParser:
    """A parser that knows every command's name, and the arguments of the one in `argv`."""
    parser = _Parser(prog="seethrough", description="User studies of occlusion management.")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    chosen = next((a for a in argv if not a.startswith("-")), None)
    for name, summary in COMMANDS.items():
        sub = commands.add_parser(name, help=summary, description=summary)
        if name == chosen:
            module = importlib.import_module(f"experiment.commands.{name}")
            module.add_arguments(sub)
            sub.set_defaults(run=module.run)
    return parser


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command; returns the exit status: 0 done, 2 bad input, 130 interrupted."""
    words = list(sys.argv[1:] if argv is None else argv)
    try:
        arguments = _parser(words).parse_args(words)
        return int(arguments.run(arguments) or 0)
    except InputError as error:
        print(f"seethrough: {one_line(str(error))}", file=sys.stderr)
        return 2
    except OSError as error:
        if error.filename is None:
            raise
        print(f"seethrough: {one_line(f'{error.filename}: {error.strerror}')}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("seethrough: interrupted; every completed trial is saved", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
