"""What `check` says of scenes: how hard they are, whether levels match, and what hides in them."""

from __future__ import annotations

import csv
from dataclasses import fields, replace
from pathlib import Path
from typing import TYPE_CHECKING

from seethrough.experiment.study.config import Study, load
from seethrough.experiment.study.design.factors import ALONE, WITHIN
from seethrough.experiment.verdicts import FAILS, WARNING, Verdicts

if TYPE_CHECKING:
    from moderngl import Context

    from seethrough.experiment.study.checked.certificate import Difficulty, Match


MOST_REDRAWS = 50
SETS = (
    "each level meets every set equally often over a whole cycle, so that none gains, but what "
    "sets differ in adds to the spread between people"
)


AS_PUBLISHED = (
    "as in the published study, which made its sets once and relied on counterbalancing alone; "
    "they stay as they are, for a study of your own `check --redraw` finds sets that match"
)


def measured_scenes(study: Study, context: Context) -> list[Difficulty]:
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


def check_difficulty(
    study: Study, measured: list[Difficulty], context: Context, redraw: bool, said: Verdicts
) -> None:
    """Whether levels that leave scenes alone are equally hard; with `redraw` the scenes that would
    have to be drawn again so that they are."""
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
                f"{worst(match).trial.scene}"
            )
            verdict = FAILS
            if not match.factor:
                why += f"; {SETS}"
                if as_published:
                    verdict, why = WARNING, f"{why}; {AS_PUBLISHED}"
            said.say("difficulty", f"{task}, {along}: {_means(match)}, {apart}", verdict, why)
    if redraw and not all(match.ok for match in found):
        _redraw(study, measured, context, said)


def check_techniques(
    study: Study, measured: list[Difficulty], context: Context, said: Verdicts
) -> None:
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
        names.append(worst(bad).trial.scene)
        design = study.design.model_copy(update={"redraw": tuple(names)})
        study = replace(study, design=design)
        certifier, again = Certifier(study, context), {d.trial.stream: d for d in measured}
        measured = [again.get(t.stream) or certifier.measure(t) for t in trials_of(study)]
    why = "the levels still do not match"
    said.say("redraw", f"{MOST_REDRAWS} scenes drawn again", FAILS, why)


def write_certificate(study: Study, measured: list[Difficulty], path: Path) -> None:
    """A row a trial, into a new file."""
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
