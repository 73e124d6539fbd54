"""A display without a window: keeps the view and draws only when somebody looks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from seethrough.experiment.display.clock import Clock
from seethrough.experiment.display.driver import describe
from seethrough.experiment.display.looking import Looking
from seethrough.renderer.scene.visibility import Visibility
from seethrough.tasks.kit.base import View

if TYPE_CHECKING:
    from moderngl import Context

    from seethrough.renderer.techniques.base import Parameters


class OffscreenDisplay:
    """Shows nothing to nobody; `look` tells what could be seen, by eyes that may be given."""

    def __init__(
        self,
        context: Context,
        size: tuple[int, int],
        clock: Clock,
        looking: Looking | None = None,
    ) -> None:
        self.size = size
        self.clock = clock
        self.looking = looking or Looking(context, size, simple=True)
        self._context = context
        self._shown: View | None = None

    @property
    def aspect(self) -> float:
        """Width / height of the view."""
        return self.size[0] / self.size[1]

    @property
    def technique(self) -> Parameters | None:
        """What the view shown last is drawn with."""
        return self.looking.technique

    def show(self, view: View, technique: Parameters) -> float:
        """Keep the view; the time now."""
        self._shown = view
        self.looking.technique = technique
        return self.clock.now()

    def digest(self) -> str:
        """Nothing is drawn for nobody."""
        return ""

    def progress(self, fraction: float) -> None:
        """Nobody sees the progress line."""

    def describe(self) -> Mapping[str, str]:
        """Driver and size."""
        return {**describe(self._context), "size": f"{self.size[0]}x{self.size[1]}", "window": "no"}

    def look(self) -> Visibility:
        """What can be seen in the view shown last. Raises RuntimeError before the first."""
        if self._shown is None:
            raise RuntimeError("nothing has been shown yet")
        return self.looking.look(self._shown)
