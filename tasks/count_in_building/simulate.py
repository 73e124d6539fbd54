"""T4: count one kind of thing in the building, telling new ones by where they seem to stand."""

from __future__ import annotations

from math import dist

from seethrough.tasks.kit.skills.counting import slips
from seethrough.tasks.kit.skills.glance import Glance
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.places import Place
from seethrough.tasks.kit.skills.strategy import Play, Strategy
from seethrough.tasks.kit.skills.walking import Found, Walker, go_on

MOST_SECONDS = 900.0


class Tally:
    """Places of what has been counted, and which of it has stayed in sight since the last look."""

    def __init__(self) -> None:
        self.places: list[Place] = []
        self.tracked: dict[int, int] = {}  # index in the scene → entry of `places`

    def add(self, walker: Walker, found: Found) -> int:
        """Match what was found to what was counted; how many are taken for new."""
        p = walker.mood.profile
        tracked: dict[int, int] = {}
        new = 0
        used: set[int] = set()
        # What has stayed in sight is known; the rest is told by its place.
        order = sorted(found.index, key=lambda i: i not in self.tracked)
        for index in order:
            place = walker.place(index, found.sight)
            entry = self.tracked.get(index)
            if entry is None:
                within = p.same_place + 0.1 * dist(place, walker.eye)
                entry = self._nearest(place, within, used)
            if entry is None:
                entry = len(self.places)
                self.places.append(place)
                new += 1
            else:
                (a, b), (c, d) = self.places[entry], place
                self.places[entry] = ((a + c) / 2, (b + d) / 2)
            used.add(entry)
            if len(tracked) < p.tracked:
                tracked[index] = entry
        self.tracked = tracked
        return new

    def _nearest(self, place: Place, within: float, used: set[int]) -> int | None:
        free = [k for k in range(len(self.places)) if k not in used]
        if not free:
            return None
        ways = [dist(self.places[k], place) for k in free]
        nearest = min(ways)
        return free[ways.index(nearest)] if nearest < within else None


def count_things(mood: Mood, glance: Glance) -> Play:
    """Walk until little is left unseen, then type the number."""
    p = mood.profile
    walker = Walker(mood, glance)
    walker.hands.wait(p.prepare)
    began = glance.now
    tally, count, goal = Tally(), 0, None
    while walker.hands.time - began < MOST_SECONDS:
        found = walker.look()
        new = tally.add(walker, found)
        if len(found.index):
            walker.settle()
            walker.hands.wait(p.count * new + p.recheck * (len(found.index) - new))
        count += new + slips(new, mood)
        if walker.known.left < p.diligence / mood.care:
            break
        goal = yield from go_on(walker, goal)
    walker.settle()
    walker.hands.type(str(max(count, 0)))
    yield walker.hands.take()


STRATEGY = Strategy(
    count_things,
    {
        "slips": "counting",
        "depth_noise": "places in the building",
        "drift": "places in the building",
    },
)
