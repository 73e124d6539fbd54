"""Four red–green plates, a page each, of each participant's own."""

from __future__ import annotations

from dataclasses import dataclass

from seethrough.experiment.pages.color_plates import DIGITS, plates
from seethrough.experiment.pages.pages import Answers, Choice, Page, PlatePicture
from seethrough.experiment.questions.kit import Asking, Respondent, Row, row
from seethrough.tasks.kit.world import NO_TEXTS, Texts

PLATES = 4
OPTIONS = (*map(str, sorted(DIGITS)), "color.nothing")


@dataclass(frozen=True)
class ColorParameters:
    """A study may say nothing of the plates."""


class ColorQuestion:
    """Which digit is it?"""

    name, version = "color_check", "1"
    source = "ours, after Ishihara 1917"
    Parameters = ColorParameters
    example = ColorParameters()
    texts: Texts = NO_TEXTS

    def count(self, p: ColorParameters) -> int:
        """One for each plate."""
        return PLATES

    def pages(self, p: ColorParameters, asking: Asking) -> tuple[Page, ...]:
        """The plates."""
        choice = Choice("digit", "color.question", OPTIONS)
        return tuple(
            Page("color check", "color.title", (PlatePicture(plate), choice))
            for plate in plates(asking.stream())
        )

    def rows(self, p: ColorParameters, asking: Asking, number: int, answers: Answers) -> list[Row]:
        """1 where the digit was read."""
        digit = str(plates(asking.stream())[number].digit)
        answer = OPTIONS[int(answers["digit"])]
        text = f"{answer.removeprefix('color.')}, shown {digit}"
        return [row(f"color_plate_{number + 1}", str(int(answer == digit)), text=text)]

    def last(self, p: ColorParameters, asking: Asking, number: int) -> tuple[str, ...]:
        """The plate."""
        return (f"color_plate_{number + 1}",)

    def items(self, p: ColorParameters, name: str) -> dict[str, str]:
        """Each plate."""
        return {f"color_plate_{n}": "1: read" for n in range(1, PLATES + 1)}

    def simulate(self, p: ColorParameters, page: Page, person: Respondent) -> Answers:
        """Every simulated person has full colour vision."""
        return person.by_blocks(page)
