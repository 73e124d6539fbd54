"""Pages between the trials, as values: the display draws them, a participant fills them in.

Every `text` is a key of the language file or of the study's [texts].
"""

from __future__ import annotations

from dataclasses import dataclass

from experiment.plates import Plate
from renderer.techniques.standard import Standard
from tasks.base import View

Answers = dict[str, str]


@dataclass(frozen=True)
class Paragraph:
    """Running text; `values` fill its placeholders."""

    text: str
    values: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class Scale:
    """A Likert scale from 0 to `steps` − 1, with a word at each end."""

    name: str
    text: str
    low: str
    high: str
    steps: int = 5
    values: tuple[tuple[str, str], ...] = ()


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
    """Free text, may stay empty."""

    name: str
    text: str
    lines: int = 5


@dataclass(frozen=True, eq=False)
class Picture:
    """A live picture of a trial's view, in the study's technique; height in screen heights."""

    view: View
    technique: object = Standard()
    height: float = 0.36


@dataclass(frozen=True, eq=False)
class PlatePicture:
    """A red–green plate."""

    plate: Plate


Block = Paragraph | Scale | Choice | TextField | Picture | PlatePicture


@dataclass(frozen=True)
class Page:
    """A page; `buttons` are text keys, the answer's "button" is the position of the one pressed.

    A page with scales or choices goes on only when each is answered.
    """

    name: str
    title: str
    blocks: tuple[Block, ...] = ()
    buttons: tuple[str, ...] = ("continue",)

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
