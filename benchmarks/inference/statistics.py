"""Size, coverage, accuracy and time of the statistics, and of whole reports.

`seethrough bench statistics --json FILE`. The accuracy rows compare ways to compute F on data whose
F is known as a fraction, at offsets up to 10¹⁵; their times are ratios within one run. The report
rows start the program itself, on made data of 384 and 240,000 trials. The rows of sizes are
`benchmarks/inference/sizes.py`'s.
"""

from __future__ import annotations

import itertools
import json
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from pathlib import Path

import numpy as np
import pandas as pd

from seethrough.analysis.before import design_before
from seethrough.analysis.load.schema import answer_columns, trial_columns
from seethrough.analysis.stats.anova import repeated_measures
from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.undefined import is_defined
from seethrough.benchmarks.inference.sizes import sizes
from seethrough.benchmarks.memory import used_by
from seethrough.benchmarks.rows import Row, row

DESIGN = design_before({})
OFFSETS = (0.0, 1e6, 1e9, 1e12, 1e15)
REPORTS = ((16, 10.0, None), (10_000, 40.0, 1.5))
"""Participants of 24 trials, the most seconds, the most GiB."""
REPORT = """
import sys
from seethrough.experiment.cli import main
if main(sys.argv[1:]):
    raise SystemExit(2)
"""


PARTS = ("sizes", "accuracy", "reports")


def figures(only: Sequence[str] = PARTS) -> Iterator[Row]:
    """Sizes and coverages, worst first; accuracy against time; then whole reports."""
    if "sizes" in only:
        yield from sizes()
    if "accuracy" in only:
        yield from accuracy()
    for participants, seconds, gib in REPORTS if "reports" in only else ():
        yield from reports(participants, seconds, gib)
    if "reports" in only:
        yield from many_factors()


def contrast_scores(y: Array) -> float:
    """Ours."""
    f = repeated_measures(y, ["c"])["c"].f
    return f if is_defined(f) else float("nan")


def textbook(y: Array) -> float:
    """One pass of sums of squares, as textbooks print it."""
    n, k = y.shape
    correction = y.sum() ** 2 / (n * k)
    effect = (y.sum(axis=0) ** 2).sum() / n - correction
    people = (y.sum(axis=1) ** 2).sum() / k - correction
    error = (y**2).sum() - correction - effect - people
    return float((effect / (k - 1)) / (error / ((k - 1) * (n - 1))))


def statsmodels_anova(y: Array) -> float:
    """statsmodels' AnovaRM."""
    from statsmodels.stats.anova import AnovaRM

    n, k = y.shape
    table = pd.DataFrame(
        {"y": y.ravel(), "who": np.repeat(np.arange(n), k), "c": np.tile(np.arange(k), n)}
    )
    return float(AnovaRM(table, "y", "who", within=["c"]).fit().anova_table["F Value"].iloc[0])


def exact(y: Array) -> Fraction:
    """F in rational arithmetic, of two conditions."""
    gaps = [Fraction(float(a)) - Fraction(float(b)) for a, b in y]
    mean = sum(gaps, Fraction(0)) / len(gaps)
    variance = sum(((g - mean) ** 2 for g in gaps), Fraction(0)) / (len(gaps) - 1)
    return mean**2 * len(gaps) / variance


def accuracy() -> Iterator[Row]:
    """Relative error of F at each offset, and each way's time against ours."""
    rng = np.random.default_rng(1)
    base = np.round(4 * (rng.normal(size=(16, 1)) + rng.normal(size=(16, 2)))) / 4
    ways: dict[str, Callable[[Array], float]] = {
        "contrast scores": contrast_scores,
        "AnovaRM": statsmodels_anova,
        "one-pass textbook": textbook,
    }
    for name, way in ways.items():
        for offset in OFFSETS:
            y = base + offset
            true = exact(y)
            with warnings.catch_warnings(), np.errstate(all="ignore"):
                warnings.simplefilter("ignore")  # what the peers warn of is what is measured
                found = way(y)
            error = abs(found / float(true) - 1) if np.isfinite(found) else float("inf")
            must = 1e-9 if way is contrast_scores else None
            yield row(f"error of F, {name}", f"offset {offset:g}", error, "relative", must)
    times = {name: _seconds(way, base) for name, way in ways.items()}
    for name in ways:
        ratio = times[name] / times["contrast scores"]
        yield row(f"time of F, {name}", "16 × 2", ratio, "× contrast scores", None)


def _seconds(way: Callable[[Array], float], y: Array, turns: int = 20) -> float:
    """The least of many turns."""
    best = float("inf")
    for _ in range(turns):
        start = time.perf_counter()
        way(y)
        best = min(best, time.perf_counter() - start)
    return best


def reports(participants: int, seconds: float, gib: float | None) -> Iterator[Row]:
    """Wall time, and where it is bounded the peak memory, of `seethrough report`."""
    scene = f"{24 * participants} trials"
    with tempfile.TemporaryDirectory() as folder:
        data = make_data(Path(folder) / "data", participants)
        start = time.perf_counter()
        used = used_by(REPORT, "report", str(data), "--out", f"{folder}/out")
        yield row("report", scene, time.perf_counter() - start, "s", seconds)
        # what a busy machine does not change
        yield row("report, processor time", scene, used.cpu, "s")
        if gib is not None and used.peak is not None:
            yield row("memory of the report", scene, used.peak / 1024, "GiB", gib)
        size = (Path(folder) / "out" / "report.html").stat().st_size / 2**20
        yield row("report.html", scene, size, "MiB", 3.0 if participants == 16 else None)


def many_factors(people: int = 60, factors: int = 6, must: float = 20.0) -> Iterator[Row]:
    """A report of so many factors of two levels, each person once in every cell."""
    scene = f"{people} people × {factors} factors"
    with tempfile.TemporaryDirectory() as folder:
        data = make_factors(Path(folder) / "data", people, factors)
        start = time.perf_counter()
        used = used_by(REPORT, "report", str(data), "--out", f"{folder}/out")
        yield row("report", scene, time.perf_counter() - start, "s", must)
        yield row("report, processor time", scene, used.cpu, "s")


def make_factors(folder: Path, people: int, factors: int) -> Path:
    """A data folder of 2^factors cells within people: log-normal times, and a distance."""
    names = [f"f{i}" for i in range(1, factors + 1)]
    time_of = {"name": "time", "column": "time", "unit": "s", "direction": "less",
               "scale": "ratio", "adds": "mean", "log": True, "rows": "all"}  # fmt: skip
    off = {**time_of, "name": "off", "column": "off", "unit": "mm", "log": False}
    entry = {
        "factors": [{"name": n, "kind": "within", "levels": ["a", "b"], "baseline": "a"}
                    for n in names],
        "tasks": [{"name": "find", "code": "T1", "measures": [time_of, off]}],
    }  # fmt: skip
    folder.mkdir(parents=True)
    (folder / "dataset_description.json").write_text('{"name": "bench"}', "utf-8")
    rng = np.random.default_rng(3)
    cells = list(itertools.product("ab", repeat=factors))
    for slot in range(1, people + 1):
        name = f"P{slot:05d}"
        own = folder / "data" / "human" / name
        own.mkdir(parents=True)
        times = np.exp(rng.normal(3, 0.3) + rng.normal(0, 0.4, len(cells)))
        far = rng.gamma(3, 2, len(cells))
        rows = []
        for number, cell in enumerate(cells, start=1):
            made = _trial(name, slot, number, (1, "standard", "abstract", "find", 1), 1.0, 0)
            kept = {k: v for k, v in made.items() if k not in DESIGN.levels}
            kept |= dict(zip(names, cell, strict=True))
            kept["time"] = kept["time_clean"] = repr(float(times[number - 1]))
            rows.append({**kept, "off": repr(float(far[number - 1]))})
        stem = own / f"study-bench_subject-{name}_session-1"
        _write(Path(f"{stem}_trials_data.csv"), dict.fromkeys(rows[0], ""), rows)
        sidecar = {"study": "bench", "design": entry}
        Path(f"{stem}_trials_data.json").write_text(json.dumps(sidecar), "utf-8")
    return folder


def make_data(folder: Path, participants: int) -> Path:
    """A data folder of whole sessions: log-normal times, faster under dynamic transparency."""
    folder.mkdir(parents=True)
    (folder / "dataset_description.json").write_text('{"name": "bench"}', "utf-8")
    rng = np.random.default_rng(2)
    conditions = [(t, s) for t in ("standard", "dynamic") for s in ("abstract", "walkthrough")]
    tasks = {"abstract": ("count", "pattern"), "walkthrough": ("unique", "count_in_building")}
    for slot in range(1, participants + 1):
        name = f"P{slot:05d}"
        own = folder / "data" / "human" / name
        own.mkdir(parents=True)
        order = np.roll(np.arange(4), slot)
        cells = [
            (block, *conditions[i], task, k)
            for block, i in enumerate(order, start=1)
            for task in tasks[conditions[i][1]]
            for k in (1, 2, 3)
        ]
        times = np.exp(rng.normal(3, 0.3) + rng.normal(0, 0.4, len(cells)))
        rows = [
            _trial(name, slot, number, cell, float(seconds), int(off))
            for number, (cell, seconds, off) in enumerate(
                zip(cells, times, rng.integers(-2, 3, len(cells)), strict=True), start=1
            )
        ]
        stem = own / f"study-bench_subject-{name}_session-1"
        _write(Path(f"{stem}_trials_data.csv"), trial_columns(DESIGN), rows)
        Path(f"{stem}_trials_data.json").write_text(json.dumps({"study": "bench"}), "utf-8")
        ratings = [
            _rating(name, item, t, s, int(rng.integers(0, 5)))
            for t, s in conditions
            for item in ("efficiency", "ease", "enjoy")
        ]
        _write(Path(f"{stem}_questionnaire_data.csv"), answer_columns(DESIGN), ratings)
    return folder


def _trial(
    name: str, slot: int, number: int, cell: tuple[int, str, str, str, int], time: float, off: int
) -> Row:
    block, transparency, scenario, task, k = cell
    time *= 0.6 if transparency == "dynamic" else 1.0
    counting = task.startswith("count")
    return {
        "row_id": f"human-{name}-1-trial{number:03d}",
        "study": "bench",
        "participant": name,
        "session": 1,
        "source": "human",
        "slot": slot,
        "trial": number,
        "block": block,
        "task_set": (number - 1) // 3 + 1,
        "trial_in_set": k,
        "attempt": 1,
        "transparency": transparency,
        "scenario": scenario,
        "task": task,
        "scene": f"set{k}",
        "targets": 20,
        "answer": 20 + off if counting else "K",
        "truth": 20 if counting else "K",
        "correct": "true" if off == 0 else "false",
        "count_error": off if counting else "",
        "distance": 10.0 + off if task == "unique" else "",
        "time": repr(time),
        "time_clean": repr(time),
        "timed_out": "false",
        "frames": int(time * 60),
        "frames_missed": abs(off),
        "path_length": 50.0,
        "turned": 6.0,
    }


def _rating(name: str, item: str, transparency: str, scenario: str, value: int) -> Row:
    return {
        "row_id": f"human-{name}-1-{item}-{transparency}-{scenario}",
        "participant": name,
        "session": 1,
        "source": "human",
        "item": item,
        "transparency": transparency,
        "scenario": scenario,
        "value": value,
        "text": "",
    }


def _write(path: Path, columns: dict[str, str], rows: list[Row]) -> None:
    lines = [",".join(columns), *(",".join(str(r[c]) for c in columns) for r in rows)]
    path.write_text("\n".join(lines) + "\n", "utf-8")
