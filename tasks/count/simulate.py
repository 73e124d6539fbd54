"""T1: counting red objects over several views of the abstract world."""

from __future__ import annotations

from seethrough.tasks.kit.skills.counting import seconds_to_count, slips
from seethrough.tasks.kit.skills.glance import Glance, heading
from seethrough.tasks.kit.skills.hands import Hands, learn_gain
from seethrough.tasks.kit.skills.memory import meet, memory_of
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.red import red_things
from seethrough.tasks.kit.skills.strategy import Play, Strategy

MOST_VIEWS = 18  # three times round
TILT = 0.35  # views alternate between this much above and below [ours]


def count_red(mood: Mood, glance: Glance) -> Play:
    """Count in the first view, then turn for what is new while a look is worth its time."""
    p = mood.profile
    hands = Hands(mood, glance.now)
    hands.wait(p.prepare)
    memory, tally = memory_of(mood), 0
    while True:
        red, view = red_things(mood, glance), glance.view
        seen = glance.look()
        met = meet(mood, seen, view.scene, view.camera, red)
        hands.wait(p.recheck * len(red) if memory.looks else 0.0)
        new = memory.take(met, None if mood.uses("view_changes") else red)
        hands.wait(seconds_to_count(seen.position[red[new]], mood))
        tally += int(new.sum()) + slips(int(new.sum()), mood)
        # The next look costs a turn and telling every thing as counted already.
        cost = hands.turn_seconds(p.orbit_step) + p.attention_shift + p.recheck * len(memory)
        if p.worth * mood.care * memory.expected() < cost or memory.looks >= MOST_VIEWS:
            break
        yaw, height = heading(view)
        aim = TILT if memory.looks % 2 == 1 else -TILT
        hands.turn(p.orbit_step, aim - height, drag=True)
        glance = yield hands.take()
        learn_gain(hands, yaw, heading(glance.view)[0], p.orbit_step)
    hands.type(str(max(tally, 0)))
    yield hands.take()


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
