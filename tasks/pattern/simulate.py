"""T2: which letter do the red cones form? Looks add up until one letter is likely."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from seethrough.tasks.kit.skills.counting import saccade
from seethrough.tasks.kit.skills.glance import Glance, heading
from seethrough.tasks.kit.skills.hands import Hands, learn_gain
from seethrough.tasks.kit.skills.memory import meet, memory_of
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.red import red_things
from seethrough.tasks.kit.skills.strategy import Play, Strategy

FROM_ABOVE = 1.25  # height, in radians, from which a flat letter reads well [ours]
MISTAKEN_SHAPE = 0.25  # of unclear red things, how many are taken for cones [ours]
ANGLES = np.arange(36) * (2 * np.pi / 36)

# How one draws the five letters in one's mind: strokes between (x, z), top at z = −1.
Stroke = tuple[tuple[float, float], tuple[float, float]]
STROKES: dict[str, list[Stroke]] = {
    "C": [((0.6, -0.7), (0, -1)), ((0, -1), (-0.6, -0.7)), ((-0.6, -0.7), (-0.6, 0.7)),
          ((-0.6, 0.7), (0, 1)), ((0, 1), (0.6, 0.7))],
    "K": [((-0.6, -1), (-0.6, 1)), ((-0.6, 0), (0.6, -1)), ((-0.6, 0), (0.6, 1))],
    "R": [((-0.6, -1), (-0.6, 1)), ((-0.6, -1), (0.3, -1)), ((0.3, -1), (0.6, -0.5)),
          ((0.6, -0.5), (0.3, 0)), ((0.3, 0), (-0.6, 0)), ((-0.2, 0), (0.6, 1))],
    "X": [((-0.6, -1), (0.6, 1)), ((0.6, -1), (-0.6, 1))],
    "Y": [((-0.6, -1), (0, 0)), ((0.6, -1), (0, 0)), ((0, 0), (0, 1))],
}  # fmt: skip


def name_letter(mood: Mood, glance: Glance) -> Play:
    """Turn the world until it is seen from above, then from other sides while in doubt."""
    p = mood.profile
    hands = Hands(mood, glance.now)
    hands.wait(p.prepare)
    letter = Letter(mood)
    for looks in range(1, p.letter_looks + 1):
        yaw, height = heading(glance.view)
        side = 0.0 if looks == 1 else p.orbit_step
        hands.turn(side, FROM_ABOVE - height, drag=True)
        glance = yield hands.take()
        if side:
            learn_gain(hands, yaw, heading(glance.view)[0], side)
        red = red_things(mood, glance)
        # Colour guides the eyes to what is red; a shape takes attention, thing by thing, until it
        # is clear.
        unclear = letter.look(glance, red)
        hands.wait(unclear * (p.attention_shift + p.search_slope + saccade(0.1, mood)))
        hands.wait(p.letter_turning * mood.rng.random())
        chances = letter_chances(letter.cones())
        if max(chances.values()) > 1 - (1 - p.certainty) / mood.care:
            break
        hands.wait(p.prepare)
    names, values = zip(*sorted(chances.items()), strict=True)
    answer = names[int(np.argmax(values))]
    hands.type(answer.lower())
    yield hands.take()


class Letter:
    """The red things met so far, and which of them are taken for cones.

    What was guessed of an unclear thing is taken back as soon as its shape is clear, and a clear
    shape is not looked at again.
    """

    def __init__(self, mood: Mood) -> None:
        self.mood = mood
        self.memory = memory_of(mood)
        self._guess = np.empty(0, dtype=bool)

    def look(self, glance: Glance, red: NDArray[np.int64]) -> int:
        """Take in the red things noticed; how many of them had to be looked at one by one."""
        mood, view = self.mood, glance.view
        met = meet(mood, glance.look(), view.scene, view.camera, red)
        clear_before = self.memory.shape != ""
        new = self.memory.take(met, None if mood.uses("view_changes") else red)
        guess = mood.rng.random(len(view.scene.objects))[red[new]] < MISTAKEN_SHAPE
        self._guess = np.concatenate([self._guess, guess])
        known = np.zeros(len(self.memory), dtype=bool)
        known[: len(clear_before)] = clear_before
        return int((~known[self.memory.entries]).sum())

    def cones(self) -> NDArray[np.float64]:
        """(n, 2) where on the floor of the world those seem to be that are taken for cones."""
        clear = self.memory.shape != ""
        cone = np.where(clear, self.memory.shape == "cone", self._guess)
        places: NDArray[np.float64] = self.memory.place[cone][:, [0, 2]]
        return places


@cache
def _templates() -> dict[str, NDArray[np.float64]]:
    """Each letter as (2, n, 36) points along its strokes at 36 angles, two units high."""
    templates = {}
    for letter, strokes in STROKES.items():
        points = [
            np.linspace(a, b, max(2, round(np.hypot(b[0] - a[0], b[1] - a[1]) / 0.25)))
            for a, b in strokes
        ]
        flat = np.concatenate(points)
        cos, sin = np.cos(ANGLES), np.sin(ANGLES)
        x, z = flat[:, :1], flat[:, 1:]
        templates[letter] = np.stack([x * cos + z * sin, z * cos - x * sin])
    return templates


def letter_chances(places: NDArray[np.float64]) -> dict[str, float]:
    """How likely each letter is, given (n, 2) places of cones about the world's centre.

    A cone far from every stroke counts against a letter, and so does a stroke without cones. The
    letter is as large as the farthest cones say; its angle is the one that fits best.
    """
    letters = sorted(STROKES)
    if len(places) < 4:
        return dict.fromkeys(letters, 1 / len(letters))
    size = np.quantile(np.hypot(places[:, 0], places[:, 1]), 0.9) / np.hypot(0.6, 1)
    fits = [_fit(_templates()[letter], places / max(size, 1e-9)) for letter in letters]
    weights = np.exp(np.array(fits) - max(fits))
    return dict(zip(letters, (weights / weights.sum()).tolist(), strict=True))


def _fit(template: NDArray[np.float64], places: NDArray[np.float64]) -> float:
    """Log-likelihood of the best angle."""
    x, z = template[:, :, None] - places.T[:, None, :, None]
    apart = np.minimum(x * x + z * z, FAR**2)
    # Nearest ones are found for all angles at once, in the last axis; means sum best along it.
    to_cone, to_stroke = apart.min(axis=1).T.copy(), apart.min(axis=0).T.copy()
    misfit = to_stroke.mean(axis=1) + to_cone.mean(axis=1)
    return float(-misfit.min() * len(places) / (2 * FIT**2))


FAR = 0.6  # a cone farther from all strokes, in half letter heights, is no part of the letter
FIT = 0.25  # s.d. of a cone about its stroke, half letter heights [ours]


STRATEGY = Strategy(
    name_letter,
    {
        "crowding": "many small things on the view",
        "view_changes": "places and shapes over several views",
    },
    heights=(FROM_ABOVE,),
)
