"""`seethrough check`: config, design, difficulty and machine, before anybody is invited."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from seethrough.experiment.commands.studies.check_design import check_balance, check_design
from seethrough.experiment.commands.studies.check_difficulty import (
    check_difficulty,
    check_techniques,
    measured_scenes,
    write_certificate,
)
from seethrough.experiment.commands.studies.check_machine import check_machine
from seethrough.experiment.errors import InputError
from seethrough.experiment.files.outputs import check_output
from seethrough.experiment.study.checked import brought
from seethrough.experiment.study.config import find, load
from seethrough.experiment.study.translations import demand_texts, languages_of, texts_of
from seethrough.experiment.verdicts import WARNING, Verdicts

if TYPE_CHECKING:
    pass


SECONDS = 10.0  # of the hardest scene
NO_CARD = "no graphics card draws: expected frames to be late in hard scenes"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("study", metavar="STUDY", help="TOML file or name of a shipped study")
    parser.add_argument("--config-only", action="store_true", help="config and design alone")
    parser.add_argument("--certificate", type=Path, metavar="FILE.csv", help="every trial's row")
    parser.add_argument(
        "--redraw", action="store_true", help="find the scenes to draw again, and print them"
    )
    parser.add_argument(
        "--balance", action="store_true", help="count balance from the tables of --slots sessions"
    )
    parser.add_argument(
        "--slots", type=int, metavar="N", help="default: a complete cycle of every group"
    )
    parser.add_argument(
        "--models", type=Path, metavar="FILE.png", help="where a picture of its own models goes"
    )
    parser.add_argument(
        "--scenes", type=Path, metavar="FILE.png", help="where a picture of its own scenes goes"
    )
    parser.add_argument("--seconds", type=float, default=SECONDS, help="of the hardest scene")


def run(arguments: argparse.Namespace) -> int:
    """Print what was checked; 0 if the study may run here, 1 if not."""
    check_output("--certificate", arguments.certificate)
    check_output("--models", arguments.models, ".png")
    check_output("--scenes", arguments.scenes, ".png")
    if arguments.certificate is not None and arguments.certificate.exists():
        raise InputError(f"{arguments.certificate}: exists already; expected a new file")
    study = load(arguments.study)
    for language in languages_of(study):
        texts_of(study, language)
        demand_texts(study, language)
    said = Verdicts()
    said.say("config", f"{study.general.name}, {study.digest()[:12]}")
    brought.texts(study, find(arguments.study), said)
    brought.models(study, said)
    check_design(study, said)
    if arguments.balance:
        check_balance(study, arguments.slots, said)
        return said.sum_up()
    brought.trial_scenes(study, said)
    if arguments.config_only:
        return said.sum_up()
    from seethrough.experiment.display.driver import describe, on_the_processor, open_context

    context = open_context()
    for name, value in describe(context).items():
        software = name == "renderer" and on_the_processor(context)
        said.say("machine", f"{name}: {value}", *([WARNING, NO_CARD] if software else []))
    brought.model_sheet(study, context, arguments.models, arguments.study, said)
    brought.scenes(study, context, arguments.scenes, arguments.study, said)
    measured = measured_scenes(study, context)
    check_difficulty(study, measured, context, arguments.redraw, said)
    check_techniques(study, measured, context, said)
    if arguments.certificate is not None:
        write_certificate(study, measured, arguments.certificate)
    check_machine(study, measured, context, arguments.seconds, said)
    return said.sum_up()
