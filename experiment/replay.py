"""A trial again, from its log alone: same config, same stream, same events, same frames.

Read-only. The events go through the same task code as they did then; frames come where the camera
file has them. What the session code took for itself (Esc, F1, focus) never reached the task.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from experiment.config import Study, parse
from experiment.design import Trial, session_for
from experiment.errors import InputError
from experiment.own_models import kept
from experiment.scenes import StudyScenes
from renderer.techniques.standard import Standard
from tasks import events as ev
from tasks.base import View
from tasks.catalog import TASKS

KINDS = {c.__name__: c for c in (ev.PointerMove, ev.PointerPress, ev.PointerRelease)}
KEYS = {c.__name__: c for c in (ev.KeyPress, ev.KeyRelease)}


@dataclass(frozen=True, eq=False)
class Recorded:
    """A trial's log: the study as it was, the trial, its files, and the picture's size then."""

    study: Study
    trial: Trial
    events: Path
    camera: Path
    size: tuple[int, int]
    driver: str
    samples: int

    @property
    def technique(self) -> Any:
        """What the trial was drawn with."""
        return self.study.dynamic if self.trial.transparency == "dynamic" else Standard()


@dataclass(frozen=True, eq=False)
class Frame:
    """A frame shown at `time` (s on the session's clock), with its digest if one was kept."""

    time: float
    view: View
    digest: str


def find_trial(data: Path, participant: str, number: int, attempt: int | None = None) -> Recorded:
    """The last (or the given) attempt at a trial. Raises InputError naming what is not there."""
    folders = [p for p in (data / "data").glob(f"*/{participant}") if p.is_dir()]
    if not folders:
        raise InputError(f"{data}: --participant = {participant}: no such participant")
    if len(folders) > 1:
        raise InputError(f"{data}: --participant = {participant}: in {len(folders)} sources")
    rows = []
    for table in sorted(folders[0].glob("*_trials_data.csv")):
        with open(table, encoding="utf-8", newline="") as file:
            rows += [(table, row) for row in csv.DictReader(file) if row["trial"] == str(number)]
    if attempt is not None:
        rows = [(t, r) for t, r in rows if r["attempt"] == str(attempt)]
    if not rows:
        raise InputError(f"{folders[0]}: --trial = {number}: no such trial recorded")
    table, row = max(rows, key=lambda pair: int(pair[1]["attempt"]))
    return _recorded(table, row, number)


def _recorded(table: Path, row: dict[str, str], number: int) -> Recorded:
    sidecar = table.with_suffix(".json")
    try:
        about = json.loads(sidecar.read_text(encoding="utf-8"))
        provenance = about["provenance"]
        width, height = (int(v) for v in provenance["display"]["size"].split("x"))
        study = parse(provenance["study"], str(sidecar))
    except (OSError, ValueError, KeyError) as error:
        raise InputError(f"{sidecar}: not a session's sidecar: {error!r}") from None
    study = study.with_walkthrough(kept(study.walkthrough, table.parents[3]))
    task_sets = session_for(int(row["slot"]), study.design.factors())
    trial = next(t for s in task_sets for t in s.trials if t.number == number)
    return Recorded(
        study,
        trial,
        table.parent / row["events_file"],
        table.parent / row["camera_file"],
        (width, height),
        provenance["display"].get("renderer", "unknown"),
        int(provenance["display"].get("samples", 0)),
    )


def replay(recorded: Recorded) -> Iterator[Frame]:
    """Every frame of the trial, in order, ending with the frame it ended on."""
    task = TASKS[recorded.trial.task]
    aspect = recorded.size[0] / recorded.size[1]
    state = StudyScenes(recorded.study).begin(task, recorded.trial, aspect)
    *shown, last = _frames(recorded.camera)
    rest = iter(shown)
    view = task.view(state)
    time, digest = next(rest)
    yield Frame(time, view, digest)
    for event in _events(recorded.events):
        state = task.on_event(state, event)
        if isinstance(event, ev.Tick) and task.outcome(state) is None:
            following = next(rest, None)
            if following is None:
                break  # the trial ended at a limit: what came after its last frame was not shown
            view = task.view(state)
            yield Frame(following[0], view, following[1])
    yield Frame(last[0], view, last[1])


def _frames(path: Path) -> list[tuple[float, str]]:
    with open(path, encoding="utf-8", newline="") as file:
        return [(float(row["time"]), row["digest"]) for row in csv.DictReader(file)]


def _events(path: Path) -> Iterator[ev.Event]:
    """The events that reached the task. Raises InputError for a kind that there is not."""
    with open(path, encoding="utf-8", newline="") as file:
        for number, row in enumerate(csv.DictReader(file), start=2):
            time, kind = float(row["time"]), row["event"]
            if kind == "tick":
                yield ev.Tick(time)
            elif kind == "PointerMove":
                place = (float(row[n]) for n in ("x", "y", "dx", "dy"))
                yield ev.PointerMove(time, *place, row["dragging"] == "true")
            elif kind in KINDS:
                yield KINDS[kind](time, float(row["x"]), float(row["y"]))
            elif kind in KEYS:
                if row["key"] not in ("escape", "f1"):
                    yield KEYS[kind](time, row["key"])
            elif kind != "FocusChange":
                raise InputError(f"{path}: row {number}: event = {kind}: unknown")
