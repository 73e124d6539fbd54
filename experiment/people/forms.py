"""Pages: reading them, and opinions formed from how long things took."""

from __future__ import annotations

from math import exp, hypot, log2
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
SCENARIO = {
    "count": "abstract",
    "pattern": "abstract",
    "unique": "walkthrough",
    "count_in_building": "walkthrough",
}


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
        answers, seconds = {"button": "0"}, 1.0
        for block in page.blocks:
            if isinstance(block, Paragraph):
                if block.text.startswith("transparency."):
                    self._level = block.text.removeprefix("transparency.")
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
        kind, level, scenario = [*page.name.split(" "), "", ""][:3]
        liking = MIDDLE - STEEPNESS * log2(max(self._relative(level, scenario), 1e-6))
        liking += WOBBLE * self.person.rng.standard_normal()
        against = kind == "tlx" or (kind == "sus" and int(block.name.rpartition("_")[2]) % 2 == 0)
        share = min(1.0, max(0.0, 1 - liking if against else liking))
        return round(share * (block.steps - 1))

    def _relative(self, level: str, scenario: str) -> float:
        """Time with this level over time with any, within the scenario; 1 where unknown."""
        times = [(lv, fmean(t)) for (lv, k), t in self._times.items()
                 if not scenario or SCENARIO.get(k) == scenario]  # fmt: skip
        own = [t for lv, t in times if lv == level]
        return fmean(own) / fmean(t for _, t in times) if own else 1.0

    def _choice(self, page: Page, block: Choice) -> int:
        if block.name == "preference":
            return self._preference(len(block.options))
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

    def _preference(self, options: int) -> int:
        """0 for see-through, the last for none of it: by the times taken, and by chance."""
        times = {
            level: [fmean(t) for (lv, _), t in self._times.items() if lv == level]
            for level in ("dynamic", "standard")
        }
        if not all(times.values()):
            return options // 2
        odds = log2(fmean(times["standard"]) / fmean(times["dynamic"]))
        chance = 1 / (1 + exp(-3 * odds))
        return 0 if self.person.rng.random() < chance else options - 1
