"""What each effect of a simulated participant does: when it applies, and what its absence costs.

`seethrough bench effects` plays the published study with and without each effect, the same people
on the same trials; `python -m seethrough.benchmarks.sessions.effects --out docs/effects.md` does it
from tables that are kept and writes the page.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from seethrough.benchmarks.rows import Row, row
from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.people.persons.profile_file import find
from seethrough.experiment.people.runs.data_mode import play_trial
from seethrough.experiment.people.runs.looks import KeptLooks
from seethrough.experiment.people.runs.pool import Pool, drawing
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import SIMULATED, generator, session_for
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import Outcome
from seethrough.tasks.kit.skills.effects import EFFECTS, plan_effects
from seethrough.tasks.kit.skills.profile import Profile

STUDY, POOL, PEOPLE, SEED = "published", 40, 16, 1
PROFILE = "calibrated"

# Accuracy of each task: what is averaged over its trials, and its unit.
MEASURES = {
    "count": ("T1 count off", "things"),
    "pattern": ("T2 wrong", "share"),
    "unique": ("T3 distance", "units"),
    "count_in_building": ("T4 count off", "things"),
}


def trials(
    pool: Pool, people: int, profile: Profile, tasks: Sequence[str], without: Iterable[str] = ()
) -> list[Row]:
    """Who, which task, how long and how far off: trials of so many people at `tasks`."""
    rows = []
    for slot in range(1, people + 1):
        person = SimulatedParticipant(
            generator(SEED, (SIMULATED, slot)), profile, frozenset(without)
        )
        for task_set in session_for(slot, pool.study.plan):
            if task_set.trials[0].task not in tasks:
                continue
            for trial in (*task_set.training, *task_set.trials):
                record, _ = play_trial(person, pool, trial)
                if trial in task_set.trials:
                    assert record.outcome is not None, "nobody is stopped here"
                    off = _off(record.outcome)
                    rows.append({"slot": slot, "task": trial.task, "time": record.time, "off": off})
    return rows


def _off(outcome: Outcome) -> float:
    if outcome.distance is not None:
        return float(outcome.distance)
    if outcome.count_error is not None:
        return float(abs(outcome.count_error))
    return float(not outcome.correct)


def change(full: Sequence[Row], less: Sequence[Row], task: str, what: str) -> tuple[float, float]:
    """Mean change of `what` without the effect, paired by person, and its 95 % half-width."""
    from scipy import stats

    means = [_per_person(rows, task, what) for rows in (full, less)]
    if what == "time":
        means = [np.log(m) for m in means]
    apart = means[1] - means[0]
    error = apart.std(ddof=1) / len(apart) ** 0.5
    return float(apart.mean()), float(stats.t.ppf(0.975, len(apart) - 1) * error)


def _per_person(rows: Sequence[Row], task: str, what: str) -> np.ndarray:
    people = sorted({r["slot"] for r in rows})
    return np.array(
        [np.mean([r[what] for r in rows if r["slot"] == p and r["task"] == task]) for p in people]
    )


def used(effect: str) -> list[str]:
    """The tasks whose trials call for the effect."""
    plans = {t: plan_effects(TASKS[t].simulate.effects, 0, frozenset()) for t in MEASURES}
    return [task for task, plan in plans.items() if plan[effect].used]


def runs(
    pool: Pool, people: int, profile: Profile, of: Sequence[str] = tuple(MEASURES)
) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """(effect, task → (change of what is off, its half-width, change of time, its half-width)).

    Only tasks that call for an effect are played without it; the first is how far off all are.
    """
    full = trials(pool, people, profile, of)
    yield "", {t: _per_person(full, t, "off").mean() for t in of}
    for effect in EFFECTS:
        tasks = [t for t in used(effect) if t in of]
        less = trials(pool, people, profile, tasks, (effect,))
        yield (
            effect,
            {t: (*change(full, less, t, "off"), *change(full, less, t, "time")) for t in tasks},
        )


def figures() -> Iterator[Row]:
    """Changes without each effect, as the bench command prints them."""
    pool = drawing(load(STUDY), POOL)
    for effect, changes in runs(pool, PEOPLE, find(PROFILE)):
        for task, values in changes.items():
            name, unit = MEASURES[task]
            value = float(values[0]) if effect else float(values)
            label = f"without {effect}: {name}" if effect else f"all effects: {name}"
            yield row(label, STUDY, value, unit)


def markdown(
    pool: Pool, people: int, profile: Profile, of: Sequence[str] = tuple(MEASURES)
) -> Iterator[str]:
    """The guide's table, line by line."""
    names = [f"{MEASURES[t][0]}, {MEASURES[t][1]}" for t in of]
    yield f"| left out | what it is | {' | '.join(names)} |"
    yield "|" + " --- |" * (2 + len(names))
    for effect, changes in runs(pool, people, profile, of):
        if not effect:
            yield f"| nothing | | {' | '.join(f'{changes[t]:.3g}' for t in of)} |"
        elif changes:
            cells = " | ".join(_cell(changes.get(t)) for t in of)
            yield f"| {effect} | {EFFECTS[effect]} | {cells} |"


def _cell(values: Sequence[float] | None) -> str:
    if values is None:
        return "not used"
    off, half, time, _ = (round(float(v), 9) + 0.0 for v in values)  # sums differ in last digits
    return f"{off:+.2g} ± {half:.2g}; time {np.expm1(time):+.0%}"


INTRODUCTION = """# What each effect of a simulated participant does

Simulated participants are a tool for planning, never evidence. Every effect can be left out:
`seethrough simulate STUDY --without crowding …`; `--explain` prints which ones each trial used, and
why. Where a task does not call for an effect, leaving it out changes nothing, event for event
(tested); where it does, this is what its absence costs or saves: the same people at the same trials
of the published study, mean change ± half of the 95 % interval, paired by person.
"""
ALONE = """
Trials are played alone here, so that nobody is tired: fatigue changes nothing. `--tasks` measures
some of the tasks. `seethrough bench effects` prints the changes of accuracy one by one.

How near these people come to the published ones, what is out of reach and how far each fitted
constant may move, says [the page of the calibration](calibration.md).
"""


def whole(
    pool: Pool, people: int, profile: Profile, of: Sequence[str], command: str
) -> Iterator[str]:
    """The page, line by line."""
    yield INTRODUCTION
    yield f"Printed by\n\n    {command}\n"
    yield from markdown(pool, people, profile, of)
    yield ALONE.rstrip()


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the page, or write it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, help="page to write; printed without")
    parser.add_argument("--tables", type=Path, help="read, and kept with what is drawn")
    parser.add_argument("--participants", type=int, default=PEOPLE)
    parser.add_argument("--pool", type=int, default=POOL, help="scenes a task")
    parser.add_argument("--profile", default=PROFILE, help=f"default: {PROFILE}")
    parser.add_argument("--tasks", default=",".join(MEASURES), metavar="T,…")
    chosen = parser.parse_args(arguments)
    profile, tasks = find(chosen.profile), chosen.tasks.split(",")
    command = (
        f"python -m seethrough.benchmarks.sessions.effects --participants {chosen.participants} "
        f"--pool {chosen.pool} --profile {chosen.profile}"
    )
    with tempfile.TemporaryDirectory() as folder:
        looks = KeptLooks(chosen.tables or Path(folder) / "tables.db")
        pool = drawing(load(STUDY), chosen.pool, looks)
        lines = whole(pool, chosen.participants, profile, tasks, command)
        if chosen.out is None:
            for line in lines:
                print(line, flush=True)
        else:
            chosen.out.write_text("\n".join(lines) + "\n", encoding="utf-8")
        looks.flush()
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
