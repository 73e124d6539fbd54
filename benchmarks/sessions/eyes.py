"""What a simulated participant's eyes cost in time, and what coarser eyes cost in accuracy.

`python -m seethrough.benchmarks.sessions.eyes --json FILE --figure FILE.svg`: the same people at
the same trials with id pictures of several heights, with more and fewer looks while on the move,
and from the tables' lattice, against the finest eyes. Errors are those of the task measures:
geometric mean of the completion times, and mean absolute count error; each with the standard error
of the pairs.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from seethrough.benchmarks.rows import Row
from seethrough.experiment.display.driver import open_context
from seethrough.experiment.pages.pages import Page, Paragraph
from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.people.runs.data_mode import play_trial
from seethrough.experiment.people.runs.pool import Pool, drawing
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.study.config import Study, load
from seethrough.experiment.study.design.design import SIMULATED, Trial, generator, session_for
from seethrough.renderer.events import Event, KeyPress, KeyRelease, Tick
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.models.simple import simplified
from seethrough.renderer.scene.visibility import Visibility
from seethrough.renderer.techniques.base import Parameters
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.skills.profile import AVERAGE

ASPECT = 4 / 3
TRIALS = 384  # of the published study: what a way to look costs there is drawn


@dataclass(frozen=True)
class Way:
    """A way to look: rows of the id picture (0: from tables), models, looks on the move."""

    height: int
    simple: bool = True
    passing: int = AVERAGE.passing

    @property
    def name(self) -> str:
        """What rows and figure call it."""
        models = "" if self.simple else ", whole models"
        looks = {0: ", none on the way", 1: "", 2: ", twice the looks"}[self.passing]
        return f"visual, {self.height} px{models}{looks}" if self.height else "data mode, 150 px"


# Of the figure: colour tells looks on the way (Okabe and Ito's, which colour-blind people tell
# apart), the mark tells the picture's rows, a hollow one whole models.
COLOURS = {0: "#0072B2", 1: "#000000", 2: "#D55E00"}
MARKS = {300: "s", 150: "o", 75: "^", 38: "v", 0: "*"}

# The reference first; then the default, coarser and finer pictures, fewer and more looks, tables.
WAYS = (
    Way(300, simple=False, passing=2),
    Way(150, simple=False),
    Way(300),
    Way(150),
    Way(75),
    Way(38),
    Way(150, passing=2),
    Way(150, passing=0),
    Way(0),
)


@dataclass(frozen=True)
class Eyes:
    """A way to look: its name, seconds a trial, the trials it led to and their events."""

    name: str
    seconds: float
    trials: tuple[TrialRecord, ...]
    events: tuple[Sequence[Event], ...] = ()


class OpenEyes(Pool):
    """Looks from where the camera is, into a picture of a given size."""

    def __init__(self, study: Study, size: int, renderer: Renderer, way: Way) -> None:
        super().__init__(study, size)
        self.renderer, self.way = renderer, way
        self.picture = (round(way.height * ASPECT), way.height)

    def look(self, view: View, technique: Parameters) -> Visibility:
        """What is seen in the view, drawn anew."""
        scene = simplified(view.scene) if self.way.simple else view.scene
        return self.renderer.look(scene, view.camera, technique, self.picture)


def play(trials: Sequence[Trial], pool: Pool, way: Way, repeats: int) -> Eyes:
    """Every trial `repeats` times, each by a person of its own: the same for every way to look."""
    played, events = [], []
    profile = replace(AVERAGE, passing=way.passing)
    start = time.perf_counter()
    for k, trial in enumerate(trials):
        for repeat in range(repeats):
            person = SimulatedParticipant(generator(1, (SIMULATED, 1 + k, repeat)), profile)
            levels = tuple(trial.levels.items())
            person.answer(Page("instruction", "", (Paragraph("ready.text"),), about=levels))
            record, sent = play_trial(person, pool, trial)
            played.append(record)
            events.append(sent)
    seconds = (time.perf_counter() - start) / len(played)
    return Eyes(way.name, seconds, tuple(played), tuple(events))


def measure(eyes: Eyes, reference: Eyes) -> Row:
    """The row of a way to look: differences of the task measures, with their standard errors."""
    slower = np.log([t.time / r.time for t, r in zip(eyes.trials, reference.trials, strict=True)])
    counts = np.array([_count_errors(e) for e in (eyes, reference)])
    return {
        "figure": "eyes",
        "scene": eyes.name,
        "value": round(eyes.seconds * 1e3, 2),
        "unit": "ms a trial",
        "looks_a_second": round(_looks(eyes), 2),
        "looks_a_second_walking": round(walking(eyes.events), 2),
        "time_error": round(float(np.expm1(slower.mean())), 4),
        "time_error_se": round(_se(slower), 4),
        "count_error": round(float(np.mean(counts[0] - counts[1])), 4),
        "count_error_se": round(_se(counts[0] - counts[1]), 4),
    }


def _looks(eyes: Eyes) -> float:
    """Looks a simulated second in the building, where every frame is looked at."""
    walks = [t for t in eyes.trials if t.trial.world != "abstract"]
    return sum(t.frames for t in walks) / sum(t.time for t in walks)


def walking(events: Sequence[Sequence[Event]]) -> float:
    """Looks a simulated second while the key that walks is held; 0 where nobody walks.

    A look follows each tick: the thinking before a step begins counts for nothing here.
    """
    looks, seconds = 0, 0.0
    for trial in events:
        pressed: float | None = None
        for event in trial:
            if isinstance(event, KeyPress) and event.key == "up":
                pressed = event.time
            elif isinstance(event, KeyRelease) and event.key == "up" and pressed is not None:
                looks, seconds = looks + 1, seconds + event.time - pressed  # at its end
                pressed = None
            elif isinstance(event, Tick) and pressed is not None:
                looks += 1
    return looks / seconds if seconds else 0.0


def _count_errors(eyes: Eyes) -> list[int]:
    counts = (t.outcome.count_error for t in eyes.trials if t.outcome)
    return [abs(error) for error in counts if error is not None]


def _se(differences: NDArray[np.float64]) -> float:
    return float(differences.std(ddof=1) / len(differences) ** 0.5)


def run(repeats: int) -> list[Row]:
    """Every way to look, the reference first."""
    study = load("published")
    trials = [s.trials[0] for s in session_for(1, study.plan)]
    renderer = Renderer(open_context(), (800, 600))
    seen = []
    for way in WAYS:
        pool = OpenEyes(study, 4, renderer, way) if way.height else drawing(study, 4)
        if not way.height:
            play(trials, pool, way, repeats)  # makes the tables
        seen.append(play(trials, pool, way, repeats))
    return [measure(eyes, seen[0]) for eyes in seen]


def told(row: Row) -> str:
    """A row as a line."""
    return (
        f"{row['scene']:42s}{row['value']:8.1f} ms a trial, {row['looks_a_second']:.1f} looks a "
        f"second, {row['looks_a_second_walking']:.1f} walking; "
        f"time {row['time_error']:+.3f} ± {row['time_error_se']:.3f}, "
        f"count {row['count_error']:+.2f} ± {row['count_error_se']:.2f}"
    )


def draw(rows: Sequence[Row], path: Path) -> None:
    """Error against time, a mark for each way to look, with twice its standard error."""
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(8, 4.5))
    axes.axhline(0, color="0.8", linewidth=1)
    ways = {way.name: way for way in WAYS}
    for row in rows:
        way = ways[row["scene"]]
        minutes = row["value"] * TRIALS / 60e3
        axes.errorbar(
            minutes, 100 * row["time_error"], 200 * row["time_error_se"], markersize=8,
            color=COLOURS[way.passing], marker=MARKS[way.height], capsize=3, linestyle="",
            markerfacecolor=COLOURS[way.passing] if way.simple else "white", label=row["scene"],
        )  # fmt: skip
    axes.set(
        xscale="log",
        xlabel=f"minutes for {TRIALS} trials",
        ylabel="error of the completion time, %\n(± 2 standard errors)",
    )
    axes.legend(frameon=False, fontsize=8, loc="center left", bbox_to_anchor=(1, 0.5))
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, bbox_inches="tight", metadata={"Date": None})


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path, metavar="FILE")
    parser.add_argument("--figure", type=Path, metavar="FILE")
    parser.add_argument("--repeats", type=int, default=8, help="people for each of 8 trials")
    chosen = parser.parse_args(arguments)
    rows = run(chosen.repeats)
    for row in rows:
        print(told(row))
    if chosen.json:
        chosen.json.write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")
    if chosen.figure:
        draw(rows, chosen.figure)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
