"""Looking for one thing, in whatever way a scene lets one move, and clicking it."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.scene.visibility import Visibility
from seethrough.tasks.kit.hud import Sought
from seethrough.tasks.kit.skills.glance import Glance, heading, noticed, recognised
from seethrough.tasks.kit.skills.hands import Hands, learn_gain
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.strategy import Play

# Heights above the middle, in radians, from which an orbit is looked at, in turn [ours].
TILTS = (0.35, -0.35, 0.8, -0.8)
MOST_SECONDS = 180.0  # then one guesses as well: clicks something in each view
STEP = pi / 4  # a walker's turn from look to look [ours]
LOOKS = 8  # from one place, before a walker goes on [ours]
STRIDE = 0.15  # of the scene's extent that a walker goes on at least, and at most three [ours]
IN_MIND = 6  # things that a walker thinks of going to [ours]
GUESSES = 10  # at most: each is wrong, most likely [ours]
AGAIN = 3  # clicks at one thing in one view, before one turns on [ours]


def find_and_click(mood: Mood, glance: Glance) -> Play:
    """Look; click what is sought once it is made out; else move on, and look again."""
    p, hands = mood.profile, Hands(mood, glance.now)
    hands.wait(p.prepare)
    began, views, tried, guesses = glance.now, 0, 0, 0
    been = list[NDArray[np.float64]]()
    while True:
        seen, sought = glance.look(), _sought(glance)
        found = _made_out(mood, hands, seen, sought)
        late = hands.time - began > MOST_SECONDS and guesses < GUESSES
        if tried < (AGAIN if found is not None else 1 if late else 0):
            wrong = mood.uses("slips") and mood.rng.random() < min(1.0, p.slip / mood.care)
            aim = _place(mood, seen, found, tried + wrong)
            hands.click_at(*aim)
            tried += 1
            guesses += found is None
            glance = yield hands.take()
            continue
        tried, views = 0, views + 1
        for events_ready in _moved(mood, hands, glance, sought.moving, views, been):
            if events_ready:
                before = heading(glance.view)[0]
                glance = yield hands.take()
                if sought.moving == "orbit":
                    learn_gain(hands, before, heading(glance.view)[0], p.orbit_step)


def _sought(glance: Glance) -> Sought:
    return next(e for e in glance.view.hud if isinstance(e, Sought))


def _made_out(mood: Mood, hands: Hands, seen: Visibility, sought: Sought) -> int | None:
    """The thing that is sought, if it is noticed and can be told from others; what else is noticed
    among what may be asked for takes its time."""
    p = mood.profile
    index = noticed(seen, mood)
    hands.wait(p.attention_shift + (p.search_slope + p.saccade) * min(len(index), 12))
    mine = index[np.isin(index, sought.things)]
    clear = mine[recognised(seen, mine, mood)]
    if not len(clear):
        return None
    hands.wait(p.count)
    return int(clear[np.argmax(seen.area[clear])])


def _place(mood: Mood, seen: Visibility, thing: int | None, tried: int) -> tuple[float, float]:
    """Where to click: in the middle of what shows of the thing; beside that, once it was wrong."""
    if thing is None:
        some = np.nonzero(seen.area > 0)[0]
        thing = int(mood.rng.choice(some)) if len(some) else 0
    x, y = seen.position[thing].tolist()
    reach = 0.5 * sqrt(float(seen.area[thing])) * tried
    dx, dy = (reach * mood.rng.standard_normal(2)).tolist()
    return (min(max(x + dx, 0.01), 1.32), min(max(y + dy, 0.01), 0.99))


def _moved(
    mood: Mood, hands: Hands, glance: Glance, moving: str, views: int,
    been: list[NDArray[np.float64]],
) -> Iterator[bool]:  # fmt: skip
    """On to the next view, as the scene lets one; `been` are the places that a walker looked about
    from."""
    if moving == "fixed":
        hands.key("right")
    elif moving == "walk":
        if views % LOOKS:
            hands.turn(STEP, drag=True)
        else:
            been.append(glance.view.camera.eye)
            yield from _walk_on(mood, hands, glance, been)
            return
    else:
        aim = TILTS[views % len(TILTS)]
        hands.turn(mood.profile.orbit_step, aim - heading(glance.view)[1], drag=True)
    yield True


def _walk_on(
    mood: Mood, hands: Hands, glance: Glance, been: list[NDArray[np.float64]]
) -> Iterator[bool]:
    """To where one has not been: of some things that come to mind, towards the one that lies
    farthest from all places one looked about from."""
    centers, eye = glance.view.scene.centers[:, [0, 2]], glance.view.camera.eye[[0, 2]]
    places = np.array(been)[:, [0, 2]]
    some = mood.rng.choice(len(centers), min(IN_MIND, len(centers)), replace=False)
    apart = np.linalg.norm(centers[some, None] - places[None], axis=2).min(axis=1)
    goal = centers[some[int(np.argmax(apart))]] - eye
    yaw = float(np.arctan2(-goal[0], -goal[1]))
    turn = (yaw - heading(glance.view)[0] + pi) % (2 * pi) - pi
    hands.turn(turn, drag=True)
    yield True
    stride = max(STRIDE * float(np.hypot(*np.ptp(centers, axis=0))), 0.1)
    for _ in hands.walking(float(np.clip(np.hypot(*goal), stride, 3 * stride))):
        yield True
