"""What a world is: how its scenes are made, how one moves in them, from where they are judged."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any, Protocol

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from seethrough.renderer.declared import key
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.tasks.kit.events import Event

OWN, SHARED = "own", "shared"
ANYWHERE = ("*",)  # the worlds of a task that takes any place with targets
NO_KEYS: frozenset[str] = frozenset()
Texts = Mapping[str, Mapping[str, str]]  # language → name of a text → the text
NO_TEXTS: Texts = MappingProxyType({})


class Place(Protocol):
    """A scene, and what its world knows of it besides."""

    @property
    def scene(self) -> Scene:
        """Everything that stands there."""


class Viewer(Protocol):
    """Where a participant looks from. Frozen; events give another one."""

    def on_event(self, event: Event) -> Any:
        """The viewer after `event`."""

    def camera(self) -> Camera:
        """What the viewer sees."""


class World(Protocol):
    """A world, without state: parameters go in, places come out.

    `scenario` is what tables call it. `moving`: "orbit" turns the world about its middle, "walk"
    moves through it with the pointer captured. `controls` is the text that says how, `takes` are
    the keys that do it, as techniques name them: "key:up".
    """

    name: str
    version: str
    source: str
    scenario: str
    moving: str
    controls: str
    takes: frozenset[str]
    Parameters: Any
    texts: Texts

    def make(self, rng: Generator, parameters: Any) -> Place:
        """A place for any task. Raises ValueError where the parameters leave no room for one."""

    def viewer(self, place: Place, parameters: Any, aspect: float) -> Viewer:
        """Where one begins, in a view so wide for its height."""

    def views(self, parameters: Any, first: Camera) -> list[Camera]:
        """From where the certificate judges a scene that begins with `first`: the same for all."""

    def path(self, first: Camera, asked: NDArray[np.float64]) -> float:
        """World units to go from the start past what a task asks for, (n, 3) centres."""


def keys(names: Iterable[str]) -> frozenset[str]:
    """Keys as `takes` names them."""
    return frozenset(f"key:{name}" for name in names)


def scenes(default: str) -> Any:
    """The key by which a study says how its scenes are had."""
    return key(
        default,
        "whose scenes: each participant's `own` in each trial, or `shared` sets that rotate over "
        "the levels",
        choices=(OWN, SHARED),
    )
