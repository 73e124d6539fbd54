"""What a simulated participant's eyes cost in time, and what coarser eyes cost in accuracy.

`python -m benchmarks.eyes --json FILE --figure FILE.svg`: the same trials with id pictures of
several heights and from the tables' lattice, against the finest picture. Errors are those of the
task measures: mean completion time, and mean absolute count error.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from experiment.config import Study, load
from experiment.design import SIMULATED, Trial, generator, session_for
from experiment.driver import open_context
from experiment.pages import Page, Paragraph
from experiment.participants.data_mode import play_trial
from experiment.participants.participant import SimulatedParticipant
from experiment.participants.pool import Pool, drawing
from experiment.world import TrialRecord
from renderer.gpu.renderer import Renderer
from renderer.models.simple import simplified
from renderer.techniques.standard import Standard
from renderer.visibility import Visibility
from tasks.base import View

HEIGHTS = (300, 150, 75, 38)  # of the id picture, in pixels; the first is the reference
ASPECT = 4 / 3


@dataclass(frozen=True)
class Eyes:
    """A way to look: its name, seconds a trial, and the trials it led to."""

    name: str
    seconds: float
    trials: tuple[TrialRecord, ...]


class OpenEyes(Pool):
    """Looks from where the camera is, into a picture of a given size."""

    def __init__(
        self, study: Study, size: int, renderer: Renderer, height: int, simple: bool
    ) -> None:
        super().__init__(study, size)
        self.renderer, self.picture = renderer, (round(height * ASPECT), height)
        self.simple = simple

    def look(self, view: View, level: str) -> Visibility:
        """What is seen in the view, drawn anew."""
        technique = self.study.dynamic if level == "dynamic" else Standard()
        scene = simplified(view.scene) if self.simple else view.scene
        return self.renderer.look(scene, view.camera, technique, self.picture)


def play(trials: Sequence[Trial], pool: Pool, name: str, repeats: int) -> Eyes:
    """Every trial `repeats` times, each by a person of its own."""
    played = []
    start = time.perf_counter()
    for k, trial in enumerate(trials):
        for repeat in range(repeats):
            person = SimulatedParticipant(generator(1, (SIMULATED, 1 + k, repeat)))
            text = Paragraph(f"transparency.{trial.transparency}")
            person.answer(Page("instruction", "", (text,)))
            played.append(play_trial(person, pool, trial)[0])
    return Eyes(name, (time.perf_counter() - start) / len(played), tuple(played))


def measure(eyes: Eyes, reference: Eyes) -> dict[str, Any]:
    """The row of a way to look: relative differences of the task measures."""
    time_ = [np.mean([t.time for t in e.trials]) for e in (eyes, reference)]
    off = [
        np.mean([abs(t.outcome.count_error) for t in e.trials
                 if t.outcome and t.outcome.count_error is not None])
        for e in (eyes, reference)
    ]  # fmt: skip
    return {
        "figure": "eyes", "scene": eyes.name, "value": round(eyes.seconds * 1e3, 2),
        "unit": "ms a trial", "time_error": round(float(time_[0] / time_[1] - 1), 4),
        "count_error": round(float(off[0] - off[1]), 4),
    }  # fmt: skip


def run(repeats: int) -> list[dict[str, Any]]:
    """Every way to look, the reference first."""
    study = load("published")
    trials = [s.trials[0] for s in session_for(1, study.design.factors())]
    renderer = Renderer(open_context(), (800, 600))
    ways = []
    for height, simple in ((HEIGHTS[0], False), (HEIGHTS[1], False), *((h, True) for h in HEIGHTS)):
        pool = OpenEyes(study, 4, renderer, height, simple)
        models = "" if simple else ", whole models"
        ways.append(play(trials, pool, f"visual, {height} px{models}", repeats))
    pool = drawing(study, 4)
    play(trials, pool, "making tables", repeats)
    ways.append(play(trials, pool, "data mode, 150 px", repeats))
    return [measure(way, ways[0]) for way in ways]


def draw(rows: Sequence[dict[str, Any]], path: Path) -> None:
    """Error against time, one point for each way to look."""
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 4))
    for row in rows:
        axes.scatter(row["value"], abs(row["time_error"]), color="C0")
        axes.annotate(row["scene"], (row["value"], abs(row["time_error"])), xytext=(2, 5),
                      textcoords="offset points", fontsize=8, rotation=35)  # fmt: skip
    axes.set(xscale="log", xlabel="ms a trial", ylabel="error of the mean completion time")
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, bbox_inches="tight", metadata={"Date": None})


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path, metavar="FILE")
    parser.add_argument("--figure", type=Path, metavar="FILE")
    parser.add_argument("--repeats", type=int, default=4, help="people for each of 8 trials")
    chosen = parser.parse_args(arguments)
    rows = run(chosen.repeats)
    for row in rows:
        errors = f"time {row['time_error']:+.3f}, count {row['count_error']:+.2f}"
        print(f"{row['scene']:20s}{row['value']:10.1f} ms a trial, {errors}")
    if chosen.json:
        chosen.json.write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")
    if chosen.figure:
        draw(rows, chosen.figure)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
