"""How far do two things seem to be, and which of them is nearer?"""

from __future__ import annotations

from math import exp

import numpy as np

from seethrough.tasks.depth_order.pair import LIFT
from seethrough.tasks.kit.hud import Label
from seethrough.tasks.kit.skills.glance import Glance, blurred, clear_pixels, recognised
from seethrough.tasks.kit.skills.hands import Hands
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.strategy import Play, Strategy

NEAR_MARK = 0.03  # view heights between a mark and the thing it stands for


def judge_depth(mood: Mood, glance: Glance) -> Play:
    """Look at what is under each mark, judge its depth, and say which is nearer.

    What is not seen under its mark leaves nothing but a guess.
    """
    p, hands = mood.profile, Hands(mood, glance.now)
    hands.wait(p.prepare)
    seen, camera = glance.look(), glance.view.camera
    marks = [e for e in glance.view.hud if isinstance(e, Label) and e.text in ("A", "B")]
    looks = []
    for mark in marks:
        hands.wait(p.attention_shift + p.search_slope + p.saccade)
        away = np.hypot(*(seen.position - np.array(mark.at) - [0.0, LIFT]).T)
        away = np.where(seen.pixels > 0, away, np.inf)
        thing = int(np.argmin(away))
        known = away[thing] <= NEAR_MARK and bool(recognised(seen, np.array([thing]), mood)[0])
        if not known:
            looks.append(exp(mood.rng.standard_normal()) * float(np.linalg.norm(camera.eye)))
            continue
        true = float(camera.depth(glance.view.scene.centers[thing][None])[0])
        blur = float(blurred(clear_pixels(seen, np.array([thing])), p)[0])
        spread = p.depth_noise * blur if mood.uses("depth_noise") else 0.0
        looks.append(true * exp(spread * mood.rng.standard_normal()))
    hands.wait(p.prepare)
    hands.key(marks[int(np.argmin(looks))].text.lower())
    yield hands.take()


STRATEGY = Strategy(judge_depth, {"depth_noise": "two distances are compared"})
