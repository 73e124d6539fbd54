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
from seethrough.experiment.study.beside.own_model_files import models_of
from seethrough.experiment.study.config import Study, load
from seethrough.experiment.study.translations import demand_texts, languages_of, texts_of
from seethrough.experiment.verdicts import OK, WARNING, Verdicts
from seethrough.tasks.kit.world import FILES

if TYPE_CHECKING:
    from moderngl import Context


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
    _models(study, said)
    check_design(study, said)
    if arguments.balance:
        check_balance(study, arguments.slots, said)
        return said.sum_up()
    if arguments.config_only:
        return said.sum_up()
    from seethrough.experiment.display.driver import describe, on_the_processor, open_context

    context = open_context()
    for name, value in describe(context).items():
        software = name == "renderer" and on_the_processor(context)
        said.say("machine", f"{name}: {value}", *([WARNING, NO_CARD] if software else []))
    _contact_sheet(study, context, arguments, said)
    _scenes(study, context, arguments, said)
    measured = measured_scenes(study, context)
    check_difficulty(study, measured, context, arguments.redraw, said)
    check_techniques(study, measured, context, said)
    if arguments.certificate is not None:
        write_certificate(study, measured, arguments.certificate)
    check_machine(study, measured, context, arguments.seconds, said)
    return said.sum_up()


def _models(study: Study, said: Verdicts) -> None:
    """What the study brings along: read already, or there would be no study."""
    models = models_of(study)
    if models:
        from seethrough.experiment.study.checked.contact_sheet import described, facts_of
    for own in models:
        first, *more = described(own, facts_of(own), study)
        said.say("model", f"{own.name}: {own.file}, {first}, {own.sha256[:12]}")
        for line in more:
            print(f"{'':<11} {line}")


def _contact_sheet(
    study: Study, context: Context, arguments: argparse.Namespace, said: Verdicts
) -> None:
    """The study's own models in a picture, where it has any."""
    if models_of(study):
        from seethrough.experiment.study.checked import contact_sheet

        path = arguments.models or contact_sheet.default_path(arguments.study)
        contact_sheet.write(study, context, path)
        said.say("models", f"a picture of each from several sides, in {path}", OK, "look at it")


def _scenes(study: Study, context: Context, arguments: argparse.Namespace, said: Verdicts) -> None:
    """The study's own scenes: how large they are, what is seen of them from where, a picture."""
    if all(place.scenes != FILES for place in study.places()):
        return
    from seethrough.experiment.study.checked import scene_sheet

    found = []
    for p, file in scene_sheet.scenes_of(study):
        seen = scene_sheet.looked_at(study, context, p, file)
        found.append(seen)
        text, odd = scene_sheet.described(p, seen.place)
        said.say("scene", text, *([WARNING, odd] if odd else []))
        for line in scene_sheet.seen_lines(seen):
            print(f"{'':<11} {line}")
    if found:
        path = arguments.scenes or scene_sheet.default_path(arguments.study)
        scene_sheet.write(found, context, path)
        said.say("scenes", f"a picture of each from every view, in {path}", OK, "look at it")
