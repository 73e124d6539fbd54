"""The keys of `[look]`. All of them off is the picture as it always was, bit for bit."""

from __future__ import annotations

from dataclasses import dataclass, fields

from seethrough.renderer.declared import check, key

ANTIALIASING = ("auto", "none", "edges", "2x", "4x", "8x")


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
    ground_shadows: float = key(
        0.0,
        "how dark the soft shadows on the floor are that things cast which stand or float above "
        "it; 0: none. A thing that turns transparent keeps its shadow; where a world has no floor, "
        "one lies below all things",
        low=0.0,
        high=1.0,
    )
    shadow_reach: float = key(
        0.0,
        "how high above the floor things cast shadows; 0: a sixth of the floor's shorter side",
        "world units",
        low=0.0,
        high=1e6,
    )
    occlusion: float = key(
        0.0,
        "how dark the hollows of models and the corners of rooms are, where little light gets in; "
        "0: as light as the rest. It is baked into the models, and into walls where others or a "
        "floor meet them; other convex things have none",
        low=0.0,
        high=1.0,
    )
    antialiasing: str = key(
        "auto",
        "against jagged edges. edges: lines are smoothed where they cross pixels, made for a "
        "machine without a graphics card; 2x, 4x, 8x: so many samples a pixel, for one with a "
        "card; auto: as display.samples says, the key of earlier versions",
        choices=ANTIALIASING,
    )

    outlines: float = key(
        0.0,
        "width of dark lines along the outlines of things, as they are seen; 0: none. A thing that "
        "turns transparent keeps its line; edges are smoothed along lines then, whatever "
        "antialiasing says but none",
        "pixels of the window",
        low=0.0,
        high=20.0,
    )
    detail_error: float = key(
        0.0,
        "how far off models may be that are drawn in fewer triangles the farther away they are; 0: "
        "all are drawn whole. Outlines of masks are those of whole models; what is sorted by pixel "
        "and what a technique's own rule draws is drawn whole",
        "pixels of the window",
        low=0.0,
        high=20.0,
    )

    def __post_init__(self) -> None:
        check(self, "look")

    @property
    def has_floor(self) -> bool:
        """Whether anything is drawn on the floor."""
        return self.floor_grid > 0 or self.ground_shadows > 0

    def smooths(self, usual: int) -> bool:
        """Whether edges are smoothed along lines, where auto stands for `usual` samples."""
        several = self.antialiasing.endswith("x") or (self.antialiasing == "auto" and usual > 0)
        return self.antialiasing == "edges" or (self.outlines > 0 and several)

    def samples(self, usual: int) -> int:
        """Samples a pixel, 0 for no more than the one; `usual` where it says auto."""
        if self.outlines > 0:
            return 0
        if self.antialiasing == "auto":
            return usual
        return int(self.antialiasing[0]) if self.antialiasing.endswith("x") else 0

    @property
    def on(self) -> tuple[str, ...]:
        """The keys that change something."""
        return tuple(f.name for f in fields(self) if getattr(self, f.name) != f.default)


PLAIN = Look()
