"""A stranger's technique: what is nearer to the viewer than some distance is removed."""

from dataclasses import dataclass

import numpy as np

from seethrough.api import key, reaching, removal


@dataclass(frozen=True)
class Parameters(removal.Removing):
    """How near is too near."""

    distance: float = key(12.0, "what is nearer is removed", "world units", low=0, high=1000)


class Toy(removal.Removal):
    """Removes what is near, as if the viewer stood before it."""

    name = "toy"
    title = "Nothing near"
    instruction = "What is near you is not shown."
    source = "nobody"
    Parameters = Parameters
    removes = """
uniform float distance_;
bool removed(Surface s) { return s.depth < distance_; }
bool pierced(Surface s) { return true; }
"""

    def touches(self, p, state, shot):
        return reaching.reached(shot, reaching.whole(shot, 1), np.array([p.distance]))

    def rule(self, p, state, seen, known):
        pixels = np.ones(seen.shot.size[0] * seen.shot.size[1], dtype=bool)
        return removal.look(p, seen, p.distance - seen.depth, pixels)

    def uniforms(self, p, state, shot):
        return {**super().uniforms(p, state, shot), "distance_": p.distance}


TECHNIQUE = Toy()
