"""The commands `seethrough task|world|question`: list what there is, check one.

`seethrough technique` draws what it checks, and is a command of its own
(experiment/commands/kinds/technique.py).
"""

from __future__ import annotations

import argparse
from pathlib import Path

from seethrough.experiment.errors import InputError, short, unknown
from seethrough.experiment.files.trust import TRUST
from seethrough.experiment.study.beside.plugin_files import from_path


def add_arguments(kind: str, parser: argparse.ArgumentParser) -> None:
    """What the command of a kind of plug-in takes."""
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    actions.add_parser("list", help=f"every {kind} there is, with its source")
    check = actions.add_parser("check", help=f"try every rule of a {kind} on one")
    check.add_argument("name", metavar="NAME", help=f"name of a {kind}, or a file with one")
    check.add_argument("--trust", action="store_true", help=TRUST)


def run(kind: str, arguments: argparse.Namespace) -> int:
    """List all, or check one: 0, or 1 where it is not what it has to be."""
    from seethrough import registry

    try:
        if arguments.action == "list":
            for name, plugin in registry.every(kind).items():
                print(f"{name:20s} {plugin.version:6s} {plugin.source}")
            return 0
        if arguments.name.endswith(".py"):
            return _check(kind, from_path(kind, Path(arguments.name)))
        if arguments.name not in registry.known(kind):
            said = unknown(arguments.name, registry.known(kind), kind)
            raise InputError(f"{kind} check {short(arguments.name)}: {said}")
        return _check(kind, arguments.name)
    except registry.PluginError as error:
        raise InputError(str(error)) from None


def _check(kind: str, name: str) -> int:
    from seethrough.experiment.suites.suite import findings

    holds = True
    for finding in findings(kind, name):
        print(finding, flush=True)
        holds &= finding.holds
    return 0 if holds else 1
