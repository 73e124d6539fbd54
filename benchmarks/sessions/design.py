"""`seethrough bench design`: what it costs to work a study out, and what must not have changed.

Times are processor time: the machine may be busy with other work.
"""

from __future__ import annotations

import hashlib
import time
import tomllib
from collections.abc import Iterator

from seethrough.benchmarks.memory import used_by
from seethrough.benchmarks.rows import Row, row
from seethrough.experiment.study.config import load, parse
from seethrough.experiment.study.design.design import Design, session_for
from seethrough.experiment.study.shown.design_table import rows_of

# The 512 lines of the published study's trials and practice as a fixed 2 × 2 design had them.
BEFORE = "7bff85ab6bbae8c07520eb60501753e1a68649f0351a8d05459d9d66455dffca"
SLOTS = 1_000
TRIES = 3
HEAD = """
[study]
name = "large"
title = "Large"
description = "Three factors within and two between people, four levels each."
participants = 1000
seed = 1
[technique]
use = "dynamic"
[world]
use = "abstract"
[design]
tasks = ["count"]
trials = 1
"""
LARGE = f"""{HEAD}
[factors.a]
set = "technique.dynamic.alpha_target"
values = [0.1, 0.2, 0.3, 0.4]
[factors.b]
set = "technique.dynamic.width"
values = [5.0, 10.0, 15.0, 20.0]
[factors.c]
set = "world.abstract.distractors"
values = [80, 100, 120, 140]
[factors.d]
vary = "between"
set = "practice.trials"
values = [0, 1, 2, 3]
[factors.e]
vary = "between"
set = "practice.limit"
values = [60.0, 120.0, 180.0, 240.0]
"""
SIX_BY_THREE = """[study]
name = "sixbythree"
title = "Six views, three clutters, two groups"
description = "An example of the study language."
participants = 24
seed = 1
[factors.view]
levels.plain = { technique.use = "standard" }
levels.xray = { technique.use = "constant", technique.constant.alpha = 0.3 }
levels.dynamic = { technique.use = "dynamic" }
levels.cut20 = { technique.use = "adaptive_cutaway", technique.adaptive_cutaway.angle = 0.35 }
levels.cut45 = { technique.use = "adaptive_cutaway", technique.adaptive_cutaway.angle = 0.79 }
levels.cutaway = { technique.use = "cutaway" }
[factors.clutter]
set = "world.abstract.distractors"
values = [80, 180, 380]
order = "mixed"
[factors.training]
vary = "between"
levels.none = { practice.trials = 0 }
levels.some = { practice.trials = 2 }
[world]
use = "abstract"
[design]
tasks = ["count"]
trials = 2
"""
START = """
import sys, tomllib
from seethrough.experiment.study.config import find, parse
from seethrough.experiment.study.design.design import session_for
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.tasks.catalog import TASKS
from seethrough.renderer.gpu.device.context import standalone
text = find("published").read_text("utf-8") if sys.argv[1] == "published" else sys.argv[1]
study = parse(tomllib.loads(text), "s")
trial = session_for(1, study.plan)[0].trials[0]
task = TASKS[trial.task]
view = task.view(StudyScenes(study).begin(task, trial, 4 / 3))
Renderer(standalone(), (800, 600)).draw(view.scene, view.camera, study.part(trial.levels).technique)
study.digest()
"""


def figures() -> Iterator[Row]:
    """Each figure as it is measured."""
    same = plan_sha256(load("published").plan) == BEFORE
    what = "trials of the published study that are not as before"
    yield row(what, "384 trials", 384 * (not same),
              "trials", must=0)  # fmt: skip
    started = time.process_time()
    large = parse(tomllib.loads(LARGE), "large")
    trials = sum(1 for _ in rows_of(large, SLOTS))
    spent = time.process_time() - started
    scene = f"3 within × 2 between factors, 4 levels each: {SLOTS} slots, {trials} trials"
    yield row("working a design out", scene, spent, "s", must=10, aim=2)
    ratio = min(_start(LARGE) / _start("published") for _ in range(TRIES))
    yield row("start of a session", "such a study / the published one", ratio, "", 1.1, 1.02)
    parse(tomllib.loads(SIX_BY_THREE), "sixbythree")
    lines = len(SIX_BY_THREE.strip().splitlines())
    yield row("lines of a study", "six techniques × three clutters × two groups", lines, "lines",
              must=45, aim=30)  # fmt: skip


def plan_sha256(plan: Design) -> str:
    """A hash of every trial of 16 people: place, levels, task, scene and stream."""
    lines = [
        f"{slot} {t.number} {t.block} {t.task_set} {t.in_set} {' '.join(t.levels.values())} "
        f"{t.task} {t.scene} {t.stream} {t.training}"
        for slot in range(1, 17)
        for s in session_for(slot, plan)
        for t in (*s.training, *s.trials)
    ]
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()


def _start(study: str) -> float:
    """Processor time until a session's first frame is drawn, in a process of its own."""
    return used_by(START, study).cpu
