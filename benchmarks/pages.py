"""From one page of a long questionnaire to the next: figures of `seethrough bench worlds`.

The pages are those of a session: made by its questionnaire, laid out, drawn, answered and recorded.
Times are processor time of all threads, since the machine may be busy; waiting for the disk is not.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from seethrough.benchmarks.rows import Row, row
from seethrough.experiment.display.stage import Stage
from seethrough.experiment.pages.form import Form
from seethrough.experiment.pages.pages import Answers, Page
from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.session import questionnaire
from seethrough.experiment.study.config import parse
from seethrough.experiment.study.shown.described import design_entry
from seethrough.experiment.study.study import Study
from seethrough.experiment.study.translations import texts_of
from seethrough.renderer.gpu.device.context import standalone

ITEMS = 60
SIZE = (800, 600)
ON_A_PAGE = (1, 10)
MUST, AIM = 100.0, 33.0  # ms


def study_of(per_page: int) -> Study:
    """A study with so many own items, so many on each page."""
    items = [f"Statement {n}: I could see what I was looking for." for n in range(1, ITEMS + 1)]
    asked = {"use": "likert", "when": "end", "items": items, "points": 7, "per_page": per_page}
    return parse(
        {
            "study": {"name": "long", "title": "Long", "description": "60 items.",
                      "participants": 1, "seed": 1},
            "technique": {"use": "standard"}, "world": {"use": "abstract"},
            "design": {"tasks": ["count"], "trials": 1}, "questions": {"long": asked},
        },
        "long",
    )  # fmt: skip


class _Turning:
    """Draws each page until it stands, answers it, and notes when the first frame was shown."""

    def __init__(self, stage: Stage) -> None:
        self.stage = stage
        context = stage.context
        self.target = context.framebuffer([context.texture(SIZE, 4)])
        self.answered = 0.0
        self.took: list[float] = []

    def ask(self, page: Page) -> Answers:
        form = Form(page)
        self.stage.draw_form(form, self.target, 1 / 60)
        self.stage.context.finish()
        if self.answered:
            self.took.append(1000 * (time.process_time() - self.answered))
        self.stage.draw_form(form, self.target, 1 / 60)
        self.answered = time.process_time()
        return {"button": "0", **dict.fromkeys(page.required, "3")}


def page_figures() -> Iterator[Row]:
    """From an answered page to the next one's first frame, the answers on disk in between."""
    stage = None
    for per_page in ON_A_PAGE:
        study = study_of(per_page)
        stage = stage or Stage(standalone(), SIZE, texts_of(study, "en"))
        turning = _Turning(stage)
        with tempfile.TemporaryDirectory() as folder:
            who = Who("long", "P01", "human", 1, {}, design=design_entry(study))
            recorder = FileRecorder(Path(folder), who)
            for rows in questionnaire.asked(questionnaire.after(study, 1), turning):
                recorder.answers(rows)
            recorder.close("complete")
        pages = len(turning.took) + 1
        scene = f"{ITEMS} own items on {pages} pages"
        median, worst = sorted(turning.took)[len(turning.took) // 2], max(turning.took)
        yield row("page to page, median", scene, median, "ms", MUST, AIM)
        yield row("page to page, worst", scene, worst, "ms", MUST, AIM)
