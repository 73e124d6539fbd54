"""Makes data folders of the layout in CONVENTIONS.md with numpy, for the tests of the analysis."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

TRIAL_COLUMNS = (
    "row_id,study,participant,session,source,slot,trial,block,task_set,trial_in_set,attempt,"
    "transparency,scenario,task,scene,targets,answer,truth,correct,count_error,distance,time,"
    "time_clean,timed_out,frames,frames_missed,worst_frame,path_length,turned,started,"
    "events_file,camera_file"
).split(",")
ANSWER_COLUMNS = (
    "row_id,study,participant,session,source,item,transparency,scenario,value,text".split(",")
)
ORDERS = ((0, 1, 3, 2), (1, 2, 0, 3), (2, 3, 1, 0), (3, 0, 2, 1))  # a Williams square
CONDITIONS = tuple((t, s) for t in ("standard", "dynamic") for s in ("abstract", "walkthrough"))
TASKS = {"abstract": ("count", "pattern"), "walkthrough": ("unique", "count_in_building")}
MEANS = {"count": 50.0, "pattern": 20.0, "unique": 55.0, "count_in_building": 120.0}


@dataclass(frozen=True)
class Made:
    """What to make."""

    participants: int = 16
    trials: int = 3
    source: str = "human"
    seed: int = 7
    speed_up: float = 0.5
    questionnaire: bool = True
    config: dict[str, Any] | None = None


def cell(value: Any) -> str:
    """As the recorder writes it."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value) if isinstance(value, float) else str(value)


def make_folder(folder: Path, made: Made) -> Path:
    """Write the data folder and return it."""
    folder.mkdir(parents=True, exist_ok=True)
    about = {"name": "made", "description": "Made by a test.", "variableMeasured": []}
    (folder / "dataset_description.json").write_text(json.dumps(about))
    for slot in range(1, made.participants + 1):
        rng = np.random.default_rng(np.random.SeedSequence(made.seed, spawn_key=(slot,)))
        _participant(folder, made, slot, rng)
    return folder


def _participant(folder: Path, made: Made, slot: int, rng: np.random.Generator) -> None:
    name = f"P{slot:02d}"
    own = folder / "data" / made.source / name
    own.mkdir(parents=True)
    stem = f"study-made_subject-{name}_session-1"
    rows = _trials(made, name, slot, rng)
    write_rows(own / f"{stem}_trials_data.csv", TRIAL_COLUMNS, rows)
    provenance = {"study": made.config or {}, "versions": {"seethrough": "0.1.0"}}
    sidecar = {"started": "2026-11-22T09:00:00Z", "provenance": provenance}
    (own / f"{stem}_trials_data.json").write_text(json.dumps(sidecar))
    if made.questionnaire:
        answers = _answers(made, name, rng)
        write_rows(own / f"{stem}_questionnaire_data.csv", ANSWER_COLUMNS, answers)


def write_rows(path: Path, columns: list[str], rows: list[dict[str, Any]]) -> None:
    """A CSV table."""
    lines = [",".join(columns), *(",".join(cell(r.get(c)) for c in columns) for r in rows)]
    path.write_text("\n".join(lines) + "\n")


def _trials(made: Made, name: str, slot: int, rng: np.random.Generator) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = []
    person = rng.normal(0, 0.3)
    for block, index in enumerate(ORDERS[(slot - 1) % 4], start=1):
        transparency, scenario = CONDITIONS[index]
        tasks = TASKS[scenario][:: 1 if slot % 2 else -1]
        for task in tasks:
            for k in range(1, made.trials + 1):
                number = len(rows) + 1
                base = np.log(MEANS[task]) + person + rng.normal(0, 0.35)
                if transparency == "dynamic":
                    base += np.log(made.speed_up)
                rows.append(
                    {
                        "row_id": f"{made.source}-{name}-1-trial{number:03d}",
                        "study": "made",
                        "participant": name,
                        "session": 1,
                        "source": made.source,
                        "slot": slot,
                        "trial": number,
                        "block": block,
                        "task_set": (number - 1) // made.trials + 1,
                        "trial_in_set": k,
                        "attempt": 1,
                        "transparency": transparency,
                        "scenario": scenario,
                        "task": task,
                        "scene": f"set{k}",
                        **_answer(task, transparency, rng),
                        **_timing(float(np.exp(base)), rng),
                    }
                )
    return rows


def _answer(task: str, transparency: str, rng: np.random.Generator) -> dict[str, Any]:
    if task in ("count", "count_in_building"):
        truth = int(rng.integers(20, 41) if task == "count" else rng.integers(4, 13))
        off = int(rng.choice([-2, -1, 0, 0, 1] if transparency == "standard" else [-1, 0, 0, 0]))
        return {
            "targets": truth,
            "answer": truth + off,
            "truth": truth,
            "correct": off == 0,
            "count_error": off,
        }
    if task == "pattern":
        truth = str(rng.choice(list("CKRXY")))
        right = bool(rng.random() < 0.93)
        return {"targets": 12, "answer": truth if right else "C", "truth": truth, "correct": right}
    gap = float(rng.gamma(2, 8))
    return {
        "targets": 1,
        "answer": "1.0 2.0",
        "truth": "3.0 4.0",
        "correct": gap < 20,
        "distance": gap,
    }


def _timing(time: float, rng: np.random.Generator) -> dict[str, Any]:
    frames = int(time * 60)
    return {
        "time": time,
        "time_clean": time,
        "timed_out": False,
        "frames": frames,
        "frames_missed": int(rng.binomial(frames, 0.002)),
        "worst_frame": 0.034,
        "path_length": float(rng.gamma(4, 20)),
        "turned": float(rng.gamma(4, 2)),
        "started": "2026-11-22T09:00:00Z",
        "events_file": "traces/x_events.csv",
        "camera_file": "traces/x_camera.csv",
    }


def _answers(made: Made, name: str, rng: np.random.Generator) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = []

    def add(item: str, value: int, transparency: str = "", scenario: str = "") -> None:
        rows.append(
            {
                "row_id": f"{made.source}-{name}-1-question{len(rows) + 1:03d}",
                "study": "made",
                "participant": name,
                "session": 1,
                "source": made.source,
                "item": item,
                "transparency": transparency,
                "scenario": scenario,
                "value": value,
            }
        )

    for transparency, scenario in CONDITIONS:
        centre = 3 if transparency == "dynamic" else 1.6
        for item in ("efficiency", "ease", "enjoy"):
            value = int(np.clip(round(rng.normal(centre, 0.7)), 0, 4))
            add(item, value, transparency, scenario)
    add("preference", int(rng.random() < 0.9))
    add("depth_self_report", int(rng.integers(2, 5)))
    add("depth_test", int(rng.integers(2, 4)))
    return rows
