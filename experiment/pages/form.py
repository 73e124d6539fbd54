"""A page while it is being filled in: what has been answered, and what is still missing."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import count

from seethrough.experiment.pages.pages import Answers, Page

Setting = tuple[float, float]  # sizes of a page's text and of the gaps about it, 1 as a rule


@dataclass
class Form:
    """A page and its answers so far.

    `insisted`: somebody tried to go on although something is missing, and is told what.
    `waiting`: it was answered, and what comes after it is being made; the text that says so.
    """

    page: Page
    answers: Answers = field(default_factory=dict)
    insisted: bool = False
    waiting: str = ""
    sought: str = ""  # name of the block to scroll to
    was_complete: bool = False  # when it was drawn last
    fitted: tuple[tuple[int, int], Setting, bool] | None = None  # window; whether it is too long
    number: int = field(default_factory=count().__next__)  # no other form has it

    @property
    def missing(self) -> tuple[str, ...]:
        """Names of what has no answer and needs one, or has one that will not do."""
        return tuple(b.name for b in self.page.asked if not b.answered(self.answers.get(b.name)))

    @property
    def complete(self) -> bool:
        """Whether the page can go on."""
        return not self.missing
