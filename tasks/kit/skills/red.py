"""Telling what is red at a glance."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.scene.scene import Scene
from seethrough.tasks.kit.skills.glance import Glance, noticed, uncrowded
from seethrough.tasks.kit.skills.mood import Mood

RED_ENOUGH = 0.5  # a thing is red if this much of its colour is [ours]


def red_things(mood: Mood, glance: Glance) -> NDArray[np.int64]:
    """Indices of red things noticed now and not lost in a crowd."""
    seen = glance.look()
    index = noticed(seen, mood)
    return uncrowded(seen, index[_red(glance.view.scene)[index]], mood)[0]


@lru_cache(maxsize=64)
def _red(scene: Scene) -> NDArray[np.bool_]:
    """(n,) which objects of a scene are red (scenes are compared by identity)."""
    colors = (thing.color for thing in scene.objects)
    return np.array([r > RED_ENOUGH and g + b < RED_ENOUGH for r, g, b in colors], dtype=bool)
