"""Makes data folders of any design, as a recorder would leave them, for tests of the analysis.

The sidecars hold the `design` entry, and the tables are chained; people, effects and noise come
from a seed. Times are log-normal, `off` is a distance, `ease` has five points.
"""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from made_chains import chain_table
from made_data import write_rows
from numpy.random import Generator

FIXED = (
    "row_id,study,participant,session,source,slot,trial,block,task_set,trial_in_set,attempt,{},"
    "task,scene,targets,answer,truth,correct,{},time,time_clean,timed_out,frames,frames_missed,"
    "worst_frame,path_length,turned,started,events_file,camera_file"
)
ASKED = "row_id,study,participant,session,source,item,{},value,text"
TIME = {"name": "time", "unit": "s", "direction": "less", "scale": "ratio", "adds": "mean",
        "log": True, "rows": "all", "margin": None, "label": "completion time"}  # fmt: skip
OFF = {"name": "off", "unit": "mm", "direction": "less", "scale": "ratio", "adds": "mean",
       "log": False, "rows": "all", "margin": None, "label": "distance off"}  # fmt: skip
RIGHT = {"name": "correct", "unit": "", "direction": "more", "scale": "binary", "adds": "share",
         "log": False, "rows": "all", "margin": None, "label": "right answers"}  # fmt: skip
EASE = {"name": "ease", "unit": "", "direction": "more", "scale": "ordinal", "adds": "median",
        "log": False, "rows": "all", "margin": None, "label": "ease"}  # fmt: skip

Cell = Mapping[str, str]


@dataclass(frozen=True)
class Design:
    """What to make. `factors`: the sidecar's; `people`: of each group, in the order of the groups'
    cells; `effect`: what a cell adds to log time; `tasks`: names, each with `measures`; `shared`:
    how many scenes of a task everybody meets, 0 where each trial has a scene of its own; `answers`:
    a slot's rows of the questionnaire instead of drawn ones; `plan`: the study's [analysis]."""

    factors: Sequence[Mapping[str, Any]]
    people: Sequence[int] = (12,)
    trials: int = 2
    tasks: Sequence[str] = ("find",)
    measures: Sequence[Mapping[str, Any]] = (TIME, OFF, RIGHT)
    excluded: Sequence[Cell] = ()
    predictions: Sequence[Mapping[str, Any]] = ()
    effect: Callable[[Cell], float] = lambda cell: 0.0
    seed: int = 1
    source: str = "human"
    asked: bool = True
    shared: int = 0
    plan: Mapping[str, Any] = field(default_factory=dict)
    answers: Callable[[int], Sequence[Mapping[str, Any]]] | None = None
    more: Mapping[str, Any] = field(default_factory=dict)

    def entry(self) -> dict[str, Any]:
        """The sidecar's `design`."""
        tasks = [{"name": t, "code": f"T{i}", "measures": list(self.measures)}
                 for i, t in enumerate(self.tasks, start=1)]  # fmt: skip
        return {"factors": list(self.factors), "excluded": list(self.excluded), "tasks": tasks,
                "predictions": list(self.predictions), **self.more}  # fmt: skip

    def of(self, within: bool) -> list[Mapping[str, Any]]:
        return [f for f in self.factors if (f["kind"] == "within") == within]

    def cells(self, within: bool) -> list[dict[str, str]]:
        """The cells of the within factors, or of those between people."""
        own = self.of(within)
        found = [dict(zip([f["name"] for f in own], levels, strict=True))
                 for levels in itertools.product(*(f["levels"] for f in own))]  # fmt: skip
        return [c for c in found
                if not any(gone.items() <= c.items() for gone in self.excluded)]  # fmt: skip

    def tasks_of(self, cell: Cell) -> list[str]:
        """The tasks that a cell has: factors may give each level its own (`tasks`)."""
        own = [f["tasks"][cell[f["name"]]] for f in self.factors if f.get("tasks")]
        return [t for t in self.tasks if all(t in known for known in own)]


def factor(name: str, *levels: str, kind: str = "within", **more: Any) -> dict[str, Any]:
    """A factor as the sidecar has it, the first level the baseline."""
    return {"name": name, "kind": kind, "levels": list(levels), "numbers": None, "labels": {},
            "baseline": levels[0], "scenes": "alone", "order": "latin", **more}  # fmt: skip


def make_design(folder: Path, design: Design) -> Path:
    """Write the data folder and return it."""
    folder.mkdir(parents=True, exist_ok=True)
    about = {"name": "made", "description": "Made by a test.", "variableMeasured": []}
    (folder / "dataset_description.json").write_text(json.dumps(about))
    groups = design.cells(within=False)
    number = 0
    for group, count in zip(groups, design.people, strict=True):
        for _ in range(count):
            number += 1
            rng = np.random.default_rng(np.random.SeedSequence(design.seed, spawn_key=(number,)))
            _person(folder, design, number, group, rng)
    return folder


def _person(folder: Path, design: Design, slot: int, group: Cell, rng: Generator) -> None:
    name = f"P{slot:02d}"
    own = folder / "data" / design.source / name
    own.mkdir(parents=True)
    stem = f"study-made_subject-{name}_session-1"
    who = {"study": "made", "participant": name, "session": 1, "source": design.source}
    rows = [{**who, "slot": slot, **row} for row in _trials(design, slot, group, rng)]
    for row in rows:
        row["row_id"] = f"{design.source}-{name}-1-trial{row['trial']:03d}"
    columns = ",".join(f["name"] for f in design.factors)
    extra = ",".join(m["name"] for m in design.measures if m["name"] not in ("time", "correct"))
    table = own / f"{stem}_trials_data.csv"
    write_rows(table, FIXED.format(columns, extra).replace(",,", ",").split(","), rows)
    config: dict[str, Any] = {"study": {"title": "Made", "participants": None}}
    if design.plan:
        config["analysis"] = dict(design.plan)
    sidecar = {"started": "2026-11-22T09:00:00Z", "design": design.entry(),
               "provenance": {"study": config}}  # fmt: skip
    table.with_suffix(".json").write_text(json.dumps(sidecar))
    if design.asked:
        within = ",".join(f["name"] for f in design.of(within=True))
        answers = [{**who, "row_id": f"{design.source}-{name}-1-q{i:03d}", **row}
                   for i, row in enumerate(design.answers(slot) if design.answers
                                           else _answers(design, rng))]  # fmt: skip
        path = own / f"{stem}_questionnaire_data.csv"
        write_rows(path, ASKED.format(within).replace(",,", ",").split(","), answers)
    chain_table(table)


def _trials(
    design: Design, slot: int, group: Cell, rng: Generator
) -> list[dict[str, Any]]:  # fmt: skip
    """A block for each condition, in a rotated order; people differ in level and in the effects."""
    cells = design.cells(within=True)
    person = rng.normal(0, 0.3)
    slopes = rng.normal(0, 0.15, len(cells))
    order = np.roll(np.arange(len(cells)), -slot % len(cells))
    rows: list[dict[str, Any]] = []
    for block, index in enumerate(order.tolist(), start=1):
        cell = {**group, **cells[index]}
        for task in design.tasks_of(cell):
            for k in range(1, design.trials + 1):
                mean = 3 + person + slopes[index] + design.effect({**cell, "task": task})
                scene, adds = _scene(design, slot, task, len(rows), index)
                mean += adds
                time = float(np.exp(mean + rng.normal(0, 0.3)))
                right = bool(rng.random() < 0.85)
                number = len(rows) + 1
                frames = int(time * 60)
                rows.append({
                    "trial": number, "block": block, "task_set": (number - 1) // design.trials + 1,
                    "trial_in_set": k, "attempt": 1, **cell, "task": task,
                    "scene": scene, "targets": 10, "answer": "a", "truth": "a",
                    "correct": right, "off": float(rng.gamma(3, 2) * np.exp(0.1 * person)),
                    "ease": int(np.clip(round(3 - 2 * design.effect({**cell, "task": task})
                                              + rng.normal(0, 0.8)), 1, 5)),
                    "time": time, "time_clean": time, "timed_out": False, "frames": frames,
                    "frames_missed": int(rng.binomial(frames, 0.002)), "worst_frame": 0.034,
                    "path_length": float(rng.gamma(4, 20)), "turned": float(rng.gamma(4, 2)),
                    "started": "2026-11-22T09:00:00Z", "events_file": "x", "camera_file": "x",
                })  # fmt: skip
    return rows


def _scene(design: Design, slot: int, task: str, before: int, cell: int) -> tuple[str, float]:
    """A trial's scene, and what it adds to log time: a level, and its own effect of each cell."""
    if not design.shared:
        return f"stream-{slot}-{before + 1}", 0.0
    which = (before // len(design.tasks) + 3 * slot) % design.shared
    key = (10_000, design.tasks.index(task), which)
    rng = np.random.default_rng(np.random.SeedSequence(design.seed, spawn_key=key))
    level, slopes = rng.normal(0, 0.2), rng.normal(0, 0.2, len(design.cells(within=True)))
    return f"{task}-{which}", float(level + slopes[cell])


def _answers(design: Design, rng: Generator) -> list[dict[str, Any]]:
    """An item after each condition, and one asked once."""
    rows: list[dict[str, Any]] = [
        {"item": "effort", **cell, "value": int(rng.integers(1, 8)), "text": ""}
        for cell in design.cells(within=True)
        if cell
    ]
    return [*rows, {"item": "age", "value": int(rng.integers(20, 60)), "text": ""}]


def _asked_of(
    *groups: tuple[Sequence[str], Sequence[Cell]],
) -> Callable[[int], list[dict[str, Any]]]:
    """Answers of these items in these cells, of five points that a person tends to."""

    def answers(slot: int) -> list[dict[str, Any]]:
        rng = np.random.default_rng(slot)
        tends = rng.integers(0, 3)
        return [
            {"item": item, **cell, "value": int(tends + rng.integers(1, 4)), "text": ""}
            for items, cells in groups for item in items for cell in cells
        ]  # fmt: skip

    return answers


CLUTTER = factor("clutter", "80", "180", "380", numbers=[80, 180, 380], scenes="changed")
VIEWS = factor("view", "plain", "xray", "cut", "lens")


def _of_view(cell: Cell) -> float:
    return {"xray": -0.2, "cut": -0.5, "lens": 0.1}.get(cell.get("view", ""), 0.0)


def _of_both(cell: Cell) -> float:
    steep = 0.0015 if cell.get("view") == "plain" else 0.0003
    return _of_view(cell) + steep * (float(cell["clutter"]) - 80)


def _of_group(cell: Cell) -> float:
    return _of_both(cell) - (0.3 if cell.get("training") == "criterion" else 0.0)


TRAINING = factor("training", "none", "criterion", kind="between")
PREDICTED = (
    {"name": "H1", "text": "a cut is faster", "measure": "time", "contrast": "view",
     "level": "cut", "expect": "less", "reason": "20 people find a ratio of .8 in .9 of studies"},
    {"name": "H2", "measure": ["off", "correct"], "contrast": "view", "expect": "not worse",
     "margin": {"off": 2.0, "correct": 0.15}},
)  # fmt: skip
DESIGNS: Mapping[str, Design] = {
    "four": Design((VIEWS,), (14,), 3, effect=_of_view, predictions=PREDICTED),
    "two_tasks": Design((factor("view", "plain", "xray", "cut"),), (12,), 2, ("find", "count"),
                        (TIME, OFF, RIGHT), effect=_of_view, seed=2),
    "six_by_three": Design(
        (factor("view", "plain", "xray", "dynamic", "cut", "cut45", "lens"), CLUTTER), (12,), 2,
        effect=_of_both, seed=3, excluded=({"view": "plain", "clutter": "380"},),
    ),
    "two_by_three": Design((factor("view", "plain", "cut"), CLUTTER), (12,), 2, effect=_of_both,
                           seed=4),
    "mixed": Design((TRAINING, CLUTTER), (9, 5), 2, effect=_of_group, seed=5,
                    predictions=({"name": "H1", "measure": "time", "contrast": "training",
                                  "expect": "less"},)),
    "mixed_ordinal": Design((TRAINING, factor("view", "plain", "cut", "lens")), (7, 9), 3,
                            ("find",), (TIME, EASE, RIGHT), effect=_of_view, seed=6),
    "between": Design((factor("training", "none", "short", "long", kind="measured"),), (4, 7, 9),
                      3, effect=lambda c: -0.2 * (c["training"] == "long"), seed=7),
    "left_out": Design((factor("view", "plain", "cut", "lens"), CLUTTER), (12,), 2,
                       effect=_of_both, seed=8, excluded=({"view": "plain", "clutter": "380"},)),
    "four_ranked": Design((VIEWS,), (11,), 3, ("find",), (TIME, EASE, RIGHT), effect=_of_view,
                          seed=11, plan={"pairwise": ["view"]}),
    "four_tasks": Design((VIEWS,), (16,), 2, ("find", "count"), (TIME, OFF, RIGHT),
                         effect=_of_view, seed=12),
    "two_by_three_ranked": Design(
        (factor("view", "plain", "cut"), CLUTTER), (10,), 3, ("find",), (OFF, EASE, RIGHT),
        effect=_of_both, seed=13, plan={"pairwise": ["clutter"], "aligned_ranks": True},
    ),
    "two_by_three_tasks": Design((factor("view", "plain", "cut"), CLUTTER), (7,), 2,
                                 ("find", "count"), effect=_of_both, seed=14),
    "mixed_unlike": Design(
        (factor("training", "none", "some", kind="measured"), CLUTTER), (12, 4), 2,
        effect=_of_group, seed=15, plan={"pairwise": ["clutter"]},
    ),
    "left_out_ranked": Design(
        (factor("view", "plain", "cut", "lens"), CLUTTER), (9,), 3, ("find",), (TIME, EASE, RIGHT),
        effect=_of_both, seed=16, excluded=({"view": "plain", "clutter": "380"},),
        plan={"pairwise": ["view"], "aligned_ranks": True},
    ),
    "tasks_by_group": Design(
        (factor("job", "finding", "counting", kind="between",
                tasks={"finding": ["find"], "counting": ["count"]}),
         factor("view", "plain", "cut")),
        (7, 6), 3, ("find", "count"), effect=_of_view, seed=17,
    ),
    "nested": Design(
        (factor("view", "plain", "cut"),
         factor("place", "in", "out", tasks={"in": ["find", "count"], "out": ["read"]})),
        (9,), 2, ("find", "count", "read"), effect=_of_view, seed=18,
        answers=_asked_of((("ease", "fun"), [
            {"view": v, "place": p} for v in ("plain", "cut") for p in ("in", "out")])),
    ),
    "asked_in_part": Design(
        (factor("view", "plain", "cut", "lens"),), (12,), 2, effect=_of_view, seed=19,
        answers=_asked_of((("quick", "sure", "calm"), [
            {"view": v} for v in ("plain", "cut", "lens")]), (
            ("tiring",), [{"view": v} for v in ("cut", "lens")])),
        more={"items": [
            {"name": n, "label": n, "each": ["view"], "group": g, "points": 5, "low": 1}
            for g, own in (("mood", ("quick", "sure", "calm")), ("", ("tiring",))) for n in own]},
    ),
    "three_people": Design((factor("view", "plain", "cut"), CLUTTER), (3,), 3, effect=_of_both,
                         seed=20),
    "scenes": Design((factor("view", "plain", "cut"),), (12,), 4, effect=_of_view, seed=9,
                     shared=8),
    "scenes_of_three": Design((factor("view", "plain", "xray", "cut"),), (9,), 4,
                              ("find", "count"), effect=_of_view, seed=10, shared=12),
}  # fmt: skip
