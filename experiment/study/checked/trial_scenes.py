"""The scenes that trials are made in, before anybody looks at them: are there enough targets, is
one trial another than the next, are a file's things told apart?"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from seethrough.experiment.study.checked.scene_sheet import scenes_of
from seethrough.experiment.study.design.design import Trial, generator, session_for
from seethrough.experiment.study.study import Study
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.experiment.verdicts import FAILS, WARNING
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import Needs
from seethrough.tasks.worlds.scene.scene_place import ScenePlace, opened
from seethrough.tasks.worlds.scene.standing import ROUND

Said = tuple[str, str, str]  # what, the verdict, and what was expected
MOST_NAMES = 6


def odd_files(study: Study) -> Iterator[Said]:
    """What a study says of its scenes' files that may not be what it means."""
    for p, file in scenes_of(study):
        place = opened(p, file)
        twice = _called_alike(place)
        if twice:
            more = f" and {len(twice) - MOST_NAMES} more" if len(twice) > MOST_NAMES else ""
            named = ", ".join(f"{name} ({count})" for name, count in twice[:MOST_NAMES])
            yield (
                f"{file}: targets of one name: {named}{more}", WARNING,
                "expected a name of its own for each: an item asks for the first, a tag says it of "
                "all, and a click on any of them is right",
            )  # fmt: skip
        if p.move == "fixed" and not place.cameras:
            yield (
                f'{file}: move = "fixed" without a camera in the file', WARNING,
                f"expected cameras; as it is, people step through {ROUND} views round the middle",
            )  # fmt: skip


def _called_alike(place: ScenePlace) -> list[tuple[str, int]]:
    names = Counter(place.names[i] for i in place.targets)
    return [(name, count) for name, count in names.items() if count > 1]


def odd_trials(study: Study) -> Iterator[Said]:
    """Tasks whose scenes lack targets, and tasks whose trials are all the same one. Raises NoScene
    where there is none."""
    scenes, found = StudyScenes(study), dict[tuple[str, str], Said]()
    for sample in _samples(study):
        trial, again = sample[0], len(sample)
        part, task = study.part(trial.levels), TASKS[trial.task]
        least = task.least if isinstance(task, Needs) else 0
        setting = scenes.setting(trial)
        rng = generator(study.general.seed, trial.stream)
        before = rng.bit_generator.state
        made = task.make_scene(rng, setting)
        there, where = int(made.scene.targets.sum()), f"{trial.task} in the world {part.world}"
        if there < least:
            found["few", where] = (
                f"{where}: its scenes have {there} targets", FAILS,
                f"expected {least} or more, which the task says that it needs (least = {least})",
            )  # fmt: skip
        if again > 1 and setting.item is None and rng.bit_generator.state == before:
            found["same", where] = (
                f"{where}: {again} trials of a person, each the same scene and question", WARNING,
                "expected more scenes, or a task that draws something or has items of its own",
            )  # fmt: skip
    yield from found.values()


def _samples(study: Study) -> Iterator[list[Trial]]:
    """The trials of one person of each group, of each task in each place."""
    for group in range(len(study.plan.groups)):
        by: dict[tuple[object, str], list[Trial]] = {}
        for task_set in session_for(study.plan.slot_of(group, 1), study.plan):
            for trial in task_set.trials:
                key = (study.part(trial.levels).place, trial.task)
                by.setdefault(key, []).append(trial)
        yield from by.values()
