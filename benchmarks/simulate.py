"""What simulating a study costs, and how near simulated people come to the published ones.

`seethrough bench simulate` prints the whole table; `python -m benchmarks.simulate --tables FILE`
parts of it, from tables that are kept. Tables are made first and timed apart.
"""

from __future__ import annotations

import argparse
import json
import resource
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from experiment.config import load
from experiment.participants import batch
from experiment.participants.calibration import FITTED, HELD_OUT, measured, published
from experiment.participants.profile import Profile
from experiment.participants.profile_file import find

STUDY = "published"
WORKERS = 2
MANY = 10_000

Figure = dict[str, Any]


def figure(
    name: str, value: float, unit: str, must: float, aim: float, more: bool = False
) -> Figure:
    """One row; `more` where larger is better."""
    met = value >= must if more else value <= must
    return {
        "figure": name, "scene": STUDY, "value": round(value, 4), "unit": unit,
        "must": must, "aim": aim, "met": bool(met),
    }  # fmt: skip


def timed(work: Callable[[], Any]) -> tuple[float, Any]:
    """Seconds that `work` took, and what it gave."""
    start = time.perf_counter()
    result = work()
    return time.perf_counter() - start, result


def visual() -> list[Figure]:
    """The published study through the real session, on this machine."""
    from experiment.commands.simulate import simulate

    study = load(STUDY)
    with tempfile.TemporaryDirectory() as folder:
        seconds, _ = timed(lambda: simulate(study, 16, 1, Path(folder) / "data"))
    return [figure("16 participants, visual", seconds / 60, "min", 10, 3)]


def _rows(job: batch.Batch, count: int, workers: int) -> list[dict[str, Any]]:
    slots = range(1, count + 1)
    return [row for rows in batch.play(job, slots, workers) for row in rows]


def make_tables(job: batch.Batch) -> float:
    """Seconds to fill the tables: every abstract viewpoint, and the buildings as 16 people walk."""

    def work() -> None:
        batch.fill(job)
        batch.play_chunk(range(1, batch.CHUNK + 1))
        batch.keep_tables()

    return timed(work)[0]


def data(job: batch.Batch) -> list[Figure]:
    """The published study from tables, and what a second worker brings.

    Workers are started and have read the tables before the clock runs: the first chunk is theirs.
    """
    spread = replace(job, draws=True)
    batch.CHUNK, before = 4, batch.CHUNK
    try:
        one, _ = timed(lambda: _rows(spread, 16, 1))
        more, _ = timed(lambda: _rows(spread, 128, 1))
        two, _ = timed(lambda: _rows(spread, 16, WORKERS))
        more_two, _ = timed(lambda: _rows(spread, 128, WORKERS))
    finally:
        batch.CHUNK = before
    # The start of the processes and the reading of the tables cancel in the differences.
    ratio = (more - one) / (more_two - two)
    return [
        figure("16 participants, data mode", (more_two - two) / 7, "s", 3, 1),
        figure("two workers against one", ratio, "×", 1.7, 1.9, more=True),
    ]


def many(job: batch.Batch, count: int) -> list[Figure]:
    """Many participants in data mode: time, and the memory of the largest process."""

    def work() -> int:
        return sum(len(rows) for rows in batch.play(job, range(1, count + 1), WORKERS))

    seconds, _ = timed(work)
    kinds = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    memory = max(resource.getrusage(kind).ru_maxrss for kind in kinds) / 2**20
    return [
        figure(f"{count} participants, data mode", seconds / 60, "min", 30, 5),
        figure(f"memory at {count} participants", memory, "GiB", 1, 1),
    ]


def calibration(job: batch.Batch, profile: Profile, count: int = 64) -> list[Figure]:
    """How far simulated times lie from the published ones, fitted and held-out half."""
    found = measured(_rows(replace(job, profile=profile), count, 1))
    figures = []
    for half, tasks in (("fitted", FITTED), ("held out", HELD_OUT)):
        means = max(_off(found[t].means, published()[t].means) for t in tasks)
        sds = max(_off(found[t].sds, published()[t].sds) for t in tasks)
        r = max(abs(found[t].r - published()[t].r) for t in tasks)
        figures += [
            figure(f"time means off, {half}", means, "share", 0.15, 0.05),
            figure(f"time s.d. off, {half}", sds, "share", 0.30, 0.15),
            figure(f"time r off, {half}", r, "", 0.2, 0.1),
        ]
    return figures


def _off(ours: Sequence[float], theirs: Sequence[float]) -> float:
    return max(abs(a / b - 1) for a, b in zip(ours, theirs, strict=True))


def figures() -> Iterator[Figure]:
    """The whole table, tables made anew in a folder of its own."""
    yield from visual()
    with tempfile.TemporaryDirectory() as folder:
        job = batch.Batch(STUDY, 1, 200, Path(folder) / "tables.npz")
        make_tables(job)
        yield from data(job)
        yield from many(job, MANY)
        yield from calibration(job, find("calibrated"))


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path, metavar="FILE")
    parser.add_argument("--tables", type=Path, required=True, help="made if it is not there")
    parser.add_argument("--pool", type=int, default=200, help="scenes a task")
    parser.add_argument("--profile", default="average", help="for the calibration's figures")
    parser.add_argument("--many", type=int, default=MANY, help="participants of the large run")
    parser.add_argument("--only", default="visual,data,many,calibration")
    chosen = parser.parse_args(arguments)
    job = batch.Batch(STUDY, 1, chosen.pool, chosen.tables)
    if not chosen.tables.exists():
        print(f"tables made in {make_tables(job):.0f} s")
    parts: dict[str, Callable[[], list[Figure]]] = {
        "visual": visual,
        "data": lambda: data(job),
        "many": lambda: many(job, chosen.many),
        "calibration": lambda: calibration(job, find(chosen.profile)),
    }
    figures = [row for name in chosen.only.split(",") for row in parts[name]()]
    for row in figures:
        met = "met" if row["met"] else "not met"
        print(
            f"{row['figure']:36s}{row['value']:10.3f} {row['unit']:6s} must {row['must']:g}, {met}"
        )
    if chosen.json:
        chosen.json.write_text(json.dumps(figures, indent=2) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
