"""Likert scales: one statement or several on a page, each with the same points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

from seethrough.experiment.pages.pages import Answers, Page, Scale
from seethrough.experiment.questions.kit import Asking, Possible, Respondent, Row, page, row
from seethrough.renderer.declared import check, key
from seethrough.tasks.kit.world import NO_TEXTS, Texts

Item = TypeVar("Item")


@dataclass(frozen=True)
class LikertParameters:
    """What a study may say of Likert scales."""

    text: str = key("", "the statement; or `items`, where there are several", shown=True)
    items: tuple[str, ...] = key(
        (), "statements, one below the other", said="an array of texts", shown=True
    )
    names: tuple[str, ...] = key(
        (), "what the data call the items; none: the table's name, with a number where there are "
        "several", said="an array of texts, one for each item",
    )  # fmt: skip
    points: int = key(5, "points of each scale", low=2, high=101)
    first: int = key(1, "what the lowest point counts", low=-100, high=100)
    ends: tuple[str, ...] = key(
        ("question.low", "question.high"), "what the lowest and the highest point mean",
        said="an array of two texts", shown=True)  # fmt: skip
    reverse: tuple[str, ...] = key(
        (), "names of items that count the other way round, in the score too",
        said="an array of names of items",
    )  # fmt: skip
    score: str = key("", "what the data call the sum of all items; none: no sum")
    factor: float = key(1.0, "what the sum is multiplied with", low=-1e6, high=1e6)
    shuffle: bool = key(False, "whether each participant has the items in another order")
    per_page: int = key(0, "items on a page; 0: all on one", low=0, high=100)
    required: bool = key(True, "the page goes on only when each is answered")
    title: str = key("", "stands above the page; none: which levels it is about", shown=True)

    def __post_init__(self) -> None:
        check(self)
        if len(self.ends) != 2:
            raise ValueError(f"ends = {list(self.ends)!r}, expected an array of two texts")
        if bool(self.text) == bool(self.items):
            raise ValueError(f"text = {self.text!r}, expected a text, or `items` instead of it")
        if self.names and len(self.names) != max(1, len(self.items)):
            raise ValueError(f"names = {list(self.names)!r}, expected one for each item")
        if len(set(self.names)) < len(self.names):
            raise ValueError(f"names = {list(self.names)!r}, expected each once")
        if self.names and not set(self.reverse) <= set(self.names):
            raise ValueError(f"reverse = {list(self.reverse)!r}, expected some of `names`")
        if self.score and not self.required:
            raise ValueError(f"score = {self.score!r}, expected `required` beside it")

    def asked(self, name: str) -> dict[str, str]:
        """Item → its statement, of a table of that name."""
        texts = self.items or (self.text,)
        numbered = tuple(f"{name}_{n}" for n in range(1, len(texts) + 1)) if self.items else (name,)
        return dict(zip(self.names or numbered, texts, strict=True))


class LikertQuestion:
    """How much does one agree?"""

    name, version = "likert", "1"
    source = "Likert 1932"
    Parameters = LikertParameters
    example = LikertParameters(items=("It was hard work.", "I knew where I was."), points=7)
    texts: Texts = NO_TEXTS

    def count(self, p: LikertParameters) -> int:
        """As many pages as the items take."""
        return len(_parts(p, list(p.asked("item"))))

    def pages(self, p: LikertParameters, asking: Asking) -> tuple[Page, ...]:
        """A scale for each statement."""
        return tuple(page(asking, p.title, blocks) for blocks in _parts(p, self._scales(p, asking)))

    def simulate(self, p: LikertParameters, page: Page, person: Respondent) -> Answers:
        """By what the page is made of."""
        return person.by_blocks(page)

    def possible(self, p: LikertParameters, item: str) -> Possible | None:
        """A point of the scale; the sum is not foreseen."""
        return None if item == p.score else Possible(p.first, p.first + p.points - 1)

    def _scales(self, p: LikertParameters, asking: Asking) -> list[Scale]:
        """In the order of this participant."""
        low, high = p.ends
        made = [
            Scale(item, text, low, high, p.points, first=p.first, optional=not p.required,
                  against=item in p.reverse)
            for item, text in p.asked(asking.name).items()
        ]  # fmt: skip
        return [made[i] for i in asking.stream().permutation(len(made))] if p.shuffle else made

    def rows(self, p: LikertParameters, asking: Asking, number: int, answers: Answers) -> list[Row]:
        """Each item's value; then the sum, in which items that were answered before count as they
        were then."""
        every = p.asked(asking.name)
        values = {i: str(p.first + int(answers[i])) for i in every if i in answers}
        found = [row(item, value) for item, value in values.items()]
        if p.score and number == self.count(p) - 1:
            before = {item: value for item, value in asking.given.items() if item in every}
            whole = {**values, **before}
            found.append(row(p.score, f"{self.total(p, whole):g}"))
        return found

    def total(self, p: LikertParameters, values: Mapping[str, str]) -> float:
        """The sum over items, those in `reverse` turned round, each counted from 0."""
        top = p.points - 1
        places = {item: float(value) - p.first for item, value in values.items()}
        return p.factor * sum(top - v if i in p.reverse else v for i, v in places.items())

    def last(self, p: LikertParameters, asking: Asking, number: int) -> tuple[str, ...]:
        """The sum, or else the last item of the page; any, where none has to be answered."""
        if p.score and number == self.count(p) - 1:
            return (p.score,)
        here = {scale.name for scale in _parts(p, self._scales(p, asking))[number]}
        items = [item for item in p.asked(asking.name) if item in here]  # as rows have them
        return (items[-1],) if p.required else tuple(items)

    def items(self, p: LikertParameters, name: str) -> dict[str, str]:
        """Each statement."""
        span = f"{p.first}–{p.first + p.points - 1}"
        found = {item: f"{text} ({span})" for item, text in p.asked(name).items()}
        return {**found, p.score: "sum of the items"} if p.score else found


def _parts(p: LikertParameters, items: Sequence[Item]) -> list[tuple[Item, ...]]:
    """The items page by page."""
    size = p.per_page or len(items)
    return [tuple(items[i : i + size]) for i in range(0, len(items), size)]
