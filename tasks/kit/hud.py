"""What lies over the 3D view, as values: the display draws it, tasks test clicks against it.

Positions and sizes are in view units (renderer/events.py): 1 is the height of the view.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene

Point = tuple[float, float]


@dataclass(frozen=True)
class Rect:
    """A rectangle: upper left corner, width, height."""

    x: float
    y: float
    width: float
    height: float

    def contains(self, x: float, y: float) -> bool:
        """Whether the point lies in the rectangle, borders included."""
        return self.x <= x <= self.x + self.width and self.y <= y <= self.y + self.height


@dataclass(frozen=True)
class Label:
    """A line of text. `text` is a key of the language file, `values` fill its placeholders.

    `at` is its upper left corner, or the middle or right end of its upper edge. A "hint" says what
    is missing, "practice" that nothing counts yet.
    """

    text: str
    at: Point
    size: float = 0.035
    align: str = "left"  # or "center" or "right"
    values: tuple[tuple[str, str], ...] = ()
    tone: str = "plain"  # or "hint" or "practice"


@dataclass(frozen=True)
class Button:
    """Something to click; `chosen` when it is the current answer.

    `text` is a digit, a letter, or a key of the language file ("button.confirm").
    """

    text: str
    rect: Rect
    chosen: bool = False


@dataclass(frozen=True)
class Entry:
    """What has been typed so far."""

    text: str
    rect: Rect


@dataclass(frozen=True, eq=False)
class Inset:
    """A small picture of a scene of its own, such as the current target, over the view."""

    scene: Scene
    look: Callable[[], Camera]
    rect: Rect

    @property
    def camera(self) -> Camera:
        """Where the scene is seen from: worked out when somebody draws it."""
        return self.look()


@dataclass(frozen=True)
class FloorPlan:
    """Walls seen from above as ((x0, y0), (x1, y1)) lines, the participant's mark, if set, where
    the thing really stands, once that may be known, and where one began (`start`) and is (`here`:
    the place, and a point in the direction of view), where a study shows that.

    All in view units, within `rect`.
    """

    rect: Rect
    walls: tuple[tuple[Point, Point], ...]
    mark: Point | None = None
    place: Point | None = None
    start: Point | None = None
    here: tuple[Point, Point] | None = None


@dataclass(frozen=True)
class Mark:
    """A ring about a place of the view, or a cross where one aims."""

    at: Point
    radius: float = 0.02
    form: str = "ring"  # or "cross"


@dataclass(frozen=True)
class Sought(Label):
    """The label that says what to look for: the indices of the `things` that are it, and how one
    moves. A simulated person reads in it what others read in its text."""

    things: tuple[int, ...] = ()
    moving: str = "orbit"


Element = Label | Button | Entry | Inset | FloorPlan | Mark
MARGIN = 0.02  # from the view's border


def hint(text: str, corner: Point, values: tuple[tuple[str, str], ...] = ()) -> Label:
    """What is missing, on the right, above whatever begins at `corner`: (aspect, its top)."""
    size = 0.035
    return Label(text, (corner[0] - MARGIN, corner[1] - 1.6 * size), size, "right", values, "hint")


def practice_mark(aspect: float) -> Label:
    """Says in the upper right corner that nothing counts yet."""
    return Label("hint.practice", (aspect - MARGIN, MARGIN), 0.028, "right", tone="practice")
