"""Draws every page and task of the published session into docs/pictures/guide/, for the guide.

python docs/make_guide_pictures.py
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from PIL import Image

from seethrough.experiment.display.display import LEAVE
from seethrough.experiment.display.stage import Stage
from seethrough.experiment.pages.form import Form
from seethrough.experiment.pages.pages import Page
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.session.questionnaire import after, asked, before
from seethrough.experiment.session.running import MENU
from seethrough.experiment.session.session import _feedback, _instruction, _page
from seethrough.experiment.session.trial import TrialRun
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import Trial, session_for
from seethrough.experiment.study.tables.ready import one_page
from seethrough.renderer.events import KeyPress
from seethrough.renderer.gpu.device.context import standalone
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import Outcome
from seethrough.tasks.kit.hud import practice_mark

SIZE = (800, 600)
ENTER = KeyPress(0.0, "enter")
OUT = Path(__file__).parent / "pictures" / "guide"


class Camera:
    """Draws pages and views offscreen and keeps the pictures."""

    def __init__(self) -> None:
        self.study = load("published")
        context = standalone()
        self.stage = Stage(context, SIZE, Texts(self.study.general.language, self.study.texts), 4)
        self.target = context.framebuffer([context.texture(SIZE, 4)])

    def keep(self, name: str) -> None:
        """Write the picture as a small PNG."""
        pixels = np.frombuffer(self.target.read(components=3, alignment=1), np.uint8)
        picture = Image.fromarray(pixels.reshape(SIZE[1], SIZE[0], 3)[::-1])
        picture = picture.quantize(128, dither=Image.Dither.NONE)
        picture.save(OUT / f"{name}.png", optimize=True)
        print(OUT / f"{name}.png")

    def page(self, page: Page, name: str | None = None, **how: Any) -> None:
        """A page; drawn a few times, because ImGui settles its layout over two frames."""
        form = Form(page, **how)
        for _ in range(4):
            self.stage.draw_form(form, self.target, 1 / 60)
        self.keep(name or page.name.replace(" ", "-"))

    def ask(self, page: Page) -> dict[str, str]:
        """Stands in for a participant: keeps each page once, answers with the first option."""
        if not (OUT / f"{page.name.replace(' ', '-')}.png").exists():
            self.page(page)
        return {"button": "0", "age": "", **dict.fromkeys(page.required, "0")}


def main() -> None:
    """Every page in the order of a session."""
    OUT.mkdir(parents=True, exist_ok=True)
    for old in OUT.glob("*.png"):
        old.unlink()
    camera = Camera()
    study = camera.study
    camera.page(_page("welcome"))
    list(asked(before(study, 1), camera))  # type: ignore[arg-type]
    run = TrialRun(study, SimpleNamespace(scenes=None, display=camera.stage, tasks=TASKS))  # type: ignore[arg-type]
    task_sets = session_for(1, study.plan)
    shown = set()
    for number, task_set in enumerate(task_sets):
        camera.stage.done = number / len(task_sets)
        trial = task_set.trials[0]
        if trial.levels["transparency"] == "dynamic" or trial.task not in shown:
            shown.add(trial.task)
            camera.page(_instruction(study, trial, 8, run), f"instruction-{trial.task}")
            _task(camera, run, trial)
    for page in (_page("ready"), _page("pause"), _page("time"), LEAVE, MENU):
        camera.page(page)
    wrong = Outcome("12", "14", False, count_error=-2)
    trial = task_sets[0].trials[0]
    record = TrialRecord(trial, wrong, 14, 0.0, 30.0, 0.0, False, 1800, 0, 0.0, 0.0, 0.0)
    camera.page(_feedback(record, TASKS[trial.task]))
    camera.page(_page("pause"), "waiting", waiting="wait.scene")
    camera.page(
        one_page("ratings", transparency="dynamic", scenario="abstract"),
        "missing",
        answers={"ease": "3"},
        insisted=True,
    )
    camera.stage.done = 1.0
    camera.page(one_page("tlx", transparency="dynamic"), "tlx")
    camera.page(one_page("sus", transparency="dynamic"), "sus")
    camera.stage.pilot = True
    camera.page(_page("pause"), "pilot")
    camera.stage.pilot = False
    list(asked(after(study), camera))  # type: ignore[arg-type]
    camera.page(_page("thanks"))


def _task(camera: Camera, run: TrialRun, trial: Trial) -> None:
    task, state = TASKS[trial.task], run.begin(trial)
    steps = [("", ())]
    if trial.task == "unique":
        steps.append(("-mark", ("space", "right", "right", "up")))
    for suffix, keys in steps:
        for key in keys:
            state = task.on_event(state, KeyPress(0.0, key))
        for _ in range(3):
            camera.stage.draw_view(task.view(state), run.technique(trial), camera.target, 1 / 60)  # type: ignore[arg-type]
        camera.keep(f"task-{trial.task}{suffix}")
    if trial.task == "unique":
        _practice(camera, run, trial, task.on_event(state, ENTER))


def _practice(camera: Camera, run: TrialRun, trial: Trial, state: Any) -> None:
    """A practice trial as it begins, with Enter pressed too early, and the feedback of another."""
    count = TASKS["count_in_building"]
    example = run.scenes.example(replace(trial, task=count.name))
    early = count.on_event(run.scenes.begin(count, example, camera.stage.aspect), ENTER)
    view = count.view(early)
    view = replace(view, hud=(*view.hud, practice_mark(camera.stage.aspect)))
    for _ in range(3):
        camera.stage.draw_view(view, run.technique(trial), camera.target, 1 / 60)  # type: ignore[arg-type]
    camera.keep("practice")
    task = TASKS[trial.task]
    record = TrialRecord(
        trial, task.outcome(state), 1, 0.0, 30.0, 0.0, False, 1800, 0, 0.0, 0.0, 0.0
    )
    solved = replace(record, solution=task.solution(state))
    camera.page(_feedback(solved, task), "feedback-unique")


if __name__ == "__main__":
    main()
