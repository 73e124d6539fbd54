"""Marking a place on the floor plan, seen from above: −z is up the page."""

from __future__ import annotations

from dataclasses import dataclass, replace

from seethrough.renderer.events import Event, KeyPress, PointerPress
from seethrough.tasks.kit.hud import Button, Element, FloorPlan, Label, Point, Rect
from seethrough.tasks.worlds.building.building import Building

SIZE, TOP = 0.78, 0.1
BUTTON = (0.22, 0.07)
BESIDE, WORDS = 0.035, 0.026  # from a sign to its words, and their height
STEPS = 32  # arrow keys move the mark by one part in so many of the building's side


@dataclass(frozen=True)
class PlanMark:
    """A mark in world units (x, z), or none yet, and whether it has been confirmed.

    `hint` says why the last click or key did nothing. `start` (x, z) and `here`, a place and a
    point before it, are shown on the plan if they are there.
    """

    aspect: float
    side: float
    mark: Point | None = None
    confirmed: bool = False
    hint: str = ""
    start: Point | None = None
    here: tuple[Point, Point] | None = None

    @property
    def rect(self) -> Rect:
        """Where the plan lies on the view: a square in its middle."""
        return Rect((self.aspect - SIZE) / 2, TOP, SIZE, SIZE)

    @property
    def button(self) -> Rect:
        """Where the button that confirms lies: below the plan."""
        width, height = BUTTON
        return Rect((self.aspect - width) / 2, TOP + SIZE + 0.02, width, height)

    def on_event(self, event: Event) -> PlanMark:
        """A click or arrow keys set the mark; enter or the button confirm it, once there is one."""
        if self.confirmed:
            return self
        if isinstance(event, PointerPress):
            if self.rect.contains(event.x, event.y):
                return replace(self, mark=self.world(event.x, event.y), hint="")
            hit = self.button.contains(event.x, event.y)
            return self._confirm() if hit else replace(self, hint="hint.outside")
        if not isinstance(event, KeyPress):
            return self
        if event.key == "enter":
            return self._confirm()
        return self._stepped(event.key)

    def _confirm(self) -> PlanMark:
        missing = self.mark is None
        return replace(self, confirmed=not missing, hint="hint.mark" if missing else "")

    def _stepped(self, key: str) -> PlanMark:
        """The mark after an arrow key; the first one puts it in the middle."""
        steps = {"left": (-1, 0), "right": (1, 0), "up": (0, -1), "down": (0, 1)}
        if key not in steps:
            return self
        if self.mark is None:
            return replace(self, mark=(0.0, 0.0), hint="")
        half, step = self.side / 2, self.side / STEPS
        x, z = (
            min(half, max(-half, old + way * step))
            for old, way in zip(self.mark, steps[key], strict=True)
        )
        return replace(self, mark=(x, z), hint="")

    def world(self, x: float, y: float) -> Point:
        """World (x, z) of a point of the view."""
        rect, scale = self.rect, self.side / SIZE
        return ((x - rect.x) * scale - self.side / 2, (y - rect.y) * scale - self.side / 2)

    def on_view(self, x: float, z: float) -> Point:
        """View units of a world place: the inverse of `world`."""
        rect, scale = self.rect, SIZE / self.side
        return (rect.x + (x + self.side / 2) * scale, rect.y + (z + self.side / 2) * scale)

    def elements(self, building: Building) -> tuple[Element, ...]:
        """The plan with its mark, all in view units, the button, and words beside where one began
        and is."""
        words: list[Label] = []
        if self.start is not None:
            x, y = self.on_view(*self.start)
            words.append(Label("plan.start", (x + BESIDE, y - WORDS / 2), WORDS))
        if self.here is not None:  # on the other side: one may be where one began
            x, y = self.on_view(*self.here[0])
            words.append(Label("plan.here", (x - BESIDE, y - WORDS / 2), WORDS, "right"))
        return (self.plan(building), Button("button.confirm", self.button), *words)

    def plan(self, building: Building, place: Point | None = None) -> FloorPlan:
        """The plan with its mark; where the answer is shown, with the true `place` (x, z) too."""
        lines = tuple((self.on_view(*a), self.on_view(*b)) for a, b in wall_lines(building))
        mark = None if self.mark is None else self.on_view(*self.mark)
        true = None if place is None else self.on_view(*place)
        start = None if self.start is None else self.on_view(*self.start)
        here = self.here and (self.on_view(*self.here[0]), self.on_view(*self.here[1]))
        return FloorPlan(self.rect, lines, mark, true, start, here)


def wall_lines(building: Building) -> list[tuple[Point, Point]]:
    """The outer walls, and the inner ones open at their doorways, as lines in world (x, z)."""
    p = building.parameters
    half = p.side / 2
    corners = [(-half, -half), (half, -half), (half, half), (-half, half)]
    lines = [(corners[i], corners[(i + 1) % 4]) for i in range(4)]
    for wall in building.floor.walls:
        for a, b in (
            (wall.start, wall.door - p.door_width / 2),
            (wall.door + p.door_width / 2, wall.end),
        ):
            if wall.axis == 0:
                lines.append(((a, wall.level), (b, wall.level)))
            else:
                lines.append(((wall.level, a), (wall.level, b)))
    return lines
