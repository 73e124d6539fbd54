"""Every shipped study from its file to its report: `seethrough bench studies [--only NAME,…]`.

`--full` checks with pictures besides: how hard the scenes are, level by level and set by set, and
what techniques do to them. A machine without a graphics card fails at frame rates: no fault of a
study.

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
from seethrough.experiment.verdicts import FAILS

FIGURE = "steps that went through"
PEOPLE = 8
POOL = 8  # scenes a task in data mode: a dry run, no measurement
PARTS = tuple(name for name in shipped() if name != "demo")
STEPS = ("check", "design", "simulate", "report")
SCENES = "scenes"  # the check with pictures
SECONDS = "0.5"  # of the hardest scene of each technique: frame rates are the machine's
PROGRAM = (sys.executable, "-m", "seethrough")


def figures(only: Sequence[str] = PARTS, full: bool = False) -> Iterator[Row]:
    """For each study: the steps that went through, people, trials and tables, and the seconds."""
    for name in only:
        with tempfile.TemporaryDirectory() as place:
            yield from through(name, Path(place), full=full)


def thorough(only: Sequence[str] = PARTS) -> Iterator[Row]:
    """The same, scenes measured as well: what `--full` asks for."""
    return figures(only, full=True)


def through(
    name: str, place: Path, people: int = PEOPLE, pool: int = POOL, full: bool = False
) -> Iterator[Row]:
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
        SCENES: ["check", name, "--seconds", SECONDS, "--scenes", str(place / "scenes.png"),
                 "--models", str(place / "models.png")],
    }  # fmt: skip
    steps = (*STEPS, SCENES) if full else STEPS
    start, passed = time.perf_counter(), 0
    for step in steps:
        run = subprocess.run([*PROGRAM, *commands[step]], capture_output=True, text=True)
        told = _failed(step, run)
        if told:
            print(f"{name}: {step} ended with {run.returncode}: {told}")
            break
        passed += 1
    yield row(FIGURE, name, passed, f"of {len(steps)}", len(steps), more=True)
    text = (out / "report.md").read_text("utf-8") if passed >= len(STEPS) else ""
    counted = re.search(r"(\d+) simulated participants? ha\w+ data of (\d+) trials", text)
    yield row(
        "people in the report", name, int(counted[1]) if counted else 0, "", people, more=True
    )
    yield row("trials in the report", name, int(counted[2]) if counted else 0, "")
    tables = len(list((out / "tables").glob("*.csv"))) if text else 0
    yield row("tables of the report", name, tables, "")
    yield row("time of all steps", name, time.perf_counter() - start, "s")


def _failed(step: str, run: subprocess.CompletedProcess[str]) -> str:
    """What a step says where it failed; "" where it did not. Whether this machine is quick enough
    for a session is no fault of the scenes."""
    if not run.returncode:
        return ""
    lines = run.stdout.splitlines()
    failures = [line for line in lines if f": {FAILS}" in line and not line.startswith("verdict")]
    of_machine = [line for line in failures if line.startswith("machine ")]
    if step == SCENES and run.returncode == 1 and failures and failures == of_machine:
        return ""
    told = failures or (run.stderr or run.stdout).strip().splitlines()
    return told[-1] if told else "nothing said"


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
    of = max((one["must"] for one in rows if one["figure"] == FIGURE and one["must"]), default=0)
    lines = [
        "| study | steps | people | trials | tables | s |",
        "| --- | ---: | ---: | ---: | ---: | ---: |",
    ]
    for name, own in studies.items():
        steps, *counts, seconds = own.values()
        cells = [f"{steps:g} of {of:g}", *(f"{count:g}" for count in counts), f"{seconds:.0f}"]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return "\n".join(lines)
