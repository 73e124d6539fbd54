"""The shape that every task has. Adding a task is adding a folder (README, tour)."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Generic, Protocol, cast, runtime_checkable

from numpy.random import Generator
from typing_extensions import TypeVar

from seethrough.renderer.declared import Declares
from seethrough.renderer.events import Event
from seethrough.renderer.look.dressed import dressed
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.look import Look
from seethrough.renderer.scene.scene import Scene
from seethrough.tasks.kit.hud import Element, FloorPlan, Point
from seethrough.tasks.kit.measure import Measure
from seethrough.tasks.kit.world import (
    NO_KEYS,
    NO_TEXTS,
    OwnMoving,
    Place,
    Texts,
    World,
    WorldParameters,
)

if TYPE_CHECKING:
    from seethrough.tasks.kit.skills.strategy import Strategy


@dataclass(frozen=True, eq=False)
class View:
    """What the participant should see now. `captured`: the pointer turns the viewer, unseen.
    `drawn`: what events have made of the technique's state, which the session keeps. `aim`: where
    enter and space point; where there is one, presses are told the thing that they hit."""

    scene: Scene
    camera: Camera
    hud: tuple[Element, ...] = ()
    captured: bool = False
    drawn: object = None
    aim: Point | None = None

    def dressed(self, look: Look) -> View:
        """The view of the scene as it looks."""
        scene = dressed(self.scene, look)
        return self if scene is self.scene else replace(self, scene=scene)


@dataclass(frozen=True)
class Outcome:
    """A confirmed answer and its score; None where a measure does not apply to the task.

    `count_error` is answer − truth; `distance` is in world units, from mark to true place; `more`
    has the values of what a task measures besides, by the measures' names.
    """

    answer: str
    truth: str
    correct: bool
    count_error: int | None = None
    distance: float | None = None
    more: Mapping[str, float | int | bool] = field(default_factory=dict)

    def value(self, measure: str) -> float | None:
        """What was measured, by the measure's name; None for what the task does not measure."""
        if measure in self.more:
            return self.more[measure]
        found = getattr(self, measure, None)
        return found if isinstance(found, int | float) else None


@dataclass(frozen=True, eq=False)
class Example:
    """What an instruction's picture may show: `asked`, the indices of the objects that the question
    is about, seen by one of the `cameras`."""

    asked: tuple[int, ...]
    cameras: tuple[Camera, ...]


# The parameters of the world that a task is set in, and its own; the scene that it makes, and what
# it is in between two events: who only hands them on need not know what they are.
Where = TypeVar("Where", bound=WorldParameters, covariant=True, default=WorldParameters)
Own = TypeVar("Own", covariant=True, default=object)
WhereTo = TypeVar("WhereTo", bound=WorldParameters, contravariant=True, default=WorldParameters)
OwnTo = TypeVar("OwnTo", contravariant=True, default=object)
Made = TypeVar("Made", bound=Place, default=Place)
State = TypeVar("State", default=object)


@dataclass(frozen=True)
class Setting(Generic[Where, Own]):
    """Where and how a task is set: a world, the world's parameters (`place`), the `task`'s own, and
    which of the `items` that it can ask for, where they are counted."""

    world: World
    place: Where
    task: Own
    item: int | None = None

    @property
    def controls(self) -> str:
        """The name of the text that says how one moves."""
        own = self.place
        return own.controls if isinstance(own, OwnMoving) else self.world.controls


Given = TypeVar("Given", bound=Setting, default=Setting)


@dataclass(frozen=True)
class NoParameters:
    """The parameters of a task or world that has none."""


class Basics(Generic[State, Given]):
    """What most tasks have in common, to be inherited: any place of the world will do, the question
    is about its targets, no keys are taken, and there are no parameters."""

    name: str
    version = "1"
    least = 1  # targets that a scene has to have
    takes = NO_KEYS
    Parameters: type[Declares] = NoParameters
    texts: Texts = NO_TEXTS

    @property
    def title(self) -> str:
        """The name of the text above the instruction."""
        return f"{self.name}.title"

    @property
    def instruction(self) -> str:
        """The name of the text that says what to do."""
        return f"{self.name}.instruction"

    def make_scene(self, rng: Generator, setting: Given) -> Place:
        """A place of the world."""
        return setting.world.make(rng, setting.place)

    def controls(self, setting: Given) -> str:
        """The name of the text that says how one moves: as the world has it."""
        return setting.controls

    @abstractmethod
    def view(self, state: State) -> View:
        """What to show for `state`: a task's own."""

    def solution(self, state: State) -> FloorPlan | None:
        """No plan."""
        return None

    def example(self, state: State, aspect: float) -> Example:
        """The targets as they are seen at first."""
        view = self.view(state)
        asked = [i for i, thing in enumerate(view.scene.objects) if thing.target]
        return Example(tuple(asked), (view.camera,))


class Task(Protocol[WhereTo, OwnTo, Made, State]):
    """One task, without state of its own: states are frozen values that replace each other.

    `code` is how a paper calls it (T1), `worlds` are those it can be set in (or ANYWHERE),
    `measures` what it measures beside the time, `takes` the keys that it answers to beside those of
    its world ("key:enter"), and `simulate` how a simulated person does it.
    """

    name: str
    code: str
    version: str
    source: str
    worlds: tuple[str, ...]
    measures: tuple[Measure, ...]
    takes: frozenset[str]
    texts: Texts
    simulate: Strategy

    @property
    def title(self) -> str:
        """The name of the text above the instruction."""

    @property
    def instruction(self) -> str:
        """The name of the text that says what to do."""

    @property
    def Parameters(self) -> type[Declares]:
        """The class of its own parameters."""

    def make_scene(self, rng: Generator, setting: Setting[WhereTo, OwnTo]) -> Made:
        """A scene of a trial, with all that `begin` and the score need to know of it."""

    def begin(self, made: Made, setting: Setting[WhereTo, OwnTo], aspect: float) -> State:
        """The first state of a trial in a scene of `make_scene`'s, so wide for its height."""

    def on_event(self, state: State, event: Event) -> State:
        """The state after `event`."""

    def view(self, state: State) -> View:
        """What to show for `state`."""

    def outcome(self, state: State) -> Outcome | None:
        """The scored answer once the participant has confirmed one, else None."""

    def solution(self, state: State) -> FloorPlan | None:
        """After a practice trial: what was marked and what is right, if there is a plan of it."""

    def example(self, state: State, aspect: float) -> Example:
        """What the instruction's picture, so wide for its height, may show of a trial's start."""


@runtime_checkable
class OwnControls(Protocol):
    """What a task says besides in which one does not move as the world has it."""

    def controls(self, setting: Setting) -> str:
        """The name of the text that says how."""


@runtime_checkable
class OwnFeedback(Protocol):
    """What a task says besides whose answers are more than right or wrong."""

    def feedback(self, outcome: Outcome) -> tuple[str, dict[str, str | float]]:
        """The name of the text that says in practice how it went, and the values in it."""


@runtime_checkable
class Needs(Protocol):
    """What a task says besides that needs more than one target."""

    @property
    def least(self) -> int:
        """Targets that a scene has to have."""


@runtime_checkable
class Counts(Protocol):
    """What a task says besides whose questions can be counted."""

    def items(self, setting: Setting) -> int | None:
        """How many things it can ask for there; None where scenes are drawn."""


def opaque(task: Task[WhereTo, OwnTo, Made, State]) -> Task:
    """The same task for who hands its states on and looks into none: no other ever gets to it,
    which no type can say."""
    return cast(Task, task)
