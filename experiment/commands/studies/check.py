"""`seethrough check`: config, design, difficulty and machine, before anybody is invited."""

from __future__ import annotations

import argparse
import csv
from collections import Counter
from collections.abc import Sequence
from dataclasses import fields, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from seethrough.experiment.errors import InputError
from seethrough.experiment.files.outputs import check_output
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.session.levels import of_blocks
from seethrough.experiment.study.beside.own_model_files import models_of
from seethrough.experiment.study.config import Study, load
from seethrough.experiment.study.design.design import TaskSet, session_for
from seethrough.experiment.study.design.factors import ALONE, WITHIN
from seethrough.experiment.study.shown.design_table import minutes
from seethrough.experiment.study.translations import demand_texts, languages_of, texts_of
from seethrough.experiment.verdicts import FAILS, OK, WARNING, Verdicts
from seethrough.renderer.errors import CannotDraw
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.kit.world import FILES

if TYPE_CHECKING:
    from moderngl import Context

    from seethrough.experiment.session.machine import FrameTimes
    from seethrough.experiment.study.checked.certificate import Difficulty, Match

SECONDS = 10.0  # of the hardest scene
LEAST_DISK = 1.0  # GiB
MOST_REDRAWS = 50
MOST_PLAYED = 5_000  # sessions
MOST_ORDERS = 64  # more than a square of the conditions that there can be has rows
SMOOTH, HOPELESS = 0.01, 0.5  # shares of frames missed: above the first a warning, the last fails
SETS = (
    "each level meets every set equally often over a whole cycle, so that none gains, but what "
    "sets differ in adds to the spread between people"
)
AS_PUBLISHED = (
    "as in the published study, which made its sets once and relied on counterbalancing alone; "
    "they stay as they are, for a study of your own `check --redraw` finds sets that match"
)
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
    _design(study, said)
    if arguments.balance:
        _balance(study, arguments.slots, said)
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
    measured = _measured(study, context)
    _difficulty(study, measured, context, arguments.redraw, said)
    _techniques(study, measured, context, said)
    if arguments.certificate is not None:
        _write(study, measured, arguments.certificate)
    _machine(study, measured, context, arguments.seconds, said)
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


def _design(study: Study, said: Verdicts) -> None:
    plan = study.plan
    for which, group in enumerate(plan.groups):
        name = "/".join(group.levels.values())
        sessions = [session_for(plan.slot_of(which, n), plan) for n in range(1, group.people + 1)]
        per_session = sum(len(s.trials) for s in sessions[0])
        total, where = group.people * per_session, f"{name}: " if name else ""
        text = f"{where}{group.people} participants × {per_session} trials = {total} trials"
        took = minutes(per_session, sum(len(s.training) for s in sessions[0]))
        most = study.session.limit / 60
        long = [WARNING, f"some {took:.0f} minutes, expected at most session.limit ({most:g})"]
        said.say("design", text, *(long if 0 < most < took else []))
        rows = Counter(map(partial(_conditions, study), sessions))
        for order, number in sorted(rows.items())[:MOST_ORDERS]:
            said.say("design", f"{where}{number} × {' → '.join(order)}")
        if len(rows) > MOST_ORDERS:
            said.say("design", f"{where}… and {len(rows) - MOST_ORDERS} orders more")
        wanted = plan.rows(which)
        uneven = group.people % wanted
        if "random" in (study.design.order, *(f.order for f in study.factors)):
            said.say("design", f"{where}orders are drawn: nothing is promised of them")
        elif not uneven:
            said.say("design", f"{where}each order equally often")
        else:
            why = f"expected a multiple of {wanted} participants"
            said.say("design", f"{where}the orders are not equally often", WARNING, why)


def _balance(study: Study, count: int | None, said: Verdicts) -> None:
    """Counted from finished tables: after so many people, and where a fifth of them dropped out."""
    from seethrough.experiment.session.balance_check import refilled, table_of, verdicts
    from seethrough.experiment.study.design.balance import cycle

    plan = study.plan
    if count is not None and count < 1:
        raise InputError(f"--slots = {count}: expected at least 1")
    longest = max(cycle(plan, which) for which in range(len(plan.groups)))
    cycles = [plan.slot_of(g, n) for g in range(len(plan.groups))
              for n in range(1, cycle(plan, g) + 1)]  # fmt: skip
    slots = sorted(cycles) if count is None else plan.slots(count)
    if len(slots) > MOST_PLAYED:
        raise InputError(
            f"--slots: missing, expected at most {MOST_PLAYED}: a complete cycle is {longest} "
            "people of each group"
        )
    again = refilled(plan, len(slots), study.general.seed)
    for what, played in (("as they come", slots), ("after drop-outs", again)):
        for found in verdicts(study, table_of(study, played), played):
            text = f"{found.group}, {what}: {found.people} people, {', '.join(found.kept)}"
            why = "; ".join(found.broken[:3])
            said.say("balance", text, *([FAILS, why] if found.broken else []))


def _conditions(study: Study, session: Sequence[TaskSet]) -> tuple[str, ...]:
    """The conditions of a session in its order, as standard/abstract."""
    blocks = {
        s.trials[0].block: "/".join(level for _, level in of_blocks(study, s.trials[0].levels))
        for s in session
    }
    return tuple(blocks.values())


def _measured(study: Study, context: Context) -> list[Difficulty]:
    """Every trial's difficulty, with progress."""
    from seethrough.experiment.session.progress import Progress
    from seethrough.experiment.study.checked.certificate import Certifier, trials_of

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
    from seethrough.experiment.study.checked.certificate import matches, worst

    found = matches(study, measured)
    as_published = study.digest() == load("published").digest()
    for task, factor in dict.fromkeys((m.task, m.factor) for m in found):
        own = [match for match in found if (match.task, match.factor) == (task, factor)]
        along = factor or "sets"
        if any(match.ok for match in own):
            means = ", ".join(_means(m) for m in own if m.ok)
            said.say("difficulty", f"{task}, {along} {_names(own[0])}: {means}")
        for match in (m for m in own if not m.ok):
            assert match.bound is not None  # else it is ok
            apart = f"apart {_apart(match, match.difference)}"
            why = (
                f"not matched, expected at most {_apart(match, match.bound)}; farthest off: "
                f"{worst(match, measured).trial.scene}"
            )
            verdict = FAILS
            if not match.factor:
                why += f"; {SETS}"
                if as_published:
                    verdict, why = WARNING, f"{why}; {AS_PUBLISHED}"
            said.say("difficulty", f"{task}, {along}: {_means(match)}, {apart}", verdict, why)
    if redraw and not all(match.ok for match in found):
        _redraw(study, measured, context, said)


def _techniques(study: Study, measured: list[Difficulty], context: Context, said: Verdicts) -> None:
    """Where the study's own scenes run into what its techniques cannot do."""
    from seethrough.experiment.session.progress import Progress
    from seethrough.experiment.study.checked.technique_warnings import Warner

    warner = Warner(study, context)
    drawn = warner.trials([d.trial for d in measured])
    with Progress("looking through techniques", len(drawn)) as progress:
        found = []
        for name, trials in drawn.items():
            found.append(warner.met(name, trials))
            progress.step(name)
    for met in found:
        warnings = list(met.warnings())
        for line in warnings:
            said.say("technique", line, WARNING, "docs/techniques.md says how each fails")
        if not warnings:
            said.say("technique", f"{met.name}: all targets of {met.scenes} scenes come to show")


def _names(match: Match) -> str:
    return " / ".join(name for name, _ in match.levels)


def _means(match: Match) -> str:
    return f"{match.measure} " + " / ".join(f"{mean:.3g}" for _, mean in match.levels)


def _apart(match: Match, value: float) -> str:
    """A difference as the measure's unit has it."""
    from seethrough.experiment.study.checked.certificate import SHARES

    return f"{value:.3f}" if match.measure in SHARES else f"{100 * value:.0f} %"


def _redraw(study: Study, measured: list[Difficulty], context: Context, said: Verdicts) -> None:
    """Draw the worst scene again until all match; print the line for the config."""
    from seethrough.experiment.study.checked.certificate import Certifier, matches, trials_of, worst

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
        study = replace(study, design=design)
        certifier, again = Certifier(study, context), {d.trial.stream: d for d in measured}
        measured = [again.get(t.stream) or certifier.measure(t) for t in trials_of(study)]
    why = "the levels still do not match"
    said.say("redraw", f"{MOST_REDRAWS} scenes drawn again", FAILS, why)


def _write(study: Study, measured: list[Difficulty], path: Path) -> None:
    from seethrough.experiment.study.checked.certificate import Difficulty

    values = [f.name for f in fields(Difficulty) if f.name != "trial"]
    with open(path, "x", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        alone = [f.name for f in study.factors if f.scenes == ALONE and f.kind == WITHIN]
        table.writerow(["scene", "task", *alone, *values])
        for d in measured:
            cells = [getattr(d, name) for name in values]
            levels = [d.trial.levels[name] for name in alone]
            table.writerow([d.trial.scene, d.trial.task, *levels, *cells])


def _machine(
    study: Study, measured: list[Difficulty], context: Context, seconds: float, said: Verdicts
) -> None:
    """Frame times where they are worst: the scenes with most to see through, of each world with
    each technique."""
    from seethrough.experiment.session.machine import crossings, frame_times, free_disk
    from seethrough.renderer.polygons.prepared import DENSE_CROSSINGS

    drawn: dict[tuple[str, object], list[Difficulty]] = {}
    for d in measured:
        part = study.part(d.trial.levels)
        if part.technique != Standard() or len(study.parts) == 1:
            drawn.setdefault((part.world, part.technique), []).append(d)
    for (world, _), own in drawn.items():
        hardest = max(own, key=lambda d: (d.occluders, d.targets))
        part = study.part(hardest.trial.levels)
        try:
            times = frame_times(study, hardest.trial, context, seconds)
        except CannotDraw as error:
            said.say("machine", f"{world}, {part.technique_name}", FAILS, str(error))
            continue
        rate = part.display.refresh
        text = (
            f"{world}, {part.technique_name}: {times.frames} frames of {hardest.trial.scene}, "
            f"median {times.median:.1f} ms, 99 % within {times.p99:.1f} ms; "
            f"{100 * times.missed:.1f} % over 1.5 periods of {rate:g} Hz"
        )
        said.say("machine", text, *smooth(times, rate))
        for line in crossings(study, hardest.trial):
            dense = [WARNING, "expected fewer crossings"] if DENSE_CROSSINGS in line else []
            said.say("machine", f"{world}, objects that intersect: {line}", *dense)
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
