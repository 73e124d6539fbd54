"""Ready-made questions, each a page of one or several kinds. Sources: ratings Elmqvist2009 §VI-G;
SUS (Brooke 1996, free to use with its name)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from seethrough import registry
from seethrough.experiment.pages.pages import Answers, Page
from seethrough.experiment.questions.choice.choice_question import ChoiceParameters
from seethrough.experiment.questions.kit import Asking, Question, Respondent, Row, page
from seethrough.experiment.questions.likert.likert_question import LikertParameters
from seethrough.experiment.questions.number.number_question import NumberParameters
from seethrough.experiment.questions.statement.statement_question import StatementParameters
from seethrough.experiment.questions.text.text_question import TextParameters
from seethrough.renderer.declared import Declares
from seethrough.tasks.kit.world import NO_TEXTS, Texts

OLDEST = 120  # years; what is above is a slip of the finger
RATED = ("rating.low", "rating.high")
RATINGS = ("efficiency", "ease", "enjoy")
SUS_ITEMS = 10


@dataclass(frozen=True)
class Part:
    """A question on a page of several: what it is called there, its kind and its parameters."""

    item: str
    kind: str
    parameters: Declares


@dataclass(frozen=True)
class NoParameters:
    """A ready-made question leaves nothing to say."""


@dataclass(frozen=True)
class Ready:
    """A page of `parts`, which may depend on what is compared. `heading` is the text above it, with
    the levels behind it that it is about."""

    name: str
    heading: str
    parts: Callable[[Asking], tuple[Part, ...]]
    source: str = "ours"
    version: str = "1"
    Parameters: type[Declares] = NoParameters
    example: Declares = NoParameters()

    @property
    def texts(self) -> Texts:
        """They are the pages' own."""
        return NO_TEXTS

    def count(self, p: Declares) -> int:
        """One."""
        return 1

    def pages(self, p: Declares, asking: Asking) -> tuple[Page, ...]:
        """All that the parts ask, on one page."""
        made = [part for one in self._each(asking) for part in one[0].pages(one[1], one[2])]
        levels = tuple(asking.about.values())
        title = ".".join((self.heading, *levels)) if levels else f"{self.heading}.title"
        blocks = tuple(block for part in made for block in part.blocks)
        return (page(asking, title, blocks, buttons=made[0].buttons),)

    def rows(self, p: Declares, asking: Asking, number: int, answers: Answers) -> list[Row]:
        """Those of the parts."""
        return [r for kind, q, a in self._each(asking) for r in kind.rows(q, a, 0, answers)]

    def last(self, p: Declares, asking: Asking, number: int) -> tuple[str, ...]:
        """The last part's; any, where none has to be answered."""
        found = [kind.last(q, a, 0) for kind, q, a in self._each(asking)]
        if not self.pages(p, asking)[0].required:
            return tuple(item for last in found for item in last)
        return found[-1]

    def items(self, p: Declares, name: str) -> Mapping[str, str]:
        """Those of the parts."""
        each = self._each(Asking(name))
        return {i: said for kind, q, a in each for i, said in kind.items(q, a.name).items()}

    def simulate(self, p: Declares, page: Page, person: Respondent) -> Answers:
        """By what the page is made of."""
        return person.by_blocks(page)

    def _each(self, asking: Asking) -> list[tuple[Question, Declares, Asking]]:
        """Kind, parameters, what it is asked about: the page says once which levels these are."""
        return [
            (
                registry.get("question", part.kind),
                part.parameters,
                replace(asking, name=part.item, about={}),
            )
            for part in self.parts(asking)
        ]


def _likert(
    item: str, text: str, ends: tuple[str, ...], points: int = 5, reverse: tuple[str, ...] = ()
) -> Part:
    scale = LikertParameters(
        text=text, names=(item,), ends=ends, first=0, points=points, reverse=reverse
    )
    return Part(item, "likert", scale)


def _ratings(asking: Asking) -> tuple[Part, ...]:
    """Efficiency, ease and enjoyment of one condition, 0–4."""
    return tuple(_likert(item, f"rating.{item}", RATED) for item in RATINGS)


def _sus(asking: Asking) -> tuple[Part, ...]:
    """Ten statements, 0 to 4; their sum, even ones reversed, times 2.5 (Brooke 1996)."""
    numbers = range(1, SUS_ITEMS + 1)
    statements = LikertParameters(
        items=tuple(f"sus.item{n}" for n in numbers),
        names=tuple(f"sus_{n}" for n in numbers),
        first=0,
        ends=("sus.low", "sus.high"),
        reverse=tuple(f"sus_{n}" for n in numbers if n % 2 == 0),
        score="sus",
        factor=2.5,
    )
    return (Part("sus", "likert", statements),)


def _comparison(asking: Asking) -> tuple[Part, ...]:
    """Which of two levels one would rather work with, 1 for the second; how well one could tell
    what was nearer, 0–4."""
    first, second = asking.of or ("first", "second")  # where nothing is compared: what it may write
    preference = ChoiceParameters(
        text="comparison.preference",
        options=(f"name.{second}", "name.neutral", f"name.{first}"),
        names=(second, "neutral", first),
        right=second,
    )
    depth = _likert("depth_self_report", "comparison.depth", RATED)
    return (Part("preference", "choice", preference), depth)


def _demographics(asking: Asking) -> tuple[Part, ...]:
    """Age and gender, both may stay open."""
    genders = ("female", "male", "other")
    age = NumberParameters(text="demographics.age", high=OLDEST, wrong="demographics.wrong")
    gender = ChoiceParameters(
        text="demographics.gender",
        options=tuple(f"gender.{g}" for g in genders),
        names=genders,
        numbered=False,
        required=False,
    )
    return (Part("age", "number", age), Part("gender", "choice", gender))


def _consent(asking: Asking) -> tuple[Part, ...]:
    """The study's own text, to be agreed to."""
    return (Part("consent", "statement", StatementParameters(text="consent.text", agree=True)),)


def _remarks(asking: Asking) -> tuple[Part, ...]:
    """Free text."""
    return (Part("remarks", "text", TextParameters(text="remarks.text")),)


READY: Mapping[str, Ready] = {
    block.name: block
    for block in (
        Ready("consent", "consent", _consent),
        Ready("demographics", "demographics", _demographics),
        Ready("ratings", "rating", _ratings, "Elmqvist2009 §VI-G"),
        Ready("comparison", "comparison", _comparison),
        Ready("sus", "sus", _sus, "Brooke 1996"),
        Ready("remarks", "remarks", _remarks),
    )
}


def question(name: str) -> Question:
    """The ready-made question or the kind of that name. Raises KeyError if there is none."""
    if name in READY:
        return READY[name]
    found: Question = registry.get("question", name)
    return found


def one_page(name: str, **about: str) -> Page:
    """The page of a ready-made question about these levels."""
    kind = question(name)
    return kind.pages(kind.Parameters(), Asking(name, about))[0]
