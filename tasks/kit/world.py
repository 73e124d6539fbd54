"""What a world is: how its scenes are made, how one moves in them, from where they are judged."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Generic, NamedTuple, Protocol, runtime_checkable

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from typing_extensions import TypeVar

from seethrough.renderer.declared import Declares, key
from seethrough.renderer.events import Event
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene

OWN, SHARED, FILES = "own", "shared", "files"
ANYWHERE: tuple[str, ...] = ("*",)  # the worlds of a task that takes any place with targets
NO_KEYS: frozenset[str] = frozenset()
Texts = Mapping[str, Mapping[str, str]]  # language → name of a text → the text
NO_TEXTS: Texts = MappingProxyType({})


class Place(Protocol):
    """A scene, and what its world knows of it besides."""

    @property
    def scene(self) -> Scene:
        """Everything that stands there."""


# What a world's own parameters and places are; who only hands them on need not know.
Made = TypeVar("Made", bound=Place, default=Place)


@dataclass(frozen=True, eq=False)
class Asked(Generic[Made]):
    """An item: a place, and the index of the thing that is asked for in it."""

    place: Made
    thing: int

    @property
    def scene(self) -> Scene:
        """Everything that stands there."""
        return self.place.scene


class Viewer(Protocol):
    """Where a participant looks from. Frozen; events give another one."""

    def on_event(self, event: Event) -> Viewer:
        """The viewer after `event`."""

    def camera(self) -> Camera:
        """What the viewer sees."""


class FileFault(NamedTuple):
    """What is wrong with a file, or with what is said of it: the parameter, its value, and what to
    say."""

    key: str
    value: object
    said: str


class FileFaults(ValueError):
    """All that is wrong with a world's files."""

    def __init__(self, found: Sequence[FileFault]) -> None:
        self.found = tuple(found)
        super().__init__("; ".join(f"{f.key} = {f.value}: {f.said}" for f in found))


@runtime_checkable
class FileWorld(Protocol):
    """What a world says besides whose scenes are made of a study's files."""

    def named(self, parameters: object) -> Mapping[str, str]:
        """Parameter → file beside the study, of all that it names."""

    def found(self, parameters: WorldParameters, folder: Path) -> WorldParameters:
        """The parameters with their files read, which lie in the folder. Raises FileFaults."""

    def keeps(self, parameters: object) -> Mapping[str, Callable[[], bytes]]:
        """Name → content, of the files that a data folder keeps for replays."""

    def kept_in(self, parameters: WorldParameters, folder: Path) -> WorldParameters:
        """The parameters with their files as a data folder has them. Raises FileFaults."""

    def targets(self, parameters: object) -> Mapping[str, int]:
        """Parameter → how many targets the scene has that it names."""


@runtime_checkable
class NamingWorld(Protocol):
    """What a world says besides where participants read names that a study gives its things."""

    def called(self, parameters: object) -> Iterable[tuple[str, str]]:
        """(parameter, name), of all that may be asked for by name."""


@runtime_checkable
class ItemWorld(Protocol):
    """What a world says besides in which all that can be asked for is counted."""

    def items(self, parameters: object) -> Sequence[Asked[Place]]:
        """All that can be asked for, in the study's order."""


@runtime_checkable
class OwnMoving(Protocol):
    """What parameters say besides that decide how one moves, in place of their world."""

    @property
    def move(self) -> str:
        """As a world's `moving`, or another word."""

    @property
    def controls(self) -> str:
        """The name of the text that says how."""

    @property
    def lattice(self) -> str:
        """From which viewpoints data mode knows what is seen: "orbit", "poses"."""


@runtime_checkable
class Lists(Protocol):
    """What parameters say besides that may list what is asked for, in the study's order."""

    @property
    def items(self) -> Sequence[object]:
        """Empty: all there is, in an order that is drawn."""


class WorldParameters(Declares, Protocol):
    """The parameters of a world: each has a key `scenes`, of which `scenes` below makes one."""

    @property
    def scenes(self) -> str:
        """OWN, SHARED or FILES."""

    def __hash__(self) -> int: ...


Where = TypeVar("Where", bound=WorldParameters, contravariant=True, default=WorldParameters)


class World(Protocol[Where, Made]):
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
    texts: Texts

    @property
    def Parameters(self) -> type[WorldParameters]:
        """The class of its parameters."""

    def make(self, rng: Generator, parameters: Where) -> Made:
        """A place for any task. Raises ValueError where the parameters leave no room for one."""

    def viewer(self, place: Made, parameters: Where, aspect: float) -> Viewer:
        """Where one begins, in a view so wide for its height."""

    def views(self, parameters: Where, first: Camera) -> list[Camera]:
        """From where the certificate judges a scene that begins with `first`: the same for all."""

    def path(self, first: Camera, asked: NDArray[np.float64]) -> float:
        """World units to go from the start past what a task asks for, (n, 3) centres."""


def moving_of(world: World, parameters: object) -> str:
    """How one moves in a world with these parameters: as they say themselves, else as it says."""
    return parameters.move if isinstance(parameters, OwnMoving) else world.moving


def lattice_of(world: World, parameters: object) -> str:
    """From which viewpoints data mode knows what is seen."""
    return parameters.lattice if isinstance(parameters, OwnMoving) else world.moving


def keys(names: Iterable[str]) -> frozenset[str]:
    """Keys as `takes` names them."""
    return frozenset(f"key:{name}" for name in names)


def scenes(default: str) -> str:
    """The key by which a study says how its scenes are had."""
    return key(
        default,
        "whose scenes: each participant's `own` in each trial, or `shared` sets that rotate over "
        "the levels",
        choices=(OWN, SHARED),
    )
