"""`seethrough bench worlds`: what it costs to bring a scene or a task of one's own.

Times are processor time, all threads together: the machine may be busy with other work, and on an
idle one nothing takes longer than that.
"""

from __future__ import annotations

import difflib
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path

import numpy as np

from seethrough.benchmarks.pages import page_figures
from seethrough.benchmarks.rows import Row, row
from seethrough.experiment.session.hand import COARSE, PICKED
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import session_for
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.renderer.models.forms.surfaces import ball
from seethrough.renderer.models.scene_file import read_scene
from seethrough.renderer.models.shipped.glb import Node, glb
from seethrough.renderer.reference.pointed import is_local, pointed
from seethrough.renderer.scene.transforms import translation
from seethrough.renderer.techniques.base import Shot
from seethrough.tasks.catalog import TASKS

PARTS = ("task", "office", "large", "click", "pages")
LARGE = 500_000  # triangles
SIDES = 142  # of each ball: 20,022 triangles
# What somebody writes who takes the package of `new task` and asks something else with it.
CHANGED = (
    ('"""Is anything red to be seen? Y or N."""', '"""Are there more than 20 targets? Y or N."""'),
    ('hands.key("y" if glance.look().visible.any() else "n")',
     "seen = glance.look().visible & glance.view.scene.targets\n"
     '    hands.key("y" if seen.sum() > 20 else "n")'),
    ('"NAME.title": "Red?"', '"NAME.title": "More than 20?"'),
    ('return Outcome(state.said, "y", state.said == "y") if state.said else None',
     'truth = "y" if state.place.scene.targets.sum() > 20 else "n"\n'
     "        return Outcome(state.said, truth, state.said == truth) if state.said else None"),
)  # fmt: skip
STUDY = """[study]
name = "mine"
title = "More than 20?"
description = "A task of one's own."
participants = 2
seed = 1
[factors.view]
levels.plain = { technique.use = "standard" }
levels.dynamic = { technique.use = "dynamic" }
[world]
use = "abstract"
[design]
tasks = ["more"]
trials = 1
"""
OFFICE = """[study]
name = "office"
title = "An office"
description = "Finding things in three rooms."
participants = 8
seed = 2
[factors.view]
levels.plain = { technique.use = "standard" }
levels.dynamic = { technique.use = "dynamic" }
[world]
use = "scene"
[world.scene]
files = ["office"]
move = "walk"
[design]
tasks = ["locate"]
trials = 8
[practice]
trials = 1
"""


def figures(only: list[str] | None = None) -> Iterator[Row]:
    """Every row."""
    measured = {"task": _task, "office": _office, "large": _large, "click": _click,
                "pages": page_figures}  # fmt: skip
    for part in only or PARTS:
        yield from measured[part]()


def _task() -> Iterator[Row]:
    """Lines that are written, of a task that then passes its suite and goes through `check`."""
    template = files("seethrough.experiment.suites").joinpath("templates", "task.txt")
    before = template.read_text("utf-8")
    after = before
    for old, new in CHANGED:
        if old not in after:
            raise ValueError(f"the template has changed: expected {old!r} in it")
        after = after.replace(old, new)
    changed = difflib.ndiff(before.splitlines(), after.splitlines())
    lines = sum(line.startswith("+ ") for line in changed) + len(STUDY.splitlines())
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        about = folder / "more-1.dist-info"
        about.mkdir()
        (about / "METADATA").write_text("Metadata-Version: 2.1\nName: more\nVersion: 1\n")
        (about / "entry_points.txt").write_text("[seethrough.tasks]\nmore = more:TASK\n")
        (folder / "more.py").write_text(after.replace("NAME", "more"))
        (folder / "mine.toml").write_text(STUDY)
        for words in (("task", "check", "more"), ("check", "mine.toml", "--config-only")):
            _seethrough(words, folder, {"PYTHONPATH": name})
    scene = "a changed `new task`, its study; suite and check pass"
    yield row("lines written for a new task", scene, lines, "lines", must=60, aim=35)


def _office() -> Iterator[Row]:
    """The whole of `check`, with the certificate of every trial."""
    with tempfile.TemporaryDirectory() as name:
        (Path(name) / "office.toml").write_text(OFFICE)
        words = ("check", "office.toml", "--seconds", "1", "--certificate", "c.csv")
        spent = _seethrough(words, Path(name), {}, (0, 1))
        rows = len((Path(name) / "c.csv").read_text().splitlines()) - 1
    yield row("check with its certificate", f"office, {rows} trials", spent, "s", must=90, aim=30)


def _large() -> Iterator[Row]:
    """A file of half a million triangles, each mesh another one; opened, then drawn."""
    from seethrough.experiment.display.driver import open_context
    from seethrough.experiment.session.machine import frame_times

    one = ball(1.0, (0.6, 0.6, 0.65), SIDES)
    count = -(-LARGE // len(one.triangles))
    rng = np.random.default_rng(17)
    shapes, nodes = {}, []
    for k in range(count):
        x, y, z = rng.uniform(-8, 8, 3).tolist()
        shapes[f"ball {k}"] = one.scaled(*rng.uniform(0.5, 1.5, 3).tolist())
        place, tags = translation(x, y, z), {"target": k % 5 == 0}
        nodes.append(Node(f"ball {k}", f"ball {k}", place, tags))
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "large.glb"
        path.write_bytes(glb(nodes, shapes, "a benchmark"))
        started = time.process_time()
        found = read_scene(path)
        spent = time.process_time() - started
        scene = f"{found.triangles} triangles, {len(found.things)} things"
        yield row("opening a scene", scene, spent, "s", must=10, aim=4)
        study = OFFICE.replace('["office"]', '["large.glb"]').replace('"walk"', '"orbit"')
        (Path(name) / "large.toml").write_text(study.replace("trials = 8", "trials = 1"))
        made = load(str(Path(name) / "large.toml"))
        trial = session_for(1, made.plan)[0].trials[0]
        times = frame_times(made, trial, open_context(), 3.0)
        yield row("its frames here, median", f"{scene}, dynamic", times.median, "ms")


def _click() -> Iterator[Row]:
    """What a press takes before the next frame can be drawn."""
    study = load("locate")
    scenes, task, seen = StudyScenes(study), TASKS["locate"], set()
    for task_set in session_for(1, study.plan):
        trial = task_set.trials[0]
        part = study.part(trial.levels)
        if part.technique_name in seen:
            continue
        seen.add(part.technique_name)
        view = task.view(scenes.begin(task, trial, 4 / 3))
        high = PICKED if is_local(part.technique) else COARSE
        shot = Shot(view.scene, view.camera, (round(high * 4 / 3), high))
        state = part.technique.technique.begin(part.technique)
        pointed(shot, part.technique, state, (0.6, 0.5))  # compiled, and kept
        started = time.process_time()
        pointed(shot, part.technique, state, (0.66, 0.5))
        spent = 1000 * (time.process_time() - started)
        yield row("what a click hits", f"jeep, {part.technique_name}", spent, "ms")


def _seethrough(
    words: tuple[str, ...], folder: Path, more: dict[str, str], statuses: tuple[int, ...] = (0,)
) -> float:
    """Processor time of a command in a process of its own. Raises ValueError where it fails."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run = subprocess.run(
        [sys.executable, "-m", "seethrough", *words], cwd=folder, env={**os.environ, **more},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if run.returncode not in statuses:
        raise ValueError(f"{' '.join(words)}: {run.stdout[-2000:]}{run.stderr[-2000:]}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
