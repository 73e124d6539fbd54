"""Tasks and worlds by name: ours and those of other packages (seethrough/registry.py)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TypeVar

from seethrough import registry
from seethrough.tasks.kit.base import Setting, Task
from seethrough.tasks.kit.world import ANYWHERE, NO_KEYS, World, WorldParameters

Plugin = TypeVar("Plugin")


class Registered(Mapping[str, Plugin]):
    """All plug-ins of a kind by name; each is imported when it is asked for."""

    def __init__(self, kind: str) -> None:
        self._kind = kind

    def __getitem__(self, name: str) -> Plugin:
        found: Plugin = registry.get(self._kind, name)
        return found

    def __iter__(self) -> Iterator[str]:
        return iter(registry.known(self._kind))

    def __len__(self) -> int:
        return len(registry.known(self._kind))


TASKS: Mapping[str, Task] = Registered("task")
WORLDS: Mapping[str, World] = Registered("world")


def worlds_of(task: Task) -> tuple[str, ...]:
    """The names of the worlds that a task can be set in."""
    return tuple(WORLDS) if tuple(task.worlds) == ANYWHERE else tuple(task.worlds)


def world_of(task: Task) -> World:
    """The world that a task is set in where a study does not say it: its first."""
    return WORLDS[worlds_of(task)[0]]


def taken(plugin: Task | World) -> frozenset[str]:
    """The keys that a task or world takes; none where a stranger's does not say."""
    found: frozenset[str] = getattr(plugin, "takes", NO_KEYS)
    return found


def setting(task: Task, place: WorldParameters | None = None, own: object = None) -> Setting:
    """A task in its first world, or in the one whose parameters are given; else with defaults."""
    worlds = [WORLDS[name] for name in worlds_of(task)]
    world = next((w for w in worlds if place is None or isinstance(place, w.Parameters)), None)
    if world is None:
        raise ValueError(f"{type(place).__name__}: {task.name} cannot be set there")
    return Setting(world, place or world.Parameters(), own or task.Parameters())
