"""Small multiples: what each parameter of a technique does, one varied at a time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from seethrough.experiment.gallery.gallery_plates import SMALL, Plate
from seethrough.renderer.declared import Key, declared
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.base import Parameters

FACTORS = (0.4, 1.0, 2.5)  # of a parameter's default
SHARES = (0.0, 0.5, 1.0)  # of what is allowed, where the default is nothing
LAYERS = (1, 2, 4)
HANDS = {"depth", "step"}  # where hands are, and how far the wheel takes them
TWINS = {"exact"}  # the same picture in another time


def plates(
    name: str, where: str, scene: Scene, camera: Camera, p: Parameters, state: object
) -> Iterator[Plate]:
    """Plates of a technique, parameter by parameter, from `p` as it stands."""
    for parameter, values in varied(p).items():
        for number, value in enumerate(values):
            change: dict[str, object] = {parameter: value}
            said = f"{value:g}" if isinstance(value, float) else f"{value}"
            yield Plate(
                f"parameter-{where}-{name}-{parameter}-{number}", f"{parameter} = {said}",
                scene, camera, replace(p, **change), SMALL, state,
            )  # fmt: skip


def varied(p: Parameters) -> Mapping[str, tuple[object, ...]]:
    """The values to show of each parameter: all choices, or some numbers that are allowed."""
    found = {}
    for parameter, key in declared(type(p)).items():
        if parameter not in HANDS | TWINS:
            values = _values(getattr(p, parameter), key, parameter)
            kept = tuple(v for v in dict.fromkeys(values) if _stands(p, parameter, v))
            if len(kept) > 1:
                found[parameter] = kept
    return found


def _values(default: object, key: Key, parameter: str) -> tuple[object, ...]:
    if key.choices:
        return key.choices
    if isinstance(default, bool):
        return (False, True)
    if parameter == "layers":
        return (*LAYERS, default)
    if not isinstance(default, (int, float)):
        return ()
    high = float("inf") if key.high is None else key.high
    if not isinstance(high, (int, float)):
        return ()
    whole = type(default)
    low = key.low or 0.0
    if default == 0:
        return tuple(whole(s * high) for s in SHARES) if high < 10 else ()
    return tuple(whole(min(max(round(f * default, 3), low), high)) for f in FACTORS)


def _stands(p: Parameters, parameter: str, value: object) -> bool:
    """Whether a value goes with the others: some exclude each other."""
    change: dict[str, object] = {parameter: value}
    try:
        replace(p, **change)
    except ValueError:
        return False
    return True
