"""Pages: reading them, and opinions formed from how long things took."""

from __future__ import annotations

from math import exp, hypot, log2
from statistics import fmean

import numpy as np
from numpy.random import Generator

from seethrough.experiment.pages.pages import (
    PICTURE_ASPECT,
    Answers,
    Choice,
    Page,
    Paragraph,
    Picture,
    PlatePicture,
    Ranking,
    Scale,
    Several,
    TextField,
    on_picture,
)
from seethrough.experiment.people.persons.person import Person
from seethrough.tasks.catalog import TASKS, world_of

READ = 4.0  # seconds a paragraph: some 15 words at 240 words a minute [ours]
DECIDE = 3.0  # seconds an item of a questionnaire [ours]
MIDDLE, STEEPNESS, WOBBLE = 0.57, 0.28, 0.15  # ratings, 0–1, against log2 of relative time [ours]


def scenario_of(task: str) -> str:
    """What tables call the world that a task is set in."""
    return world_of(TASKS[task]).scenario


class Opinions:
    """Remembers what took how long under what instruction, and answers accordingly."""

    def __init__(self, person: Person) -> None:
        self.person = person
        self._level = ""
        self._times: dict[tuple[str, str], list[float]] = {}

    def begin(self, task: str) -> None:
        """A trial of `task` begins, under the instruction read last."""
        self._times.setdefault((self._level, task), []).append(0.0)

    def spent(self, task: str, seconds: float) -> None:
        """The running trial has taken so long by now."""
        self._times[self._level, task][-1] = seconds

    def answer(self, page: Page) -> tuple[dict[str, str], float]:
        """Answers by name ("button": which one), and the seconds that took."""
        seconds = 1.0
        for block in page.blocks:
            if isinstance(block, Paragraph):
                if block.text.startswith("transparency."):
                    self._level = block.text.removeprefix("transparency.")
                seconds += READ
            elif isinstance(block, Scale | Choice | Several | Ranking):
                needed = isinstance(block, Scale) or not block.optional
                seconds += DECIDE if needed else 0.0
        answers = self.by_blocks(page) if page.simulate is None else page.simulate(self)
        return answers, seconds * self.person.profile.pace

    @property
    def rng(self) -> Generator:
        """What makes the choices of this person."""
        return self.person.rng

    def by_blocks(self, page: Page) -> Answers:
        """Answers by what a page is made of: what was quick is liked, what may be left open is."""
        answers = {"button": "0"}
        for block in page.blocks:
            if isinstance(block, Scale):
                answers[block.name] = str(self._rating(page, block))
            elif isinstance(block, Choice) and not block.optional:
                answers[block.name] = str(self._choice(page, block))
            elif isinstance(block, Several):
                one = "" if block.optional else str(self.rng.integers(len(block.options)))
                answers[block.name] = one
            elif isinstance(block, Ranking) and not block.optional:
                answers[block.name] = ",".join(map(str, self._ranks(block)))
            elif isinstance(block, TextField):
                answers[block.name] = ""
        return answers

    def _ranks(self, block: Ranking) -> list[int]:
        """What was quick comes first, where options are levels; by chance otherwise."""
        levels = block.prefer or ("",) * len(block.options)
        dislike = np.array([log2(max(self._relative(level, ""), 1e-6)) for level in levels])
        dislike += WOBBLE / STEEPNESS * self.rng.standard_normal(len(levels))
        return [int(rank) for rank in 1 + np.argsort(np.argsort(dislike))]

    def _rating(self, page: Page, block: Scale) -> int:
        """Liking what was quick; what speaks `against` it is the other way round."""
        about = dict(page.about)
        level, scenario = about.get("transparency", ""), about.get("scenario", "")
        liking = MIDDLE - STEEPNESS * log2(max(self._relative(level, scenario), 1e-6))
        liking += WOBBLE * self.person.rng.standard_normal()
        share = min(1.0, max(0.0, 1 - liking if block.against else liking))
        return round(share * (block.steps - 1))

    def _relative(self, level: str, scenario: str) -> float:
        """Time with this level over time with any, within the scenario; 1 where unknown."""
        times = [(lv, fmean(t)) for (lv, k), t in self._times.items()
                 if not scenario or scenario_of(k) == scenario]  # fmt: skip
        own = [t for lv, t in times if lv == level]
        return fmean(own) / fmean(t for _, t in times) if own else 1.0

    def _choice(self, page: Page, block: Choice) -> int:
        if block.prefer:
            return self._preference(block.prefer)
        for other in page.blocks:
            if isinstance(other, PlatePicture):
                # Every simulated participant has full colour vision.
                return block.options.index(str(other.plate.digit))
            if isinstance(other, Picture):
                return self._nearer(other, block.options)
        return int(self.person.rng.integers(len(block.options)))

    def _nearer(self, picture: Picture, options: tuple[str, ...]) -> int:
        """Which of the kinds looks nearest in the picture, with the usual error in depth."""
        p = self.person.profile
        spread = hypot(p.depth_noise, p.through_noise)
        kinds = [o.removeprefix("kind.") for o in options]
        camera, scene = picture.view.camera, picture.view.scene
        depth = camera.depth(scene.centers)
        place = np.abs(on_picture(camera, scene.centers))
        shown = (depth > 0) & (place < [PICTURE_ASPECT, 1.0]).all(axis=1)
        looks = []
        for kind in kinds:
            same = [depth[i] for i in np.nonzero(shown)[0] if scene.objects[i].kind == kind]
            true = min(same, default=np.inf)
            looks.append(true * exp(spread * self.person.rng.standard_normal()))
        return int(np.argmin(looks))

    def _preference(self, options: tuple[str, ...]) -> int:
        """The first level or the last: by the times taken, and by chance."""
        first, last = (
            [fmean(t) for (lv, _), t in self._times.items() if lv == level]
            for level in (options[0], options[-1])
        )
        if not first or not last:
            return len(options) // 2
        odds = log2(fmean(last) / fmean(first))
        chance = 1 / (1 + exp(-3 * odds))
        return 0 if self.person.rng.random() < chance else len(options) - 1
