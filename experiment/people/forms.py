"""Pages: reading them, and opinions formed from how long things took."""

from __future__ import annotations

from math import exp, hypot, log, log2
from statistics import fmean

import numpy as np

from seethrough.experiment.pages.depth_test import on_picture
from seethrough.experiment.pages.pages import (
    PICTURE_ASPECT,
    Choice,
    Page,
    Paragraph,
    Picture,
    PlatePicture,
    Scale,
    TextField,
)
from seethrough.experiment.people.persons.person import Person

READ = 4.0  # seconds a paragraph: some 15 words at 240 words a minute [ours]
DECIDE = 3.0  # seconds an item of a questionnaire [ours]
MIDDLE, STEEPNESS, WOBBLE = 0.57, 0.28, 0.15  # ratings, 0–1, against log2 of relative time [ours]

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
        answers, seconds = {"button": "0"}, 1.0
        if page.name == "instruction":
            self._levels = page.levels
        for block in page.blocks:
            if isinstance(block, Paragraph):
                seconds += READ
            elif isinstance(block, Scale):
                answers[block.name] = str(self._rating(page, block))
                seconds += DECIDE
            elif isinstance(block, Choice) and not block.optional:
                answers[block.name] = str(self._choice(page, block))
                seconds += DECIDE
            elif isinstance(block, TextField):
                answers[block.name] = ""
        return answers, seconds * self.person.profile.pace

    def _rating(self, page: Page, block: Scale) -> int:
        """Liking what was quick; load is the other way round, as are the SUS's even items."""
        kind = page.name.partition(" ")[0]
        liking = MIDDLE - STEEPNESS * log2(max(self._relative(page.levels), 1e-6))
        liking += WOBBLE * self.person.rng.standard_normal()
        against = kind == "tlx" or (kind == "sus" and int(block.name.rpartition("_")[2]) % 2 == 0)
        share = min(1.0, max(0.0, 1 - liking if against else liking))
        return round(share * (block.steps - 1))

    def _relative(self, levels: Levels) -> float:
        """Time at these levels over time at any, of the same tasks; 1 where unknown."""
        own = {task for met, task in self._times if set(levels) <= set(met)}
        times = [(met, fmean(t)) for (met, task), t in self._times.items() if task in own]
        here = [t for met, t in times if set(levels) <= set(met)]
        return fmean(here) / fmean(t for _, t in times) if here else 1.0

    def _choice(self, page: Page, block: Choice) -> int:
        if block.name == "preference":
            return self._preference(page.levels)
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

    def _preference(self, offered: Levels) -> int:
        """One of the levels on offer, by the times taken with each, and by chance."""
        times = {
            k: [fmean(t) for (met, _), t in self._times.items() if level in met]
            for k, level in enumerate(offered)
        }
        met = [k for k, own in times.items() if own]
        if len(met) < 2:
            return len(offered) // 2
        weights = [fmean(times[k]) ** (-3 / log(2)) for k in met]  # of two: odds of 3 log2 ratios
        draw, reached = self.person.rng.random() * sum(weights), 0.0
        for k, weight in zip(met, weights, strict=True):
            reached += weight
            if draw < reached:
                return k
        return met[-1]
