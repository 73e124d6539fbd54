"""What a study may say of the abstract world; the defaults are the published study's.

Source of the defaults: Elmqvist2009 §VI where it prints a number, else the comment says what we
chose.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, floor, pi

from seethrough.renderer.declared import Of, check, key
from seethrough.tasks.kit.tags import KindTag
from seethrough.tasks.kit.world import scenes

SHAPES = ("sphere", "cone", "box", "torus")
FILLS = ("cube", "things")
PALETTES = ("published", "colour-blind-safe")


@dataclass(frozen=True)
class AbstractParameters:
    """The abstract world and the orbit about it. Lengths in world units, angles in radians.

    `radius` and `start_pitch` are ours, the paper prints neither; so are the drag of half a turn
    for the height of the view and the speed of the arrow keys.
    """

    side: float = key(100.0, "edge of the cube that things are in", "world units", low=1, high=1e4)
    objects: int = key(200, "things in the world, targets included", low=1, high=5000)
    target_share: tuple[float, float] = key(
        (0.10, 0.20), "share of the things that are targets (red), drawn from this range for each "
        "scene", low=0, high=1,
    )  # fmt: skip
    radius: tuple[float, float] = key(
        (2.5, 5.0), "how large things are: radius of the sphere about each", "world units",
        low=1e-3, high=Of("a quarter of `side`", lambda p: p["side"] / 4),
    )  # fmt: skip
    targets: tuple[int, int] | None = key(
        None, "how many things are targets, drawn from this range for each scene; instead of "
        "`target_share`", low=1, high=5000,
    )  # fmt: skip
    distractors: int | None = key(
        None, "how many things are none; instead of what `objects` leaves", low=0, high=5000
    )
    shapes: tuple[str, ...] = key(SHAPES, "what the things are", choices=SHAPES)
    palette: str = key(
        "published", "colours of targets and distractors: as published, or such that people who do "
        "not tell red from green can do the tasks", choices=PALETTES,
    )  # fmt: skip
    tags: tuple[KindTag, ...] = key((), "what things of a kind are; kinds are the `shapes`")
    scenes: str = scenes("own")
    fov_y: float = key(pi / 3, "angle of view, from bottom to top", "radians", low=0.1, high=2.5)
    start_pitch: float = key(
        0.35, "how far from above the first view looks down", "radians", low=-pi / 2, high=pi / 2
    )
    fills: str = key(
        "cube", "what the first view holds: the cube, or the sphere about the things, which "
        "touches the smaller side of the window", choices=FILLS,
    )  # fmt: skip
    drag_gain: float = key(
        pi, "turn for a drag over the height of the view", "radians", low=0.1, high=20
    )
    key_rate: float = key(1.0, "turn while an arrow key is held", "radians/s", low=0.05, high=10)

    def __post_init__(self) -> None:
        check(self)
        low, high = self.target_range
        if low > high:
            raise ValueError(
                f"target_share = {list(self.target_share)}, expected a range that holds a whole "
                f"number of {self.objects} objects"
            )
        if self.distractors is None and high > self.objects:
            raise ValueError(
                f"targets = {list(self.targets or ())}, expected at most `objects` "
                f"({self.objects}), or `distractors` beside it"
            )

    @property
    def target_range(self) -> tuple[int, int]:
        """How few and how many targets a scene may have."""
        if self.targets is not None:
            return self.targets
        low, high = self.target_share
        # A share that is meant to be a whole number of things may be off by a rounding error.
        return ceil(low * self.objects - 1e-9), floor(high * self.objects + 1e-9)

    def others(self, targets: int) -> int:
        """How many things beside so many targets are none."""
        return self.objects - targets if self.distractors is None else self.distractors
