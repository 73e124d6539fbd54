"""The shape that every task has. Adding a task is copying a file (README, tour)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

from numpy.random import Generator

from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.tasks.kit.events import Event
from seethrough.tasks.kit.hud import Element, FloorPlan


@dataclass(frozen=True, eq=False)
class View:
    """What the participant should see now. `captured`: the pointer turns the viewer, unseen."""

    scene: Scene
    camera: Camera
    hud: tuple[Element, ...] = ()
    captured: bool = False


@dataclass(frozen=True)
class Outcome:
    """A confirmed answer and its score; None where a measure does not apply to the task.

    `count_error` is answer − truth; `distance` is in world units, from mark to true place.
    """

    answer: str
    truth: str
    correct: bool
    count_error: int | None = None
    distance: float | None = None


@dataclass(frozen=True, eq=False)
class Example:
    """What an instruction's picture may show: `asked`, the indices of the objects that the question
    is about, seen by one of the `cameras`."""

    asked: tuple[int, ...]
    cameras: tuple[Camera, ...]


class Task(Protocol):
    """One task, without state of its own: states are frozen values that replace each other."""

    name: str
    scenario: str

    def make_scene(self, rng: Generator, parameters: Any) -> Any:
        """The world of a trial, with all that `begin` and the score need to know of it."""

    def begin(self, rng: Generator, parameters: Any, aspect: float, scene: Any = None) -> Any:
        """The first state of a trial, in `scene` or in one of its own made with `rng`.

        Walkthrough tasks are given the study's scenes. `aspect` is the view's width / height.
        """

    def on_event(self, state: Any, event: Event) -> Any:
        """The state after `event`."""

    def view(self, state: Any) -> View:
        """What to show for `state`."""

    def outcome(self, state: Any) -> Outcome | None:
        """The scored answer once the participant has confirmed one, else None."""

    def solution(self, state: Any) -> FloorPlan | None:
        """After a practice trial: what was marked and what is right, if there is a plan of it."""

    def example(self, state: Any, aspect: float) -> Example:
        """What the instruction's picture, so wide for its height, may show of a trial's start."""
