"""Pages between the trials, as values: the display draws them, a participant fills them in.

Every `text` is a key of the language file or of the study's [texts].
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

from seethrough.experiment.pages.color_plates import Plate
from seethrough.renderer.techniques.base import Parameters
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.hud import FloorPlan

Answers = dict[str, str]
Values = tuple[tuple[str, str | float], ...]  # a placeholder's name, and what to put there
# Few enough digits that a number of any length costs nothing to read.
NUMBER = re.compile(r"(-?[0-9]{1,9})([.,][0-9]{1,9})?", re.ASCII)
PICTURE_ASPECT = 4 / 3  # width / height of every picture on a page, whatever the window's


@dataclass(frozen=True)
class Paragraph:
    """Running text; `values` fill its placeholders."""

    text: str
    values: Values = ()


@dataclass(frozen=True)
class Scale:
    """A scale of `steps` with a word at each end, counted from `first`; the answer is the position
    on it, from 0. `slider`: drawn as one, as scales of many steps are anyway. `against`: high
    values speak against what is judged.
    """

    name: str
    text: str
    low: str
    high: str
    steps: int = 5
    values: Values = ()
    first: int = 0
    slider: bool = False
    optional: bool = False
    against: bool = False

    def answered(self, text: str | None) -> bool:
        """Whether that will do for an answer."""
        return self.optional or text is not None


@dataclass(frozen=True)
class Choice:
    """One of several options, each a text key; the answer is the option's position.

    An empty `text` leaves the question to a paragraph before. `prefer`: the level that each option
    speaks for, empty for none.
    """

    name: str
    text: str
    options: tuple[str, ...]
    optional: bool = False
    prefer: tuple[str, ...] = ()

    def answered(self, text: str | None) -> bool:
        """Whether that will do for an answer."""
        return self.optional or text is not None


@dataclass(frozen=True)
class Several:
    """Any of several options; the answer is their positions, with commas between."""

    name: str
    text: str
    options: tuple[str, ...]
    optional: bool = False

    def answered(self, text: str | None) -> bool:
        """Whether that will do for an answer."""
        return self.optional or bool(text)


@dataclass(frozen=True)
class Ranking:
    """All options in an order; the answer is each one's rank from 1, with commas between, nothing
    for those that have none yet. `prefer` as of a Choice."""

    name: str
    text: str
    options: tuple[str, ...]
    prefer: tuple[str, ...] = ()
    optional: bool = False

    def answered(self, text: str | None) -> bool:
        """Whether that will do for an answer: all have a rank, or none where that is allowed."""
        given = [rank for rank in (text or "").split(",") if rank]
        return len(given) == len(self.options) or (self.optional and not given)


@dataclass(frozen=True)
class TextField:
    """Free text, or with `most` a number from `least` up to it, a `whole` one unless it need not.

    `wrong` is what to say of anything else: a text with places for {most} and the field's name.
    """

    name: str
    text: str
    lines: int = 5
    most: float | None = None
    wrong: str = ""
    least: float = 0
    whole: bool = True
    optional: bool = True

    def answered(self, text: str | None) -> bool:
        """Whether that will do for an answer."""
        return self.takes(text or "") and (self.optional or bool((text or "").strip()))

    def takes(self, text: str) -> bool:
        """Whether the text can be an answer; nothing always can."""
        text = text.strip()
        if self.most is None or not text:
            return True
        number = NUMBER.fullmatch(text)
        if number is None or (self.whole and number[2]):
            return False
        return self.least <= float(text.replace(",", ".")) <= self.most


@dataclass(frozen=True, eq=False)
class Picture:
    """A live picture of a view, in the study's technique; height in screen heights.

    The view's insets are drawn over it. `look` makes the view, once, when somebody wants to see it.
    """

    look: Callable[[], View]
    technique: Parameters = field(default_factory=Standard)
    height: float = 0.36

    @cached_property
    def view(self) -> View:
        """What it shows."""
        return self.look()


@dataclass(frozen=True)
class PlanPicture:
    """A floor plan with what is marked on it; height in screen heights."""

    plan: FloorPlan
    height: float = 0.5


@dataclass(frozen=True, eq=False)
class PlatePicture:
    """A red–green plate."""

    plate: Plate


Asked = Scale | Choice | Several | Ranking | TextField
Block = Paragraph | Asked | Picture | PlanPicture | PlatePicture


@dataclass(frozen=True)
class Page:
    """A page; `buttons` are text keys, the answer's "button" is the position of the one pressed.

    A page goes on only when each of its questions is answered that has to be. The first button is
    what is usually meant, and looks so; the others do something else. `about`: the level of each
    factor that it asks about. `simulate` answers it for a simulated person (people/forms.py).
    """

    name: str
    title: str
    blocks: tuple[Block, ...] = ()
    buttons: tuple[str, ...] = ("continue",)
    about: tuple[tuple[str, str], ...] = ()
    simulate: Callable[[object], Answers] | None = field(default=None, compare=False)

    @property
    def asks(self) -> bool:
        """Whether there is anything to fill in."""
        return bool(self.asked)

    @property
    def asked(self) -> tuple[Asked, ...]:
        """What there is to fill in."""
        return tuple(b for b in self.blocks if isinstance(b, Asked))

    @property
    def required(self) -> tuple[str, ...]:
        """Names that need an answer."""
        return tuple(b.name for b in self.asked if not b.optional)

    def insisting(self) -> Page:
        """The page with nothing on it that may be left open."""
        blocks = (replace(b, optional=False) if isinstance(b, Asked) else b for b in self.blocks)
        return replace(self, blocks=tuple(blocks))

    @property
    def takes_time(self) -> bool:
        """Whether something on it has to be worked out before it can be drawn."""
        return any(isinstance(b, Picture | PlatePicture) for b in self.blocks)

    @property
    def shows_scenes(self) -> bool:
        """Whether a scene is among it."""
        return any(isinstance(b, Picture) for b in self.blocks)

    def prepare(self) -> None:
        """Work it out: no graphics, so another thread may."""
        for block in self.blocks:
            if isinstance(block, Picture):
                _ = block.view
            elif isinstance(block, PlatePicture):
                _ = block.plate.places
