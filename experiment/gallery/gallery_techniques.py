"""Every technique on the same scenes, and where each of them fails."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import fields, replace

from seethrough import registry
from seethrough.experiment.gallery import gallery_parameters
from seethrough.experiment.gallery.gallery_failures import failures
from seethrough.experiment.gallery.gallery_plates import SIZE, Plate, Section
from seethrough.renderer import events
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques import named
from seethrough.renderer.techniques.base import Parameters, Shot

POINTER = (0.62, 0.5)  # at the horse of the stage
# How far from the eye what is looked for is, in the scene's units.
REACHES = {"stage": 11.5, "abstract": 97.2, "walkthrough": 29.0, "jeep": 3.4}


def sections(places: Mapping[str, tuple[Scene, Camera]]) -> Iterator[Section]:
    """Each technique in all places, by name, with what its parameters do in the first; then the
    failures."""
    first = next(iter(places))
    for name in registry.known("technique"):
        technique = registry.get("technique", name)
        plates = {
            where: _plate(name, where, Shot(scene, camera, SIZE), REACHES[where])
            for where, (scene, camera) in places.items()
        }
        yield Section(technique.title, technique.instruction, tuple(plates.values()))
        shown = plates[first]
        small = gallery_parameters.plates(
            name, first, shown.scene, shown.camera, shown.technique, shown.state
        )
        if many := tuple(small):
            yield Section(f"{technique.title}: parameters", "One varied at a time.", many)
    yield Section(
        "Where techniques fail",
        "Each picture is exact: what is wrong with it is the technique's own.",
        tuple(
            Plate(f"fails-{name}", f"{named(name).technique.title}: {f.words}", f.scene, f.camera,
                  f.parameters)
            for name, f in failures().items()
        ),
    )  # fmt: skip


def placed(name: str, shot: Shot, reach: float) -> tuple[Parameters, object]:
    """A technique's parameters and state, with its pointer somewhere, its volumes as large as the
    scene asks and up to a depth, and things transparent that have no tag."""
    p = named(name)
    known = {field.name for field in fields(p)}
    scale = reach / 11.5
    values: dict[str, object] = {"depth": reach} if "depth" in known else {}
    values |= {"radius": 1.1 * scale} if name == "dig" else {}
    values |= {"radius": 2.6 * scale} if name == "balloon" else {}
    if "kinds" in known and "wall" not in {thing.kind for thing in shot.scene.objects}:
        values["kinds"] = tuple(sorted({o.kind for o in shot.scene.objects if not o.target}))
    p = replace(p, **values)
    state = p.technique.begin(p)
    for event in (events.PointerMove(0.0, *POINTER, 0.0, 0.0), events.KeyPress(0.1, "q")):
        if isinstance(event, events.PointerMove) or name == "dig":
            state, _ = p.technique.on_event(p, state, event, shot)
    return p, state


def _plate(name: str, where: str, shot: Shot, reach: float) -> Plate:
    p, state = placed(name, shot, reach)
    if "kinds" in {field.name for field in fields(p)}:
        # Of one kind only, so that it is not taken for constant transparency.
        kinds = Counter(o.kind for o in shot.scene.objects if not o.target)
        only: dict[str, object] = {"kinds": (kinds.most_common(1)[0][0],)}
        p = replace(p, **only)
    title = f"{p.technique.title}, {where}"
    return Plate(f"technique-{where}-{name}", title, shot.scene, shot.camera, p, state=state)
