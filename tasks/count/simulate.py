"""T1: counting red objects over several views of the abstract world."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from seethrough.tasks.kit.skills.counting import seconds_to_count, slips
from seethrough.tasks.kit.skills.glance import WHOLE, Glance, heading
from seethrough.tasks.kit.skills.hands import Hands, learn_gain
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.red import red_things
from seethrough.tasks.kit.skills.strategy import Play, Strategy

MOST_VIEWS = 18  # three times round
TILT = 0.35  # views alternate between this much above and below [ours]


def count_red(mood: Mood, glance: Glance) -> Play:
    """Count in the first view, then turn and look for what is new until views bring no news."""
    p = mood.profile
    hands = Hands(mood, glance.now)
    hands.wait(p.prepare)
    counted: set[int] = set()
    tally, quiet, views, through = 0, 0, 0, False
    while True:
        red = red_things(mood, glance)
        new = new_ones(mood, red, counted, first=views == 0)
        seen = glance.look()
        if views:
            hands.wait(p.recheck * len(red))
        hands.wait(seconds_to_count(seen.position[new], mood))
        tally += len(new) + slips(len(new), mood)
        counted.update(red.tolist())  # what was taken for a counted one stays so
        views += 1
        # One more among thirty is hardly news, and may be an old one taken for new.
        quiet = 0 if len(new) > p.no_news * tally else quiet + 1
        # Nobody believes a first view; who has seen red things through others needs fewer more.
        through = through or bool((seen.weight[red] < WHOLE).any())
        patience = 1 + max(0.0, p.patience * mood.care - 1) * (1 - p.trust_cloud * through)
        # A patience of 1.3 is one quiet view, and another three times out of ten.
        if quiet + mood.rng.random() > patience or views >= MOST_VIEWS:
            break
        yaw, height = heading(glance.view)
        aim = TILT if views % 2 == 0 else -TILT
        hands.turn(p.orbit_step, aim - height, drag=True)
        before = yaw
        glance = yield hands.take()
        learn_gain(hands, before, heading(glance.view)[0], p.orbit_step)
    hands.type(str(max(tally, 0)))
    yield hands.take()


def new_ones(
    mood: Mood, red: NDArray[np.int64], counted: set[int], first: bool
) -> NDArray[np.int64]:
    """Which of these are taken for not yet counted: memory mixes some up when the view turned."""
    if first or not mood.uses("view_changes"):
        return np.array([i for i in red if i not in counted], dtype=np.int64)
    p = mood.profile
    forget, mistake = (min(1.0, x / mood.care) for x in (p.forget, p.mistake_old))
    draws = mood.rng.random(len(red))
    taken = [
        draw < forget if i in counted else draw >= mistake
        for i, draw in zip(red.tolist(), draws, strict=True)
    ]
    new: NDArray[np.int64] = red[np.array(taken, dtype=bool)]
    return new


STRATEGY = Strategy(
    count_red,
    {
        "crowding": "many small things on the view",
        "subitising": "many things at a glance",
        "slips": "counting",
        "view_changes": "counting over several views",
    },
    heights=(-TILT, TILT),
)
