"""Things one has met: where, of what shape, how often; and which of them is this one again?

Nothing has a name to be known by. A thing is known again by its place, its colour (only what is of
the asked colour or kind comes here) and its shape, where that was made out.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.scene.visibility import Visibility
from seethrough.tasks.kit.skills.glance import blurred, clear_pixels, recognised
from seethrough.tasks.kit.skills.learned import Share
from seethrough.tasks.kit.skills.mood import Mood

GATE = 3.0  # Mahalanobis distance within which two places may be one thing's [ours]
ACROSS = 0.02  # s.d. of a direction in radians: as near as things run together [ours]
# Of things in one world some are seen from everywhere, some from hardly anywhere: their chances
# follow a beta distribution of this concentration, which is flat where every second one is seen.
SPREAD = 2.0
NOVICE = 2.0  # cases that a first guess of how often things are seen counts for [ours]


@dataclass(frozen=True, eq=False)
class Met:
    """Things noticed in one look. `place` (n, d) where they seem to be, `doubt` (n, d, d) its
    covariance in square world units, `shape` (n,) "" where it was not made out."""

    place: NDArray[np.float64]
    doubt: NDArray[np.float64]
    shape: NDArray[np.str_]


def doubt(way: NDArray[np.float64], along: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, d, d) covariance of places (n, d) away: `along` (n,) of the way, little across it."""
    far = np.linalg.norm(way, axis=1)
    unit = way / np.maximum(far, 1e-9)[:, None]
    across = (ACROSS * far + 1.0) ** 2
    line = unit[:, :, None] * unit[:, None, :]
    flat: NDArray[np.float64] = across[:, None, None] * np.eye(way.shape[1])
    made: NDArray[np.float64] = flat + ((along * far) ** 2)[:, None, None] * line
    return made


def meet(
    mood: Mood, seen: Visibility, scene: Scene, camera: Camera, index: NDArray[np.int64]
) -> Met:
    """What can be told of things noticed: direction well, distance and shape as pixels go."""
    draws = mood.rng.standard_normal(len(scene.objects))[index]
    way = scene.centers[index] - camera.eye
    noise = mood.profile.cloud_depth * blurred(clear_pixels(seen, index), mood.profile)
    made_out = recognised(seen, index, mood)
    kinds = np.array([scene.objects[i].kind for i in index.tolist()], dtype="<U32")
    place = camera.eye + way * (1 + noise * draws)[:, None]
    return Met(place, doubt(way, noise), np.where(made_out, kinds, ""))


@dataclass(eq=False)
class Memory:
    """The things met so far, in the order in which they were: their mean places, shapes, looks.

    `times` (k,) how often each was seen in `looks`; `entries` (n,) which of them the last look met.
    """

    again: Share
    size: int = 3
    place: NDArray[np.float64] = field(init=False)
    doubt: NDArray[np.float64] = field(init=False)
    shape: NDArray[np.str_] = field(default_factory=lambda: np.empty(0, dtype="<U32"))
    times: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    looks: int = 0
    entries: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    _names: list[int] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.place = np.empty((0, self.size))
        self.doubt = np.empty((0, self.size, self.size))

    def __len__(self) -> int:
        return len(self.times)

    def take(
        self, met: Met, names: NDArray[np.int64] | None = None, busy: Collection[int] = ()
    ) -> NDArray[np.bool_]:
        """Match things to what is remembered, remember the rest; (n,) which are taken for new.

        `names` says which is which, as if nobody ever mixed things up. Entries that are `busy` are
        known to be something else.
        """
        known = len(self)
        entry = self._same(met, busy) if names is None else self._named(names)
        found, new = entry >= 0, entry < 0
        self.again.add(float(found.sum()), float(known))
        self._merge(entry[found], met, found)
        self.place = np.concatenate([self.place, met.place[new]])
        self.doubt = np.concatenate([self.doubt, met.doubt[new]])
        self.shape = np.concatenate([self.shape, met.shape[new].astype("<U32")])
        self.times = np.concatenate([self.times, np.ones(int(new.sum()), dtype=np.int64)])
        self.looks += 1
        entry[new] = np.arange(known, len(self))
        self.entries = entry
        return new

    def _merge(self, at: NDArray[np.int64], met: Met, found: NDArray[np.bool_]) -> None:
        """What was seen better counts for more. Looks err alike: two leave the doubt of the better
        one, not less."""
        place, doubt, shape = met.place[found], met.doubt[found], met.shape[found]
        old, fresh = (np.trace(c, axis1=1, axis2=2) for c in (self.doubt[at], doubt))
        self.place[at] += (place - self.place[at]) * (old / (old + fresh))[:, None]
        self.doubt[at] = np.where((fresh < old)[:, None, None], doubt, self.doubt[at])
        self.shape[at] = np.where(shape == "", self.shape[at], shape)
        self.times[at] += 1

    def _named(self, names: NDArray[np.int64]) -> NDArray[np.int64]:
        where = {name: k for k, name in enumerate(self._names)}
        self._names += [n for n in names.tolist() if n not in where]
        return np.array([where.get(n, -1) for n in names.tolist()], dtype=np.int64)

    def _same(self, met: Met, busy: Collection[int]) -> NDArray[np.int64]:
        """(n,) entry of each thing, the likeliest pairs first; -1 for none."""
        entry = np.full(len(met.place), -1)
        if not len(self) or not len(entry):
            return entry
        apart = met.place[:, None] - self.place[None]
        both = met.doubt[:, None] + self.doubt[None]
        way = np.linalg.solve(both, apart[..., None])[..., 0]
        distance = np.sqrt((apart * way).sum(axis=2))
        other = (met.shape[:, None] != self.shape[None]) & (met.shape != "")[:, None]
        distance[other & (self.shape != "")[None]] = np.inf
        free = np.ones(len(self), dtype=bool)
        free[list(busy)] = False
        for flat in np.argsort(distance, axis=None, kind="stable").tolist():
            i, k = divmod(flat, len(self))
            if distance[i, k] > GATE:
                break
            if entry[i] < 0 and free[k]:
                entry[i], free[k] = k, False
        return entry

    def expected(self) -> float:
        """How many things a next look is expected to show that none showed before.

        How often known things were seen again says how easily things are seen here (as recapture
        does); one more than were counted is always thought to be possible. People stop looking
        when little comes of it (Chun1996, Wolfe2013).
        """
        a, b = SPREAD * self.again.mean, SPREAD * (1 - self.again.mean)
        missed = 1.0  # chance that all looks so far missed a thing
        for look in range(self.looks):
            missed *= (b + look) / (SPREAD + look)
        then = missed * a / (SPREAD + self.looks)  # and the next one shows it
        return (len(self) + 1) * then / max(1 - missed, 1e-9)


def memory_of(mood: Mood) -> Memory:
    """An empty memory of a person who knows how often things were seen again of late."""
    return Memory(mood.learned.share("seen again", 0.5, NOVICE))
