"""`power --scenes`: how much of what is asked for each condition shows, scene by scene."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from seethrough.experiment.errors import InputError
from seethrough.experiment.study.config import Study
from seethrough.experiment.study.selection import said
from seethrough.tasks.kit.world import FILES

if TYPE_CHECKING:
    from seethrough.experiment.study.checked.shown import Shower, Shown
    from seethrough.experiment.study.design.design import Trial

MOST_ROUNDS = 20  # of drawing again what the rule does not select
MEASURES = ("asked", "shown", "clear", "hidden")


def describe(study: Study, path: Path) -> int:
    """Look at every scene in every condition, write a row each, print what conditions show; 1 if
    the study declares a rule that some of its scenes do not keep."""
    from seethrough.experiment.display.driver import open_context
    from seethrough.experiment.study.checked.shown import Shower, breaking

    context = open_context(looks=True)
    shower = Shower(study, context)
    scenes = _looked(shower, shower.scenes())
    write(study, scenes, path)
    for line in lines(study, scenes):
        print(line)
    print(f"scenes: {path}, a row for each scene and condition")
    rule, wrong = said(study), list(breaking(study, scenes))
    if not rule:
        return 0
    print(f"scenes selected: {rule}")
    if not wrong:
        return 0
    print(f"{len(wrong)} of {len(scenes)} scenes do not keep the rule")
    again = _drawn_again(study, scenes, wrong, lambda other: Shower(other, context))
    if again is None:
        print(f"no line for redraw was found that keeps it, in {MOST_ROUNDS} rounds")
    else:
        quoted = ", ".join(f'"{name}"' for name in again)
        print(f"in [design]: redraw = [{quoted}]")
    return 1


def _looked(shower: Shower, trials: Sequence[Trial]) -> list[list[Shown]]:
    from seethrough.experiment.session.progress import Progress

    found = []
    with Progress("looking at scenes", len(trials)) as progress:
        for trial in trials:
            found.append(shower.of(trial))
            progress.step(trial.task)
    return found


def _drawn_again(
    study: Study,
    scenes: Sequence[list[Shown]],
    wrong: list[Trial],
    shower_of: Callable[[Study], Shower],
) -> list[str] | None:
    """The study's redraw with what makes every scene keep the rule; None where nothing does."""
    from seethrough.experiment.study.checked.shown import breaking

    known = {found[0].trial.stream: found for found in scenes}
    names = list(study.design.redraw)
    for _ in range(MOST_ROUNDS):
        if any(study.part(t.levels).place.scenes == FILES for t in wrong):
            return None  # a file's scene stays what it is
        names += dict.fromkeys(t.scene for t in wrong)
        design = study.design.model_copy(update={"redraw": tuple(names)})
        study = replace(study, design=design)
        shower = shower_of(study)
        trials = shower.scenes()
        for found in _looked(shower, [t for t in trials if t.stream not in known]):
            known[found[0].trial.stream] = found
        wrong = list(breaking(study, [known[t.stream] for t in trials]))
        if not wrong:
            return names
    return None


def write(study: Study, scenes: Sequence[Sequence[Shown]], path: Path) -> None:
    """A row for each scene and condition, into a new file. Raises InputError."""
    factors = [factor.name for factor in study.factors]
    try:
        with open(path, "x", encoding="utf-8", newline="") as file:
            table = csv.writer(file, lineterminator="\n")
            table.writerow(["scene", "task", *factors, *MEASURES])
            for found in scenes:
                for one in found:
                    levels = [one.levels[name] for name in factors]
                    shares = [f"{value:.4f}" for value in (one.shown, one.clear)]
                    table.writerow(
                        [one.trial.scene, one.trial.task, *levels, one.asked, *shares, one.hidden]
                    )
    except OSError as error:
        raise InputError(f"--scenes = {path}: cannot be written: {error.strerror}") from None


def lines(study: Study, scenes: Sequence[Sequence[Shown]]) -> Iterator[str]:
    """What conditions show, task by task: means over scenes, from the least to the most; and how
    far each is from the first in the same scenes."""
    for task in study.tasks():
        own = [found for found in scenes if found[0].trial.task == task]
        by: dict[tuple[str, ...], list[Shown]] = {}
        for found in own:
            for one in found:
                by.setdefault(tuple(one.levels[f.name] for f in study.factors), []).append(one)
        yield f"{task}: {len(own)} scenes, {_mean([f[0].asked for f in own]):.1f} things asked for"
        for cell, shown in by.items():
            spread = _spread([one.shown for one in shown])
            clear, hidden = _mean([s.clear for s in shown]), _mean([s.hidden for s in shown])
            yield (
                f"  {', '.join(cell):40s} shown {spread}; set off {clear:.2f}; hidden from all "
                f"views {hidden:.2f} things"
            )
        yield from _compared(study, own)


def _compared(study: Study, own: Sequence[Sequence[Shown]]) -> Iterator[str]:
    """Each level against the baseline, in the scenes that both leave as they are."""
    for factor in study.factors:
        baseline = factor.baseline or factor.names[0]
        for level in factor.names:
            apart = []
            for found in own:
                means = [
                    [s.shown for s in found if s.levels[factor.name] == name]
                    for name in (baseline, level)
                ]
                if all(means) and level != baseline:
                    apart.append(_mean(means[1]) - _mean(means[0]))
            if apart:
                more = sum(a > 0 for a in apart)
                yield (
                    f"  {factor.name}: {level} − {baseline} {_spread(apart, '+')}; shows more in "
                    f"{more} of {len(apart)} scenes"
                )


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values)


def _spread(values: Sequence[float], sign: str = "") -> str:
    low, mean, high = (f"{v:{sign}.2f}" for v in (min(values), _mean(values), max(values)))
    return f"{mean} ({low} to {high})"
