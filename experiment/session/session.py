"""The state machine of a session. Knows Protocols only: the same code runs in the window,
offscreen, and in tests.

    welcome → consent, demographics, colour check → for each task set: its instruction,
    training, trials (a break between conditions) → questionnaire → thanks
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

from seethrough.experiment.display.display import DisplayLost, Leave
from seethrough.experiment.pages.pages import Page, Paragraph, Picture, PlanPicture, Values
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.session import levels, questionnaire
from seethrough.experiment.session.moments import Moment, moments_of
from seethrough.experiment.session.questionnaire import Given, Item, Said, Step
from seethrough.experiment.session.strangers import PluginFailed
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.experiment.session.trial import TrialRun
from seethrough.experiment.study.config import Study
from seethrough.experiment.study.design.design import TaskSet, Trial, session_for
from seethrough.tasks.kit.base import OwnControls, OwnFeedback, Task
from seethrough.tasks.kit.unsure import UNKNOWN


class TimeIsUp(Leave):
    """The session's own time limit ended it."""


def run_session(
    study: Study,
    slot: int,
    world: Surroundings,
    done: frozenset[int] = frozenset(),
    given: Given | None = None,
) -> str:
    """Run a slot's session: `complete`, `left` or `time limit`. Raises DisplayLost, PluginFailed.

    Trials numbered in `done` are not played again, and what was answered in `given` is not asked
    again (experiment/session/resume.py).
    """
    status = "left"
    try:
        _run(study, slot, world, done, given or {})
        status = "complete"
    except TimeIsUp:
        status = "time limit"
    except DisplayLost:
        status = "display lost"
        raise
    except PluginFailed:
        status = "plug-in failed"
        raise
    except Leave:
        pass  # the caller and the record are told by the status
    finally:
        world.recorder.close(status)
    return status


def _run(study: Study, slot: int, world: Surroundings, done: frozenset[int], given: Given) -> None:
    start = world.clock.now()
    task_sets = session_for(slot, study.plan)
    total = sum(len(s.trials) for s in task_sets)
    # What was asked after trials that are played again is asked again.
    asker = _Asker(study, slot, world, questionnaire.of_trials(given, done), moments_of(task_sets))
    world.display.progress(len(done) / total)
    world.input.ask(_page("welcome"))
    if not done:
        asker.ask(questionnaire.before(study, slot))
    run = TrialRun(study, world)
    block = None
    for task_set in task_sets:
        remaining = tuple(t for t in task_set.trials if t.number not in done)
        for trial in task_set.trials:
            if trial.number in done:  # it may have been broken off before what is asked after it
                asker.between("trial", trial)
        if remaining and block not in (None, remaining[0].block):
            world.input.ask(_page("pause"))
        if remaining:
            block = remaining[0].block
            _run_task_set(study, TaskSet(task_set.training, remaining), total, run, asker)
        for when in ("task_set", "condition"):
            asker.between(when, task_set.trials[-1])
        if remaining and _over(world.clock.now() - start, study.session.limit):
            world.input.ask(_page("time"))
            raise TimeIsUp
    asker.ask(questionnaire.after(study, slot))
    world.input.ask(_page("thanks"))


@dataclass(frozen=True)
class _Asker:
    """Asks what a study asks, and knows what was answered."""

    study: Study
    slot: int
    world: Surroundings
    known: dict[Item, Said]
    moments: tuple[Moment, ...]

    def ask(self, steps: Iterator[Step]) -> None:
        """Each page's answers are on disk before the next page is shown."""
        for rows in questionnaire.asked(steps, self.world.input, self.known):
            self.world.recorder.answers(rows)

    def between(self, when: str, trial: Trial) -> None:
        """What is asked after a trial, or a task set or condition that it ends."""
        for now in self.moments:
            if now.when == when and now.trial == trial.number:
                self.ask(questionnaire.between(self.study, self.slot, now, self.moments))


def _page(name: str) -> Page:
    return Page(name, f"{name}.title", (Paragraph(f"{name}.text"),))


def _run_task_set(
    study: Study, task_set: TaskSet, total: int, run: TrialRun, asker: _Asker
) -> None:
    world = run.world
    sets = sum(m.when == "task_set" for m in asker.moments)
    world.input.ask(_instruction(study, task_set.trials[0], sets, run))
    _train(study, task_set, run)
    for trial in task_set.trials:
        again = True
        while again:
            record = run.play(trial, study.part(trial.levels).task_options.limit(trial.task))
            world.recorder.trial_ends(record)
            world.progress(record)
            again = record.repeat
        asker.between("trial", trial)
        world.display.progress(trial.number / total)


def _train(study: Study, task_set: TaskSet, run: TrialRun) -> None:
    """The training trials, each with feedback, until the study's limit or criterion."""
    world, practice = run.world, study.part(task_set.trials[0].levels).practice
    limit = practice.limit
    if practice.explore and world.explores:
        run.play(run.scenes.exploring(task_set.trials[0]), practice.explore)
    right: list[bool] = []
    began = world.clock.now()
    for trial in task_set.training:
        if practice.until is not None and sum(right[-practice.until[1] :]) >= practice.until[0]:
            break
        left = limit - (world.clock.now() - began)
        if limit and left <= 0:
            break
        record = run.play(trial, left if limit else 0.0)
        right.append(record.outcome is not None and record.outcome.correct)
        world.input.ask(_feedback(record, world.tasks[trial.task]))
    if task_set.training:
        world.input.ask(_page("ready"))


def _instruction(study: Study, trial: Trial, total: int, run: TrialRun) -> Page:
    values = (("set", str(trial.task_set)), ("sets", str(total)))
    return Page(
        "instruction",
        run.world.tasks[trial.task].title,
        (
            Paragraph(run.world.tasks[trial.task].instruction),
            Paragraph(_controls(study, trial, run.world.tasks[trial.task])),
            *levels.instructions(study, trial.levels),
            *levels.hands(study, trial),
            Picture(partial(run.preview, trial), run.technique(trial)),
            Paragraph("progress", values),
        ),
        ("begin",),
        about=levels.of_blocks(study, trial.levels),
    )


def _controls(study: Study, trial: Trial, task: Task) -> str:
    """How one moves, as the task says it, or as its world does."""
    setting = study.setting(trial)
    return task.controls(setting) if isinstance(task, OwnControls) else setting.controls


def _feedback(record: TrialRecord, task: Task) -> Page:
    outcome = record.outcome
    if outcome is None:
        return Page("feedback", "feedback.title", (Paragraph("feedback.time"),))
    values: Values = (("answer", outcome.answer), ("truth", outcome.truth))
    if outcome.answer == UNKNOWN:
        return Page("feedback", "feedback.title", (Paragraph("feedback.unsure"),))
    text = "feedback.right" if outcome.correct else "feedback.wrong"
    if isinstance(task, OwnFeedback):
        text, said = task.feedback(outcome)
        values = tuple(said.items())
    pictures = () if record.solution is None else (PlanPicture(record.solution),)
    return Page("feedback", "feedback.title", (Paragraph(text, values), *pictures))


def _over(passed: float, limit: float) -> bool:
    return bool(limit) and passed > limit
