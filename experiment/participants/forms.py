"""Pages: reading them, and opinions formed from how long things took."""

from __future__ import annotations

from math import exp, log2
from statistics import fmean
from typing import Any

from experiment.participants.person import Person

READ = 4.0  # seconds a paragraph: some 15 words at 240 words a minute [ours]
DECIDE = 3.0  # seconds an item of a questionnaire [ours]
MIDDLE, STEEPNESS, WOBBLE = 2.3, 1.1, 0.6  # ratings against log2 of relative time [ours]
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

    def answer(self, page: Any) -> tuple[dict[str, str], float]:
        """Answers by name ("button": which one), and the seconds that took."""
        answers = {"button": "0"}
        seconds = 1.0
        for block in page.blocks:
            text = getattr(block, "text", "")
            if text.startswith("transparency."):
                self._level = text.removeprefix("transparency.")
            if hasattr(block, "steps"):
                answers[block.name] = str(self._rating(page, block))
                seconds += DECIDE
            elif hasattr(block, "options"):
                answers[block.name] = str(self._preference(len(block.options)))
                seconds += DECIDE
            elif hasattr(block, "name"):
                answers[block.name] = ""
            elif text:
                seconds += READ
        return answers, seconds * self.person.profile.pace

    def _rating(self, page: Any, block: Any) -> int:
        values = dict(block.values)
        level = values.get("transparency", "").removeprefix("name.")
        scenario = values.get("scenario", "").removeprefix("name.")
        middle = MIDDLE - STEEPNESS * log2(max(self._relative(level, scenario), 1e-6))
        value = middle + WOBBLE * self.person.rng.standard_normal()
        return min(block.steps - 1, max(0, round(value)))

    def _relative(self, level: str, scenario: str) -> float:
        """Time with this level over time with any, within the scenario; 1 where unknown."""
        own = [fmean(t) for (lv, k), t in self._times.items()
               if lv == level and SCENARIO.get(k) == scenario]  # fmt: skip
        every = [fmean(t) for (_, k), t in self._times.items() if SCENARIO.get(k) == scenario]
        return fmean(own) / fmean(every) if own and every else 1.0

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
