"""Pages: reading them, and opinions formed from how long things took."""

from __future__ import annotations

from math import exp, log2
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
)
from seethrough.experiment.people.persons.person import Person

READ = 4.0  # seconds a paragraph: some 15 words at 240 words a minute [ours]
DECIDE = 3.0  # seconds an item of a questionnaire [ours]
MIDDLE, STEEPNESS, WOBBLE = 0.57, 0.28, 0.15  # ratings, 0–1, against log2 of relative time [ours]
STILL = 2**0.5  # a picture that stands still: twice the variance of a depth in it [ours]

Levels = tuple[tuple[str, str], ...]  # factor and level


class Opinions:
    """Remembers what took how long under what instruction, and answers accordingly."""

    def __init__(self, person: Person) -> None:
        self.person = person
        self._levels: Levels = ()
        self._times: dict[tuple[Levels, str], list[float]] = {}

    def begin(self, task: str) -> None:
        """A trial of `task` begins, under the instruction read last."""
        self._times.setdefault((self._levels, task), []).append(0.0)

    def spent(self, task: str, seconds: float) -> None:
        """The running trial has taken so long by now."""
        self._times[self._levels, task][-1] = seconds

    def answer(self, page: Page) -> tuple[dict[str, str], float]:
        """Answers by name ("button": which one), and the seconds that took."""
        seconds = 1.0
        if page.name == "instruction":
            self._levels = page.about
        for block in page.blocks:
            if isinstance(block, Paragraph):
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
                answers[block.name] = "" if block.optional else self._written(block)
        return answers

    def _written(self, block: TextField) -> str:
        """Any number that may be, or of a text, that nobody wrote it."""
        if block.most is None:
            return "simulated"
        value = self.rng.uniform(block.least, block.most)
        return str(round(value)) if block.whole else f"{value:.3f}"

    def _ranks(self, block: Ranking) -> list[int]:
        """What was quick comes first, where options are levels; by chance otherwise."""
        levels = block.prefer or ("",) * len(block.options)
        known = [self._met(level) for level in levels]
        dislike = np.array([log2(max(self._relative(at), 1e-6)) for at in known])
        dislike += WOBBLE / STEEPNESS * self.rng.standard_normal(len(levels))
        return [int(rank) for rank in 1 + np.argsort(np.argsort(dislike))]

    def _rating(self, page: Page, block: Scale) -> int:
        """Liking what was quick; what speaks `against` it is the other way round."""
        liking = MIDDLE - STEEPNESS * log2(max(self._relative(page.about), 1e-6))
        liking += WOBBLE * self.person.rng.standard_normal()
        share = min(1.0, max(0.0, 1 - liking if block.against else liking))
        return round(share * (block.steps - 1))

    def _relative(self, levels: Levels) -> float:
        """Time at these levels over time at any, of the same tasks; 1 where unknown."""
        own = {task for met, task in self._times if set(levels) <= set(met)}
        times = [(met, fmean(t)) for (met, task), t in self._times.items() if task in own]
        here = [t for met, t in times if set(levels) <= set(met)]
        usual = fmean(t for _, t in times) if here else 0.0
        return fmean(here) / usual if usual else 1.0  # nothing has taken any time yet

    def _met(self, level: str) -> Levels:
        """The factor and level of this name that were met."""
        every = (pair for levels, _ in self._times for pair in levels)
        return next(((pair,) for pair in every if pair[1] == level), ())

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
        spread = p.depth_noise * STILL
        kinds = [o.removeprefix("kind.") for o in options]
        camera, scene = picture.view.camera, picture.view.scene
        depth = camera.depth(scene.centers)
        place = np.abs(camera.places(scene.centers))
        shown = (depth > 0) & (place < [PICTURE_ASPECT, 1.0]).all(axis=1)
        looks = []
        for kind in kinds:
            same = [depth[i] for i in np.nonzero(shown)[0] if scene.objects[i].kind == kind]
            true = min(same, default=np.inf)
            looks.append(true * exp(spread * self.person.rng.standard_normal()))
        return int(np.argmin(looks))

    def _preference(self, options: tuple[str, ...]) -> int:
        """The first level or the last: by the times taken, and by chance; neither where one of them
        took no time, as with a task that somebody begins to write."""
        first, last = (
            [fmean(t) for (met, _), t in self._times.items() if level in dict(met).values()]
            for level in (options[0], options[-1])
        )
        if not first or not last or not any(first) or not any(last):
            return len(options) // 2
        odds = log2(fmean(last) / fmean(first))
        chance = 1 / (1 + exp(-3 * odds))
        return 0 if self.person.rng.random() < chance else len(options) - 1
