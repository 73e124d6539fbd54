"""Every shipped study from its file to its report: `seethrough bench studies [--only NAME,…]`.

Each is checked (its file, its design, and balance counted from the tables of 8 sessions), designed,
played by 8 simulated people and reported, by the program itself as a user would. Data mode plays
what needs no hands; techniques that somebody works with the pointer are played as drawn.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from seethrough import registry
from seethrough.benchmarks.rows import Row, row
from seethrough.experiment.study.config import Study, load, shipped

PEOPLE = 8
POOL = 8  # scenes a task in data mode: a dry run, no measurement
PARTS = tuple(name for name in shipped() if name != "demo")
STEPS = ("check", "design", "simulate", "report")
PROGRAM = (sys.executable, "-m", "seethrough")


def figures(only: Sequence[str] = PARTS) -> Iterator[Row]:
    """For each study: the steps that went through, people, trials and tables, and the seconds."""
    for name in only:
        with tempfile.TemporaryDirectory() as place:
            yield from through(name, Path(place))


def through(name: str, place: Path, people: int = PEOPLE, pool: int = POOL) -> Iterator[Row]:
    """One study's rows; `place` is an empty folder. A step that fails is told and ends it."""
    study = load(name)
    data, out = place / "data", place / "report"
    mode = ["visual"] if by_hand(study) else ["data", "--pool", str(pool)]
    commands = {
        "check": ["check", name, "--balance", "--slots", str(people)],
        "design": ["design", name, "--csv", str(place / "design.csv")],
        "simulate": ["simulate", name, "--participants", str(people), "--out", str(data),
                     "--mode", *mode],
        "report": ["report", str(data), "--out", str(out)],
    }  # fmt: skip
    start, passed = time.perf_counter(), 0
    for step in STEPS:
        run = subprocess.run([*PROGRAM, *commands[step]], capture_output=True, text=True)
        if run.returncode:
            told = (run.stderr or run.stdout).strip().splitlines()
            print(f"{name}: {step} ended with {run.returncode}: {told[-1] if told else ''}")
            break
        passed += 1
    yield row("steps that went through", name, passed, "of 4", len(STEPS), more=True)
    text = (out / "report.md").read_text("utf-8") if passed == len(STEPS) else ""
    counted = re.search(r"(\d+) simulated participants? ha\w+ data of (\d+) trials", text)
    yield row(
        "people in the report", name, int(counted[1]) if counted else 0, "", people, more=True
    )
    yield row("trials in the report", name, int(counted[2]) if counted else 0, "")
    tables = len(list((out / "tables").glob("*.csv"))) if text else 0
    yield row("tables of the report", name, tables, "")
    yield row("time of all steps", name, time.perf_counter() - start, "s")


def by_hand(study: Study) -> bool:
    """Whether a level's technique is worked with the pointer: what is seen then depends on it."""
    for part in study.parts.values():
        technique = registry.get("technique", part.technique_name)
        if "pointer" in technique.takes and getattr(part.technique, "mode", "active") == "active":
            return True
    return False


def summary(rows: Sequence[Row]) -> str:
    """A line for each study."""
    studies: dict[str, Mapping[str, float]] = {}
    for one in rows:
        studies.setdefault(one["scene"], {})
        studies[one["scene"]] = {**studies[one["scene"]], one["figure"]: one["value"]}
    lines = [
        "| study | steps | people | trials | tables | s |",
        "| --- | ---: | ---: | ---: | ---: | ---: |",
    ]
    for name, own in studies.items():
        steps, people, trials, tables, seconds = own.values()
        lines.append(
            f"| {name} | {steps:g} of 4 | {people:g} | {trials:g} | {tables:g} | {seconds:.0f} |"
        )
    return "\n".join(lines)
