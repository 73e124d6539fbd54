"""T3: find the thing that occurs once, go near, and mark its place on the plan."""

from __future__ import annotations

from math import dist

import numpy as np

from seethrough.tasks.kit.hud import Button, FloorPlan
from seethrough.tasks.kit.skills.glance import Glance
from seethrough.tasks.kit.skills.hands import Hands
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.places import Place
from seethrough.tasks.kit.skills.strategy import Play, Strategy
from seethrough.tasks.kit.skills.walking import Walker, go_on

AGAIN = 0.01  # with so little left unseen and nothing found, one begins again
MOST_SECONDS = 900.0  # then one gives up and marks a guess


def find_unique(mood: Mood, glance: Glance) -> Play:
    """Search, approach, end the search, mark the plan."""
    walker = Walker(mood, glance)
    walker.hands.wait(mood.profile.prepare)
    began = glance.now
    goal, believed = None, (0.0, 0.0)
    while walker.hands.time - began < MOST_SECONDS:
        found = walker.look()
        if len(found.index):
            walker.settle()
            index = found.index[0]
            believed = walker.place(index, found.clear[index])
            there = (believed[0] - walker.error[0], believed[1] - walker.error[1])
            if dist(there, walker.eye) <= mood.profile.near_enough:
                break
            yield from walker.hop(there)
            continue
        if walker.known.left < AGAIN:
            walker.known.doubt()
        goal = yield from go_on(walker, goal)
    walker.settle()
    walker.hands.wait(mood.profile.prepare)
    walker.hands.key("space")
    glance = yield walker.hands.take()
    yield from _mark(mood, walker.hands, glance, believed)


def _mark(mood: Mood, hands: Hands, glance: Glance, believed: Place) -> Play:
    """Work out where on the plan that was, click there, click to confirm."""
    p = mood.profile
    plan = next(e for e in glance.view.hud if isinstance(e, FloorPlan))
    button = next(e for e in glance.view.hud if isinstance(e, Button))
    hands.wait(2 * p.prepare)
    mark = np.array(believed)
    if mood.uses("drift"):
        mark = mark + p.plan_noise * mood.rng.standard_normal(2)
    floor = next(o for o in glance.view.scene.objects if o.kind == "floor")
    side = float(np.hypot(*floor.transform[[0, 2], 0])) * np.ptp(floor.mesh.vertices[:, 0])
    share = np.clip(mark / side + 0.5, 0.01, 0.99)
    hands.click_at(
        plan.rect.x + share[0] * plan.rect.width, plan.rect.y + share[1] * plan.rect.height
    )
    hands.click(button.rect)
    yield hands.take()


STRATEGY = Strategy(
    find_unique,
    {"depth_noise": "places in the building", "drift": "places in the building"},
)
