"""T4: count one kind of thing in the building, telling new ones by where they seem to stand."""

from __future__ import annotations

import numpy as np

from seethrough.tasks.kit.skills.counting import slips
from seethrough.tasks.kit.skills.glance import Glance, blurred
from seethrough.tasks.kit.skills.memory import NOVICE, Memory, Met, doubt
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.strategy import Play, Strategy
from seethrough.tasks.kit.skills.walking import Found, Walker, go_on

MOST_SECONDS = 900.0
SHAPES = np.full(1000, "", dtype="<U32")  # all are of the asked kind


class Tally:
    """What has been counted, told by its place, and what of it has stayed in sight since."""

    def __init__(self, mood: Mood) -> None:
        self.memory = Memory(mood.learned.share("found again", 0.5, NOVICE), size=2)
        self.tracked: dict[int, int] = {}  # index in the scene → entry of `memory`

    def add(self, walker: Walker, found: Found) -> int:
        """Match what was found to what was counted; how many are taken for new."""
        # What has stayed in sight is known (ACT-R's fingers of instantiation); all else is told by
        # its place.
        stayed = [i for i in found.clear if i in self.tracked]
        rest = [i for i in found.clear if i not in self.tracked]
        entries = {i: self.tracked[i] for i in stayed}
        new = 0
        if rest:
            new = int(self.memory.take(_met(walker, found, rest), busy=set(entries.values())).sum())
            entries |= dict(zip(rest, self.memory.entries.tolist(), strict=True))
        self.tracked = dict(list(entries.items())[: walker.mood.profile.tracked])
        return new


def _met(walker: Walker, found: Found, index: list[int]) -> Met:
    """The things of these numbers, where one believes them to stand."""
    p = walker.mood.profile
    place = np.array([walker.place(i, found.clear[i]) for i in index])
    clear = np.array([found.clear[i] for i in index])
    here = np.add(walker.eye, walker.error)
    return Met(place, doubt(place - here, p.depth_noise * blurred(clear, p)), SHAPES[: len(index)])


def count_things(mood: Mood, glance: Glance) -> Play:
    """Walk until little is left unseen, then type the number."""
    p = mood.profile
    walker = Walker(mood, glance)
    walker.hands.wait(p.prepare)
    began = glance.now
    tally, count, goal = Tally(mood), 0, None
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
