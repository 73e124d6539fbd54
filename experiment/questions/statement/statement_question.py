"""A statement: something to read, and perhaps to agree to."""

from __future__ import annotations

from dataclasses import dataclass

from seethrough.experiment.display.display import Leave
from seethrough.experiment.pages.pages import Answers, Page
from seethrough.experiment.questions.kit import Asking, Respondent, Row, page, paragraphs, row
from seethrough.renderer.declared import check, key
from seethrough.tasks.kit.world import NO_TEXTS, Texts


@dataclass(frozen=True)
class StatementParameters:
    """What a study may say of a statement."""

    text: str = key(..., "what is to be read", shown=True)
    agree: bool = key(False, "whether it is to be agreed to; who does not ends the session")
    yes: str = key("consent.yes", "the button of those who agree", shown=True)
    no: str = key("consent.no", "the button of those who do not", shown=True)
    title: str = key("", "stands above the page; none: which levels it is about", shown=True)

    def __post_init__(self) -> None:
        check(self)


class StatementQuestion:
    """Has it been read?"""

    name, version = "statement", "1"
    source = "ours"
    Parameters = StatementParameters
    example = StatementParameters(text="Please sit upright.")
    texts: Texts = NO_TEXTS

    def count(self, p: StatementParameters) -> int:
        """One."""
        return 1

    def pages(self, p: StatementParameters, asking: Asking) -> tuple[Page, ...]:
        """The text and its buttons."""
        buttons = (p.yes, p.no) if p.agree else ("continue",)
        return (page(asking, p.title, paragraphs(p.text), buttons=buttons),)

    def rows(
        self, p: StatementParameters, asking: Asking, number: int, answers: Answers
    ) -> list[Row]:
        """1 for who has read it or agreed. Raises Leave for who has not."""
        if p.agree and answers["button"] == "1":
            raise Leave
        return [row(asking.name, "1")]

    def last(self, p: StatementParameters, asking: Asking, number: int) -> tuple[str, ...]:
        """The row that says so."""
        return (asking.name,)

    def items(self, p: StatementParameters, name: str) -> dict[str, str]:
        """Whether it was read or agreed to."""
        return {name: "1: agreed" if p.agree else "1: read"}

    def simulate(self, p: StatementParameters, page: Page, person: Respondent) -> Answers:
        """Everybody agrees."""
        return person.by_blocks(page)
