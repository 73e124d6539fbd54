"""What every kind of question is, and what it is given to ask about."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Generic, NamedTuple, Protocol, runtime_checkable

import numpy as np
from numpy.random import Generator
from typing_extensions import TypeVar

from seethrough.experiment.pages.pages import Answers, Asked, Block, Page, Paragraph
from seethrough.renderer.declared import Declares
from seethrough.renderer.scene.look import Look
from seethrough.renderer.techniques.base import Parameters
from seethrough.tasks.kit.world import Texts, WorldParameters

Row = Mapping[str, str]


class Places(Protocol):
    """What a question may know of the study that it belongs to."""

    @property
    def seed(self) -> int:
        """The study's seed."""

    def place(self, world: str) -> WorldParameters:
        """The study's parameters of a world."""

    def technique(self, about: Mapping[str, str]) -> Parameters:
        """What frames are drawn with at these levels."""

    def look(self, about: Mapping[str, str]) -> Look:
        """How scenes look at these levels."""


@dataclass(frozen=True, eq=False)
class Asking:
    """What a question is asked about: the levels of the factors that it is asked for, by factor.

    `name` is that of its table: items are called so. `of` are the levels that it compares, `given`
    the values of items that were answered before about the same levels. `stream()` makes what
    differs between people: the same each time for one of them.
    """

    name: str
    about: Mapping[str, str] = field(default_factory=dict)
    of: tuple[str, ...] = ()
    given: Mapping[str, str] = field(default_factory=dict)
    stream: Callable[[], Generator] = field(default=partial(np.random.default_rng, 0))
    study: Places | None = None


class Respondent(Protocol):
    """A simulated person before a page (experiment/people/forms.py)."""

    @property
    def rng(self) -> Generator:
        """What makes the choices of this person."""

    def by_blocks(self, page: Page) -> Answers:
        """Answers by what the page is made of: what was quick is liked."""


class Titled(Declares, Protocol):
    """Parameters of a question that stands on a page of its own."""

    @property
    def title(self) -> str:
        """The name of the text above it; "" says which levels it is about."""


# Parameters of a kind; who only hands them on need not know what they are.
PTo = TypeVar("PTo", bound=Declares, contravariant=True, default=Declares)
P = TypeVar("P", bound=Titled, default=Titled)


class Question(Protocol[PTo]):
    """A kind of question, without state: parameters go in, pages and rows come out."""

    @property
    def name(self) -> str:
        """As a study file says it."""

    @property
    def version(self) -> str:
        """Changes with what it asks."""

    @property
    def source(self) -> str:
        """Where it is from."""

    @property
    def Parameters(self) -> type[Declares]:
        """The frozen dataclass of what a study may set."""

    @property
    def example(self) -> Declares:
        """Parameters that show it."""

    @property
    def texts(self) -> Texts:
        """What it says to participants."""

    def count(self, p: PTo) -> int:
        """How many pages it has."""

    def pages(self, p: PTo, asking: Asking) -> tuple[Page, ...]:
        """The pages that ask it, in order."""

    def rows(self, p: PTo, asking: Asking, number: int, answers: Answers) -> list[Row]:
        """What the answers to page `number` (from 0) are in the questionnaire's table. Raises
        Leave where they say that the session is over."""

    def last(self, p: PTo, asking: Asking, number: int) -> tuple[str, ...]:
        """Items one of which says that page `number` was answered: its rows are written at once, in
        order."""

    def items(self, p: PTo, name: str) -> Mapping[str, str]:
        """What it may write: item → its meaning."""

    def simulate(self, p: PTo, page: Page, person: Respondent) -> Answers:
        """How a simulated person fills in a page."""


@runtime_checkable
class Weighs(Protocol):
    """A kind some of whose items only lead to others: the report leaves them out."""

    def behind(self, p: object) -> tuple[str, ...]:
        """The names of these items."""


class Possible(NamedTuple):
    """What an answer may be: one of the texts, or a number from `low` to `high`."""

    low: float
    high: float
    texts: frozenset[str] = frozenset()


@runtime_checkable
class Foreseen(Protocol):
    """A kind that knows what its answers may be: a study may not wait for any other."""

    def possible(self, p: object, item: str) -> Possible | None:
        """What an item's answer may be; None where that depends on what is compared."""


class OnOnePage(Generic[P]):
    """What kinds share that ask on a single page: they say their blocks, rows and items alone."""

    def blocks(self, p: P, asking: Asking) -> tuple[Asked, ...]:
        """What is to be filled in."""
        raise TypeError(f"{type(self).__name__}: expected `blocks`")

    def count(self, p: P) -> int:
        """One."""
        return 1

    def pages(self, p: P, asking: Asking) -> tuple[Page, ...]:
        """The page."""
        return (page(asking, p.title, self.blocks(p, asking)),)

    def last(self, p: P, asking: Asking, number: int) -> tuple[str, ...]:
        """The last item that has to have an answer; any, where none has to."""
        asked = self.blocks(p, asking)
        needed = [b.name for b in asked if not b.optional]
        return (needed[-1],) if needed else tuple(b.name for b in asked)

    def simulate(self, p: P, page: Page, person: Respondent) -> Answers:
        """By what the page is made of."""
        return person.by_blocks(page)


def page(
    asking: Asking, title: str, blocks: tuple[Block, ...], buttons: tuple[str, ...] = ("continue",)
) -> Page:
    """A page of a question's; without a title of its own it says which levels it is about."""
    levels = tuple(asking.about.values())
    name = " ".join((asking.name, *levels))
    about = tuple(asking.about.items())
    if not title:
        title = "question.title"
        blocks = (*(Paragraph(f"name.{level}") for level in levels), *blocks)
    return Page(name, title, blocks, about=about, buttons=buttons)


def row(item: str, value: str, **more: str) -> Row:
    """A row of the questionnaire's table."""
    return {"item": item, "value": value, **more}


def paragraphs(text: str) -> tuple[Block, ...]:
    """A text, if there is one, as a block."""
    return (Paragraph(text),) if text else ()
