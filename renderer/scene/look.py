"""The keys of `[look]`. All of them off is the picture as it always was, bit for bit."""

from __future__ import annotations

from dataclasses import dataclass, fields

from seethrough.renderer.declared import check, key


@dataclass(frozen=True)
class Look:
    """What a scene's picture has besides the things in it, as a study's `[look]` says.

    Raises ValueError, in one line, for a value that is not allowed.
    """

    fog: float = key(
        0.0,
        "distance over which fog takes half of a thing's colour and leaves that of the background; "
        "0: no fog. Colours that tell things apart fade with it",
        "world units",
        low=0.0,
        high=1e6,
    )
    fog_start: float = key(
        0.0, "distance from the eye at which the fog begins", "world units", low=0.0, high=1e6
    )
    floor_grid: float = key(
        0.0,
        "distance between lines on the floor; where a world has no floor, one lies below all "
        "things; 0: no lines",
        "world units",
        low=0.0,
        high=1e6,
    )

    def __post_init__(self) -> None:
        check(self, "look")

    @property
    def has_floor(self) -> bool:
        """Whether anything is drawn on the floor."""
        return self.floor_grid > 0

    @property
    def on(self) -> tuple[str, ...]:
        """The keys that change something."""
        return tuple(f.name for f in fields(self) if getattr(self, f.name) != f.default)


PLAIN = Look()
