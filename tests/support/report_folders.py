"""Writes the folders of `report_cases` by the project's own recorder and batch writer."""

from __future__ import annotations

import csv
import hashlib
import json
import os
import tomllib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from unittest.mock import patch

import numpy as np
from report_cases import Answer, Case, Draws, Play, plain_answers, plain_plays

from seethrough.analysis.before import design_before
from seethrough.analysis.load.schema import certificate_columns
from seethrough.analysis.published.grim import fitting_whole_numbers
from seethrough.analysis.published.numbers import load_published
from seethrough.analysis.published.report import reconstructed
from seethrough.experiment.people.runs.batch import Batch
from seethrough.experiment.people.runs.batch_files import CHUNK, Results, render
from seethrough.experiment.people.runs.data_mode import Played
from seethrough.experiment.record.recorder import FileRecorder, Who, trial_row
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.study.config import Study, find, parse
from seethrough.experiment.study.design.design import session_for
from seethrough.experiment.study.shown.described import design_entry

NOW = "2026-01-02T03:04:05.000Z"
KEPT = ("_trials_data.csv", "_questionnaire_data.csv", "certificate.csv")
READ = frozenset(
    "row_id participant session source slot trial block task_set trial_in_set attempt transparency "
    "scenario task scene targets truth correct count_error distance time time_clean timed_out "
    "frames frames_missed item value text visible hidden occluders clutter path".split()
)
"""Columns that R reads: others may come and change without R being asked again."""
PLAN = ("alpha", "exclude", "too_fast", "margins")
"""What R reads of a sidecar's plan."""


def study_of(case: Case) -> Study:
    """The published study with the case's own name and changes."""
    path = find("published")
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    table["questions"].pop("consent")
    changes = {"study": {"name": "oracle", "participants": case.people}, **case.study}
    for name, change in changes.items():
        table[name] = {**table.get(name, {}), **change}
    return parse(table, str(path))


def make_case(case: Case, folder: Path) -> Path:
    """Write the case's data folder and return it."""
    study = study_of(case)
    with _no_waiting():
        if case.source == "simulated":
            _batches(case, study, folder)
        else:
            for person in range(1, case.people + 1):
                _person(case, study, folder, person)
    if case.certificate:
        _certificate(folder)
    return folder


@contextmanager
def _no_waiting() -> Iterator[None]:
    """Nothing here must outlive a power cut, and thousands of syncs take half a minute."""
    with patch.object(os, "fsync", lambda _: None):
        yield


def played(case: Case, study: Study, person: int) -> tuple[list[Play], list[Answer]]:
    """What one participant did and answered."""
    factors = study.plan
    trials = [t for s in session_for(person, factors) for t in s.trials]
    plays = case.change(person, plain_plays(person, trials))
    return plays, case.change_answers(
        person, plain_answers(person, [tuple(c.values()) for c in factors.conditions()])
    )


def _record(play: Play) -> TrialRecord:
    return TrialRecord(
        trial=play.trial,
        outcome=play.outcome,
        targets=play.targets,
        first_frame=0.0,
        confirmed=play.time,
        away=play.away,
        timed_out=play.timed_out,
        frames=play.frames,
        frames_missed=play.missed,
        worst_frame=0.034,
        path_length=12.5,
        turned=3.25,
        repeat=play.repeat,
    )


def _person(case: Case, study: Study, folder: Path, person: int) -> None:
    """The sessions of one participant, as the recorder writes them."""
    plays, answers = played(case, study, person)
    provenance = {"study": study.resolved(), "study_sha256": study.digest()}
    attempts: dict[int, int] = {}
    last = plays[-1].session
    for session in range(1, last + 1):
        who = Who(
            study.general.name,
            f"P{person:02d}",
            case.source,
            person,
            provenance,
            session,
            design_entry(study),
        )
        recorder = FileRecorder(folder, who, lambda: NOW, attempts)
        for play in (p for p in plays if p.session == session):
            recorder.trial_begins(play.trial)
            recorder.trial_ends(_record(play))
            attempts[play.trial.number] = attempts.get(play.trial.number, 0) + 1
        if session == last:
            recorder.answers([_answer(a) for a in answers])
        recorder.close("complete" if session == last else "left")


def _answer(answer: Answer) -> dict[str, str]:
    return {
        "item": answer.item,
        "transparency": answer.transparency,
        "scenario": answer.scenario,
        "value": str(answer.value),
        "text": answer.text,
    }


def _batches(case: Case, study: Study, folder: Path) -> None:
    """Simulated participants, as the batch writer writes them: sixteen a table."""
    about = Batch("published", seed=1, pool=1, code="none").about(study)
    with Results(folder, study, about) as results:
        for first in range(1, case.people + 1, CHUNK):
            slots = tuple(range(first, min(first + CHUNK, case.people + 1)))
            people = [_simulated(case, study, slot) for slot in slots]
            results.add(render(about, study, slots, people))


def _simulated(case: Case, study: Study, slot: int) -> Played:
    plays, answers = played(case, study, slot)
    name = f"S{slot:05d}"
    who = {
        "study": study.general.name,
        "participant": name,
        "session": 1,
        "source": case.source,
    }
    trials = [
        {
            **who,
            "row_id": f"{case.source}-{name}-1-trial{play.trial.number:03d}",
            "slot": slot,
            "attempt": 1,
            "started": NOW,
            **trial_row(_record(play)),
        }
        for play in plays
    ]
    questions = [
        {**who, "row_id": f"{case.source}-{name}-1-question{number:03d}", **_answer(answer)}
        for number, answer in enumerate(answers, start=1)
    ]
    return Played(
        study.general.name, name, slot, trials=trials, questions=questions, status="complete"
    )


def _certificate(folder: Path) -> None:
    """A certificate of the scenes that were met, with difficulties made up."""
    met: dict[tuple[str, str], dict[str, str]] = {}
    for row in _rows(folder.glob("data/*/*/*_trials_data.csv")):
        met.setdefault((row["scene"], row["task"]), row)
    lines = [",".join(certificate_columns(design_before({})))]
    for number, ((scene, task), row) in enumerate(sorted(met.items())):
        draws = Draws(3, number)
        path = round(60 + 40 * draws.share(), 2) if row["scenario"] == "walkthrough" else 0.0
        targets = draws.below(30) + 1
        cells = [
            scene,
            task,
            row["transparency"],
            targets,
            round(draws.share(), 4),
            draws.below(4),
            draws.below(90),
            draws.below(60),
            path,
        ]
        lines.append(",".join(map(str, cells)))
    (folder / "certificate.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def _rows(paths: Sequence[Path] | Iterator[Path]) -> Iterator[dict[str, str]]:
    for path in sorted(paths):
        with open(path, newline="", encoding="utf-8") as file:
            yield from csv.DictReader(file)


def contents(folder: Path) -> str:
    """SHA-256 of all that R reads in the folder: what its values belong to."""
    digest = hashlib.sha256()
    for path in sorted(p for p in folder.rglob("*.csv") if p.name.endswith(KEPT)):
        digest.update(path.relative_to(folder).as_posix().encode())
        for row in _rows([path]):
            digest.update(repr([(k, row[k]) for k in sorted(READ & row.keys())]).encode())
    sidecar = json.loads(min(folder.rglob("*_trials_data.json")).read_text(encoding="utf-8"))
    plan = sidecar["provenance"]["study"]["analysis"]
    digest.update(json.dumps([plan[name] for name in PLAN], sort_keys=True).encode())
    return digest.hexdigest()


PUBLISHED = "published_data.csv"
"""Beside R's tables of the published report: the data that were made to have its moments."""


def published_data() -> list[tuple[str, float, float]]:
    """(measure, standard, dynamic) of each person, as the published report makes them."""
    published = load_published()
    rng = np.random.default_rng(np.random.SeedSequence(1, spawn_key=(3, 0)))
    rows = [
        (m.key, float(a), float(b))
        for m in reconstructed(published, rng)
        for a, b in zip(m.first, m.second, strict=True)
    ]
    ratings = [
        fitting_whole_numbers(
            m, published.participants, published.rating_items * published.rating_highest,
            published.rating_items,
        )
        for m in published.rating
    ]  # fmt: skip
    return rows + [
        ("rating", a / published.rating_items, b / published.rating_items)
        for a, b in zip(*(r or () for r in ratings), strict=True)
    ]


def write_published(path: Path) -> None:
    """The data as a CSV."""
    lines = [f"{measure},{a!r},{b!r}" for measure, a, b in published_data()]
    path.write_text("\n".join(["measure,standard,dynamic", *lines]) + "\n")
