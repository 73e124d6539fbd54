"""What a session needs of the world: Protocols, so that window, offscreen and tests are alike."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Protocol

from seethrough.experiment.errors import InputError
from seethrough.experiment.pages.pages import Answers, Page, Paragraph
from seethrough.renderer.events import Event
from seethrough.tasks.kit.base import View

if TYPE_CHECKING:
    from seethrough.renderer.techniques.base import Parameters

MEANT = ("escape", "f1")  # keys that are for the session, whenever they were pressed
LEAVE = Page("leave", "leave.title", (Paragraph("leave.text"),), ("leave.no", "leave.yes"))


class Leave(Exception):
    """The participant or the experimenter ends the session now."""


class DisplayLost(InputError):
    """The graphics context is gone: the driver was reset or updated, or ran out of memory."""

    def __init__(self, said: str) -> None:
        super().__init__(
            f"display: the graphics driver gave up ({said}); every completed trial is saved: "
            "go on with the same --participant"
        )


class Display(Protocol):
    """Shows views."""

    @property
    def aspect(self) -> float:
        """Width / height of the view."""

    def show(self, view: View, technique: Parameters) -> float:
        """Draw and flip; the time of the flip."""

    def digest(self) -> str:
        """A digest of the picture shown last, without its HUD; empty where nothing was drawn."""

    def progress(self, fraction: float) -> None:
        """How much of the session is done: a line, never a clock."""

    def describe(self) -> Mapping[str, str]:
        """Driver, size, refresh: for the sidecar."""


class Input(Protocol):
    """Brings what the participant does."""

    def begin_trial(self, task: str, training: bool) -> None:
        """A trial of `task` is about to show its first view."""

    def events(self, view: View) -> list[Event]:
        """What happened until the next frame is due, ending with a Tick; waits for it."""

    def ask(self, page: Page) -> Answers:
        """Show a page until it is answered. Raises Leave if the session is to end."""
