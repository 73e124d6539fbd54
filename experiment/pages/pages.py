"""Pages between the trials, as values: the display draws them, a participant fills them in.

Every `text` is a key of the language file or of the study's [texts].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

from seethrough.experiment.pages.color_plates import Plate
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.hud import FloorPlan

Answers = dict[str, str]
Values = tuple[tuple[str, str | float], ...]  # a placeholder's name, and what to put there
PICTURE_ASPECT = 4 / 3  # width / height of every picture on a page, whatever the window's


@dataclass(frozen=True)
class Paragraph:
    """Running text; `values` fill its placeholders."""

    text: str
    values: Values = ()


@dataclass(frozen=True)
class Scale:
    """A Likert scale from 0 to `steps` − 1, with a word at each end."""

    name: str
    text: str
    low: str
    high: str
    steps: int = 5
    values: Values = ()


@dataclass(frozen=True)
class Choice:
    """One of several options, each a text key; the answer is the option's position.

    An empty `text` leaves the question to a paragraph before.
    """

    name: str
    text: str
    options: tuple[str, ...]
    optional: bool = False


@dataclass(frozen=True)
class TextField:
    """Free text, or with `most` a whole number from 0 up to it; either may stay empty.

    `wrong` is what to say of anything else: a text with places for {most} and the field's name.
    """

    name: str
    text: str
    lines: int = 5
    most: int | None = None
    wrong: str = ""

    def takes(self, text: str) -> bool:
        """Whether the text can be an answer."""
        text = text.strip()
        if self.most is None or not text:
            return True
        return text.isascii() and text.isdigit() and len(text) <= 9 and int(text) <= self.most


@dataclass(frozen=True, eq=False)
class Picture:
    """A live picture of a view, in the study's technique; height in screen heights.

    The view's insets are drawn over it. `look` makes the view, once, when somebody wants to see it.
    """

    look: Callable[[], View]
    technique: object = Standard()
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


Block = Paragraph | Scale | Choice | TextField | Picture | PlanPicture | PlatePicture


@dataclass(frozen=True)
class Page:
    """A page; `buttons` are text keys, the answer's "button" is the position of the one pressed.

    A page with scales or choices goes on only when each is answered. The first button is what is
    usually meant, and looks so; the others do something else.
    """

    name: str
    title: str
    blocks: tuple[Block, ...] = ()
    buttons: tuple[str, ...] = ("continue",)
    levels: tuple[tuple[str, str], ...] = ()  # factor and level of what it is about

    @property
    def asks(self) -> bool:
        """Whether there is anything to fill in."""
        return any(isinstance(b, Scale | Choice | TextField) for b in self.blocks)

    @property
    def required(self) -> tuple[str, ...]:
        """Names that need an answer."""
        return tuple(
            b.name
            for b in self.blocks
            if isinstance(b, Scale) or (isinstance(b, Choice) and not b.optional)
        )

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
