"""`seethrough check`: config, design, difficulty and machine, before anybody is invited."""

from __future__ import annotations

import argparse
import csv
from collections import Counter
from collections.abc import Iterator
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from experiment.config import Study, load
from experiment.design import order_of, session_for
from experiment.errors import InputError
from experiment.texts import Texts

if TYPE_CHECKING:
    from experiment.certificate import Difficulty, Match

SECONDS = 10.0  # of the hardest scene
LEAST_DISK = 1.0  # GiB
MOST_REDRAWS = 50


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
    print(f"config      {study.study.name}: valid, {study.digest()[:12]}")
    for line in (*_models(study), *_design(study)):
        print(line)
    if arguments.config_only:
        return 0
    from experiment.driver import describe, open_context

    context = open_context()
    for name, value in describe(context).items():
        print(f"machine     {name}: {value}")
    _contact_sheet(study, context, arguments)
    measured = _measured(study, context)
    passed = _difficulty(study, measured, context, arguments.redraw)
    if arguments.certificate is not None:
        _write(measured, arguments.certificate)
    return 0 if _machine(study, measured, context, arguments.seconds) and passed else 1


def _models(study: Study) -> Iterator[str]:
    """What the study brings along: read already, or there would be no study."""
    if study.walkthrough.models:
        from experiment.contact_sheet import described, facts_of
    for own in study.walkthrough.models:
        first, *more = described(own, facts_of(own), study)
        yield f"model       {own.name}: {own.file}, {first}, {own.sha256[:12]}"
        for line in more:
            yield f"            {line}"


def _contact_sheet(study: Study, context: Any, arguments: argparse.Namespace) -> None:
    """The study's own models in a picture, where it has any."""
    if study.walkthrough.models:
        from experiment import contact_sheet

        path = arguments.models or contact_sheet.default_path(arguments.study)
        contact_sheet.write(study, context, path)
        print(f"models      a picture of each from several sides: {path}")


def _design(study: Study) -> Iterator[str]:
    factors, count = study.design.factors(), study.study.participants
    per_session = sum(len(s.trials) for s in session_for(1, factors))
    rows = Counter(order_of(slot, len(factors.conditions)) for slot in range(1, count + 1))
    yield f"design      {count} participants × {per_session} trials = {count * per_session} trials"
    for order, number in sorted(rows.items()):
        yield f"            {number} × " + " → ".join(
            "/".join(factors.conditions[c]) for c in order
        )
    uneven = max(rows.values()) - min(rows.values())
    yield f"            {'balanced' if uneven == 0 else f'rows differ by {uneven}'}"


def _measured(study: Study, context: Any) -> list[Difficulty]:
    """Every trial's difficulty, with progress."""
    from experiment.certificate import Certifier, trials_of
    from experiment.progress import Progress

    certifier, trials = Certifier(study, context), trials_of(study)
    measured = []
    with Progress("measuring difficulty", len(trials)) as progress:
        for trial in trials:
            measured.append(certifier.measure(trial))
            progress.step(trial.task)
    return measured


def _difficulty(study: Study, measured: list[Difficulty], context: Any, redraw: bool) -> bool:
    from experiment.certificate import matches, worst

    found = matches(study, measured)
    for task in study.design.tasks:
        own = [match for match in found if match.task == task]
        print(f"difficulty  {task}: " + ", ".join(_means(m) for m in own if m.ok) + ": ok")
        for match in (m for m in own if not m.ok):
            print(
                f"difficulty  {task}: {_means(match)}: apart {_apart(match, match.difference)}, "
                f"at most {_apart(match, match.bound)}: NOT MATCHED"
            )
            print(f"            farthest off: {worst(match, measured).trial.scene}")
    passed = all(match.ok for match in found)
    if redraw and not passed:
        _redraw(study, measured, context)
    return passed


def _means(match: Match) -> str:
    return f"{match.measure} " + " / ".join(f"{mean:.3g}" for _, mean in match.levels)


def _apart(match: Match, value: float) -> str:
    """A difference as the measure's unit has it."""
    from experiment.certificate import SHARES

    return f"{value:.3f}" if match.measure in SHARES else f"{100 * value:.0f} %"


def _redraw(study: Study, measured: list[Difficulty], context: Any) -> None:
    """Draw the worst scene again until all match; print the line for the config."""
    from experiment.certificate import Certifier, matches, trials_of, worst

    names = list(study.design.redraw)
    for _ in range(MOST_REDRAWS):
        bad = next((m for m in matches(study, measured) if not m.ok), None)
        if bad is None:
            quoted = ", ".join(f'"{name}"' for name in names)
            print(f"redraw      these scenes drawn again match; in [design]: redraw = [{quoted}]")
            return
        names.append(worst(bad, measured).trial.scene)
        design = study.design.model_copy(update={"redraw": tuple(names)})
        study = study.model_copy(update={"design": design})
        certifier, again = Certifier(study, context), {d.trial.stream: d for d in measured}
        measured = [again.get(t.stream) or certifier.measure(t) for t in trials_of(study)]
    print(f"redraw      {MOST_REDRAWS} scenes drawn again, and the levels still do not match")


def _write(measured: list[Difficulty], path: Path) -> None:
    from experiment.certificate import Difficulty

    values = [f.name for f in fields(Difficulty) if f.name != "trial"]
    with open(path, "x", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["scene", "task", "transparency", *values])
        for d in measured:
            cells = [getattr(d, name) for name in values]
            table.writerow([d.trial.scene, d.trial.task, d.trial.transparency, *cells])


def _machine(study: Study, measured: list[Difficulty], context: Any, seconds: float) -> bool:
    """Frame times where they are worst: the scenes with most to see through, in each scenario."""
    from experiment.machine import crossings, frame_times, free_disk

    for scenario in study.design.factors().tasks:
        own = [d for d in measured if d.trial.scenario == scenario]
        level = study.design.transparency[-1]
        hardest = max(
            (d for d in own if d.trial.transparency == level),
            key=lambda d: (d.occluders, d.targets),
        )
        times = frame_times(study, hardest.trial, context, seconds)
        rate = study.display.refresh
        print(
            f"machine     {scenario}, {level}: {times.frames} frames of {hardest.trial.scene}, "
            f"median {times.median:.1f} ms, 99 % within {times.p99:.1f} ms; "
            f"{100 * times.missed:.1f} % over 1.5 periods of {rate:g} Hz"
        )
        for line in crossings(study, hardest.trial):
            print(f"machine     {scenario}, objects that intersect: {line}")
    fit = _refresh(study)
    free = free_disk(Path.cwd())
    print(f"machine     free disk: {free:.1f} GiB" + ("" if free > LEAST_DISK else ": TOO LITTLE"))
    return fit and free > LEAST_DISK


def _refresh(study: Study) -> bool:
    """Measured against declared refresh rate, where there is a display."""
    from experiment.window import available

    if not available():
        print("machine     no display: refresh rate not measured")
        return True
    from experiment import refresh
    from experiment.clock import RealClock
    from experiment.window import Window

    window = Window(study.display, Texts("en"), RealClock(), "check")
    rate, declared = window.measured, window.declared
    window.close()
    print(f"machine     refresh: {refresh.said(rate, declared)}")
    return refresh.fits(rate, declared)
