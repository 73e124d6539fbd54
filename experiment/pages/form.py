"""A page while it is being filled in: what has been answered, and what is still missing."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import count

from seethrough.experiment.pages.pages import Answers, Page, TextField

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
        """Names of the scales and choices without an answer, and of fields with a wrong one."""
        unanswered = {name for name in self.page.required if name not in self.answers}
        wrong = {
            b.name
            for b in self.page.blocks
            if isinstance(b, TextField) and not b.takes(self.answers.get(b.name, ""))
        }
        names = (getattr(b, "name", "") for b in self.page.blocks)
        return tuple(name for name in names if name in unanswered | wrong)

    @property
    def complete(self) -> bool:
        """Whether the page can go on."""
        return not self.missing
