"""Getting about in the building: look round where one is, walk to where most is still unseen."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from functools import lru_cache
from math import atan2, cos, dist, hypot, pi, sin

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.events import Event
from seethrough.renderer.scene.scene import Scene
from seethrough.tasks.kit.hud import Inset
from seethrough.tasks.kit.skills.counting import saccade
from seethrough.tasks.kit.skills.glance import WINDOW_PIXELS, Glance, likely
from seethrough.tasks.kit.skills.hands import Hands
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.places import (
    CELL,
    COS_HALF_VIEW,
    DIRECTIONS,
    STRIDES,
    THERE,
    Known,
    Place,
    apart,
    crossed,
    layout,
    turn_to,
)
from seethrough.tasks.kit.skills.sight import Sight, Thing, sight

STEP = 2 * pi / DIRECTIONS
THING = 1.5  # radius of a usual thing, for how well it would be seen from afar [ours]
# Window pixels of a usual thing at distance 1, of which it fills half its circle: the picture is
# one unit high at distance 1 / (2 tan 30°), and three quarters of its width high.
FILLED = 0.5 * pi * (THING / (2 * np.tan(np.pi / 6))) ** 2 * 0.75 * WINDOW_PIXELS
REACH = 3  # cells about a place that count as worth going there for [ours]
TURNS = np.array([apart(k * STEP, 0.0) for k in range(1, DIRECTIONS)])
TURN_COST = 0.25 / STEP  # seconds a radian is thought to cost when choosing [ours]
GOAL = 0.5  # a cell is a goal if it is unseen at least half as much as any [ours]
MOST_KEPT = 2048  # arrays over cells that a building keeps
LOOK = 1.0  # seconds that a look somewhere else is thought to cost when choosing [ours]
TURN_AND_LOOK = LOOK + TURN_COST * np.abs(TURNS)


@dataclass(frozen=True, eq=False)
class Found:
    """Things of the asked kind recognised, in the order of the scene, each with the pixels that
    showed it clearly."""

    clear: dict[int, float]

    @property
    def index(self) -> list[int]:
        """Their numbers."""
        return list(self.clear)


class Walker:
    """One trial's walk: what is known, where one believes to be, and the hands."""

    def __init__(self, mood: Mood, glance: Glance) -> None:
        self.mood = mood
        self.hands = Hands(mood, glance.now)
        self.known = Known(layout(glance.view.scene))
        self.glance = glance
        self._asked = _of_kind(glance.view.scene, _asked(glance))
        self._walls: set[int] = set()  # objects that are no things and have been visible
        self.error = (0.0, 0.0)  # where one believes to be, less where one is
        self.recognised: set[int] = set()  # what has been made out, and is known again
        self.passed: dict[int, float] = {}  # the same made out in passing, as in `Found`
        # Of known things behind known walls, how many were seen well enough to be told.
        self.through = mood.learned.share("through walls", 0.0, 1.0)
        self._busy = glance.now  # until then one thinks about what was seen last
        self._one = mood.profile.search_slope + saccade(0.2, mood)  # seconds a thing noticed takes
        # What hides, the cell and experience that the quality of looks was worked out for, and it.
        self._quality: tuple[NDArray[np.bool_], tuple[int, float], NDArray[np.float64]] | None = (
            None
        )

    @property
    def glance(self) -> Glance:
        """What is displayed."""
        return self._glance

    @glance.setter
    def glance(self, glance: Glance) -> None:
        self._glance = glance
        camera = glance.view.camera
        x, _, z = camera.eye.tolist()
        self.eye = (x, z)
        # What can be seen from a cell is judged from its middle.
        self.cell = self.known.layout.grid.cell(self.eye)
        self.yaw = atan2(-camera.rotation.item(2, 0), camera.rotation.item(0, 0))

    def look(self) -> Found:
        """Look, and remember what has been seen; found is also what was made out in passing."""
        self.settle()
        view, known = self._sight(), self.recognised.copy()
        things, asked = self._make_out(view, self._noticed(view))
        self._check(view)
        self._inspect()
        # What was made out before is known at its place.
        news = sum(thing.number not in known for thing in things)
        self._think(self.mood.profile.count, news)
        if self.passed:
            asked = {**self.passed, **asked}
            asked = {number: asked[number] for number in sorted(asked)}
            self.passed.clear()
        return Found(asked)

    def pass_by(self) -> None:
        """Look while on the move: at nothing that is known already."""
        view = self._sight()
        news = [thing for thing in self._noticed(view) if thing.number not in self.recognised]
        things, asked = self._make_out(view, news)
        self.passed.update(asked)
        self._think(0.0, len(things))

    def _sight(self) -> Sight:
        return sight(self.glance.look(), self.glance.view.scene, self.mood.profile)

    def _luck(self) -> list[float]:
        """One draw for each object of the scene, however few are visible."""
        luck: list[float] = self.mood.rng.random(len(self._asked)).tolist()
        return luck

    def _noticed(self, view: Sight) -> list[Thing]:
        """Which of the things seen are noticed."""
        luck = self._luck()
        return [thing for thing in view.things if luck[thing.number] < thing.notice]

    def _make_out(self, view: Sight, things: list[Thing]) -> tuple[list[Thing], dict[int, float]]:
        """The things noticed; and those of the asked kind, with the pixels that show them."""
        luck = self._luck()
        self._see_walls(view, luck)
        clear: dict[int, float] = {}
        unclear: list[Thing] = []
        for thing in things:
            if luck[thing.number] < thing.recognise:
                clear[thing.number] = thing.clear
            else:
                unclear.append(thing)
        self.recognised.update(clear)
        if self.known.unclear:
            for made_out in clear:
                self.known.unclear.pop(made_out, None)
        self._wonder(unclear)
        return things, {index: pixels for index, pixels in clear.items() if self._asked[index]}

    def _see_walls(self, view: Sight, luck: list[float]) -> None:
        """Remember walls once enough of them was seen."""
        new = {
            wall
            for wall, chance in view.walls.items()
            if luck[wall] < chance and wall not in self._walls
        }
        if new:
            self.known.see_walls(new)
            self._walls |= new

    def _think(self, seconds: float, things: int) -> None:
        """Thinking about a look begins now and goes on while the feet and hands do."""
        seconds += self.mood.profile.attention_shift + things * self._one
        self._busy = max(self._busy, self.hands.time) + seconds * self.mood.pace

    def settle(self) -> None:
        """Think to the end about what was seen: before the next look, and before decisions."""
        self.hands.time = max(self.hands.time, self._busy)

    def _check(self, view: Sight) -> None:
        """Learn how far walls hide: are known things seen that stand behind known walls?

        Places are checked, not things that happen to shine through: what is not seen counts too.
        """
        known = np.array(sorted(self.recognised), dtype=np.int64)
        if not len(known):
            return
        places = self.glance.view.scene.transforms[known][:, [0, 2], 3]
        way = places - self.eye
        far = np.maximum(np.hypot(way[:, 0], way[:, 1]), 1.0)
        ahead = (way @ [-sin(self.yaw), -cos(self.yaw)]) > COS_HALF_VIEW * far
        walls = self.known.layout.segments[self.known.walls]
        behind = ahead & crossed(np.array(self.eye), places, walls)
        if not behind.any():
            return
        p = self.mood.profile
        told = {thing.number: thing.recognise for thing in view.things}
        expected = likely(FILLED / far[behind] ** 2, p.recognise, p.recognise_spread)
        seen = sum(told.get(number, 0.0) for number in known[behind].tolist())
        self.through.add(seen, float(expected.sum()))

    def _inspect(self) -> None:
        plan = self.known.layout.grid
        inside = plan.ahead(self.cell, self.yaw)
        here = plan.near(self.cell)
        self.known.inspect(np.where(inside, self.quality(), here))
        if self.known.unclear:
            self.known.unclear = {i: c for i, c in self.known.unclear.items() if not here[c]}

    def _wonder(self, things: list[Thing]) -> None:
        """Where something was noticed and not made out, one has not really looked yet."""
        for thing in things:
            if thing.number not in self.recognised:
                x, z = self.place(thing.number, thing.clear)
                place = (x - self.error[0], z - self.error[1])
                self.known.unclear[thing.number] = self.known.layout.grid.cell(place)

    def quality(self) -> NDArray[np.float64]:
        """(n,) how surely a thing in each cell would be recognised from where one stands."""
        hidden = self.known.hidden(self.cell)
        about = (self.cell, self.through.cases)
        if self._quality is None or self._quality[0] is not hidden or self._quality[1] != about:
            sure = self._sure()
            made = np.where(hidden, min(self.through.mean, 1.0) * sure, sure)
            self._quality = (hidden, about, made)
        return self._quality[2]

    def _sure(self) -> NDArray[np.float64]:
        """(n,) the same if nothing hid anything; looked up where nobody's eyes differ."""
        p, kept = self.mood.profile, self.known.layout.grid.sure
        key = (self.cell, p.recognise, p.recognise_spread)
        if key not in kept:
            distance = np.maximum(self.known.layout.grid.ways(self.cell)[0], 1.0)
            if len(kept) >= MOST_KEPT:
                kept.clear()  # calibration tries profile after profile
            kept[key] = likely(FILLED / distance**2, p.recognise, p.recognise_spread)
        return kept[key]

    def choose(self) -> tuple[float, Place | None]:
        """The next thing to do: (turn, None) to look round, (turn, place) to go somewhere.

        What is most worth its time: unseen cells that a look would show, over seconds.
        """
        distance, toward = self.known.layout.grid.ways(self.cell)
        worth = self.known.gain(self.quality())
        inside = self.known.layout.grid.ahead(self.cell, self.yaw + TURNS)
        gains = (inside @ worth) / TURN_AND_LOOK
        side = int(gains.argmax())
        best, choice = float(gains[side]), (float(TURNS[side]), None)
        seconds = distance / self.hands.speed + 3 * LOOK
        # Only what is unseen is worth going to: there, one will at least have seen that.
        unseen = self.known.unseen
        rates = np.where(
            unseen > GOAL * unseen.max(),
            _nearby(unseen, self.known.layout.grid.size) / seconds,
            0.0,
        )
        there = int(rates.argmax())
        if rates[there] > best:
            x, z = self.known.layout.grid.centers[there].tolist()
            return float(apart(toward[there], self.yaw)), (x, z)
        return choice

    def turn(self, angle: float) -> Generator[list[Event], Glance, None]:
        """Turn, with a look at each heading in passing, and see where that led."""
        before = self.yaw
        for ended in self.hands.turning(angle, parts=self._parts(round(abs(angle) / STEP))):
            self.glance = yield self.hands.take()
            if not ended:
                self.pass_by()
        turned = apart(self.yaw, before)
        if turned * angle > 0 and not 0.7 < turned / angle < 1.4:
            self.hands.gain *= turned / angle

    def hop(self, goal: Place) -> Generator[list[Event], Glance, None]:
        """One cell on towards `goal`: face one of eight directions, walk, see how far it went."""
        aim = round(turn_to(goal[0] - self.eye[0], goal[1] - self.eye[1]) / STEP) * STEP
        if abs(turn := apart(aim, self.yaw)) > 1e-9:
            yield from self.turn(turn)
            self.pass_by()
        direction = round(aim / STEP)
        distance = CELL * (2**0.5 if direction % 2 == 1 else 1.0)
        before = self.eye
        parts = self._parts(STRIDES[direction % DIRECTIONS])
        for ended in self.hands.walking(distance, parts):
            self.glance = yield self.hands.take()
            if not ended:
                self.pass_by()
        self.known.move()
        went = dist(self.eye, before)
        if not 0.7 < went / distance < 1.4 and went > 0:
            self.hands.speed *= went / distance
        if self.mood.uses("drift"):
            spread = self.mood.profile.drift * went**0.5
            x, z = self.mood.rng.standard_normal(2).tolist()
            self.error = (self.error[0] + spread * x, self.error[1] + spread * z)

    def _parts(self, usual: int) -> int:
        """Into how many parts looks divide a way that they usually divide into so many."""
        return max(1, usual * self.mood.profile.passing)

    def place(self, index: int, clear: float) -> Place:
        """Where one believes a thing to stand that so many pixels show clearly: direction good,
        distance uncertain."""
        mood, p = self.mood, self.mood.profile
        (x, z), transforms = self.eye, self.glance.view.scene.transforms
        across, along = transforms.item(index, 0, 3) - x, transforms.item(index, 2, 3) - z
        if mood.uses("depth_noise"):
            spread = p.depth_noise * (1 + p.recognise / max(clear, 1.0)) ** 0.5
            # Near things are seen at their distance; far ones look nearer.
            bias = 1 - (1 - p.depth_bias) * min(1.0, hypot(across, along) / 30)
            noise = float(np.exp(spread * mood.rng.standard_normal()))
            across, along = across * bias * noise, along * bias * noise
        return x + self.error[0] + across, z + self.error[1] + along


def go_on(walker: Walker, goal: Place | None) -> Generator[list[Event], Glance, Place | None]:
    """One step of the search: on to a goal, or whatever is worth most now; the goal, if any."""
    if goal is None or dist(goal, walker.eye) < THERE:
        walker.settle()
        turn, goal = walker.choose()
        if goal is None:
            yield from walker.turn(turn)
            return None
    yield from walker.hop(goal)
    return goal


def _asked(glance: Glance) -> str:
    """The kind that turns in the corner of the view."""
    inset = next(e for e in glance.view.hud if isinstance(e, Inset))
    return inset.scene.objects[0].kind


@lru_cache(maxsize=64)
def _of_kind(scene: Scene, kind: str) -> NDArray[np.bool_]:
    """(n,) which objects are of a kind."""
    return np.array([o.kind == kind for o in scene.objects], dtype=bool)


@lru_cache(maxsize=8)
def _within_reach(size: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """(size,) first cell of a line within `REACH` of each, and the one after the last."""
    cells = np.arange(size)
    return np.maximum(cells - REACH, 0), np.minimum(cells + REACH + 1, size)


def _nearby(unseen: NDArray[np.float64], size: int) -> NDArray[np.float64]:
    """(n,) unseen cells within `REACH` of each cell, by sums along both axes."""
    low, high = _within_reach(size)
    total, sums = unseen.reshape(size, size), np.zeros((size + 1, size))
    for _ in range(2):
        total.cumsum(axis=0, out=sums[1:])
        total = (sums.take(high, axis=0) - sums.take(low, axis=0)).T
    return total.ravel()
