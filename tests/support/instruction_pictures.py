"""What the pictures on instruction pages show of what is asked for, seed by seed.

    python tests/support/instruction_pictures.py SEEDS

prints the least of it for each task and level, and from how many starts of a trial, where the
picture was taken once, nothing of it would be seen.
"""

import sys
from collections import defaultdict
from dataclasses import dataclass, replace
from types import SimpleNamespace

from seethrough.experiment.pages.pages import PICTURE_ASPECT
from seethrough.experiment.session.trial import TrialRun
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import session_for
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.tasks.catalog import TASKS

SIZE = (288, 216)  # that of a picture in a window of 800 × 600
SEEN = 12  # pixels of an object that can be made out


@dataclass(frozen=True)
class Sight:
    """Of what is asked for: the largest thing's part of the picture, how many things of how many
    show at least `SEEN` pixels, and the largest part in the view that a trial begins with."""

    largest: float
    seen: int
    asked: int
    at_start: float


def sights(renderer, seed):
    """((task, level), sight) of each instruction of a slot of the published study with a seed."""
    study = load("published")
    study = replace(study, general=study.general.model_copy(update={"seed": seed}))
    display = SimpleNamespace(aspect=PICTURE_ASPECT)
    run = TrialRun(study, SimpleNamespace(scenes=None, display=display, tasks=TASKS))
    for task_set in session_for(1 + seed % 16, study.plan):
        trial = task_set.trials[0]
        task, view = TASKS[trial.task], run.preview(trial)
        state = run.begin(run.scenes.example(trial))
        asked = list(task.example(state, PICTURE_ASPECT).asked)
        pixels, start = (
            renderer.look(view.scene, camera, run.technique(trial), SIZE).pixels[asked]
            for camera in (view.camera, task.view(state).camera)
        )
        whole, seen = SIZE[0] * SIZE[1], int((pixels >= SEEN).sum())
        sight = Sight(pixels.max() / whole, seen, len(asked), start.max() / whole)
        yield (trial.task, trial.levels["transparency"]), sight


def main(seeds):
    """The least of each, over so many seeds."""
    renderer, found = Renderer(standalone(), SIZE), defaultdict(list)
    for seed in range(1, seeds + 1):
        for which, sight in sights(renderer, seed):
            found[which].append(sight)
        print(f"{seed} of {seeds} seeds", file=sys.stderr, flush=True)
    for (task, level), all_ in sorted(found.items()):
        print(
            f"{task:18s}{level:9s} {len(all_):3d} pictures: the largest thing asked for fills at "
            f"least {min(s.largest for s in all_):.2%}; seen at least {min(s.seen for s in all_)} "
            f"things, {min(s.seen / s.asked for s in all_):.0%} of them; nothing at the start in "
            f"{sum(s.at_start == 0 for s in all_)}"
        )


if __name__ == "__main__":
    main(int(sys.argv[1]))
