"""`seethrough check`: config, design, difficulty and machine, before anybody is invited."""

from __future__ import annotations

import argparse
import csv
from collections import Counter
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING

from seethrough.experiment.errors import InputError
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.study.config import Study, load
from seethrough.experiment.study.design import order_of, session_for
from seethrough.experiment.verdicts import FAILS, OK, WARNING, Verdicts

if TYPE_CHECKING:
    from moderngl import Context

    from seethrough.experiment.session.machine import FrameTimes
    from seethrough.experiment.study.certificate import Difficulty, Match

SECONDS = 10.0  # of the hardest scene
LEAST_DISK = 1.0  # GiB
MOST_REDRAWS = 50
MOST_ORDERS = 64  # more than a square of the conditions that there can be has rows
SMOOTH, HOPELESS = 0.01, 0.5  # shares of frames missed: above the first a warning, the last fails
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
        "--models", type=Path, metavar="FILE.png", help="where a picture of its own models goes"
    )
    parser.add_argument("--seconds", type=float, default=SECONDS, help="of the hardest scene")


def run(arguments: argparse.Namespace) -> int:
    """Print what was checked; 0 if the study may run here, 1 if not."""
    if arguments.certificate is not None and arguments.certificate.exists():
        raise InputError(f"{arguments.certificate}: exists already; expected a new file")
    study = load(arguments.study)
    Texts(study.study.language, study.texts)
    said = Verdicts()
    said.say("config", f"{study.study.name}, {study.digest()[:12]}")
    _models(study, said)
    _design(study, said)
    if arguments.config_only:
        return said.sum_up()
    from seethrough.experiment.display.driver import describe, on_the_processor, open_context

    context = open_context()
    for name, value in describe(context).items():
        software = name == "renderer" and on_the_processor(context)
        said.say("machine", f"{name}: {value}", *([WARNING, NO_CARD] if software else []))
    _contact_sheet(study, context, arguments, said)
    measured = _measured(study, context)
    _difficulty(study, measured, context, arguments.redraw, said)
    if arguments.certificate is not None:
        _write(measured, arguments.certificate)
    _machine(study, measured, context, arguments.seconds, said)
    return said.sum_up()


def _models(study: Study, said: Verdicts) -> None:
    """What the study brings along: read already, or there would be no study."""
    if study.walkthrough.models:
        from seethrough.experiment.study.contact_sheet import described, facts_of
    for own in study.walkthrough.models:
        first, *more = described(own, facts_of(own), study)
        said.say("model", f"{own.name}: {own.file}, {first}, {own.sha256[:12]}")
        for line in more:
            print(f"{'':<11} {line}")


def _contact_sheet(
    study: Study, context: Context, arguments: argparse.Namespace, said: Verdicts
) -> None:
    """The study's own models in a picture, where it has any."""
    if study.walkthrough.models:
        from seethrough.experiment.study import contact_sheet

        path = arguments.models or contact_sheet.default_path(arguments.study)
        contact_sheet.write(study, context, path)
        said.say("models", f"a picture of each from several sides, in {path}", OK, "look at it")


def _design(study: Study, said: Verdicts) -> None:
    factors, count = study.design.factors(), study.study.participants
    per_session = sum(len(s.trials) for s in session_for(1, factors))
    rows = Counter(order_of(slot, len(factors.conditions)) for slot in range(1, count + 1))
    total = count * per_session
    said.say("design", f"{count} participants × {per_session} trials = {total} trials")
    for order, number in sorted(rows.items()):
        way = " → ".join("/".join(factors.conditions[c]) for c in order)
        said.say("design", f"{number} × {way}")
    uneven = max(rows.values()) - min(rows.values())
    orders = {order_of(slot, len(factors.conditions)) for slot in range(1, MOST_ORDERS + 1)}
    if uneven == 0 and len(rows) == len(orders):
        said.say("design", "each order equally often")
    else:
        why = f"expected a multiple of {len(orders)} participants"
        said.say("design", "the orders are not equally often", WARNING, why)


def _measured(study: Study, context: Context) -> list[Difficulty]:
    """Every trial's difficulty, with progress."""
    from seethrough.experiment.session.progress import Progress
    from seethrough.experiment.study.certificate import Certifier, trials_of

    certifier, trials = Certifier(study, context), trials_of(study)
    measured = []
    with Progress("measuring difficulty", len(trials)) as progress:
        for trial in trials:
            measured.append(certifier.measure(trial))
            progress.step(trial.task)
    return measured


def _difficulty(
    study: Study, measured: list[Difficulty], context: Context, redraw: bool, said: Verdicts
) -> None:
    from seethrough.experiment.study.certificate import matches, worst

    found = matches(study, measured)
    for task in study.design.tasks:
        own = [match for match in found if match.task == task]
        if any(match.ok for match in own):
            said.say("difficulty", f"{task}: " + ", ".join(_means(m) for m in own if m.ok))
        for match in (m for m in own if not m.ok):
            apart = f"apart {_apart(match, match.difference)}"
            why = (
                f"not matched, expected at most {_apart(match, match.bound)}; farthest off: "
                f"{worst(match, measured).trial.scene}"
            )
            said.say("difficulty", f"{task}: {_means(match)}, {apart}", FAILS, why)
    if redraw and not all(match.ok for match in found):
        _redraw(study, measured, context, said)


def _means(match: Match) -> str:
    return f"{match.measure} " + " / ".join(f"{mean:.3g}" for _, mean in match.levels)


def _apart(match: Match, value: float) -> str:
    """A difference as the measure's unit has it."""
    from seethrough.experiment.study.certificate import SHARES

    return f"{value:.3f}" if match.measure in SHARES else f"{100 * value:.0f} %"


def _redraw(study: Study, measured: list[Difficulty], context: Context, said: Verdicts) -> None:
    """Draw the worst scene again until all match; print the line for the config."""
    from seethrough.experiment.study.certificate import Certifier, matches, trials_of, worst

    names = list(study.design.redraw)
    for _ in range(MOST_REDRAWS):
        bad = next((m for m in matches(study, measured) if not m.ok), None)
        if bad is None:
            quoted = ", ".join(f'"{name}"' for name in names)
            # Last on its line, so that it can be copied into the study.
            said.say("redraw", "the levels match with more scenes drawn again")
            print(f"            ok; in [design]: redraw = [{quoted}]")
            return
        names.append(worst(bad, measured).trial.scene)
        design = study.design.model_copy(update={"redraw": tuple(names)})
        study = study.model_copy(update={"design": design})
        certifier, again = Certifier(study, context), {d.trial.stream: d for d in measured}
        measured = [again.get(t.stream) or certifier.measure(t) for t in trials_of(study)]
    why = "the levels still do not match"
    said.say("redraw", f"{MOST_REDRAWS} scenes drawn again", FAILS, why)


def _write(measured: list[Difficulty], path: Path) -> None:
    from seethrough.experiment.study.certificate import Difficulty

    values = [f.name for f in fields(Difficulty) if f.name != "trial"]
    with open(path, "x", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["scene", "task", "transparency", *values])
        for d in measured:
            cells = [getattr(d, name) for name in values]
            table.writerow([d.trial.scene, d.trial.task, d.trial.transparency, *cells])


def _machine(
    study: Study, measured: list[Difficulty], context: Context, seconds: float, said: Verdicts
) -> None:
    """Frame times where they are worst: the scenes with most to see through, in each scenario."""
    from seethrough.experiment.session.machine import crossings, frame_times, free_disk
    from seethrough.renderer.polygons.prepared import DENSE_CROSSINGS

    for scenario in study.design.factors().tasks:
        own = [d for d in measured if d.trial.scenario == scenario]
        level = study.design.transparency[-1]
        hardest = max(
            (d for d in own if d.trial.transparency == level),
            key=lambda d: (d.occluders, d.targets),
        )
        times = frame_times(study, hardest.trial, context, seconds)
        rate = study.display.refresh
        text = (
            f"{scenario}, {level}: {times.frames} frames of {hardest.trial.scene}, "
            f"median {times.median:.1f} ms, 99 % within {times.p99:.1f} ms; "
            f"{100 * times.missed:.1f} % over 1.5 periods of {rate:g} Hz"
        )
        said.say("machine", text, *smooth(times, rate))
        for line in crossings(study, hardest.trial):
            dense = [WARNING, "expected fewer crossings"] if DENSE_CROSSINGS in line else []
            said.say("machine", f"{scenario}, objects that intersect: {line}", *dense)
    _refresh(study, said)
    free = free_disk(Path.cwd())
    enough = [] if free > LEAST_DISK else [FAILS, f"expected {LEAST_DISK:g} GiB or more"]
    said.say("machine", f"free disk: {free:.1f} GiB", *enough)


def smooth(times: FrameTimes, rate: float) -> tuple[str, str]:
    """The verdict on frame times, and why. Where more frames are missed than not, the display's
    rate is out of reach: nobody should be run on this machine."""
    if times.missed > HOPELESS:
        return (
            FAILS,
            f"{rate:g} Hz is out of reach here ({1000 / times.median:.0f} frames a second): "
            "expected a graphics card, a smaller window or an easier scene",
        )
    if times.missed > SMOOTH:
        return WARNING, f"expected at most {100 * SMOOTH:g} % missed; the report counts them"
    return OK, ""


def _refresh(study: Study, said: Verdicts) -> None:
    """Measured against declared refresh rate, where there is a display."""
    from seethrough.experiment.display.system_window import available

    if not available():
        why = "no display: simulated people only, and the refresh rate was not measured"
        said.say("machine", "window: none can be opened", WARNING, why)
        return
    from seethrough.experiment.display import refresh
    from seethrough.experiment.display.clock import RealClock
    from seethrough.experiment.display.window import Window

    window = Window(study.display, Texts("en"), RealClock(), "check")
    rate, declared = window.measured, window.declared
    window.close()
    right = [] if refresh.fits(rate, declared) else [FAILS, "write the measured one into [display]"]
    said.say("machine", f"refresh: {refresh.said(rate, declared)}", *right)
