"""A trial again, from its log alone: same config, same stream, same events, same frames.

Read-only. The events go through the same task code as they did then; frames come where the camera
file has them. What the session code took for itself (Esc, F1, focus) never reached the task.
"""

from __future__ import annotations

import csv
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from seethrough.analysis.load.chain import read_rows
from seethrough.analysis.load.files import Source, table_in
from seethrough.analysis.load.person import CHUNK, Session
from seethrough.analysis.load.schema import SOURCES
from seethrough.analysis.load.whole import verified_person
from seethrough.experiment.errors import InputError, one_line
from seethrough.experiment.files.folders import check_participant, folder_of
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.session.hand import Hand
from seethrough.experiment.session.options import as_asked
from seethrough.experiment.study.beside.own_model_files import kept
from seethrough.experiment.study.beside.plugin_files import kept as kept_plugins
from seethrough.experiment.study.config import Study, parse
from seethrough.experiment.study.design.design import Trial, session_for
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.experiment.study.translations import texts_of
from seethrough.renderer import events as ev
from seethrough.renderer.scene.look import Look
from seethrough.renderer.techniques.base import Parameters
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import Outcome, View

KINDS = {
    c.__name__: c for c in (ev.PointerPress, ev.PointerRelease, ev.SecondPress, ev.SecondRelease)
}
CAMERA = ("eye_x", "eye_y", "eye_z", "forward_x", "forward_y", "forward_z")
KEYS = {c.__name__: c for c in (ev.KeyPress, ev.KeyRelease)}


@dataclass(frozen=True, eq=False)
class Recorded:
    """A trial's log: the study as it was, the trial, its row and files, the picture's size."""

    study: Study
    trial: Trial
    row: Mapping[str, str]
    events: Path
    camera: Path
    size: tuple[int, int]
    driver: str
    samples: int

    @property
    def technique(self) -> Parameters:
        """What the trial was drawn with."""
        return self.study.part(self.trial.levels).technique

    @property
    def texts(self) -> Texts:
        """What the participant read, in their language."""
        return texts_of(self.study, self.study.part(self.trial.levels).general.language)

    @property
    def look(self) -> Look:
        """How the trial's scene looked."""
        return self.study.part(self.trial.levels).look


@dataclass(frozen=True, eq=False)
class Frame:
    """A frame shown at `time` (s on the session's clock), with its digest if one was kept."""

    time: float
    view: View
    digest: str
    camera: tuple[float, ...] = ()  # eye and direction as they were recorded, where they changed
    outcome: Outcome | None = None  # with the last frame


def find_trial(data: Path, participant: str, number: int, attempt: int | None = None) -> Recorded:
    """The last (or the given) attempt at a trial.

    Raises InputError naming what is not there, DataError for files that are not as written.
    """
    check_participant(participant)
    sources = [s for s in SOURCES if os.path.lexists(folder_of(data, s, participant))]
    if not sources:
        if any(CHUNK.fullmatch(p.name) for p in (data / "data" / "simulated").glob("S*")):
            raise InputError(
                f"{data}: --participant = {participant}: simulated in data mode, which keeps no "
                "traces: there is nothing to show again"
            )
        raise InputError(f"{data}: --participant = {participant}: no such participant")
    if len(sources) > 1:
        raise InputError(f"{data}: --participant = {participant}: in {len(sources)} sources")
    person = verified_person(data, sources[0], participant)
    found = [
        (session, row)
        for session in person.sessions
        if session.table is not None
        for row in _rows(session.table)
        if row["trial"] == str(number) and attempt in (None, int(row["attempt"]))
    ]
    if not found:
        where = folder_of(data, sources[0], participant)
        raise InputError(f"{where}: --trial = {number}: no such trial recorded")
    session, row = max(found, key=lambda pair: int(pair[1]["attempt"]))
    return _recorded(data, session, row)


def _rows(table: Source) -> list[dict[str, str]]:
    """A verified table's rows. Raises InputError where they say not which trials they are."""
    header, *rows = read_rows(table.data.decode("utf-8", "replace")) or [[]]
    made = [dict(zip(header, row, strict=False)) for row in rows]
    for line, row in enumerate(made, start=2):
        if not all(row.get(name, "").isdecimal() for name in ("trial", "attempt", "slot")):
            raise InputError(f"{table.name}: row {line}: expected numbers of trial, attempt, slot")
    return made


def _recorded(data: Path, session: Session, row: dict[str, str]) -> Recorded:
    assert session.table is not None
    table = data / session.table.name
    sidecar = table.with_suffix(".json")
    if session.sidecar is None:
        raise InputError(f"{sidecar}: missing: a replay needs to know how it was shown")
    try:
        provenance = table_in(session.sidecar, "provenance")
        display = table_in(provenance, "display")
        width, height = (int(v) for v in str(display["size"]).split("x"))
        samples = int(str(display.get("samples", 0)))
        kept_plugins(table_in(provenance, "study"), data)
        study = parse(table_in(provenance, "study"), str(sidecar), before=True)
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        said = f"{error}" if isinstance(error, ValueError) else f"{type(error).__name__} {error}"
        raise InputError(
            f"{sidecar}: expected what a session was shown with (provenance, its display and "
            f"study): {one_line(said)}"
        ) from None
    study = study.with_places(lambda place: kept(place, data))
    task_sets = session_for(int(row["slot"]), study.plan)
    number = int(row["trial"])
    trial = next((t for s in task_sets for t in s.trials if t.number == number), None)
    if trial is None:
        raise InputError(f"{sidecar}: trial {number}: expected one of the study's design")
    traces = [row.get(f"{name}_file", "") for name in ("events", "camera")]
    if not all(traces):
        raise InputError(
            f"{table}: --trial = {number}: recorded without traces: there is nothing to show again"
        )
    for name in traces:
        if not (table.parent / name).is_file():
            raise InputError(f"{table.parent / name}: not in this folder: expected the trial's log")
    events, camera = (table.parent / name for name in traces)
    return Recorded(
        study, trial, row, events, camera, (width, height), str(display.get("renderer", "unknown")),
        samples,
    )  # fmt: skip


def replay(recorded: Recorded) -> Iterator[Frame]:
    """Every frame of the trial, in order, ending with the frame it ended on."""
    task = as_asked(TASKS[recorded.trial.task], recorded.study, recorded.trial)
    aspect = recorded.size[0] / recorded.size[1]
    state = StudyScenes(recorded.study).begin(task, recorded.trial, aspect)
    *shown, last = _frames(recorded.camera)
    rest = iter(shown)
    part = recorded.study.part(recorded.trial.levels)
    hand = Hand(recorded.technique, aspect, recorded.look, part.display.height)
    view = hand.shown(task.view(state))
    time, digest, camera = next(rest)
    yield Frame(time, view, digest, camera)
    for event in _events(recorded.events):
        event = hand.pointed(event, view)
        if not hand.on_event(event, view):
            state = task.on_event(state, event)
        if isinstance(event, ev.Tick) and task.outcome(state) is None:
            following = next(rest, None)
            if following is None:
                break  # the trial ended at a limit: what came after its last frame was not shown
            view = hand.shown(task.view(state))
            yield Frame(following[0], view, *following[1:])
    time, digest, camera = last
    yield Frame(time, view, digest, camera, task.outcome(state))


def _frames(path: Path) -> list[tuple[float, str, tuple[float, ...]]]:
    """(time, digest, eye and direction or ()) of each frame. Raises InputError."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    try:
        found = [
            (float(r["time"]), r["digest"], tuple(float(r[n]) for n in CAMERA if r["eye_x"]))
            for r in rows
        ]
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(f"{path}: not a camera path: {error!r}") from None
    if len(found) < 2:
        raise InputError(f"{path}: {len(found)} frames: expected the first and the last at least")
    return found


def _events(path: Path) -> Iterator[ev.Event]:
    """The events that reached the task. Raises InputError for a kind that there is not."""
    with open(path, encoding="utf-8", newline="") as file:
        for number, row in enumerate(csv.DictReader(file), start=2):
            time, kind = float(row["time"]), row["event"]
            if kind == "tick":
                yield ev.Tick(time)
            elif kind == "PointerMove":
                x, y, dx, dy = (float(row[n]) for n in ("x", "y", "dx", "dy"))
                yield ev.PointerMove(time, x, y, dx, dy, row["dragging"] == "true")
            elif kind == "Wheel":
                x, y, dy = (float(row[n]) for n in ("x", "y", "dy"))
                yield ev.Wheel(time, x, y, dy)
            elif kind in KINDS:
                yield KINDS[kind](time, float(row["x"]), float(row["y"]))
            elif kind in KEYS:
                if row["key"] not in ("escape", "f1"):
                    yield KEYS[kind](time, row["key"])
            elif kind != "FocusChange":
                raise InputError(f"{path}: row {number}: event = {kind}: unknown")
