"""A gallery is sections of plates: what a picture is of, and what is said about it."""

from __future__ import annotations

from dataclasses import dataclass, field

from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.base import Parameters
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

DYNAMIC = DynamicTransparency()
SMALL, SIZE, LARGE = (200, 150), (400, 300), (1040, 780)


@dataclass(frozen=True, eq=False)
class Plate:
    """One picture: its file name, what it shows in words, how large it is drawn, and what events
    have made of the technique's state (None: there were none)."""

    name: str
    caption: str
    scene: Scene
    camera: Camera
    technique: Parameters
    size: tuple[int, int] = SIZE
    state: object = None


@dataclass(frozen=True, eq=False)
class Section:
    """Pictures under one heading, with a line about them; `refused` are inputs and the message
    that each one got."""

    title: str
    about: str
    plates: tuple[Plate, ...]
    refused: tuple[tuple[str, str], ...] = field(default=())

    @property
    def small(self) -> bool:
        """Whether its pictures are small multiples."""
        return all(plate.size == SMALL for plate in self.plates)
