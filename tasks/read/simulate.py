"""Turning the world until the sign can be read."""

from __future__ import annotations

import numpy as np

from seethrough.tasks.kit.skills.glance import Glance, heading, recognised
from seethrough.tasks.kit.skills.hands import Hands, learn_gain
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.strategy import Play, Strategy
from seethrough.tasks.read.sign import DIGITS, SIGN, WIDTH

MOST_VIEWS = 18  # three times round
TILT = 0.35  # views alternate between this much above and below [ours]
FACING = 0.35  # cosine below which a sign is seen too much from the side to be read [ours]
ENOUGH = 0.7  # of a sign that has to be seen [ours]
ASPECT = 4 / 3  # of the view; in a wider one a little more of the sign has to be seen


def read_sign(mood: Mood, glance: Glance) -> Play:
    """Look, turn on while the sign cannot be read, then type what it says; or guess in the end."""
    p, hands = mood.profile, Hands(mood, glance.now)
    hands.wait(p.prepare)
    digit, views = None, 0
    while digit is None and views < MOST_VIEWS:
        digit = _read(mood, glance, hands)
        views += 1
        if digit is None:
            yaw, height = heading(glance.view)
            aim = TILT if views % 2 else -TILT
            hands.turn(p.orbit_step, aim - height, drag=True)
            glance = yield hands.take()
            learn_gain(hands, yaw, heading(glance.view)[0], p.orbit_step)
    wrong = mood.uses("slips") and mood.rng.random() < min(1.0, p.slip / mood.care)
    if digit is None or wrong:
        digit = int(mood.rng.integers(len(DIGITS)))
    hands.type(str(digit))
    yield hands.take()


def _read(mood: Mood, glance: Glance, hands: Hands) -> int | None:
    """The digit, if its sign faces the eye, little hides it, and it can be made out."""
    p, seen, scene = mood.profile, glance.look(), glance.view.scene
    hands.wait(p.attention_shift + p.search_slope + p.saccade)
    number = next(i for i, thing in enumerate(scene.objects) if thing.kind.startswith(SIGN))
    sign, camera = scene.objects[number], glance.view.camera
    front, away = sign.transform[:3, 2], camera.eye - sign.transform[:3, 3]
    facing = front @ away / (np.linalg.norm(front) * np.linalg.norm(away))
    # Of the view, which is as wide as an id picture: its share that the plate would fill.
    high = np.linalg.norm(sign.transform[:3, 1]) / np.linalg.norm(away) / np.tan(camera.fov_y / 2)
    whole = WIDTH * (high / 2) ** 2 * facing / ASPECT
    if facing < FACING or seen.area[number] < ENOUGH * whole:
        return None
    if not recognised(seen, np.array([number]), mood)[0]:
        return None
    hands.wait(p.count)
    return int(sign.kind.removeprefix(SIGN))


STRATEGY = Strategy(read_sign, {"slips": "a digit is read"}, heights=(-TILT, TILT))
