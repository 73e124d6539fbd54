"""A number: typed, and refused where it cannot be meant."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, floor

from seethrough.experiment.pages.pages import Answers, TextField
from seethrough.experiment.questions.kit import Asking, OnOnePage, Possible, Row, row
from seethrough.renderer.declared import check, key
from seethrough.tasks.kit.own_texts import OwnTexts
from seethrough.tasks.kit.world import Texts


@dataclass(frozen=True)
class NumberParameters:
    """What a study may say of a number."""

    text: str = key(..., "what is asked", shown=True)
    low: float = key(0.0, "the least it may be", low=-1e9, high=1e9)
    high: float = key(1_000_000.0, "the most it may be", low=-1e9, high=1e9)
    whole: bool = key(True, "whether it has to be a whole number")
    unit: str = key("", "what it counts, for those who read the data")
    wrong: str = key(
        "number.wrong", "what to say of anything else, with {answer} and {most} in it", shown=True
    )
    required: bool = key(False, "the page goes on only when it is answered")
    title: str = key("", "stands above the page; none: which levels it is about", shown=True)

    def __post_init__(self) -> None:
        check(self)
        if self.high <= self.low:
            raise ValueError(f"high = {self.high}, expected more than `low` ({self.low})")
        if self.whole and ceil(self.low) > floor(self.high):
            expected = f"a whole number from `low` ({self.low}) on"
            raise ValueError(f"high = {self.high}, expected {expected}, or whole = false")


class NumberQuestion(OnOnePage[NumberParameters]):
    """How many?"""

    name, version = "number", "1"
    source = "ours"
    Parameters = NumberParameters
    example = NumberParameters(text="How many things did you see?", high=50)
    texts: Texts = OwnTexts("seethrough.experiment.questions.number")

    def blocks(self, p: NumberParameters, asking: Asking) -> tuple[TextField, ...]:
        """A field of one line."""
        field = TextField(
            asking.name,
            p.text,
            1,
            wrong=p.wrong,
            optional=not p.required,
            most=p.high,
            least=p.low,
            whole=p.whole,
        )
        return (field,)

    def rows(self, p: NumberParameters, asking: Asking, number: int, answers: Answers) -> list[Row]:
        """The number, with a point; none where it was left open."""
        text = answers.get(asking.name, "").strip().replace(",", ".")
        return [row(asking.name, text)] if text else []

    def possible(self, p: NumberParameters, item: str) -> Possible:
        """Any number between the limits."""
        return Possible(p.low, p.high)

    def items(self, p: NumberParameters, name: str) -> dict[str, str]:
        """The number."""
        return {name: f"{p.text} ({p.unit})" if p.unit else p.text}
