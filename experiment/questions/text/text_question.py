"""Free text."""

from __future__ import annotations

from dataclasses import dataclass

from seethrough.experiment.pages.pages import Answers, TextField
from seethrough.experiment.questions.kit import Asking, OnOnePage, Row, row
from seethrough.renderer.declared import check, key
from seethrough.tasks.kit.world import NO_TEXTS, Texts


@dataclass(frozen=True)
class TextParameters:
    """What a study may say of a free text."""

    text: str = key(..., "what is asked", shown=True)
    lines: int = key(5, "how high the field is", "lines", low=1, high=20)
    required: bool = key(False, "the page goes on only when something is written")
    title: str = key("", "stands above the page; none: which levels it is about", shown=True)

    def __post_init__(self) -> None:
        check(self)


class TextQuestion(OnOnePage[TextParameters]):
    """What does one say?"""

    name, version = "text", "1"
    source = "ours"
    Parameters = TextParameters
    example = TextParameters(text="What did you do?")
    texts: Texts = NO_TEXTS

    def blocks(self, p: TextParameters, asking: Asking) -> tuple[TextField, ...]:
        """A field."""
        return (TextField(asking.name, p.text, p.lines, optional=not p.required),)

    def rows(self, p: TextParameters, asking: Asking, number: int, answers: Answers) -> list[Row]:
        """What was written, if anything was."""
        text = answers.get(asking.name, "")
        return [row(asking.name, "", text=text)] if text else []

    def items(self, p: TextParameters, name: str) -> dict[str, str]:
        """What was written."""
        return {name: p.text}
