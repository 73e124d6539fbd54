"""Many participants in data mode: chunks of slots, played by any worker, handed over in order."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from importlib import metadata
from pathlib import Path

from seethrough.experiment.people.code_hash import code_sha256
from seethrough.experiment.people.runs.batch_files import CHUNK, Chunk, Slots, render
from seethrough.experiment.people.runs.data_mode import Played, play_session
from seethrough.experiment.people.runs.look_tables import views_of
from seethrough.experiment.people.runs.looks import KeptLooks
from seethrough.experiment.people.runs.pool import Pool, drawing
from seethrough.experiment.session.progress import Progress
from seethrough.experiment.study.config import Study, load
from seethrough.experiment.study.design.design import Trial, session_for
from seethrough.experiment.study.shown.described import design_entry
from seethrough.experiment.workers import ordered_map
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.skills.profile import AVERAGE, Profile


@dataclass(frozen=True)
class Batch:
    """What a worker needs to know; everything in it can be sent to another process."""

    study: str
    seed: int
    pool: int
    tables: Path | None = None
    profile: Profile = AVERAGE
    without: frozenset[str] = frozenset()
    draws: bool = True
    code: str = field(default_factory=code_sha256)  # of the process that began the run

    def about(self, study: Study) -> dict[str, object]:
        """The sidecar of every chunk: what the rows depend on."""
        return {
            "mode": "data: decisions from visibility tables; a tool for planning, never evidence",
            "source": "simulated",
            "design": design_entry(study),
            "provenance": {
                "study": study.resolved(),
                "study_sha256": study.digest(),
                "seed": study.general.seed,
                "versions": {name: metadata.version(name) for name in ("seethrough", "numpy")},
                "simulation_seed": self.seed,
                "profile": asdict(self.profile),
                "without": sorted(self.without),
                "pool": self.pool,
                "code": self.code,
            },
        }


@dataclass(frozen=True)
class _Ready:
    """This process's study and pool."""

    batch: Batch
    study: Study
    pool: Pool


_made: list[_Ready] = []  # the one that `prepare` made


def _ready() -> _Ready:
    return _made[-1]


def prepare(batch: Batch, study: Study | None = None, tables: bytes = b"") -> None:
    """Make this process ready for `play_chunk`.

    `study` and the content of the tables' file are given where their files are on another machine.
    """
    study = study or load(batch.study)
    looks = KeptLooks(batch.tables, tables)
    pool = (drawing if batch.draws else Pool)(study, batch.pool, looks=looks)
    _made[:] = [_Ready(batch, study, pool)]


def play_chunk(slots: Sequence[int], profile: Profile | None = None) -> list[dict[str, object]]:
    """Rows of the trial table of these slots, in order; `profile` instead of the batch's."""
    return [row for played in _sessions(slots, profile) for row in played.trials]


def play_files(slots: Slots) -> Chunk:
    """The same as the files of a chunk, questionnaires included.

    What was drawn on the way is in the tables' file, or in the chunk where there is no such file.
    """
    ready = _ready()
    batch, study, pool = ready.batch, ready.study, ready.pool
    chunk = render(batch.about(study), study, slots, _sessions(slots))
    drawn = pool.looks.flush()
    return chunk if batch.tables is not None else replace(chunk, looks=drawn)


def _sessions(slots: Sequence[int], profile: Profile | None = None) -> list[Played]:
    ready = _ready()
    batch, study, pool = ready.batch, ready.study, ready.pool
    person = profile or batch.profile
    return [play_session(study, s, batch.seed, pool, person, batch.without) for s in slots]


def in_chunks(slots: Sequence[int]) -> list[tuple[int, ...]]:
    """What one worker plays at a time."""
    return [tuple(slots[i : i + CHUNK]) for i in range(0, len(slots), CHUNK)]


def play(batch: Batch, slots: Sequence[int], workers: int) -> Iterator[list[dict[str, object]]]:
    """Rows chunk by chunk, the same whatever the number of workers."""
    return ordered_map(play_chunk, in_chunks(slots), workers, prepare, (batch,))


def keep_tables() -> None:
    """Write what this process has drawn into the tables' file."""
    _ready().pool.looks.flush()


def fill(batch: Batch, progress: Progress | None = None) -> None:
    """Draw what the tables lack of every scene of the pool.

    Each scene is drawn from the viewpoints that a participant of this profile looks from. What was
    drawn is kept scene by scene: who is interrupted goes on there.
    """
    prepare(batch)
    study, pool = _ready().study, _ready().pool
    aspect = study.display.width / study.display.height
    for trial in pooled_trials(study):
        for which in range(batch.pool):
            task = TASKS[trial.task]
            part = study.part(trial.levels)
            view = task.view(pool.world(trial, which, aspect)).dressed(part.look)
            eyes = pool.eyes(view.scene, part.technique)
            for camera in views_of(task.simulate.heights, view.camera):
                eyes.look(view.scene, camera)
            pool.looks.flush()
            if progress is not None:
                progress.step(f"{trial.task} {' '.join(trial.levels.values())}")


def make_worlds() -> None:
    """Make every world of this process's pool now, instead of when somebody first plays in it."""
    ready = _ready()
    batch, study, pool = ready.batch, ready.study, ready.pool
    aspect = study.display.width / study.display.height
    for trial in pooled_trials(study):
        for which in range(batch.pool):
            pool.world(trial, which, aspect)


def pooled_trials(study: Study) -> list[Trial]:
    """One trial of each task whose scenes are everybody's own, with each technique, in each
    place."""
    trials: dict[object, Trial] = {}
    for slot in range(1, len(study.plan.groups) + 1):
        for task_set in session_for(slot, study.plan):
            for trial in task_set.trials:
                part = study.part(trial.levels)
                if not part.plan.shared:
                    trials.setdefault((trial.task, part.technique, part.place, part.look), trial)
    return list(trials.values())
