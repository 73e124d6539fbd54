"""What a study file may name: techniques, worlds, tasks and questions, and what each declares."""

from __future__ import annotations

from dataclasses import is_dataclass
from functools import cache
from typing import get_args, get_origin, get_type_hints

from seethrough import registry
from seethrough.experiment.study.tables.parameter_tables import Fault
from seethrough.experiment.study.tables.study_tables import TaskTable
from seethrough.renderer.declared import Declares
from seethrough.renderer.meant import meant
from seethrough.tasks import catalog
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters


def names(kind: str) -> tuple[str, ...]:
    """The names of all techniques, worlds, tasks or question kinds."""
    if kind == "question":
        from seethrough.experiment.study.tables.ready import READY  # asks for pages: not for --help

        return (*READY, *registry.known(kind))
    return registry.known(kind)


def taken_names(kind: str) -> tuple[str, ...]:
    """What no plug-in of a kind can be called: where a study names it, these are keys already."""
    if kind == "question":
        from seethrough.experiment.study.tables.ready import READY  # asks for pages: not for --help

        return tuple(READY)
    return tuple(TaskTable.model_fields) if kind == "task" else ("use",)


def parameters(kind: str, name: str) -> type[Declares]:
    """The class of the parameters of one of them."""
    if kind == "question":
        from seethrough.experiment.study.tables.ready import question

        return question(name).Parameters
    found: type[Declares] = registry.get(kind, name).Parameters
    return found


def worlds_of(task: str) -> tuple[str, ...]:
    """The worlds that a task can live in."""
    return catalog.worlds_of(registry.get("task", task))


@cache
def clashes(technique: str, world: str, tasks: tuple[str, ...]) -> tuple[str, ...]:
    """What is expected instead, for each of these whose keys a technique takes as well."""
    takes = registry.get("technique", technique).takes
    others = [("world", world), *(("task", task) for task in tasks)]
    found = []
    for kind, name in others:
        both = sorted(takes & catalog.taken(registry.get(kind, name)))
        if both:
            keys = ", ".join(key.removeprefix("key:").upper() for key in both)
            found.append(f"a technique that leaves the key {keys} to the {kind} {name}")
    return tuple(found)


def further_faults(place: object) -> list[Fault]:
    """The building's models are there, each once, and enough of them to tell one from others."""
    if not isinstance(place, BuildingParameters):
        return []
    types, own = place.types, [model.name for model in place.models]
    if not types and not own:
        return []
    from seethrough.renderer.models import MODELS

    found = [
        Fault(f"models[{number}].name", name, "a name that no other model has")
        for number, name in enumerate(own)
        if name in MODELS or own.count(name) > 1
    ]
    known = {*MODELS, *own}
    wrong = [t for t in types if t not in known or types.count(t) > 1]
    if wrong or (types and len(types) < 3 and place.objects > 1):
        expected = f"three or more of {', '.join(sorted(known))}, each once"
        found.append(Fault("types", wrong or types, expected + meant(wrong, known)))
    return found


def inner_tables(cls: type[Declares]) -> dict[str, type[Declares]]:
    """Key → class, of the parameters that are arrays of tables."""
    return {
        name: get_args(hint)[0]
        for name, hint in get_type_hints(cls).items()
        if get_origin(hint) is tuple and is_dataclass(get_args(hint)[0])
    }
