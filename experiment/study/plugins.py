"""What a study file may name: techniques, worlds and tasks, and what each declares of itself."""

from __future__ import annotations

from dataclasses import dataclass, is_dataclass
from typing import Any, get_args, get_origin, get_type_hints

from seethrough.experiment.study.parameter_tables import Fault
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.parameters import AbstractParameters, BuildingParameters

OWN, SHARED = "own", "shared"
TECHNIQUES = {"dynamic": DynamicTransparency, "standard": Standard}
WORLDS = {"abstract": AbstractParameters, "building": BuildingParameters}
SCENES = {"abstract": OWN, "building": SHARED}
TASK_WORLDS = {
    "count": ("abstract",),
    "pattern": ("abstract",),
    "unique": ("building",),
    "count_in_building": ("building",),
}


QUESTIONS = (
    "consent", "demographics", "color_check", "ratings", "comparison", "tlx", "sus", "depth_test",
    "remarks",
)  # fmt: skip


def names(kind: str) -> tuple[str, ...]:
    """The names of all techniques, worlds, tasks or question kinds."""
    known: dict[str, Any] = {
        "technique": TECHNIQUES, "world": WORLDS, "task": TASK_WORLDS, "question": QUESTIONS,
    }  # fmt: skip
    return tuple(known[kind])


def parameters(kind: str, name: str) -> Any:
    """The class of the parameters of one of them."""
    known: dict[str, Any] = {"technique": TECHNIQUES, "world": WORLDS}
    return known[kind][name] if kind in known else NoParameters


def worlds_of(task: str) -> tuple[str, ...]:
    """The worlds that a task can live in."""
    return TASK_WORLDS[task]


@dataclass(frozen=True)
class NoParameters:
    """Of what has none."""


def further_faults(place: Any) -> list[Fault]:
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
        found.append(Fault("types", wrong or types, expected))
    return found


def scenes_of(place: Any) -> str:
    """Whose scenes a world's parameters say: each person's own, or shared sets."""
    return SHARED if isinstance(place, BuildingParameters) else OWN


def inner_tables(cls: Any) -> dict[str, Any]:
    """Key → class, of the parameters that are arrays of tables."""
    return {
        name: get_args(hint)[0]
        for name, hint in get_type_hints(cls).items()
        if get_origin(hint) is tuple and is_dataclass(get_args(hint)[0])
    }


CODES = {"count": "T1", "pattern": "T2", "unique": "T3", "count_in_building": "T4"}
_TIME = {"name": "time", "unit": "s", "direction": "less", "scale": "ratio", "adds": "mean",
         "log": True, "rows": "all", "margin": None, "label": "completion time"}  # fmt: skip
_CORRECT = {**_TIME, "name": "correct", "unit": "", "direction": "more", "scale": "binary",
            "adds": "share", "log": False, "label": "right answers"}  # fmt: skip
_COUNT = {**_TIME, "name": "count_error", "unit": "objects", "scale": "count", "log": False,
          "label": "error of the count"}  # fmt: skip
_DISTANCE = {**_TIME, "name": "distance", "unit": "world units", "log": False,
             "label": "distance of the mark"}  # fmt: skip
_OWN = {"count": _COUNT, "count_in_building": _COUNT, "unique": _DISTANCE}


def code_of(task: str) -> str:
    """How a paper calls a task: T1."""
    return CODES[task]


def measures_of(task: str) -> list[dict[str, Any]]:
    """What is measured of a task, time first, as a sidecar has it."""
    own = [_OWN[task]] if task in _OWN else []
    return [dict(measure) for measure in (_TIME, _CORRECT, *own)]
