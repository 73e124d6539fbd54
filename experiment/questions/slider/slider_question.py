"""A slider: a place on a line between two ends."""

from __future__ import annotations

from dataclasses import dataclass

from seethrough.experiment.pages.pages import Answers, Scale
from seethrough.experiment.questions.kit import Asking, OnOnePage, Possible, Row, row
from seethrough.renderer.declared import check, key
from seethrough.tasks.kit.world import NO_TEXTS, Texts


@dataclass(frozen=True)
class SliderParameters:
    """What a study may say of a slider."""

    text: str = key(..., "what is asked", shown=True)
    low: int = key(0, "the lowest value", low=-1_000_000, high=1_000_000)
    high: int = key(100, "the highest value", low=-1_000_000, high=1_000_000)
    ends: tuple[str, ...] = key(
        ("question.low", "question.high"),
        "what the ends mean",
        said="an array of two texts",
        shown=True,
    )
    required: bool = key(True, "the page goes on only when it was moved")
    title: str = key("", "stands above the page; none: which levels it is about", shown=True)

    def __post_init__(self) -> None:
        check(self)
        if len(self.ends) != 2:
            raise ValueError(f"ends = {list(self.ends)!r}, expected an array of two texts")
        if self.high <= self.low:
            raise ValueError(f"high = {self.high}, expected more than `low` ({self.low})")


class SliderQuestion(OnOnePage[SliderParameters]):
    """Where between the ends?"""

    name, version = "slider", "1"
    source = "visual analogue scale, Hayes and Patterson 1921"
    Parameters = SliderParameters
    example = SliderParameters(text="How sure are you?")
    texts: Texts = NO_TEXTS

    def blocks(self, p: SliderParameters, asking: Asking) -> tuple[Scale, ...]:
        """The slider."""
        low, high = p.ends
        steps = p.high - p.low + 1
        return (Scale(asking.name, p.text, low, high, steps, (), p.low, True, not p.required),)

    def rows(self, p: SliderParameters, asking: Asking, number: int, answers: Answers) -> list[Row]:
        """The value."""
        if asking.name not in answers:
            return []
        return [row(asking.name, str(p.low + int(answers[asking.name])))]

    def possible(self, p: SliderParameters, item: str) -> Possible:
        """Any value between the ends."""
        return Possible(p.low, p.high)

    def items(self, p: SliderParameters, name: str) -> dict[str, str]:
        """The value."""
        return {name: f"{p.text} ({p.low}–{p.high})"}
