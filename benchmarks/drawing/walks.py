"""Walks through the building that simulated people took in the published study, to draw along.

    seethrough simulate published --participants 2 --out DATA
    python -m seethrough.benchmarks.drawing.walks DATA

writes data/walks/published.csv anew: where each walker of DATA was at the frames of each trial.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from math import atan2, pi
from pathlib import Path

import numpy as np

from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import session_for
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.renderer.arrays import Floats
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.base import Parameters
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.controls import Walk, changed, walk
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

FILE = Path(__file__).resolve().parents[2] / "data" / "walks" / "published.csv"
COLUMNS = ("slot", "trial", "time", "x", "z", "yaw")
STUDY, ASPECT = "published", 4 / 3


@dataclass(frozen=True, eq=False)
class Walked:
    """A trial of the study and the way its walker took: times (k,) in s from its first frame,
    places (k, 3): x and z in world units, yaw in radians without jumps."""

    slot: int
    trial: int
    level: str
    technique: Parameters
    scene: Scene
    times: Floats
    places: Floats
    walk: Walk

    def frames(self, rate: float) -> tuple[Floats, list[Camera]]:
        """Times and cameras of those frames, `rate` a second, that differ from the one before.

        Between two frames of the simulated person the way is taken to be straight and even.
        """
        times = np.arange(0.0, self.times[-1], 1 / rate)
        places = np.stack([np.interp(times, self.times, column) for column in self.places.T], 1)
        moving = np.append(True, (np.diff(places, axis=0) != 0).any(axis=1))
        return times[moving], [self.camera(*place) for place in places[moving].tolist()]

    def camera(self, x: float, z: float, yaw: float) -> Camera:
        """What the walker sees from a place."""
        return changed(self.walk, x=x, z=z, yaw=yaw).camera()


def walked() -> Iterator[Walked]:
    """Every trial in the file, with its scene. Raises OSError where the file is not there."""
    study = load(STUDY)
    scenes = StudyScenes(study)
    ways: dict[tuple[int, int], list[list[float]]] = {}
    with open(FILE, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            key = int(row["slot"]), int(row["trial"])
            ways.setdefault(key, []).append([float(row[name]) for name in COLUMNS[2:]])
    for (slot, number), rows in ways.items():
        trials = [t for s in session_for(slot, study.plan) for t in s.trials]
        trial = next(t for t in trials if t.number == number)
        task, place = TASKS[trial.task], scenes.setting(trial).place
        assert isinstance(place, BuildingParameters)
        state = scenes.begin(task, trial, ASPECT)
        way = np.array(rows)
        yield Walked(
            *(slot, number, trial.levels["transparency"], study.part(trial.levels).technique),
            task.view(state).scene, way[:, 0], way[:, 1:], walk(place, (0.0, 0.0)),
        )  # fmt: skip


def _ways(data: Path) -> Iterator[tuple[int, int, list[list[float]]]]:
    """Slot, trial and the walker's times, places and yaws, of all trials in the building."""
    for table in sorted((data / "data" / "simulated").glob("S*/*_trials_data.csv")):
        with open(table, encoding="utf-8", newline="") as file:
            rows = [row for row in csv.DictReader(file) if row["world"] == "building"]
        for row in rows:
            with open(table.parent / row["camera_file"], encoding="utf-8", newline="") as file:
                yield int(row["slot"]), int(row["trial"]), _way(list(csv.DictReader(file)))


def _way(frames: list[dict[str, str]]) -> list[list[float]]:
    """[time, x, z, yaw] of each frame; where one stands, the frames between are left out."""
    way: list[list[float]] = []
    begin, yaw, still = float(frames[0]["time"]), 0.0, 0.0
    for frame in frames:
        time = float(frame["time"]) - begin
        if not frame["eye_x"]:
            still = time
            continue
        turned = atan2(-float(frame["forward_x"]), -float(frame["forward_z"]))
        yaw += (turned - yaw + pi) % (2 * pi) - pi
        if way and still > way[-1][0]:
            way.append([still, *way[-1][1:]])
        way.append([time, float(frame["eye_x"]), float(frame["eye_z"]), yaw])
    return way


def main(data: Path) -> None:
    """Write the file anew."""
    with open(FILE, "w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(COLUMNS)
        for slot, trial, way in _ways(data):
            out.writerows([slot, trial, *(f"{value:.3f}" for value in row)] for row in way)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
